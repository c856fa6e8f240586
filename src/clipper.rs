//! Bézier clipping of one surface and one ray: clips, bisections, and the regions that wait.
//!
//! A region's u and v are clipped in turn. If a clip removes less than the threshold, the region is bisected: of two roots no
//! clip parts one from the other. A region that is proved to hold one root at most is done with by Newton's method, which ends
//! with the root or with the proof that there is none.
//!
//! Source: T. Nishita, T. W. Sederberg and M. Kakimoto, "Ray tracing trimmed rational surface patches", SIGGRAPH 1990; the
//! paper's sections "Clipping Process of Bézier Clipping" and "An Improvement of Bézier Clipping". The end by Newton's
//! method is a departure: it stands for the last clips, and refuses the phantom hits that Campagna, Slusallek and Seidel
//! (1997) found, where a region shrinks to a point that the ray passes by.

use crate::bernstein::{BasisView, Direction, Full};
use crate::clip::{Clip, chords, clip_by, corners, turned};
use crate::contract::{Contraction, Single, contract, is_provable, single};
use crate::graze::{Across, Met, across, first_met, on_line, polished};
use crate::limits::{Limit, Limits, Work, spend};
use crate::local::{Exactness, Local};
use crate::parameter::Parameter;
use crate::part::Part;
use crate::passed::{all_pass, passes};
use crate::planes::{Planes, project_net};
use crate::point::Point;
use crate::ray::Incidence;
use crate::reading::{Ours, Reading};
use crate::region::{Order, Region};
use crate::root::{Place, Root};
use crate::roots::{Seen, Sighting};
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::Surface;
use heapless::vec::VecView;

/// Room for clipping one surface.
#[derive(Debug)]
pub struct ClipRoom<'s, P: Point> {
    /// For the projected net of the surface.
    pub whole: &'s mut VecView<P::Flat>,
    /// For that of the region at hand.
    pub part: &'s mut VecView<P::Flat>,
    /// For regions that wait; its capacity bounds them, as [`Limits::pending_domains`] does.
    pub pending: &'s mut VecView<Region<P::Parameter>>,
    /// For the roots found so far, so that one found from two regions counts once. Those for which there is no room may
    /// be found again.
    pub roots: &'s mut VecView<Root<P::Parameter>>,
    /// For evaluating the surface.
    pub basis: BasisView<'s, P::Scalar>,
}

/// One ray and one surface.
#[derive(Debug)]
pub struct Clipper<'a, 's, 'm, P: Point> {
    /// The surface.
    pub surface: &'a Surface<'m, P>,
    /// The ray.
    pub planes: &'a Planes<P::Scalar>,
    /// Bounds on the work.
    pub limits: &'a Limits<P::Scalar>,
    /// What it works in.
    pub room: &'a mut ClipRoom<'s, P>,
}

