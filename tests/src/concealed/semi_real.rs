//! Effects added to other people's recordings: real noise, real grain and real motions, and whatever physics is missing there
//! besides.

use std::fmt::Write;
use std::path::Path;

use super::set_of;
use super::summary::share;
use frikan_trainer::diagnose::{BaseKind, Diagnosis, Lock, Options, Signals, diagnose, strength};
use frikan_trainer::joint::Joint;
use frikan_trainer::physics::{EffectId, JointState};
use frikan_trainer::recording;

/// Recordings that effects are added to.
pub const RECORDINGS: [&str; 3] = ["emps/train.csv", "kr300/axis1-A.csv", "kr300/axis3-A.csv"];

/// Effects that are added.
pub const ADDED: [&str; 9] = [
    "stribeck",
    "viscous_nonlinearity",
    "direction_asymmetry",
    "torque_offset",
    "spring",
    "inertia_error",
    "slow_drift",
    "presliding",
    "position_ripple",
];

/// What came of one addition.
#[derive(Clone, Debug)]
pub struct Added {
    /// The recording.
    pub recording: &'static str,
    /// The effect that was added.
    pub effect: &'static str,
    /// What is found without it.
    pub found_before: Vec<&'static str>,
    /// What is found with it, each with its set.
    pub found: Vec<Vec<&'static str>>,
}

impl Added {
    /// Whether the recording shows this effect by itself, so that nothing can be learned from adding it.
    pub fn was_there(&self) -> bool {
        self.found_before.contains(&self.effect)
    }

    /// Whether the effect is named, in the set of a finding, or set aside as minor.
    pub fn is_found(&self) -> bool {
        self.found.iter().flatten().any(|effect| *effect == self.effect)
    }
}

/// Part of the recorded torque, root mean square, that an effect is given beyond what the base absorbs.
const SHARE: f64 = 0.05;

/// Adds each effect in turn to a recording.
///
/// # Errors
/// What keeps the recording from being read or diagnosed.
pub fn run(folder: &Path, name: &'static str) -> Result<Vec<Added>, String> {
    let joint = Joint::default();
    let recording = recording::load(&folder.join(name), &joint).map_err(|e| e.to_string())?;
    let signals = Signals::of(&recording, &joint).map_err(|e| e.to_string())?;
    let state = signals.states();
    let options = Options::default();
    let diagnosed = |signals: &Signals| diagnose(&signals.clone().into(), &options).map_err(|e| e.to_string());
    let found_before: Vec<&'static str> = diagnosed(&signals)?.findings.iter().map(|f| f.effect.name()).collect();
    // Without a rigid body to be wrong its inertia is part of the base.
    let can_be_wrong = |effect: &str| effect != "inertia_error" || signals.rigid_body.is_some();
    ADDED
        .into_iter()
        .filter(|effect| can_be_wrong(effect))
        .map(|effect| {
            let shape = torque(effect, &state);
            let mut with = signals.clone();
            let one =
                strength(&signals.clone().into(), &shape, &signals.torque, BaseKind::CoulombViscous, Lock::Spread);
            let amplitude = one.map_or(0.0, |s| SHARE / s.effect_to_noise.max(f64::MIN_POSITIVE));
            with.torque.iter_mut().zip(&shape).for_each(|(t, s)| *t += amplitude * s);
            let found = sets(&diagnosed(&with)?);
            Ok(Added { recording: name, effect, found_before: found_before.clone(), found })
        })
        .collect()
}

fn sets(diagnosis: &Diagnosis) -> Vec<Vec<&'static str>> {
    let set = |found| set_of(found).map(EffectId::name).collect();
    let minor = diagnosis.discarded.minor.iter().map(|(effect, _)| vec![effect.name()]);
    diagnosis.findings.iter().map(set).chain(minor).collect()
}

/// Torque of an effect along a recorded motion, for unit amplitude. The equations are of this file alone.
fn torque(effect: &str, state: &JointState) -> Vec<f64> {
    let speed = state.top_speed();
    let (low, high) =
        state.position.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), q| (l.min(*q), h.max(*q)));
    let span = high - low;
    let along = |of: &dyn Fn(f64, f64, usize) -> f64| -> Vec<f64> {
        (0..state.len()).map(|i| of(state.position[i], state.velocity[i], i)).collect()
    };
    match effect {
        "stribeck" => along(&|_, v, i| state.sign[i] * (-(v.abs() / (0.08 * speed))).exp()),
        "viscous_nonlinearity" => along(&|_, v, _| v * v.abs()),
        "direction_asymmetry" => along(&|_, v, _| v.abs()),
        "torque_offset" => along(&|_, _, _| 1.0),
        "spring" => along(&|q, _, _| q - low - 0.37 * span),
        "inertia_error" => along(&|_, _, i| state.acceleration[i]),
        "slow_drift" => along(&|_, _, i| state.time[i] * state.sign[i]),
        "position_ripple" => along(&|q, _, _| (23.0 * std::f64::consts::TAU * q / span + 0.4).sin()),
        "presliding" => bristle(state, 0.004 * span),
        _ => vec![0.0; state.len()],
    }
}

/// Deflection of a bristle (Dahl 1968) of the given break-away distance, less what Coulomb friction has of it.
fn bristle(state: &JointState, distance: f64) -> Vec<f64> {
    let mut deflection = 0.0f64;
    let mut before = state.position.first().copied().unwrap_or(0.0);
    (0..state.len())
        .map(|i| {
            let moved = state.position[i] - before;
            before = state.position[i];
            let end = moved.signum();
            deflection = end + (deflection - end) * (-moved.abs() / distance).exp();
            deflection - state.sign[i]
        })
        .collect()
}

/// The results as a section of Markdown.
pub fn table(results: &[Added]) -> String {
    let mut text = format!(
        "\n## Added to real recordings\n\nEach effect is added to the torque of a recording; what Coulomb and viscous friction cannot absorb of it is {:.0} % of the\nrecorded torque, root mean square. What the recording shows by itself is not counted; what is set aside as minor is.\n\n| recording | shows by itself | added | found |\n|---|---|---|---|\n",
        100.0 * SHARE
    );
    for added in results {
        let found: Vec<String> = added.found.iter().map(|set| set.join(" or ")).collect();
        let note = if added.was_there() { " (is there already)" } else { "" };
        let before = added.found_before.join(", ");
        let _ = writeln!(text, "| {} | {before} | {}{note} | {} |", added.recording, added.effect, found.join(", "));
    }
    let counted: Vec<&Added> = results.iter().filter(|added| !added.was_there()).collect();
    let hits = counted.iter().filter(|added| added.is_found()).count();
    let _ = writeln!(text, "\nFound: {}.", share(hits, counted.len()));
    text
}
