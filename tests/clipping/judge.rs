//! A list of hits against the oracle's roots, one for one.

use crate::ask::{Answers, Query};
use crate::common::{Built, Kind, dot, norm};
use patchray::bernstein::Basis;
use patchray::ray::Incidence;
use patchray::scalar::Scalar;
use patchray_host::oracle::{Oracle, Verdict};

/// What may be off, as shares of the model's diagonal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    /// Along the ray, times |cos(d, n)|.
    pub(crate) across: f64,
    /// Along the ray, however flat the ray.
    pub(crate) most: f64,
    /// A ray that changes its answer when it moves by less is not judged.
    pub(crate) margin: f64,
}

impl Allowed {
    /// As `patchray_host::judge` allows; in `f32` four times that, which is what a region that noise keeps from being clipped
    /// may pass the ray by, with margins for what the control points lose.
    pub(crate) fn of<S: Scalar>() -> Self {
        if S::EPSILON.to_f64() < 1e-10 {
            Allowed { across: 1e-9, most: 1e-4, margin: 1e-11 }
        } else {
            Allowed { across: 2e-5, most: 4e-3, margin: 8e-5 }
        }
    }
}

/// What became of many rays.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) rays: u32,
    /// Rays of which every root was judged.
    pub(crate) judged: u32,
    pub(crate) roots: u32,
    /// Roots without a hit, hits without a root, answers that are none.
    pub(crate) missed: u32,
    pub(crate) phantom: u32,
    pub(crate) gave_up: u32,
}

impl Tally {
    /// Judges one ray against one surface, or surfaces that do not touch: there each root is one hit.
    pub(crate) fn add<P: Kind>(
        &mut self,
        built: &Built<P>,
        oracle: &Oracle,
        query: &Query,
        answers: &Answers<P::Scalar>,
        size: f64,
        allowed: &Allowed,
    ) {
        self.rays += 1;
        if answers.all.is_err() {
            self.gave_up += 1;
            return;
        }
        let Verdict { roots, unresolved, margin } =
            oracle.trace(query.origin, query.direction, query.range[0], query.range[1]);
        if unresolved > 0 || margin < allowed.margin || roots.iter().any(|root| root.margin < allowed.margin) {
            return;
        }
        self.judged += 1;
        self.roots += roots.len() as u32;
        let speed = norm(query.direction);
        let scene = built.scene();
        let mut taken = vec![false; answers.hits.len()];
        for root in &roots {
            let near = (0..taken.len()).find(|&k| {
                let hit = &answers.hits[k];
                let normal = scene.normal(hit, &mut Basis::<P::Scalar, 16>::new().view()).unwrap();
                let normal = normal.map(|normal| normal.map(Scalar::to_f64));
                let cosine = normal.map_or(1.0, |normal| dot(normal, query.direction).abs() / speed);
                // From far away, t itself is rounded.
                let far = 8.0 * P::Scalar::EPSILON.to_f64() * root.t.abs() * speed;
                let off = (allowed.across / cosine).min(allowed.most) * size + root.blur * size + far;
                !taken[k] && (hit.t.to_f64() - root.t).abs() * speed <= off
            });
            match near {
                Some(k) => taken[k] = true,
                None => {
                    self.missed += 1;
                    println!("missed {root:?} of {query:?}: {:?}", answers.hits);
                }
            }
        }
        for (hit, _) in answers.hits.iter().zip(&taken).filter(|(_, taken)| !**taken) {
            // The oracle's margin says nothing of roots behind the closest: a graze or a root on an edge is left out.
            let [u, v] = [hit.u, hit.v].map(Scalar::to_f64);
            if !(hit.incidence != Incidence::Crossing || [u, v].iter().any(|c| *c == 0.0 || *c == 1.0)) {
                self.phantom += 1;
                println!("phantom {hit:?} of {query:?}: {roots:?}");
            }
        }
    }
}
