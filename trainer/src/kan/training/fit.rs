//! One call from data to a trained network: initial linear fit, independent starts, training, choice of the best.

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::dataset::{Dataset, row_count};
use super::initial_linear_fit::initial_linear_fit;
use super::initial_weights::initial_weights;
use super::model::Model;
use super::optimisers::minimise;
use super::outcome::{Convergence, Step};
use super::settings::{Monitor, Optimiser, ProgressCallback, Settings, Smoothing};
use super::sparsity::Sparsity;
use crate::kan::network::architecture::Architecture;
use crate::kan::network::error::KanError;
use crate::kan::network::layers::Network;

/// What to train, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitOptions {
    /// Shape of the network.
    pub architecture: Architecture,
    /// One seed, one result, on any number of threads.
    pub seed: u64,
    /// Independent starts; the best on validation rows, without them by generalised cross-validation, is returned.
    pub restarts: usize,
    /// Most steps of one start.
    pub steps: usize,
    /// How it is trained.
    pub optimiser: Optimiser,
    /// How smooth activations shall be.
    pub smoothing: Smoothing,
    /// Whether edges train a SiLU base weight as well. A cubic spline covers what it does inside the grid; under noise
    /// each weight costs a degree of freedom.
    pub base_weights: bool,
    /// Relative fall of the loss per step below which a step counts as no progress.
    pub tolerance: f64,
    /// How often the cells of the best start are halved and trained on, at most: as long as its criterion falls.
    pub refinements: usize,
    /// Penalty on superfluous edges.
    pub sparsity: Sparsity,
}

impl FitOptions {
    /// One start of at most 60 steps with estimated smoothing and without base weights.
    pub fn new(architecture: Architecture) -> Self {
        Self {
            architecture,
            seed: 0,
            restarts: 1,
            steps: 60,
            optimiser: Optimiser::GaussNewton,
            smoothing: Smoothing::Estimated,
            base_weights: false,
            tolerance: 1e-2,
            refinements: 0,
            sparsity: Sparsity::NONE,
        }
    }
}

/// A trained network and how it came about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitResult {
    /// The network, physical units.
    pub network: Network,
    /// Coefficients of the linear columns, physical units.
    pub linear_coefficients: Vec<f64>,
    /// Why training stopped, and where.
    pub convergence: Convergence,
    /// Every step of the start that won.
    pub history: Vec<Step>,
    /// The network along the way: (step, network), at most a few dozen.
    pub snapshots: Vec<(usize, Network)>,
    /// Which start won.
    pub restart: usize,
    /// Root mean square of the residuals of the training rows.
    pub train_rmse: f64,
    /// The same of the validation rows.
    pub validation_rmse: Option<f64>,
    /// Effective degrees of freedom, where smoothing was estimated.
    pub degrees_of_freedom: Option<f64>,
}

impl FitResult {
    /// The network after a share of the training steps, `0.0 ..= 1.0`; 1 is the final one.
    pub fn network_at(&self, share: f64) -> &Network {
        if share >= 1.0 {
            return &self.network;
        }
        let last = self.history.last().map_or(0, |step| step.step) as f64;
        self.snapshots.iter().rev().find(|(step, _)| *step as f64 <= share * last).map_or(&self.network, |(_, n)| n)
    }
}

/// Trains a network.
///
/// # Errors
/// [`KanError`] when the data or the architecture cannot be used; never for a fit that merely is a bad one.
pub fn fit(dataset: &Dataset, options: &FitOptions, progress: ProgressCallback) -> Result<FitResult, KanError> {
    dataset.check(options.architecture.inputs)?;
    let rows = dataset.training_rows();
    let linear_fit = initial_linear_fit(dataset, &rows)?;
    let train = |restart: usize| -> Result<Trained, KanError> {
        let network = initial_weights(&options.architecture, &linear_fit, options.seed, restart)?;
        let mut model = Model::scaled_to(network, dataset, &rows);
        model.linear.copy_from_slice(linear_fit.linear());
        Ok(Trained::run(model, linear_fit.noise_variance, dataset, options, restart, progress))
    };
    let first = train(0)?;
    let others: Vec<Trained> = (1..options.restarts).into_par_iter().map(train).collect::<Result<_, _>>()?;
    let mut best = (0, first);
    for (index, trained) in others.into_iter().enumerate() {
        if trained.criterion < best.1.criterion {
            best = (index + 1, trained);
        }
    }
    let (restart, mut trained) = best;
    for _ in 0..options.refinements {
        let linear = trained.model.linear_coefficients();
        let network = trained.model.network.refined()?;
        let finer = refit_from(network, &linear, linear_fit.noise_variance, dataset, options, progress);
        if finer.criterion >= trained.criterion {
            break;
        }
        trained = finer;
    }
    Ok(trained.into_result(dataset, restart))
}