impl<'s, 'm, P: Point> Clipper<'_, 's, 'm, P> {
    /// Projects the net, for [`Clipper::single`] and [`Clipper::roots_within`].
    #[inline(always)]
    pub(crate) fn project(&mut self) -> Result<(), Limit> {
        project_net(&self.surface.net, self.planes, self.room.whole).map(|_| ()).map_err(|Full| Limit::Scratch)
    }

    /// The root in a region, if it is proved to hold one at most. The net has to be projected.
    #[inline(always)]
    pub(crate) fn single(
        &mut self,
        region: Region<P::Parameter>,
        work: &mut Work,
    ) -> Result<Single<P::Parameter>, Limit> {
        let Clipper { surface, planes, limits, room } = self;
        let ClipRoom { whole, basis, .. } = &mut **room;
        let whole = whole.get(..surface.net.points().len()).ok_or(Limit::Scratch)?;
        let exact = Exactness::of(surface, planes, limits);
        single(surface, planes, whole, region, &exact, limits, basis, work)
    }

    /// The surface at (u, v) to first order. The net has to be projected.
    pub(crate) fn local(&mut self, at: [P::Parameter; 2], work: &mut Work) -> Result<Local<P::Parameter>, Limit> {
        let Clipper { surface: Surface { net, .. }, limits, room, .. } = self;
        let ClipRoom { whole, basis, .. } = &mut **room;
        let whole = whole.get(..net.points().len()).ok_or(Limit::Scratch)?;
        Local::step_at(at, net.degrees(), whole, basis, limits, work)
    }

    /// All points where the ray's line meets a region of the surface, to `found`. The net has to be projected.
    #[inline(always)]
    pub(crate) fn roots_within(
        &mut self,
        region: Region<P::Parameter>,
        work: &mut Work,
        mut found: impl FnMut(Root<P::Parameter>, &mut Work),
    ) -> Result<(), Limit> {
        match self.single(region, work)? {
            Single::Nothing => {}
            Single::Root(root, _) => found(root, work),
            Single::Unproved => {
                let mut roots = self.search(Ours, Order::Any, Some(region))?;
                // Ends with the roots, whose search counts clips against a budget.
                while let Some(root) = roots.next(work)? {
                    found(root, work);
                }
            }
        }
        Ok(())
    }

    /// The search for all points where the ray's line meets the surface, in `order`.
    #[inline(always)]
    pub fn roots(&mut self, order: Order<P::Parameter>) -> Result<Roots<'_, 's, 'm, P>, Limit> {
        self.roots_by(Ours, order)
    }

    /// [`Clipper::roots`] by another reading of the paper.
    #[inline(always)]
    pub(crate) fn roots_by<R: Reading>(
        &mut self,
        reading: R,
        order: Order<P::Parameter>,
    ) -> Result<Roots<'_, 's, 'm, P, R>, Limit> {
        self.project()?;
        self.search(reading, order, None)
    }

    /// [`Clipper::roots`] of a region of the surface, or all of it, from the projected net.
    #[inline]
    pub(crate) fn search<R: Reading>(
        &mut self,
        reading: R,
        order: Order<P::Parameter>,
        region: Option<Region<P::Parameter>>,
    ) -> Result<Roots<'_, 's, 'm, P, R>, Limit> {
        let Clipper { surface, planes, limits, room } = self;
        let ClipRoom { whole, part, pending, roots: found, basis } = &mut **room;
        let whole: &[P::Flat] = whole.get(..surface.net.points().len()).ok_or(Limit::Scratch)?;
        let exact = Exactness::of(surface, planes, limits);
        let degrees = surface.net.degrees();
        let part = Part::whole(reading, degrees, whole, exact.of_net::<P::Flat>(degrees), part);
        let mut part = part.map_err(|Full| Limit::Scratch)?;
        if let (Some(part), Some(region)) = (&mut part, region) {
            part.become_region(whole, region);
        }
        pending.clear();
        found.clear();
        let open = part.is_some();
        Ok(Roots {
            reading,
            surface,
            planes,
            limits,
            exact,
            whole,
            part,
            open,
            bisected: false,
            sighting: Sighting::New,
            order,
            pending,
            found,
            basis,
        })
    }
}

/// The search for all points where a ray's line meets a surface, or a region of it: they are asked for one by one.
///
/// A machine holds this code once, whatever becomes of the roots: it is most of what clipping takes.
pub struct Roots<'a, 's, 'm, P: Point, R = Ours> {
    reading: R,
    surface: &'a Surface<'m, P>,
    planes: &'a Planes<P::Scalar>,
    limits: &'a Limits<P::Scalar>,
    exact: Exactness<P::Scalar>,
    /// The surface's projected net.
    whole: &'a [P::Flat],
    /// The region at hand; none of a surface that is seen to pass the ray by.
    part: Option<Part<'a, P::Flat>>,
    /// Whether that is still to be clipped.
    open: bool,
    /// Whether any region was bisected.
    bisected: bool,
    /// What the last root was.
    sighting: Sighting<P::Parameter>,
    order: Order<P::Parameter>,
    pending: &'a mut VecView<Region<P::Parameter>>,
    found: &'a mut VecView<Root<P::Parameter>>,
    basis: &'a mut BasisView<'s, P::Scalar>,
}

