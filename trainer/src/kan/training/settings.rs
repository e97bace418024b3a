//! Settings that all optimisers share, and the monitor that records steps, reports them, stops early and keeps the best model.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::dataset::{Dataset, row_count};
use super::model::Model;
use super::outcome::Step;
use super::sparsity::Sparsity;
use crate::kan::network::layers::Network;

/// How strongly neighbouring spline coefficients are tied.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// Not at all; for data known to be free of noise.
    None,
    /// With this weight relative to the mean squared error of the normalised target.
    Fixed(f64),
    /// As strongly as the noise in the data warrants, per input and layer (restricted maximum likelihood).
    Estimated,
}

/// How the network is trained.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Optimiser {
    /// Damped Gauss-Newton: converges in tens of steps; time grows with the cube of the number of coefficients. The
    /// only one that can estimate smoothing.
    GaussNewton,
    /// L-BFGS: hundreds of steps, any size.
    Lbfgs,
    /// Adam with a constant rate, for comparison.
    Adam {
        /// Step size.
        rate: f64,
    },
}

/// Settings of one optimisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::kan) struct Settings {
    pub(in crate::kan) optimiser: Optimiser,
    pub(in crate::kan) steps: usize,
    pub(in crate::kan) smoothing: Smoothing,
    /// First guess of the residual variance, normalised target; where estimated smoothing starts from.
    pub(in crate::kan) noise_variance: f64,
    /// Relative fall of the penalised loss below which a step counts as no progress.
    pub(in crate::kan) tolerance: f64,
    pub(in crate::kan) with_base: bool,
    pub(in crate::kan) sparsity: Sparsity,
}

/// What a progress callback is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Which of the independent starts, from zero.
    pub restart: usize,
    /// The step just taken.
    pub step: Step,
}

/// Called from worker threads, in no particular order of restarts.
pub type ProgressCallback<'a> = &'a (dyn Fn(&Progress) + Sync);

/// Networks kept for pictures of the training.
const SNAPSHOTS: usize = 32;

/// Steps without a better validation loss after which training ends: at least this many, and at least this share of
/// the steps allowed.
const VALIDATION_PATIENCE: usize = 8;
const PATIENCE_SHARE: usize = 10;

/// Follows one optimisation.
pub(in crate::kan) struct Monitor<'a> {
    progress: ProgressCallback<'a>,
    restart: usize,
    validation: Vec<Range<usize>>,
    patience: usize,
    pub(in crate::kan) history: Vec<Step>,
    pub(in crate::kan) snapshots: Vec<(usize, Network)>,
    stride: usize,
    best: Option<(f64, usize, Model)>,
}

impl<'a> Monitor<'a> {
    pub(in crate::kan) fn new(
        progress: ProgressCallback<'a>,
        restart: usize,
        validation: &[Range<usize>],
        steps: usize,
    ) -> Self {
        Self {
            progress,
            restart,
            validation: validation.to_vec(),
            patience: VALIDATION_PATIENCE.max(steps / PATIENCE_SHARE),
            history: Vec::new(),
            snapshots: Vec::new(),
            stride: 1,
            best: None,
        }
    }

    /// Records a step; true when training should end because the validation loss no longer falls.
    pub(in crate::kan) fn observe(&mut self, mut step: Step, model: &Model, dataset: &Dataset) -> bool {
        if !self.validation.is_empty() {
            let rows = row_count(&self.validation);
            step.validation_loss = Some(model.physical_loss(model.residual_sum(dataset, &self.validation), rows));
        }
        self.history.push(step);
        if step.step.is_multiple_of(self.stride) {
            self.snapshots.push((step.step, model.network.clone()));
            if self.snapshots.len() > SNAPSHOTS {
                self.stride *= 2;
                self.snapshots.retain(|(at, _)| at % self.stride == 0);
            }
        }
        (self.progress)(&Progress { restart: self.restart, step });
        let Some(loss) = step.validation_loss else { return false };
        match &self.best {
            Some((best, at, _)) if loss >= *best => step.step - at >= self.patience,
            _ => {
                self.best = Some((loss, step.step, model.clone()));
                false
            }
        }
    }

    /// Puts back the model with the lowest validation loss.
    pub(in crate::kan) fn restore_best(&mut self, model: &mut Model) {
        if let Some((_, _, best)) = self.best.take() {
            *model = best;
        }
    }
}

impl Model {
    /// Mean squared error in squared target units from a sum over `rows` normalised residuals.
    pub(in crate::kan) fn physical_loss(&self, residual_sum: f64, rows: usize) -> f64 {
        residual_sum / rows.max(1) as f64 * self.network.output.width.powi(2)
    }
}
