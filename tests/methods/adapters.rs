//! One adapter per method and precision.

use patchray_host::lower::Stages;
use patchray_host::prepared::Prepared;
use patchray_host::scene::model::Model;
use patchray_host::scene::trace::{Acceptance, Method, Precision};
use patchray_host::settings::Settings;

/// A method in a precision, with its defaults.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adapter {
    /// The method.
    pub(crate) method: Method,
    /// The precision.
    pub(crate) precision: Precision,
}

/// All of them.
pub(crate) const ADAPTERS: [Adapter; 8] = [
    Adapter { method: Method::Newton, precision: Precision::F64 },
    Adapter { method: Method::NewtonCoherent, precision: Precision::F64 },
    Adapter { method: Method::Clipping, precision: Precision::F64 },
    Adapter { method: Method::ClippingCoherent, precision: Precision::F64 },
    Adapter { method: Method::Newton, precision: Precision::F32 },
    Adapter { method: Method::NewtonCoherent, precision: Precision::F32 },
    Adapter { method: Method::Clipping, precision: Precision::F32 },
    Adapter { method: Method::ClippingCoherent, precision: Precision::F32 },
];

impl Adapter {
    /// What the tables call it.
    pub(crate) fn name(&self) -> String {
        format!("{:?} {:?}", self.method, self.precision)
    }

    /// The defaults, with this method and precision.
    pub(crate) fn settings(&self) -> Settings {
        // The paper's rule: else Newton's methods would be judged by what clipping finds for them.
        let acceptance = Acceptance::Paper;
        Settings { method: self.method, precision: self.precision, acceptance, ..Settings::default() }
    }

    /// The model, made ready with the stages that the method needs.
    pub(crate) fn prepare(&self, model: &Model, settings: &Settings) -> Prepared {
        Prepared::build(model, Stages::of(self.method), settings).expect("the corpus is valid in both precisions")
    }
}
