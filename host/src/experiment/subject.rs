//! What is measured: the paper's methods to the letter, the same with one part more or less, and ours.

use serde::Serialize;

use crate::scene::trace::Method;
use crate::settings::Settings;
use crate::settings::switches::{On, Switch};

/// Which of the paper's two kinds of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Barth and Stürzlinger's, with Newton's method.
    Numerical,
    /// Bézier clipping.
    Clipping,
}

impl Family {
    /// Both.
    pub const ALL: [Self; 2] = [Family::Numerical, Family::Clipping];

    /// Its original method.
    pub fn original(self) -> Method {
        match self {
            Family::Numerical => Method::Newton,
            Family::Clipping => Method::Clipping,
        }
    }

    /// Its improved method.
    pub fn improved(self) -> Method {
        match self {
            Family::Numerical => Method::NewtonCoherent,
            Family::Clipping => Method::ClippingCoherent,
        }
    }

    /// Our method for the rays of one view.
    pub fn predicted(self) -> Method {
        match self {
            Family::Numerical => Method::NewtonPredicted,
            Family::Clipping => Method::ClippingPredicted,
        }
    }
}

/// A method as it is measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Subject {
    /// What tables call it.
    pub name: &'static str,
    /// The method.
    pub method: Method,
    /// The parts that are there; serialised, `without` those that are not.
    #[serde(rename = "without")]
    pub parts: On,
    /// The share of an interval that a clip has to remove; `None` for the paper's 20 %.
    pub clip_threshold: Option<f64>,
    /// The factor of eq. (1); `None` for the paper's 1.
    pub critical_factor: Option<f64>,
    /// How far from the ray a root may lie, as a share of its surface's size; `None` for the default, which is at rounding.
    pub tolerance: Option<f64>,
}

impl Subject {
    fn new(name: &'static str, method: Method, parts: On) -> Self {
        Subject { name, method, parts, clip_threshold: None, critical_factor: None, tolerance: None }
    }

    /// How it is traced, all else being as in `settings`.
    pub fn settings(&self, settings: &Settings) -> Settings {
        Settings {
            method: self.method,
            parts: self.parts,
            clip_threshold: self.clip_threshold.unwrap_or(settings.clip_threshold),
            critical_factor: self.critical_factor.unwrap_or(settings.critical_factor),
            tolerance: self.tolerance.or(settings.tolerance),
            ..*settings
        }
    }
}

/// The paper's methods to the letter: the original, the improved, and the improved with nothing kept from ray to ray, whose
/// difference to the one before is what coherence is worth.
pub fn letter(family: Family) -> [Subject; 3] {
    [
        Subject::new("original", family.original(), On::LETTER),
        Subject::new("improved", family.improved(), On::LETTER),
        Subject::new("improved, nothing kept", family.improved(), On::LETTER.without(&[Switch::Coherence])),
    ]
}

/// From the original to the letter to ours, a part at a time.
pub fn ladder(family: Family) -> Vec<Subject> {
    let pruned = On::LETTER.with(&[Switch::Pruning, Switch::EarlyEnd]);
    let kept = |name, on: On| Subject::new(name, family.improved(), on);
    let mut steps = vec![
        Subject::new("original to the letter", family.original(), On::LETTER),
        Subject::new("+ pruning", family.original(), pruned),
        kept("+ grid, early end", pruned.without(&[Switch::Coherence])),
        kept("+ coherence, believed", pruned.without(&[Switch::Verification])),
        kept("+ verification", pruned),
    ];
    if family == Family::Clipping {
        let quick = pruned.with(&[Switch::QuickVerdict]);
        let boxes = quick.with(&[Switch::BoxFirst]);
        let spread = boxes.with(&[Switch::SpreadLines]);
        let long = spread.with(&[Switch::LongSide]);
        let across = long.with(&[Switch::LookAcross]);
        let known = across.with(&[Switch::KnownRoots]);
        steps.push(kept("ours: + quick verdict", quick));
        steps.push(kept("ours: + box first", boxes));
        steps.push(kept("ours: + spread lines", spread));
        steps.push(kept("ours: + longer side", long));
        steps.push(kept("ours: + look across", across));
        steps.push(kept("ours: + known roots", known));
        steps.push(kept("ours: + end by Newton", known.with(&[Switch::NewtonEnd])));
    }
    steps.push(Subject::new("ours: original with all parts", family.original(), On::ALL));
    steps.push(Subject::new("ours: predicted, in a view", family.predicted(), On::ALL));
    steps
}

/// The change by which what lies behind the closest hit so far is left out.
pub const PRUNING: &str = "pruning";

/// A change of one thing, and the improved and the original method to the letter but for that.
pub struct Change {
    /// What it is.
    pub name: &'static str,
    /// Original and improved.
    pub subjects: [Subject; 2],
}

/// Each departure, and each other reading of what the text leaves open, alone.
pub fn changes(family: Family) -> Vec<Change> {
    let switched = |name, on: On| Change {
        name,
        subjects: [family.original(), family.improved()].map(|method| Subject::new(name, method, on)),
    };
    let with = |name, switch| switched(name, On::LETTER.with(&[switch]));
    let factor = |name, factor| {
        let mut change = switched(name, On::LETTER);
        change.subjects.iter_mut().for_each(|subject| subject.critical_factor = Some(factor));
        change
    };
    let mut all = vec![with(PRUNING, Switch::Pruning)];
    match family {
        Family::Numerical => {
            all.push(with("early end", Switch::EarlyEnd));
            let mut coarse = switched("tolerance 1e-6", On::LETTER);
            coarse.subjects.iter_mut().for_each(|subject| subject.tolerance = Some(1e-6));
            all.push(coarse);
        }
        Family::Clipping => {
            all.push(with("quick verdict", Switch::QuickVerdict));
            all.push(with("box first", Switch::BoxFirst));
            all.push(with("end by Newton", Switch::NewtonEnd));
            all.push(with("spread lines", Switch::SpreadLines));
            all.push(with("longer side", Switch::LongSide));
            all.push(with("look across", Switch::LookAcross));
            all.push(with("known roots", Switch::KnownRoots));
            let mut share = switched("20 % must remain", On::LETTER);
            share.subjects.iter_mut().for_each(|subject| subject.clip_threshold = Some(0.8));
            all.push(share);
        }
    }
    all.push(factor("eq. (1), factor 2", 2.0));
    all.push(factor("eq. (1), factor 1/2", 0.5));
    all.push(switched("halving by turning", On::LETTER.without(&[Switch::BendHalving])));
    all
}