impl<P: Point, R: Reading> Roots<'_, '_, '_, P, R> {
    /// Whether regions wait that may hold more roots.
    #[inline(always)]
    pub fn regions_wait(&self) -> bool {
        !self.pending.is_empty()
    }

    /// The root for which the last one stands: found before, but met behind it.
    #[inline(always)]
    pub(crate) fn replaced(&self) -> Option<Root<P::Parameter>> {
        if let Sighting::Nearer(root) = self.sighting { Some(root) } else { None }
    }

    /// The next root; `None` if there are no more.
    ///
    /// # Errors
    /// What ran out: then the search is at its end, too.
    #[inline(always)]
    pub fn next(&mut self, work: &mut Work) -> Result<Option<Root<P::Parameter>>, Limit> {
        // Most surfaces have one root, after which no region waits.
        if self.open || self.regions_wait() { self.clip_on(work) } else { Ok(None) }
    }

    #[inline(never)]
    fn clip_on(&mut self, work: &mut Work) -> Result<Option<Root<P::Parameter>>, Limit> {
        let Roots { surface, planes, limits, exact, whole, part: Some(part), pending, found, basis, order, .. } = self
        else {
            return Ok(None);
        };
        let reading = self.reading;
        let (exact, tolerance) = (&*exact, exact.tolerance);
        // Whether the last clip, which was of the other parameter, found it settled; or left it as it was.
        let (mut settled, mut stuck) = (false, false);
        // Ends: each turn counts a clip against its budget.
        loop {
            if !self.open {
                // Ends: each turn takes one of the regions that wait.
                loop {
                    match order.pop(pending) {
                        Some(region) => {
                            P::Scalar::tell(|| Event::Region {
                                sides: region.sides.map(|side| side.map(|t| t.number().to_f64())),
                            });
                            part.become_region(whole, region);
                        }
                        None => return Ok(None),
                    }
                    // Most halves of a small region, which only a fold keeps from being proved, lie apart from the ray across
                    // it; of larger ones a clip is the better question.
                    let folded = reading.look_across() && is_provable(surface, part.region.widths(), exact);
                    if !folded || !matches!(across(part.degrees, part.net, &part.noise(tolerance)), Across::Apart) {
                        break;
                    }
                }
                (self.open, settled, stuck) = (true, false, false);
            }
            let direction = part.region.next;
            part.region.next = direction.other();
            let widths = part.region.widths();
            let is_point = |width: P::Scalar| {
                !reading.newton_end() && width <= P::Scalar::EPSILON.sqrt() * P::Scalar::from_f64(END)
            };
            let mut step = if widths.into_iter().all(is_point) {
                Step::Done(Some(middle(surface, whole, part, basis)?))
            } else {
                spend(&mut work.clip_steps, limits.clip_steps, Limit::ClipSteps)?;
                let noise = part.noise(tolerance);
                let clipped = clip_by(reading, part.degrees, part.net, direction, &noise);
                P::Scalar::tell(|| told(&part.region, direction, &clipped));
                match clipped {
                    Clip::Nothing => Step::Done(None),
                    Clip::Part([from, to]) if to - from <= P::Scalar::ONE - limits.clip_threshold => {
                        part.narrow(direction, [from, to]);
                        (settled, stuck) = (false, false);
                        if reading.newton_end() && (!self.bisected || may_be_single(surface, part, exact)) {
                            match contract(surface, whole, part.region, part.error, exact, limits, basis, work)? {
                                Contraction::Open => Step::On,
                                Contraction::Done(place) => Step::Done(place.map(crossed)),
                            }
                        } else {
                            Step::On
                        }
                    }
                    Clip::Part(_) if is_point(widths[direction as usize]) => Step::Settled,
                    // A width that cannot be halved is as settled as one that need not be. One that moves nothing, as along a
                    // collapsed edge, is not to be halved when the other, settled as seen across its own line, is what keeps it
                    // from being clipped.
                    //
                    // Ours: along a collapsed edge each half is as long as the whole, down to the edge: the other parameter is clipped
                    // toward it as long as that shortens it.
                    Clip::Part(_) if !(stuck || settled) && part.is_collapsed(direction) => {
                        stuck = true;
                        Step::On
                    }
                    // Ours: what a clip leaves that does not shorten the interval enough is let go, and the interval halved as it was.
                    Clip::Part(_) => {
                        let halves = || {
                            let much_longer = part.much_longer().filter(|_| reading.long_side());
                            let halved = if settled { part.longer() } else { much_longer.unwrap_or(direction) };
                            part.region.halves(halved).map_or(Step::Settled, Step::Bisect)
                        };
                        let seen =
                            if reading.look_across() { across(part.degrees, part.net, &noise) } else { Across::Open };
                        match seen {
                            Across::Apart => Step::Done(None),
                            Across::Line(along) => {
                                if passes(surface, whole, &part.region, Some(turned(along)), exact, basis)? {
                                    Step::Done(None)
                                } else {
                                    match on_line(
                                        surface,
                                        planes,
                                        whole,
                                        &part.region,
                                        along,
                                        exact,
                                        part.error,
                                        basis,
                                    )? {
                                        Some(met) => Step::Done(Some(met)),
                                        None => halves(),
                                    }
                                }
                            }
                            Across::Open => halves(),
                        }
                    }
                    Clip::Settled => Step::Settled,
                }
            };
            if let (Step::Settled, true) = (&step, settled) {
                // A region as small as the error of its net, or as thin, holds a root, a grazing one, if some place of it
                // passes the ray by no more than that.
                step = match nearest(surface, planes, whole, &part.region, exact, part.error, basis)? {
                    Some(met) => Step::Done(Some(met)),
                    None if all_pass(surface, whole, part, exact, basis)? => Step::Done(None),
                    // Between lines that are near parallel both clips may settle too soon.
                    None => {
                        let longer = part.longer();
                        match part.region.halves(longer).or_else(|| part.region.halves(longer.other())) {
                            Some(halves) => Step::Bisect(halves),
                            // No number parts what is left, and nothing proves that the ray passes it: so it is told as a graze.
                            None => {
                                let all = P::Scalar::INFINITY;
                                Step::Done(nearest(surface, planes, whole, &part.region, exact, all, basis)?)
                            }
                        }
                    }
                };
            }
            match step {
                Step::On => {}
                Step::Settled => settled = true,
                Step::Bisect([first, second]) => {
                    spend(&mut work.bisections, limits.bisections, Limit::Bisections)?;
                    P::Scalar::tell(|| Event::Bisection);
                    work.bisection_cases += u32::from(!self.bisected);
                    self.bisected = true;
                    order.push(second, pending, limits.pending_domains)?;
                    order.push(first, pending, limits.pending_domains)?;
                    self.open = false;
                }
                Step::Done(met) => {
                    self.open = false;
                    if let Some(Met { place, incidence }) = met {
                        let mut root = place.root(&surface.net, whole, planes, exact, basis)?;
                        root.incidence = root.incidence.max(incidence);
                        let seen = Seen { surface, planes, whole, exact };
                        let again = reading.known_roots();
                        let sighting = if again { seen.add(&mut root, found, basis)? } else { Sighting::New };
                        if sighting != Sighting::Known {
                            self.sighting = sighting;
                            return Ok(Some(root));
                        }
                        work.intersection_points += u32::from(planes.t_in_interval(root.depth).is_some());
                    }
                }
            }
        }
    }
}

