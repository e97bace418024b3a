//! What the improved image leaves on other trajectories of the same joint, recorded after those that were diagnosed.

use std::fmt::Write;

use super::summary::share;
use super::{Case, Hidden, conceal, signals};
use frikan_runtime::shared::model::RigidBody;
use frikan_runtime::shared::units::Unit;
use frikan_trainer::compile::improved::{Origin, improve};
use frikan_trainer::compile::profile::Profile;
use frikan_trainer::diagnose::{BaseKind, Comparison, Diagnosis, Lock, Options, Settings, Signals, diagnose, model};
use frikan_trainer::plant::{self, NoiseKind};

/// Effects that a drive can feed forward from what it measures.
pub const FEED_FORWARD: [&str; 15] = [
    "stribeck",
    "viscous_nonlinearity",
    "direction_asymmetry",
    "temperature",
    "load_friction",
    "drive_backdrive",
    "presliding",
    "frictional_lag",
    "position_ripple",
    "position_friction",
    "gravity_error",
    "inertia_error",
    "torque_scale",
    "torque_offset",
    "spring",
];

/// Error of an image on trajectories that no part of the diagnosis saw; N m, root mean square behind the common filter.
#[derive(Clone, Debug)]
pub struct Afterwards {
    /// The hidden effect.
    pub effect: &'static str,
    /// Whether it was named first.
    pub named: bool,
    /// Error of the image without the findings.
    pub before: f64,
    /// Error of the improved image.
    pub after: f64,
    /// Error of the image of the same joint with nothing hidden in it: the noise of its torque and of its acceleration.
    pub floor: f64,
    /// Noise of the torque alone.
    pub noise: f64,
}

/// Hides an effect at a non-centrality, records twice as long, diagnoses the first half, and predicts the second.
///
/// # Errors
/// What keeps the joint from being simulated, diagnosed or improved.
pub fn run(effect: &'static str, lambda: f64, seed: u64) -> Result<Afterwards, String> {
    let base = BaseKind::CoulombViscous;
    let case = Case { hidden: Hidden::Effect(effect, lambda), noise: NoiseKind::Coloured, base, seed };
    let mut joint = conceal(&case).map_err(|e| e.to_string())?.joint;
    joint.campaign.sets *= 2;
    let unspoilt = plant::Joint { effects: Vec::new(), ..joint.clone() };
    let hidden = Halves::record(&joint, seed)?;
    let [before, after] = hidden.errors()?;
    let [floor, _] = Halves::record(&unspoilt, seed)?.errors()?;
    let named = hidden.diagnosis.findings.first().is_some_and(|found| found.effect.name() == effect);
    Ok(Afterwards { effect, named, before, after, floor, noise: hidden.noise() })
}

/// A recording whose first half is diagnosed and whose second half is predicted.
struct Halves {
    recorded: Comparison,
    diagnosis: Diagnosis,
    later: Signals,
    later_noise: Vec<f64>,
}

impl Halves {
    fn record(joint: &plant::Joint, seed: u64) -> Result<Self, String> {
        let both = plant::simulate(joint, seed).map_err(|e| e.to_string())?;
        let half = both.len() / 2;
        let (first, second) = (both.part(0..half), both.part(half..both.len()));
        let recorded = signals(&first, joint).into();
        let options = Options { settings: Settings { seed, ..Settings::default() }, ..Options::default() };
        let diagnosis = diagnose(&recorded, &options).map_err(|e| e.to_string())?;
        Ok(Self { recorded, diagnosis, later: signals(&second, joint), later_noise: second.truth.noise_torque })
    }

    /// Errors on the second half of the image without the findings and of the improved one.
    fn errors(&self) -> Result<[f64; 2], String> {
        let mut bare = self.diagnosis.clone();
        bare.findings.clear();
        bare.improved_refit = bare.baseline_refit.clone();
        Ok([self.error(&bare)?, self.error(&self.diagnosis)?])
    }

    fn error(&self, diagnosis: &Diagnosis) -> Result<f64, String> {
        let image = improve(
            diagnosis,
            &self.recorded,
            Origin::Recording(RigidBody::default()),
            Unit::NewtonMetre,
            Profile::default(),
        )
        .map_err(|why| why.to_string())?;
        let later = &self.later;
        let predicted = model::at(&image.model, &later.states(), later.rigid_body.as_deref());
        let predicted = predicted.map_err(|e| e.to_string())?.torque;
        Ok(self.filtered_rms(&later.torque.iter().zip(&predicted).map(|(t, p)| t - p).collect::<Vec<_>>()))
    }

    fn noise(&self) -> f64 {
        self.filtered_rms(&self.later_noise)
    }

    fn filtered_rms(&self, series: &[f64]) -> f64 {
        let filtered = Comparison::from(self.later.clone()).prepare(Lock::Nothing).filtered(series);
        (filtered.iter().map(|r| r * r).sum::<f64>() / filtered.len() as f64).sqrt()
    }
}

/// The results as a section of Markdown.
pub fn table(results: &[Afterwards]) -> String {
    let mut text = String::from(
        "\n## Other trajectories of the same joint\n\nThe joint is recorded twice as long, the first half is diagnosed, the improved image predicts the second: trajectories with\nother random details that no part of the diagnosis saw. Root mean square behind the common filter, N m. The floor is what the\nimage of the same joint leaves when nothing is hidden in it, with the same noise: that of the torque and that of the measured\nmotion.\n\n| effect | named first | image without it | improved image | floor | improved over floor | noise of the torque |\n|---|---|---|---|---|---|---|\n",
    );
    for result in results {
        let Afterwards { effect, named, before, after, floor, noise } = result;
        let named = if *named { "yes" } else { "no" };
        let _ = writeln!(
            text,
            "| {effect} | {named} | {before:.4} | {after:.4} | {floor:.4} | {:.2} | {noise:.4} |",
            after / floor
        );
    }
    let close = results.iter().filter(|result| result.after < 1.1 * result.floor).count();
    let _ = writeln!(text, "\nWithin 10 % of the floor: {}.", share(close, results.len()));
    text
}
