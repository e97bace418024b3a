//! The optimisers: each takes a model, the rows to learn from and the settings. Knows no restart and no choice between networks.

mod adam;
mod first_order;
pub mod gauss_newton;
mod lbfgs;

use std::ops::Range;

use crate::kan::training::dataset::Dataset;
use crate::kan::training::model::Model;
use crate::kan::training::outcome::Convergence;
use crate::kan::training::settings::{Monitor, Optimiser, Settings};

/// Trains the model with whichever optimiser is asked for; also returns the criterion by which fits are compared.
pub(super) fn minimise(
    model: &mut Model,
    dataset: &Dataset,
    rows: &[Range<usize>],
    settings: &Settings,
    monitor: &mut Monitor,
) -> (Convergence, f64) {
    match settings.optimiser {
        Optimiser::GaussNewton => gauss_newton::minimise(model, dataset, rows, settings, monitor),
        Optimiser::Lbfgs | Optimiser::Adam { .. } => first_order::minimise(model, dataset, rows, settings, monitor),
    }
}
