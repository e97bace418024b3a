//! What the improved image leaves on other trajectories of the same joint, recorded after those that were diagnosed.

use std::fmt::Write;

use super::summary::share;
use super::{Case, Hidden, conceal, signals};
use frikan_runtime::shared::model::RigidBody;
use frikan_runtime::shared::units::Unit;
use frikan_trainer::diagnose::improve::{Origin, improve};
use frikan_trainer::diagnose::{BaseKind, Lock, Options, Prepared, Settings, diagnose, model};
use frikan_trainer::fit::HostModel;
use frikan_trainer::plant::{self, NoiseKind, SimulatedRecording};

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
    let both = plant::simulate(&joint, seed).map_err(|e| e.to_string())?;
    let half = both.len() / 2;
    let (first, second) = (both.part(0..half), both.part(half..both.len()));
    let recorded = signals(&first, &joint);
    let options = Options { settings: Settings { seed, ..Settings::default() }, ..Options::default() };
    let diagnosis = diagnose(&recorded, "N m", &options).map_err(|e| e.to_string())?;
    let image = |diagnosis| {
        improve(diagnosis, &recorded, Origin::Recording(RigidBody::default()), Unit::NewtonMetre)
            .ok_or_else(|| format!("{effect}: no valid image"))
    };
    let mut bare = diagnosis.clone();
    bare.findings.clear();
    bare.improved_refit = bare.baseline_refit.clone();
    let (before, after) = (image(&bare)?.model, image(&diagnosis)?.model);
    let [before, after, noise] = errors(&second, &joint, &before, &after)?;
    let named = diagnosis.findings.first().is_some_and(|found| found.effect.name() == effect);
    Ok(Afterwards { effect, named, before, after, noise })
}

/// Errors of both images on a recording, and its noise.
fn errors(
    recording: &SimulatedRecording,
    joint: &plant::Joint,
    before: &HostModel,
    after: &HostModel,
) -> Result<[f64; 3], String> {
    let signals = signals(recording, joint);
    let state = signals.states();
    let prepared = Prepared::new(&signals, Lock::Nothing);
    let rms = |series: &[f64]| {
        let filtered = prepared.filtered(series);
        (filtered.iter().map(|r| r * r).sum::<f64>() / filtered.len() as f64).sqrt()
    };
    let error = |image: &HostModel| {
        let predicted = model::at(image, &state, signals.rigid_body.as_deref()).map_err(|e| e.to_string())?.torque;
        Ok::<_, String>(rms(&signals.torque.iter().zip(&predicted).map(|(t, p)| t - p).collect::<Vec<_>>()))
    };
    Ok([error(before)?, error(after)?, rms(&recording.truth.noise_torque)])
}

/// The results as a section of Markdown.
pub fn table(results: &[Afterwards]) -> String {
    let mut text = String::from(
        "\n## Other trajectories of the same joint\n\nThe joint is recorded twice as long, the first half is diagnosed, the improved image predicts the second: trajectories with\nother random details that no part of the diagnosis saw. Root mean square behind the common filter, N m.\n\n| effect | named first | image without it | improved image | noise | improved over noise |\n|---|---|---|---|---|---|\n",
    );
    for result in results {
        let Afterwards { effect, named, before, after, noise } = result;
        let named = if *named { "yes" } else { "no" };
        let _ = writeln!(text, "| {effect} | {named} | {before:.4} | {after:.4} | {noise:.4} | {:.2} |", after / noise);
    }
    let close = results.iter().filter(|result| result.after < 1.1 * result.noise).count();
    let _ = writeln!(text, "\nWithin 10 % of the noise: {}.", share(close, results.len()));
    text
}