/// Whether a region may be proved to hold one root at most, by the mean Jacobian over it, which the corners of its net tell
/// without evaluating the surface: if not by four times what the proof allows for, asking would be in vain.
#[inline(always)]
fn may_be_single<P: Point>(surface: &Surface<'_, P>, part: &Part<'_, P::Flat>, exact: &Exactness<P::Scalar>) -> bool {
    let widths = part.region.widths();
    // That is not asked for anyhow.
    if !is_provable(surface, widths, exact) {
        return false;
    }
    let [[fu, gu], [fv, gv]] = chords(corners(part.degrees, part.net)).map(|chord| chord.map(|c| c * P::Scalar::HALF));
    let halves = widths.map(|width| width * P::Scalar::HALF);
    let strays = surface.strays(halves);
    let [along_u, along_v] = [fv.abs() + gv.abs(), fu.abs() + gu.abs()].map(|length| length * strays);
    // Mean chords are derivatives times whole widths.
    let determinant = (fu * gv - gu * fv).abs();
    let [u, v] = halves;
    // The way that an error makes in u, by the inverse of the Jacobian, is that times a width; and must be less than half of
    // either.
    let way = along_u * u + along_v * v;
    way <= determinant * P::Scalar::TWO * u.lesser(v)
}

/// A place where the ray does not follow the surface.
#[inline(always)]
fn crossed<A: Parameter>(place: Place<A>) -> Met<A> {
    Met { place, incidence: Incidence::Crossing }
}

