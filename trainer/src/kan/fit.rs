//! One call from data to a trained network: pilot, independent starts, training, choice of the best.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::architecture::Architecture;
use super::dataset::{Dataset, row_count};
use super::error::KanError;
use super::gauss_newton::{Settings, minimise};
use super::knots::{Pilot, pilot};
use super::model::Model;
use super::network::Network;
use super::outcome::{Convergence, Step};
use super::random::Random;
use super::start::initial;
use super::training::{ProgressCallback, Smoothing, Watch};

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
    /// How smooth activations shall be.
    pub smoothing: Smoothing,
    /// Relative fall of the loss per step below which a step counts as no progress.
    pub tolerance: f64,
}

impl FitOptions {
    /// One start of at most 100 steps with estimated smoothing.
    pub fn new(architecture: Architecture) -> Self {
        Self { architecture, seed: 0, restarts: 1, steps: 100, smoothing: Smoothing::Estimated, tolerance: 1e-4 }
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
    /// Root mean square of the residuals of the training rows, and of the validation rows.
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
    let pilot = pilot(dataset, &rows)?;
    let candidates: Vec<Candidate> = (0..options.restarts.max(1))
        .into_par_iter()
        .map(|restart| train(dataset, options, &pilot, restart, progress))
        .collect::<Result<_, _>>()?;
    let best = (0..candidates.len()).min_by(|&a, &b| candidates[a].score.total_cmp(&candidates[b].score)).unwrap_or(0);
    let winner = candidates.into_iter().nth(best).expect("there is at least one start");
    let rmse = |rows: &[std::ops::Range<usize>]| {
        winner.model.physical_loss(winner.model.residual_sum(dataset, rows), row_count(rows)).sqrt()
    };
    let validation = &dataset.blocks.validation;
    Ok(FitResult {
        linear_coefficients: winner.model.linear_coefficients(),
        convergence: winner.convergence,
        restart: best,
        train_rmse: rmse(&rows),
        validation_rmse: (!validation.is_empty()).then(|| rmse(validation)),
        degrees_of_freedom: winner.history.last().and_then(|step| step.degrees_of_freedom),
        history: winner.history,
        snapshots: winner.snapshots,
        network: winner.model.network,
    })
}

struct Candidate {
    model: Model,
    convergence: Convergence,
    history: Vec<Step>,
    snapshots: Vec<(usize, Network)>,
    score: f64,
}

fn train(
    dataset: &Dataset,
    options: &FitOptions,
    pilot: &Pilot,
    restart: usize,
    progress: ProgressCallback,
) -> Result<Candidate, KanError> {
    let rows = dataset.training_rows();
    let mut random = Random::new(options.seed, restart as u64);
    let network = initial(&options.architecture, pilot, &mut random)?;
    let mut model = Model::scaled_to(network, dataset, &rows);
    model.linear.copy_from_slice(pilot.linear());
    let mut watch = Watch::new(progress, restart, &dataset.blocks.validation);
    let settings = Settings {
        steps: options.steps,
        smoothing: options.smoothing,
        tolerance: options.tolerance,
        with_base: true,
    };
    let (convergence, criterion) = minimise(&mut model, dataset, &rows, &settings, &mut watch);
    let validation = &dataset.blocks.validation;
    let score = if validation.is_empty() { criterion } else { model.residual_sum(dataset, validation) };
    Ok(Candidate { model, convergence, history: watch.history, snapshots: watch.snapshots, score })
}
