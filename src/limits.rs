//! Every bound on work, the count of work done, and what a call says when a bound ran out.
//!
//! [`Limits`] holds two kinds of numbers. *Parameters* shape an algorithm (how many Newton iterations a start may take);
//! reaching one is part of the algorithm. *Budgets* bound a counter of [`Work`] over one call, that is one ray through the
//! whole scene; reaching one ends the call with [`GaveUp`], which is neither a hit nor a miss. Only a method with coherence memory
//! may come to twice a budget: where the search that memory led runs out, the ray is searched without memory, by budgets of its
//! own, so that it is answered wherever the original method answers it.

use crate::ray::Hit;
use crate::scalar::Scalar;

/// By which rule a ray is believed to meet a patch at most once, or not at all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Acceptance {
    /// The paper's: unless eq. (1), tan α > b/h, flags the ray as nearly tangential. Likely, not certain.
    #[default]
    Paper,
    /// Only where that is proved: of a point found before, by the patch's projection along the ray being injective
    /// ([`Patch::at_most_once`](crate::patch::Patch::at_most_once); a rational patch is never proved so). And of each other patch
    /// that the ray meets Newton's methods prove that it holds no root or one, or hand it to their
    /// [`Fallback`](crate::fallback::Fallback), if they have one.
    Proved,
}

/// The most starts of Newton's method on one patch: the paper's number.
pub const MAX_NEWTON_STARTS: u32 = 3;

/// The bounds of one call: one ray through the whole scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<S> {
    /// Parameter: evaluations of the surface that one Newton start may take, halved steps included, and but one to look at a root
    /// that a singular Jacobian led to. Starts that succeed need 2 to 4; each one more is paid only by starts that fail, and now
    /// and then saves one.
    pub newton_iterations: u32,
    /// Parameter: starts per patch, at most [`MAX_NEWTON_STARTS`]: the parallelogram, the entrance, the exit. Fewer is
    /// faster and loses roots at silhouettes.
    pub newton_starts: u32,
    /// Parameter: how often one Newton step may be halved because the residual grew. 0 is the undamped method.
    pub newton_halvings: u32,
    /// Parameter: how far from the ray a root may lie, as a share of its surface's size (the longest side of its control points'
    /// box); never below what rounding of the surface's coordinates, and of the ray's near it, leaves. Larger saves an
    /// evaluation or a clip of some roots; what else stands in the scene changes nothing.
    pub tolerance: S,
    /// Parameter: the factor f in eq. (1), read as tan α > f · b/h; the paper's is 1. Smaller flags more rays as critical,
    /// which costs time and loses fewer double roots.
    pub critical_factor: S,
    /// Parameter: what Newton's methods and the coherent ones take for "met at most once".
    pub acceptance: Acceptance,
    /// Parameter: the share of a parameter's interval that a clip has to remove, else the interval is bisected; the
    /// paper's is 0.20. Smaller clips on where a bisection would part two roots, larger bisects where a clip would do.
    pub clip_threshold: S,
    /// Budget: surfaces whose box is tested.
    pub surfaces: u32,
    /// Budget: inner nodes of binary trees tested.
    pub nodes: u32,
    /// Budget: patches whose parallelepiped is tested.
    pub patches: u32,
    /// Budget: voxels visited, of the scene's grid and the surfaces' grids together.
    pub voxels: u32,
    /// Budget: spans of a view's scan line looked at.
    pub spans: u32,
    /// Budget: Newton iterations, that is evaluations of a surface.
    pub newton_steps: u32,
    /// Budget: clips of a parameter's interval.
    pub clip_steps: u32,
    /// Budget: bisections of a parameter's interval.
    pub bisections: u32,
    /// Budget: domains of one surface that wait to be clipped at one time. The scratch may hold fewer.
    pub pending_domains: u32,
}

impl<S: Scalar> Default for Limits<S> {
    /// The paper's values where it gives one. The budgets are a hundred times what the hardest ray of the common teapot
    /// needs: no honest ray of such a scene meets them, and a pathological one ends within milliseconds (of degrees 15 × 15
    /// within a tenth of a second).
    fn default() -> Self {
        Limits {
            newton_iterations: 12,
            newton_starts: MAX_NEWTON_STARTS,
            newton_halvings: 3,
            tolerance: S::TOLERANCE,
            critical_factor: S::ONE,
            acceptance: Acceptance::Paper,
            clip_threshold: S::from_f64(0.2),
            surfaces: 100_000,
            nodes: 1_000_000,
            patches: 1_000_000,
            voxels: 1_000_000,
            spans: 1_000_000,
            newton_steps: 100_000,
            clip_steps: 50_000,
            bisections: 10_000,
            pending_domains: 64,
        }
    }
}

