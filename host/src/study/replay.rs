//! One ray of a cell, traced again: its whole scan line as before, since a coherent method answers by what came before.

use std::fmt::Write as _;

use serde::Serialize;

use super::errors::{Judge, Kind};
use super::plan::{Cell, Knob};
use super::run::viewed;
use super::subject::Subject;
use super::truth::{RayTruth, of_ray};
use crate::judge::allowance;
use crate::number::Shortest;
use crate::oracle::Oracle;
use crate::scanline::{Outcome, Tally, rays_of};

/// The command that traces a pixel of a cell again.
pub fn command(subject: &Subject, cell: &Cell, [x, y]: [u32; 2]) -> String {
    let [width, height] = subject.picture.size;
    let place = format!("--size {width}x{height} --only {} --pixel {x},{y}", cell.id());
    let parts = ["patchray study", subject.argument.as_deref().unwrap_or(""), &place, &subject.words];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The command that asks `query` the same of the ray alone: by the method for any rays, and with nothing kept from the rays
/// before.
fn query(subject: &Subject, cell: &Cell, ray: &str) -> String {
    let value = cell.value.map_or(String::new(), |value| Shortest(value).to_string());
    let knob = match cell.knob {
        Knob::Default => String::new(),
        Knob::Paper => "--acceptance paper".to_owned(),
        Knob::NewtonSteps | Knob::ClipSteps => format!("--limit {}={value}", cell.knob.name()),
        _ => format!("--{} {value}", cell.knob.name()),
    };
    let method = format!("--method {} --precision {}", cell.method.of_any_rays().name(), cell.precision.name());
    // Of a flag that is given twice, a limit counts as given last; the others are refused, so that the cell's stands alone.
    let flag = format!("--{} ", cell.knob.name());
    let words = if subject.words.contains(&flag) { "" } else { &subject.words };
    let flags = [method.as_str(), words, &knob];
    let flags = flags.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ");
    format!("printf 'ox,oy,oz,dx,dy,dz\\n{ray}\\n' | patchray query {} - {flags}", subject.patches)
}

/// A ray traced again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Replay {
    /// The cell.
    pub id: String,
    /// The pixel, [0, 0] being the top left one.
    pub pixel: [u32; 2],
    /// Where the ray starts.
    pub origin: [f64; 3],
    /// Its direction.
    pub direction: [f64; 3],
    /// What became of it: `hit`, `miss`, `refused` or `gave-up:LIMIT`.
    pub answer: String,
    /// The t of the hit.
    pub t: Option<f64>,
    /// The (u, v) of the hit.
    pub uv: Option<[f64; 2]>,
    /// The index of the hit's surface in the model.
    pub surface: Option<usize>,
    /// The roots that the oracle finds.
    pub roots: Vec<f64>,
    /// How far the ray may move before the oracle's answer changes, as a share of the diagonal.
    pub margin: f64,
    /// What the answer is by the oracle.
    pub kind: Kind,
    /// How far t is off, as a share of the diagonal.
    pub error: Option<f64>,
    /// How far the point at (u, v) is from the point at t, as a share of the diagonal.
    pub residual: Option<f64>,
    /// The command that asks `query` the same of the ray alone.
    pub query: String,
}

/// Traces a pixel of a cell again. The pixel has to be one of the picture.
///
/// # Errors
/// The cell cannot be traced, or there is no such pixel.
pub fn replay(subject: &Subject, cell: &Cell, pixel: [u32; 2]) -> Result<Replay, String> {
    let [x, y] = pixel;
    let [width, height] = subject.picture.size;
    let outside = || format!("there is no pixel {x},{y} in a picture of {width} × {height}");
    if y >= height {
        return Err(outside());
    }
    let mut viewed = viewed(subject, cell)?;
    let (tracer, _) = viewed.tracer().map_err(|error| error.to_string())?;
    let samples = subject.picture.scan_line(y);
    let rays = rays_of(&subject.picture, y, &samples);
    let mut outcomes = Vec::new();
    tracer.lane().trace_line(&samples, &rays, &mut outcomes, &mut Tally::default());
    let (ray, outcome) = rays.get(x as usize).zip(outcomes.get(x as usize)).ok_or_else(outside)?;
    let truth = of_ray(&Oracle::new(&subject.model), ray);
    let judge = Judge { model: &subject.model, diagonal: subject.diagonal(), allowance: allowance(cell.precision) };
    let judged = judge.judge(outcome, ray, &truth);
    let RayTruth { truth, roots } = truth;
    let found = if let Outcome::Hit(found) = outcome { Some(found) } else { None };
    let numbers =
        ray.origin.iter().chain(&ray.direction).map(|x| Shortest(*x).to_string()).collect::<Vec<_>>().join(",");
    Ok(Replay {
        id: cell.id(),
        pixel,
        origin: ray.origin,
        direction: ray.direction,
        answer: match outcome {
            Outcome::Hit(_) => "hit".to_owned(),
            Outcome::Miss => "miss".to_owned(),
            Outcome::GaveUp { limit, .. } => format!("gave-up:{limit}"),
            Outcome::Refused(_) | Outcome::Invalid => "refused".to_owned(),
        },
        t: found.map(|found| found.t),
        uv: found.map(|found| [found.u, found.v]),
        surface: found.map(|found| found.surface),
        roots,
        margin: truth.margin,
        kind: judged.kind,
        error: judged.error,
        residual: judged.residual,
        query: query(subject, cell, &numbers),
    })
}

impl Replay {
    /// The same for people.
    pub fn to_text(&self) -> String {
        let Replay { id, pixel: [x, y], origin, direction, answer, roots, margin, kind, .. } = self;
        let mut text = String::new();
        // Writing to a string cannot fail.
        let mut line = |args: std::fmt::Arguments| {
            let _ = writeln!(text, "{args}");
        };
        let vector = |v: &[f64; 3]| v.map(|x| Shortest(x).to_string()).join(", ");
        line(format_args!("cell      {id}, pixel {x},{y}"));
        line(format_args!("ray       from ({}) along ({})", vector(origin), vector(direction)));
        match (self.t, self.uv, self.surface) {
            (Some(t), Some([u, v]), Some(surface)) => {
                line(format_args!(
                    "answer    {answer}: t {}, u {}, v {}, surface {surface}",
                    Shortest(t),
                    Shortest(u),
                    Shortest(v)
                ));
            }
            _ => line(format_args!("answer    {answer}")),
        }
        let roots: Vec<String> = roots.iter().map(|t| Shortest(*t).to_string()).collect();
        let roots = if roots.is_empty() { "no root".to_owned() } else { format!("t {}", roots.join(", ")) };
        line(format_args!("oracle    {roots}; margin {margin:.1e}"));
        let share =
            |name: &str, value: Option<f64>| value.map_or(String::new(), |value| format!(", {name} {value:.1e}"));
        line(format_args!(
            "verdict   {}{}{}",
            kind.name(),
            share("error", self.error),
            share("residual", self.residual)
        ));
        line(format_args!("alone     {}", self.query));
        text
    }
}
