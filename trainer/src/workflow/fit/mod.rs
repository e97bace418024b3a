//! From recordings to a law that tells itself.

mod integers;
pub(super) mod json;
mod servo;
mod simulated;
pub(super) mod text;

use std::path::Path;
use std::time::Instant;

use serde_json::Value;

use super::recordings::{Warning, folded_warnings, load, load_all};
use super::source::{Reading, Source};
use crate::actuator::Kind;
use crate::error::{Error, Result, codes};
use crate::fit::outcome::Soundness;
use crate::fit::{Options, OtherForces, Outcome, ProgressCallback};
use crate::joint::Joint;
use crate::recording::Recording;
use crate::report::{self, Origin};
use crate::servo::{ServoFit, fit_servo};
use simulated::SimulatedMotions;

/// A fit with what was noticed of its recordings.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Law, image, scores and all that is told of them.
    pub outcome: Outcome,
    /// What was identified of the actuator, of a joint that reports no torque.
    pub servo: Option<ServoFit>,
    /// The recordings that were fitted, as the checks left them.
    pub recordings: Vec<Recording>,
    /// What the checks of the recordings put right or noticed.
    pub warnings: Vec<Warning>,
    /// Name and CRC-64/XZ of the content of each recording, tests included.
    pub sources: Vec<(String, u64)>,
    /// Time that reading and fitting took, s.
    pub seconds: f64,
    /// The joint simulated with the image, where it can be.
    motions: Option<SimulatedMotions>,
}

/// Fits recordings of one joint; `tests` are only scored.
///
/// ```
/// use frikan_trainer::fit::Options;
/// use frikan_trainer::joint::Joint;
/// # let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
/// # std::env::set_current_dir(fixtures)?;
/// let recordings = ["stribeck.csv".into()];
/// let tests = ["stribeck-test.csv".into()];
/// let fitted = frikan_trainer::fit(&recordings, &tests, &Joint::default(), &Options::default(), &|_| {})?;
/// println!("friction = {}", fitted.outcome.law.expression);
/// assert!(fitted.outcome.tests[0].score.r2 > 0.999);
/// std::fs::write(std::env::temp_dir().join("stribeck.html"), fitted.report("my program"))?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`crate::fit::fit()`] or [`fit_servo`], and whatever reading a recording reports.
pub fn fit(
    recordings: &[Source<'_>],
    tests: &[Source<'_>],
    joint: &Joint,
    options: &Options,
    progress: ProgressCallback<'_>,
) -> Result<Fitted> {
    let start = Instant::now();
    if options.integers && joint.actuator.kind != Kind::Torque {
        let message = "a table of integers is made from recorded torque, force or current; this joint reports none";
        return Err(Error::new(&codes::USAGE, message).with_value(options.budget.target.name));
    }
    let inputs = options.inputs.as_deref().unwrap_or_default();
    let reading = Reading::of(inputs, options.memory_mb, recordings.len() + tests.len());
    let (recordings, mut warnings) = load_all(recordings.iter().copied(), |source| load(source, joint, reading))?;
    let (tests, of_tests) = load_all(tests.iter().copied(), |source| load(source, joint, reading))?;
    warnings.extend(of_tests);
    let sources = recordings.iter().chain(&tests).map(Recording::source).collect();
    let forces = OtherForces::of(&recordings, joint)?;
    let taken_off = |recordings: Vec<Recording>| recordings.into_iter().map(|recording| forces.taken_off(recording));
    let recordings = taken_off(recordings).collect::<Result<Vec<_>>>()?;
    let tests = taken_off(tests).collect::<Result<Vec<_>>>()?;
    let servo = match joint.actuator.kind {
        Kind::Torque => None,
        _ => Some(fit_servo(&recordings, &tests, joint, options, progress)?),
    };
    let mut outcome = match &servo {
        Some(servo) => servo.outcome.clone(),
        None => crate::fit::fit(&recordings, &tests, joint, options, progress)?,
    };
    outcome.parameters.extend(forces.factors);
    outcome.remarks.extend(forces.remarks);
    let motions = match &servo {
        Some(servo) => Some(SimulatedMotions::of_servo(servo, joint)),
        None => SimulatedMotions::under_torque(&outcome, &recordings, &tests, joint),
    };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Fitted { outcome, servo, recordings, warnings, sources, seconds, motions })
}

impl Fitted {
    /// The result as JSON, schema `frikan.fit/1`.
    #[must_use]
    pub fn json(&self) -> Value {
        json::summary(&self.outcome, self.motions.as_ref(), &self.warnings, self.seconds)
    }

    /// The result for a terminal; `image` is the name of the image's file, where one is written.
    #[must_use]
    pub fn text(&self, image: Option<&Path>) -> String {
        let text = text::summary(&self.outcome, &self.warnings, image, self.seconds);
        text + &self.motions.as_ref().map(SimulatedMotions::text).unwrap_or_default()
    }

    /// What was identified of the actuator as `[actuator]` of a joint.toml.
    #[must_use]
    pub fn actuator_toml(&self) -> Option<String> {
        self.servo.as_ref().map(|servo| servo::table(&servo.identified))
    }

    /// The result as one HTML page; `command` is what made it, for its foot.
    #[must_use]
    pub fn report(&self, command: &str) -> String {
        let told: Vec<String> = folded_warnings(&self.warnings).iter().map(|warning| format!("{warning}.")).collect();
        let settings = format!("Seed {}. Filter: {}.", self.outcome.seed, self.outcome.filter);
        report::fit(&self.outcome, &told, &Origin { command, recordings: &self.sources, settings: &settings })
    }

    /// Whether the image may not be relied upon, and is written only by force.
    #[must_use]
    pub fn is_withheld(&self) -> bool {
        self.outcome.sound != Soundness::Sound
    }

    /// Why the fit may not be relied upon, where it may not.
    #[must_use]
    pub fn doubt(&self) -> Option<Error> {
        doubt(&self.outcome.sound)
    }
}

/// Why a fit may not be relied upon, where it may not.
pub(in crate::workflow) fn doubt(sound: &Soundness) -> Option<Error> {
    let (code, what) = match sound {
        Soundness::Sound => return None,
        Soundness::NotIdentifiable(what) => (&codes::NOT_IDENTIFIABLE, what),
        Soundness::NotConverged(what) => (&codes::NOT_CONVERGED, what),
        Soundness::NotPhysical(what) => (&codes::NOT_PHYSICAL, what),
    };
    Some(Error::new(code, what.clone()))
}