/// How large a scene is, for [`Limits::worst_case`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Surfaces in the scene.
    pub surfaces: u32,
    /// Inner nodes of all binary trees (0 for a method without them).
    pub nodes: u32,
    /// Patches of all surfaces.
    pub patches: u32,
    /// The most voxels that one line can pass in the scene's grid.
    pub scene_voxels: u32,
    /// The most voxels that one line can pass, summed over the surfaces' grids (0 for a method without them).
    pub surface_voxels: u32,
    /// The most spans in one of a view's scan lines (0 for rays of no view).
    pub spans: u32,
    /// How often a method may walk the grid of one surface, or the spans of a line, for one ray: 0, or 2 with a testing ray first.
    pub walks: u32,
    /// Whether the method is a clipping method, or falls back on one: these have no bound on clips and Newton iterations but the
    /// budget.
    pub clipped: bool,
}

impl<S: Scalar> Limits<S> {
    /// Whether the parameters are what a person can mean: numbers, a tolerance of at least 0, at least one start and one step.
    /// Of others rays find nothing, and no budget runs out that would say so; searches take them as they are.
    pub fn in_range(&self) -> bool {
        let Limits { tolerance, critical_factor, clip_threshold, newton_starts, newton_iterations, .. } = *self;
        let finite = tolerance.is_finite() && critical_factor.is_finite() && clip_threshold.is_finite();
        let steps = (1..=MAX_NEWTON_STARTS).contains(&newton_starts) && newton_iterations > 0;
        finite && tolerance >= S::ZERO && steps
    }

    /// The same budgets for a call that goes on counting where `work` stands, and began when it had counted this many spans.
    #[inline(always)]
    pub(crate) fn beyond(&self, work: &Work, spans: u32) -> Self {
        Limits {
            surfaces: self.surfaces.saturating_add(work.surfaces_tested),
            nodes: self.nodes.saturating_add(work.nodes_visited),
            patches: self.patches.saturating_add(work.patches_tested),
            voxels: self.voxels.saturating_add(work.voxels_visited),
            spans: self.spans.saturating_add(spans),
            newton_steps: self.newton_steps.saturating_add(work.newton_steps),
            clip_steps: self.clip_steps.saturating_add(work.clip_steps),
            bisections: self.bisections.saturating_add(work.bisections),
            ..*self
        }
    }

    /// The most work one call can do under these limits, whatever the ray, in a scene of this extent.
    pub fn worst_case(&self, extent: &Extent) -> Work {
        let search = self.worst_search(extent);
        // A search that memory led is begun anew without it where it runs out.
        let (searches, all) = if extent.walks > 1 { (2, search.plus(&search)) } else { (1, search) };
        // A line's list is made once. Each of its spans may come into it past all before it, n (n − 1) / 2 times in all, and is
        // looked at five times: for the list, in two searches, and in a walk around a fold in each.
        let spans = u64::from(extent.spans);
        let visited = (spans.saturating_mul(spans + 9) / 2).min(searches * u64::from(self.spans));
        Work { spans_visited: u32::try_from(visited).unwrap_or(u32::MAX), ..all }
    }

