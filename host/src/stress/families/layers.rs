//! What misleads a method that remembers: sheets and fins in the order of scan lines, and rays that are none.

use glam::DVec3;

use crate::scene::camera::{Camera, View};
use crate::scene::model::{Model, ModelSurface};
use crate::scene::shapes::{bumpy, net, single, torus};
use crate::scene::trace::Precision;
use crate::stress::case::{Case, Draw, FEW, Family, Shot, ray};

pub(super) const FAMILIES: [Family; 3] = [
    Family {
        name: "sheets",
        what: "five sheets 1e-9 (f32: 1e-4) apart, as a picture, the nearest first, last and in between",
        unjudged: FEW,
        cases: sheets,
    },
    Family {
        name: "fins",
        what: "fins 1e-9 (f32: 1e-4) thick before a hill, as a picture along the scan lines",
        unjudged: FEW,
        cases: fins,
    },
    Family {
        name: "invalid-rays",
        what: "NaN, infinite and zero rays among good ones along scan lines",
        unjudged: FEW,
        cases: invalid_rays,
    },
];

/// How thin things are.
fn thin(draw: &Draw) -> f64 {
    if draw.precision == Precision::F64 { 1e-9 } else { 1e-4 }
}

/// A picture of about as many pixels as the case is to have rays.
fn picture(draw: &Draw, eye: [f64; 3]) -> Shot {
    let side = (draw.rays as f64).sqrt().ceil().max(4.0);
    let camera = Camera::LookAt { eye, look_at: [0.0; 3], up: [0.0, 1.0, 0.0], fov: 40.0 };
    // Twice as wide as high: what is remembered is remembered along the line.
    let view: View = camera.view([(1.5 * side) as u32, (side / 1.5) as u32]);
    Shot::Picture(view)
}

/// The surface moved along z.
fn raised(surface: &ModelSurface, by: f64) -> ModelSurface {
    let points = surface.points.iter().map(|&[x, y, z, w]| [x, y, z + by, w]).collect();
    ModelSurface { points, ..surface.clone() }
}

fn sheets(draw: &mut Draw) -> Vec<Case> {
    let gap = thin(draw);
    let hill = bumpy(111, [3, 3], [0.0; 3], 2.0, 0.3);
    let orders = [[0, 1, 2, 3, 4], [4, 3, 2, 1, 0], [2, 0, 4, 1, 3]];
    let cases = orders.map(|order| {
        let model = Model::numbered(order.map(|k| raised(&hill, gap * f64::from(k))).to_vec());
        Case { model, shot: picture(draw, [0.4, 0.3, 3.0]), exact: None }
    });
    cases.to_vec()
}

fn fins(draw: &mut Draw) -> Vec<Case> {
    let gap = thin(draw);
    let hill = bumpy(112, [3, 3], [0.0; 3], 2.0, 0.3);
    let mut surfaces = vec![hill];
    for k in 0..6 {
        let x = -0.75 + 0.3 * f64::from(k);
        // Two sides and a rounded front: a blade of degree 2 around its edge, seen from its edge.
        let width = [-gap, 0.0, gap];
        let depth = [0.5, 1.0, 0.5];
        surfaces.push(net(2, 3, |i, j| [x + width[i], -0.8 + 0.5 * j as f64, depth[i] + 0.02 * (j % 2) as f64]));
    }
    vec![
        Case { model: Model::numbered(surfaces.clone()), shot: picture(draw, [0.0, 0.1, 4.0]), exact: None },
        Case { model: Model::numbered(surfaces), shot: picture(draw, [2.5, 0.4, 3.0]), exact: None },
    ]
}

fn invalid_rays(draw: &mut Draw) -> Vec<Case> {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let models = [single(bumpy(113, [3, 3], [0.0; 3], 2.0, 0.3)), torus([0.0; 3], 0.7, 0.25, 4, 4)];
    let cases = models.map(|model| {
        let width = 64;
        let rays = (0..draw.rays / 2).map(|k| {
            let (x, y) = ((k % width) as f64 / width as f64 - 0.5, (k / width % 7) as f64 / 7.0 - 0.5);
            let eye = DVec3::new(0.3, 0.2, 3.0);
            let mut ray = ray(eye, DVec3::new(1.8 * x, 1.8 * y, 0.0) - eye);
            ray.scan_line = (k / width) as u64;
            if draw.random.within(0.0, 4.0) < 1.0 {
                let place = draw.random.within(0.0, 3.0) as usize;
                match draw.random.within(0.0, 3.0) as usize {
                    0 => ray.origin[place] = *draw.pick(&bad),
                    1 => ray.direction[place] = *draw.pick(&bad),
                    _ => ray.direction = [0.0, -0.0, 0.0],
                }
            }
            ray
        });
        let rays = rays.collect();
        Case::of_rays(model, rays)
    });
    cases.to_vec()
}
