//! A story in words.

use std::fmt::Write as _;

use patchray::limits::Work;
use patchray::ray::Incidence;
use patchray::story::Event;

use super::Story;
use crate::scanline::Outcome;
use crate::scene::model::Model;
use crate::stress::truth::residual;

/// What the story of a ray is about, and how it is told.
struct Telling<'s> {
    model: &'s Model,
    unit: f64,
    text: String,
    /// The step of Newton's method.
    step: u32,
    /// What was passed by since something else was told: voxels, nodes and patches.
    passed: [u32; 4],
}

/// What of that is counted.
const PASSED: [[&str; 2]; 4] = [
    ["voxel of the scene's grid visited", "voxels of the scene's grid visited"],
    ["voxel visited", "voxels visited"],
    ["node tested", "nodes tested"],
    ["patch passed by", "patches passed by"],
];

impl Story {
    /// The story as text, a line for each thing that was done. `name` names surfaces, by their index in the model.
    pub fn words(&self, model: &Model, name: impl Fn(usize) -> String) -> String {
        let Story { ray, outcome, work, events, unit } = self;
        let mut telling = Telling { model, unit: *unit, text: String::new(), step: 0, passed: [0; 4] };
        telling.line(0, &format!("the ray starts at {} and goes along {}", triple(ray.origin), triple(ray.direction)));
        if events.is_empty() {
            telling.line(1, "nothing that it can meet lies on its way");
        }
        for event in events {
            telling.event(event, &name);
        }
        telling.say_passed();
        telling.line(0, &self.answer(outcome, &name));
        let counts = Work::NAMES.iter().zip(work.counts()).filter(|(_, count)| *count > 0);
        let counts: Vec<String> = counts.map(|(name, count)| format!("{name} {count}")).collect();
        telling
            .line(0, &format!("counted: {}", if counts.is_empty() { "nothing".to_owned() } else { counts.join(", ") }));
        telling.text
    }

    /// What became of the ray.
    fn answer(&self, outcome: &Outcome, name: &impl Fn(usize) -> String) -> String {
        match outcome {
            Outcome::Hit(found) => {
                let incidence = match found.incidence {
                    Incidence::Crossing => "",
                    Incidence::Grazing => ", a graze",
                    Incidence::Contact => ", where a stretch begins on which the ray lies in the surface",
                };
                format!(
                    "it meets {} at (u, v) = ({}, {}), t = {}{incidence}",
                    name(found.surface),
                    found.u,
                    found.v,
                    found.t,
                )
            }
            Outcome::Miss => "it meets nothing".to_owned(),
            Outcome::GaveUp { limit, best } => {
                let best = best.map_or(String::new(), |best| {
                    format!("; the closest root by then, at t = {}, is no answer", best.t)
                });
                format!("it is given up: the limit on {limit} ran out{best}")
            }
            Outcome::Refused(error) => format!("the kernel refuses it: {error}"),
            Outcome::Invalid => "it is not valid".to_owned(),
        }
    }

    /// How far the surface's point is from the ray's, in the scene's units; `None` without a hit.
    pub fn residual(&self, model: &Model) -> Option<f64> {
        let Outcome::Hit(found) = &self.outcome else { return None };
        Some(residual(model.surfaces.get(found.surface)?, &self.ray, found))
    }
}

impl Telling<'_> {
    fn line(&mut self, depth: usize, text: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{:1$}{text}", "", 2 * depth);
    }

    /// Tells what was passed by.
    fn say_passed(&mut self) {
        let passed = std::mem::take(&mut self.passed);
        let counted = passed.iter().zip(PASSED).filter(|(count, _)| **count > 0);
        let counted: Vec<String> =
            counted.map(|(&count, [one, many])| format!("{count} {}", if count == 1 { one } else { many })).collect();
        if !counted.is_empty() {
            self.line(1, &counted.join(", "));
        }
    }

    fn event(&mut self, event: &Event, name: &impl Fn(usize) -> String) {
        let passed = match event {
            Event::SceneVoxel => Some(0),
            Event::Voxel => Some(1),
            Event::Node { .. } => Some(2),
            Event::Patch { met: false, .. } => Some(3),
            _ => None,
        };
        if let Some(count) = passed.and_then(|kind| self.passed.get_mut(kind)) {
            *count += 1;
            return;
        }
        self.say_passed();
        let unit = self.unit;
        match *event {
            Event::Ray | Event::SceneVoxel | Event::Voxel | Event::Node { .. } => {}
            Event::Surface(number) => {
                let known = self.model.surfaces.get(number as usize).is_some();
                let name = if known { name(number as usize) } else { format!("surface {number}") };
                self.line(1, &format!("{name}:"));
            }
            Event::Patch { sides, .. } => self.line(1, &format!("the patch {} is met", rectangle(sides))),
            Event::Critical => self.line(2, "critical by eq. (1): the ray may meet it more than once"),
            Event::Excluded => self.line(2, "proved to hold no root"),
            Event::HandedOver => self.line(2, "nothing is proved: it is clipped"),
            Event::Unresolved => self.line(2, "no start led to a root: taken for not met"),
            Event::Start([u, v]) => {
                self.step = 0;
                self.line(2, &format!("Newton's method from (u, v) = ({u}, {v})"));
            }
            Event::Step { at: [u, v], residual } => {
                self.step += 1;
                let step = self.step;
                self.line(3, &format!("step {step}: ({u}, {v}), {:.3e} off the ray", residual * unit));
            }
            Event::Stuck => self.line(3, "leads to no root"),
            Event::Root { at: [u, v], incidence, .. } => {
                self.step = 0;
                let incidence = match incidence {
                    Incidence::Crossing => "",
                    Incidence::Grazing => ", the ray tangent to it",
                    Incidence::Contact => ", where the ray begins to lie in it",
                };
                self.line(2, &format!("a root at (u, v) = ({u}, {v}){incidence}"));
            }
            Event::Clip { sides, in_v, left } => {
                let side = if in_v { "v" } else { "u" };
                let left = left.map_or("nothing is left".to_owned(), |[from, to]| {
                    format!("{:.3} % is left, from {from:.6} to {to:.6}", 100.0 * (to - from))
                });
                self.step = 0;
                self.line(2, &format!("clip in {side} of {}: {left}", rectangle(sides)));
            }
            Event::Bisection => self.line(3, "too little is clipped away: it is bisected"),
            Event::Region { sides } => self.line(2, &format!("goes on with {}", rectangle(sides))),
            Event::Remembered([u, v]) => {
                self.line(1, &format!("the ray before leads to (u, v) = ({u}, {v})"));
            }
            Event::Testing => self.line(1, "the testing ray runs back from the root"),
            Event::Listed { owner: true } => self.line(2, "it meets the patch that holds the root"),
            Event::Listed { owner: false } => self.line(2, "it meets another patch"),
            Event::Verified => self.line(1, "confirmed: nothing lies before the root"),
            Event::DecidedByList => self.line(1, "decided: what the testing ray met was searched"),
            Event::Refused => self.line(1, "not confirmed: all else is searched"),
            Event::StartFailed => self.line(1, "what the ray before has left leads to nothing"),
            Event::FullSearch => self.line(1, "all that the ray meets is searched, front to back"),
        }
    }
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}

fn rectangle([[u0, u1], [v0, v1]]: [[f64; 2]; 2]) -> String {
    format!("u {u0:.6} to {u1:.6}, v {v0:.6} to {v1:.6}")
}