    /// The same of one search, but for spans.
    fn worst_search(&self, extent: &Extent) -> Work {
        // In each walk a view's clipping method may go through what the ray meets once more, where a fold is all but touched.
        let walks = extent.walks.max(1);
        let walks = if extent.clipped && extent.spans > 0 { walks.saturating_mul(2) } else { walks };
        // A remembered point and the verification's starts come on top of those of the full search.
        let starts_per_patch = self.newton_starts.saturating_add(extent.walks.min(1));
        let patches = extent.patches.saturating_mul(walks).min(self.patches);
        let clips = if extent.clipped { self.clip_steps } else { 0 };
        let starts = patches.saturating_mul(starts_per_patch).saturating_add(extent.surfaces);
        // What proves that a patch holds one root at most finds it, without a start and without a clip.
        let proved = if extent.clipped { patches } else { 0 };
        Work {
            surfaces_tested: extent.surfaces.min(self.surfaces),
            nodes_visited: extent.nodes.min(self.nodes),
            patches_tested: patches,
            voxels_visited: extent
                .surface_voxels
                .saturating_mul(extent.walks)
                .saturating_add(extent.scene_voxels)
                .min(self.voxels),
            spans_visited: 0,
            newton_starts: starts,
            newton_steps: if extent.clipped || self.acceptance == Acceptance::Proved {
                self.newton_steps
            } else {
                starts.saturating_mul(self.newton_iterations.saturating_add(1)).min(self.newton_steps)
            },
            critical: patches,
            unresolved: patches,
            excluded: patches,
            handed_over: patches,
            intersection_points: starts.saturating_add(proved).saturating_add(clips),
            verified: extent.surfaces,
            decided_by_list: extent.surfaces,
            start_failed: extent.surfaces,
            full_searches: extent.surfaces,
            clip_steps: clips,
            bisections: if extent.clipped { self.bisections.min(clips) } else { 0 },
            // Of each patch that is handed over one more.
            bisection_cases: if extent.clipped { extent.surfaces.saturating_add(patches) } else { 0 },
            refused_as_critical: extent.surfaces,
            refused_by_list: extent.surfaces,
            refused_by_neighbour: extent.surfaces,
        }
    }
}

macro_rules! counters {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// What one call did. A call begins by setting all to 0; the caller sums over rays as it likes.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Work {
            $($(#[$doc])* pub $name: u32,)*
        }

        impl Work {
            /// How many counters there are.
            pub const COUNT: usize = [$(stringify!($name)),*].len();
            /// The counters' names, in the order of [`Work::counts`].
            pub const NAMES: [&'static str; Work::COUNT] = [$(stringify!($name)),*];

            /// The counters.
            pub fn counts(&self) -> [u32; Work::COUNT] {
                [$(self.$name),*]
            }

            /// These and others together.
            pub(crate) fn plus(&self, other: &Work) -> Work {
                Work { $($name: self.$name.saturating_add(other.$name)),* }
            }

            /// What was counted since the counters were these: of one ray, where they go on from ray to ray.
            pub fn since(&self, before: &Work) -> Work {
                Work { $($name: self.$name.saturating_sub(before.$name)),* }
            }
        }
    };
}

counters! {
    /// Surfaces whose min-max box was tested.
    surfaces_tested,
    /// Inner nodes of binary trees whose parallelepiped was tested.
    nodes_visited,
    /// Patches whose parallelepiped was tested.
    patches_tested,
    /// Voxels visited, of the scene's grid and the surfaces' grids together.
    voxels_visited,
    /// Spans of a view's scan line that were looked at.
    spans_visited,
    /// Newton starts.
    newton_starts,
    /// Newton iterations: evaluations of a surface with its derivatives.
    newton_steps,
    /// Patches met in the critical case of eq. (1).
    critical,
    /// Patches met of which no start led to a root; taken for no hit, as in the paper.
    unresolved,
    /// Newton's methods with a fallback, under [`Acceptance::Proved`]: patches met that are proved to hold no root.
    excluded,
    /// The same: patches met that the fallback decided.
    handed_over,
    /// Roots found in the interval, each time they were found, those that clipping knows again among them: the paper's
    /// "intersection points". How often clipping finds one again depends on how it ends.
    intersection_points,
    /// Coherent: points confirmed at once, alone in the testing ray's list.
    verified,
    /// Coherent: points confirmed or replaced by Newton over the testing ray's list.
    decided_by_list,
    /// Coherent: the remembered start led to no point, or to one that the testing ray could not judge.
    start_failed,
    /// Coherent: searches of a surface's whole grid.
    full_searches,
    /// Clips of a parameter's interval.
    clip_steps,
    /// Bisections of a parameter's interval.
    bisections,
    /// Surfaces, or patches that were handed over, of which a domain was bisected: the paper's bisection case. Others that
    /// the ray met are the straight-forward case.
    bisection_cases,
    /// Coherent clipping: points not verified because the ray is critical, by eq. (1), in the patch that holds them, or
    /// because no listed patch holds them.
    refused_as_critical,
    /// Coherent clipping: points not verified because the testing ray meets another patch.
    refused_by_list,
    /// Of those: the other patch only adjoins the one that holds the point.
    refused_by_neighbour,
}

/// The bound that ran out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// [`Limits::surfaces`].
    Surfaces,
    /// [`Limits::nodes`].
    Nodes,
    /// [`Limits::patches`].
    Patches,
    /// [`Limits::voxels`].
    Voxels,
    /// [`Limits::spans`].
    Spans,
    /// [`Limits::newton_steps`].
    NewtonSteps,
    /// [`Limits::clip_steps`].
    ClipSteps,
    /// [`Limits::bisections`].
    Bisections,
    /// [`Limits::pending_domains`], or the room for them in the scratch.
    PendingDomains,
    /// The caller's list of hits is full.
    Hits,
    /// The scratch is too small for a surface of these degrees: its capacities are the owner's choice.
    Scratch,
    /// The ray is not of the part of the image that the scan line was made for.
    Line,
    /// Coherence memory with fewer slots than surfaces.
    Memory,
    /// A slot of lent memory names a place that is not there: the memory was not filled by this crate.
    Slot,
}

