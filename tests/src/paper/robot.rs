//! P7 to P9 on other people's recordings of a robot, since those of the paper are not public.

use std::path::{Path, PathBuf};

use frikan_trainer::error::Result;
use frikan_trainer::fit::outcome::{Representation, Score, Trace};
use frikan_trainer::fit::{Options, Outcome, fit};
use frikan_trainer::joint::Joint;
use frikan_trainer::law::{KnownForm, fit_form};
use frikan_trainer::recording;

use crate::laws::{data, velocity};

/// Bins of the velocity that bound what any function of it can explain.
const BINS: usize = 80;
/// Most samples that the known form is fitted to.
const MOST_SAMPLES: usize = 4000;

/// The folder of the robot's recordings, where it is there.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let folder = crate::recordings_folder().join("kr300");
    folder.is_dir().then_some(folder)
}

/// Fits an axis on trajectory A and scores it on B and C.
///
/// # Errors
/// As reading and fitting.
pub fn axis(folder: &Path, axis: usize, representation: Option<Representation>) -> Result<Outcome> {
    let load = |run: &str| recording::load(&folder.join(format!("axis{axis}-{run}.csv")), &Joint::default());
    let options = Options { seed: 1, representation, ..Options::default() };
    fit(&[load("A")?], &[load("B")?, load("C")?], &Joint::default(), &options, &|_| ())
}

/// Score of friction alone, as predicted by the image.
#[must_use]
pub fn friction_score(trace: &Trace) -> Score {
    Score::of(&trace.friction, &trace.predicted_friction)
}

/// R2 that no function of the velocity exceeds by much on this very trajectory: means of narrow bins, not held out.
#[must_use]
pub fn ceiling(trace: &Trace) -> f64 {
    let mut order: Vec<usize> = (0..trace.velocity.len()).collect();
    order.sort_by(|a, b| trace.velocity[*a].total_cmp(&trace.velocity[*b]));
    let mut predicted = vec![0.0; order.len()];
    for bin in order.chunks(order.len().div_ceil(BINS).max(1)) {
        let mean = bin.iter().map(|&row| trace.friction[row]).sum::<f64>() / bin.len() as f64;
        bin.iter().for_each(|&row| predicted[row] = mean);
    }
    Score::of(&trace.friction, &predicted).r2
}

/// Scores of a known form on the friction of each test trajectory, fitted to that of the training trajectories.
///
/// # Panics
/// When the trajectories cannot be used, which they can once they were fitted.
#[must_use]
pub fn known_form_scores(outcome: &Outcome, form: KnownForm) -> Vec<Score> {
    let rows: usize = outcome.train.iter().map(|trace| trace.velocity.len()).sum();
    let every = |column: fn(&Trace) -> &Vec<f64>| -> Vec<f64> {
        outcome.train.iter().flat_map(column).step_by(rows.div_ceil(MOST_SAMPLES).max(1)).copied().collect()
    };
    let samples = data(vec![velocity(every(|trace| &trace.velocity))], every(|trace| &trace.friction));
    let law = fit_form(form, &samples, None).expect("trajectories that were fitted").law;
    let score = |trace: &Trace| {
        let predicted: Vec<f64> = trace.velocity.iter().map(|v| law.expression.value(&[*v], &[])).collect();
        Score::of(&trace.friction, &predicted)
    };
    outcome.tests.iter().map(score).collect()
}