/// Goes on training a network, for instance after edges were switched off by hand.
///
/// # Errors
/// As [`fit`].
pub fn refit(
    network: &Network,
    linear_coefficients: &[f64],
    dataset: &Dataset,
    options: &FitOptions,
    progress: ProgressCallback,
) -> Result<FitResult, KanError> {
    dataset.check(network.inputs.len())?;
    let rows = dataset.training_rows();
    let before = Model::resumed(network.clone(), linear_coefficients, dataset, &rows);
    let noise_variance = before.residual_sum(dataset, &rows) / row_count(&rows) as f64;
    let trained = refit_from(network.clone(), linear_coefficients, noise_variance, dataset, options, progress);
    Ok(trained.into_result(dataset, 0))
}

pub(in crate::kan) fn refit_from(
    network: Network,
    linear_coefficients: &[f64],
    noise_variance: f64,
    dataset: &Dataset,
    options: &FitOptions,
    progress: ProgressCallback,
) -> Trained {
    let model = Model::resumed(network, linear_coefficients, dataset, &dataset.training_rows());
    Trained::run(model, noise_variance, dataset, options, 0, progress)
}

/// A model at the end of its training.
pub(in crate::kan) struct Trained {
    pub(in crate::kan) model: Model,
    /// Mean squared error, normalised: of the validation rows, without them by generalised cross-validation.
    pub(in crate::kan) criterion: f64,
    pub(in crate::kan) convergence: Convergence,
    history: Vec<Step>,
    snapshots: Vec<(usize, Network)>,
}

impl Trained {
    fn run(
        mut model: Model,
        noise_variance: f64,
        dataset: &Dataset,
        options: &FitOptions,
        restart: usize,
        progress: ProgressCallback,
    ) -> Self {
        let validation = &dataset.blocks.validation;
        let mut monitor = Monitor::new(progress, restart, validation, options.steps);
        let settings = Settings {
            optimiser: options.optimiser,
            steps: options.steps,
            smoothing: options.smoothing,
            noise_variance,
            tolerance: options.tolerance,
            with_base: options.base_weights,
            sparsity: options.sparsity,
        };
        let (convergence, cross_validation) =
            minimise(&mut model, dataset, &dataset.training_rows(), &settings, &mut monitor);
        let held_out = row_count(validation);
        let criterion = match held_out {
            0 => cross_validation,
            rows => model.residual_sum(dataset, validation) / rows as f64,
        };
        Self { model, criterion, convergence, history: monitor.history, snapshots: monitor.snapshots }
    }

    pub(in crate::kan) fn into_result(self, dataset: &Dataset, restart: usize) -> FitResult {
        let rmse = |rows: &[Range<usize>]| {
            self.model.physical_loss(self.model.residual_sum(dataset, rows), row_count(rows)).sqrt()
        };
        let validation = &dataset.blocks.validation;
        FitResult {
            linear_coefficients: self.model.linear_coefficients(),
            convergence: self.convergence,
            restart,
            train_rmse: rmse(&dataset.training_rows()),
            validation_rmse: (row_count(validation) > 0).then(|| rmse(validation)),
            degrees_of_freedom: self.history.iter().rev().find_map(|step| step.degrees_of_freedom),
            history: self.history,
            snapshots: self.snapshots,
            network: self.model.network,
        }
    }
}