/// That a region was clipped.
fn told<A: Parameter>(region: &Region<A>, direction: Direction, clipped: &Clip<A::Scalar>) -> Event {
    let left = match clipped {
        Clip::Nothing => None,
        Clip::Part(part) => Some(part.map(Scalar::to_f64)),
        Clip::Settled => Some([0.0, 1.0]),
    };
    Event::Clip {
        sides: region.sides.map(|side| side.map(|t| t.number().to_f64())),
        in_v: direction == Direction::V,
        left,
    }
}

/// By the paper's letter an interval this narrow is one point, as a multiple of the square root of a rounding. Were it narrower,
/// rounding would let more points be found twice, and were it wider, they would be less exact.
const END: f64 = 0.0625;

/// The middle of a region that is a point: the end of the paper's clipping.
#[cold]
#[inline(never)]
fn middle<P: Point>(
    surface: &Surface<'_, P>,
    whole: &[P::Flat],
    part: &Part<'_, P::Flat>,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Met<P::Parameter>, Limit> {
    Ok(crossed(Place::look(part.region.middle(), surface.net.degrees(), whole, basis)?))
}

/// What a clip leads to.
enum Step<A: Parameter> {
    /// The next clip.
    On,
    /// The region's halves.
    Bisect([Region<A>; 2]),
    /// The clipped parameter cannot be told closer.
    Settled,
    /// The region is done with: where its root is, if it has one.
    Done(Option<Met<A>>),
}

/// Of a region whose points all pass the ray within the tolerance or the error of their net, the one that the ray meets
/// first, in its interval if one is; from its corners, the middles of its sides and its middle, each brought nearer by Newton's
/// method. `None` if the ray passes all of them by, by more than what is allowed and `held`, as it may at a phantom hit.
///
/// Such a region is small but where the ray lies in the surface.
#[cold]
#[inline(never)]
fn nearest<P: Point>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    whole: &[P::Flat],
    region: &Region<P::Parameter>,
    exact: &Exactness<P::Scalar>,
    held: P::Scalar,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Option<Met<P::Parameter>>, Limit> {
    let ([[u0, u1], [v0, v1]], [u, v]) = (region.sides, region.middle());
    let mut from = |at| polished(surface, whole, region, at, exact, &mut *basis);
    let corners = [from([u0, v0])?, from([u0, v1])?, from([u1, v0])?, from([u1, v1])?];
    let [a, b, c, d] = corners;
    let places = [from([u, v])?, a, b, c, d, from([u0, v])?, from([u1, v])?, from([u, v0])?, from([u, v1])?];
    first_met(surface, planes, places, exact, held, basis)
}

#[cfg(test)]
mod tests;
