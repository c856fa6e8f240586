//! Weights that fall toward edges and corners, are graded, or are of any arrangement, on surfaces of all kinds.

use crate::scene::shapes::single;
use crate::scene::shapes::weights::{Sheet, Weights, point_anywhere};
use crate::stress::case::{COARSE, Case, Draw, Family, away};

pub(super) const FAMILIES: [Family; 3] = [
    Family {
        name: "weights-falling",
        what: "weights up to 1e9 times as light along an edge or at a corner: flat, twisted, bicubic, 15 × 1 and 1 × 15",
        unjudged: COARSE,
        cases: falling,
    },
    Family {
        name: "weights-graded",
        what: "the same with weights 1, c, c² and so on along u, v or both, either way",
        unjudged: COARSE,
        cases: graded,
    },
    Family { name: "weights-any", what: "the same with weights of any arrangement", unjudged: COARSE, cases: any },
];

/// The most decades that weights differ by.
const DECADES: f64 = 9.0;

fn falling(draw: &mut Draw) -> Vec<Case> {
    arranged(draw, &Weights::FALLING)
}

fn graded(draw: &mut Draw) -> Vec<Case> {
    arranged(draw, &Weights::GRADED)
}

fn any(draw: &mut Draw) -> Vec<Case> {
    arranged(draw, &[Weights::Any; 8])
}

/// A case of each sheet in each of the arrangements.
fn arranged(draw: &mut Draw, arrangements: &[Weights]) -> Vec<Case> {
    let rays = draw.rays.div_ceil(Sheet::ALL.len() * arrangements.len());
    let mut cases = Vec::new();
    for sheet in Sheet::ALL {
        for &arrangement in arrangements {
            let ratio = 10.0_f64.powf(draw.random.within(1.0, DECADES));
            let surface = sheet.surface(&mut draw.random);
            let model = single(arrangement.of(surface, ratio, &mut draw.random));
            let mut lines = draw.rays_at(&model, rays / 4);
            for _ in lines.len()..rays {
                let target = point_anywhere(&model.surfaces[0], ratio, &mut draw.random).into();
                lines.push(draw.ray_to(target, away(&model)));
            }
            cases.push(Case::of_rays(model, lines));
        }
    }
    cases
}