impl Limit {
    /// Its name as the command line writes it.
    pub fn name(self) -> &'static str {
        match self {
            Limit::Surfaces => "surfaces",
            Limit::Nodes => "nodes",
            Limit::Patches => "patches",
            Limit::Voxels => "voxels",
            Limit::Spans => "spans",
            Limit::NewtonSteps => "newton-steps",
            Limit::ClipSteps => "clip-steps",
            Limit::Bisections => "bisections",
            Limit::PendingDomains => "pending-domains",
            Limit::Hits => "hits",
            Limit::Scratch => "scratch",
            Limit::Line => "line",
            Limit::Memory => "memory",
            Limit::Slot => "slot",
        }
    }
}

impl core::fmt::Display for Limit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// A call ran out of a bound: neither a hit nor a miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaveUp<S> {
    /// Which bound.
    pub limit: Limit,
    /// The closest hit found by then. It is not an answer: a closer one may exist.
    pub best: Option<Hit<S>>,
}

impl<S: Scalar> core::fmt::Display for GaveUp<S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "gave up: the bound on {} ran out", self.limit.name())
    }
}

impl<S: Scalar> core::error::Error for GaveUp<S> {}

/// Counts one unit of work, unless that would pass its budget.
#[inline(always)]
pub(crate) fn spend(counter: &mut u32, budget: u32, limit: Limit) -> Result<(), Limit> {
    if *counter >= budget {
        return Err(limit);
    }
    *counter += 1;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_of_n_allows_n() {
        let mut counter = 0;
        assert!((0..3).all(|_| spend(&mut counter, 3, Limit::Patches).is_ok()));
        assert_eq!(spend(&mut counter, 3, Limit::Patches), Err(Limit::Patches));
        assert_eq!(counter, 3);
        assert_eq!(spend(&mut 0, 0, Limit::Patches), Err(Limit::Patches));
    }

    /// With no starts allowed and no clips, a ray that met 64 patches once was said to find nothing, and found a point in each.
    #[test]
    fn a_proof_finds_points_without_a_start() {
        let limits = Limits { newton_starts: 0, clip_steps: 0, ..Limits::<f32>::default() };
        let extent = Extent { surfaces: 1, patches: 64, clipped: true, ..Extent::default() };
        assert_eq!(limits.worst_case(&extent).intersection_points, 65);
        assert_eq!(limits.worst_case(&Extent { clipped: false, ..extent }).intersection_points, 1);
    }

    /// Through the C interface, and by no name of a bound that ran out, these once answered misses.
    #[test]
    fn parameters_with_which_nothing_is_found_are_out_of_range() {
        let good = Limits::<f64>::default();
        assert!(
            good.in_range() && Limits { tolerance: 0.0, newton_starts: 1, newton_iterations: 1, ..good }.in_range()
        );
        for bad in [
            Limits { tolerance: -1e-300, ..good },
            Limits { tolerance: f64::NAN, ..good },
            Limits { critical_factor: f64::INFINITY, ..good },
            Limits { clip_threshold: f64::NAN, ..good },
            Limits { newton_starts: 0, ..good },
            Limits { newton_starts: MAX_NEWTON_STARTS + 1, ..good },
            Limits { newton_iterations: 0, ..good },
        ] {
            assert!(!bad.in_range(), "{bad:?}");
        }
    }

    #[test]
    fn the_outcome_stays_small_because_it_rides_in_every_return() {
        assert!(size_of::<Result<Option<Hit<f64>>, GaveUp<f64>>>() <= 48);
        assert!(size_of::<Result<Option<Hit<f32>>, GaveUp<f32>>>() <= 28);
    }
}
