//! Recordings as they are safe to use, and what was wrong with them in sentences.

use crate::checks::{self, Fault, Note, Reviewed};
use crate::compile::profile::{PROFILES, Profile};
use crate::diagnose::checks::note::{HealthNote, Observation, RecordingNote};
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::physics::EffectId;
use crate::physics::units::Units;
use crate::recording::{self, Axis, Recording};
use crate::report::tell::recording_note::recording_note;
use serde_json::{Value, json};
use std::fmt;
use std::path::{Path, PathBuf};

/// A note on a recording for a reader.
#[derive(Clone, Debug)]
pub(super) struct Warning {
    note: RecordingNote,
    /// One sentence without a final stop.
    pub(super) message: String,
}

/// What is known of the joint, from its file where one is given; what nothing reads of that file is told on standard error.
///
/// # Errors
/// As [`Joint::load`].
pub(super) fn joint(path: Option<&Path>, quiet: bool) -> Result<Joint> {
    let Some(path) = path else { return Ok(Joint::default()) };
    let joint = Joint::load(path)?;
    if !quiet {
        joint.unknown_keys().iter().for_each(|sentence| eprintln!("{} {sentence}", codes::UNKNOWN_KEY.id));
    }
    Ok(joint)
}

/// Recordings of one joint, each read by `load`, with the warnings of all; where there are several, a warning names its own.
///
/// # Errors
/// As `load`.
pub(super) fn load_all(
    paths: &[PathBuf],
    load: impl Fn(&Path) -> Result<(Recording, Vec<Warning>)>,
) -> Result<(Vec<Recording>, Vec<Warning>)> {
    let loaded = paths.iter().map(|path| load(path)).collect::<Result<Vec<_>>>()?;
    let (recordings, mut warnings): (Vec<Recording>, Vec<Vec<Warning>>) = loaded.into_iter().unzip();
    if paths.len() > 1 {
        for (recording, warnings) in recordings.iter().zip(&mut warnings) {
            for warning in warnings {
                warning.note.recording = Some(recording.label.clone());
                warning.message = recording_note(&warning.note, units(recording));
            }
        }
    }
    Ok((recordings, warnings.concat()))
}

/// A recording that may be fitted to, with what was put right.
///
/// # Errors
/// As [`recording::load`] and [`checks::review`], and the code of a fault that cannot be put right.
pub(super) fn load(path: &Path, joint: &Joint) -> Result<(Recording, Vec<Warning>)> {
    let (recording, warnings) = load_with_faults(path, joint)?;
    match warnings.iter().find(|warning| warning.note.note.fault.is_blocking()) {
        Some(warning) => {
            Err(Error::new(warning.note.note.fault.code(), warning.message.clone()).in_file(recording.file()))
        }
        None => Ok((recording, warnings)),
    }
}

/// A recording that may be diagnosed: faults that cannot be put right are among the warnings.
///
/// # Errors
/// As [`recording::load`] and [`checks::review`].
pub(super) fn load_with_faults(path: &Path, joint: &Joint) -> Result<(Recording, Vec<Warning>)> {
    checks::review(recording::load(path, joint)?, joint).map(with_warnings)
}

/// A recording of which only the motion is used, or a simulation.
///
/// # Errors
/// As [`checks::review_motion`].
pub(super) fn motion(recording: Recording, joint: &Joint) -> Result<(Recording, Vec<Warning>)> {
    checks::review_motion(recording, joint).map(with_warnings)
}

fn with_warnings(Reviewed { recording, notes }: Reviewed) -> (Recording, Vec<Warning>) {
    let actuator = recording.separated_friction().or_else(|| recording.actuator());
    let actuator = actuator.map_or("torque", |channel| channel.name.as_str()).to_owned();
    let warning = |note: Note| {
        let note = RecordingNote { note, actuator: actuator.clone(), recording: None };
        Warning { message: recording_note(&note, units(&recording)), note }
    };
    let warnings = notes.into_iter().map(warning).collect();
    (recording, warnings)
}

/// Stable code and message.
impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.code(), self.message)
    }
}

impl Warning {
    /// Stable code, message and times.
    pub(super) fn to_json(&self) -> Value {
        json!({ "code": self.code(), "message": self.message, "when_s": self.note.note.when_s })
    }

    pub(super) fn code(&self) -> &'static str {
        self.note.note.fault.code().id
    }

    /// Whether it is a finding of its own: nothing of the physics explains it.
    pub(super) fn is_finding(&self) -> bool {
        matches!(self.note.note.fault, Fault::WrongSign { .. } | Fault::WrongUnit(_) | Fault::TurnedTorque { .. })
    }

    /// The same as a diagnosis notes it.
    pub(super) fn to_health(&self) -> HealthNote {
        let effect = match self.note.note.fault {
            Fault::RepeatedRows { .. } | Fault::RepeatedStamps { .. } | Fault::HeldSamples { .. } => {
                EffectId::Quantisation
            }
            Fault::FrozenTorque { .. } => EffectId::TransientEvent,
            Fault::OneDirection => EffectId::TorqueOffset,
            _ => EffectId::UnitOrSign,
        };
        let observation = Observation::Recording(self.note.clone());
        HealthNote { effect, blocking: self.note.note.fault.is_blocking(), observation }
    }
}

/// Units of a recording as they are printed.
pub(super) fn units(recording: &Recording) -> Units {
    let channel = recording.actuator().or_else(|| recording.separated_friction());
    let actuator = match channel.map(|channel| channel.unit) {
        Some("N") => "N",
        Some("A") => "A",
        _ => "N m",
    };
    Units { actuator, rotary: recording.axis == Axis::Rotary }
}

/// A documented drive by its name.
pub(crate) fn profile(name: &str) -> std::result::Result<Profile, String> {
    let names = || PROFILES.map(|profile| profile.name).join(", ");
    Profile::named(name).ok_or_else(|| format!("there is no drive of this name; there are {}", names()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    /// A slow swing of a joint with Coulomb friction; the torque is `sign` times what it is.
    fn swing(sign: f64) -> String {
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for row in 0..6000 {
            let phase = 0.004 * f64::from(row);
            let friction = 0.8 * (phase.cos() / 0.01).tanh() + 0.05 * (37.0 * phase).sin();
            writeln!(text, "{},{},{}", 0.01 * f64::from(row), phase.sin(), sign * friction).unwrap();
        }
        text
    }

    #[test]
    fn a_fault_that_cannot_be_put_right_is_an_error_for_a_fit_and_a_warning_for_a_diagnosis() {
        let folder = tempfile::tempdir().unwrap();
        let [good, turned] = [("good.csv", 1.0), ("turned.csv", -1.0)].map(|(name, sign)| {
            let path = folder.path().join(name);
            std::fs::write(&path, swing(sign)).unwrap();
            path
        });
        let joint = Joint::default();
        assert!(load(&good, &joint).unwrap().1.is_empty());
        let error = load(&turned, &joint).unwrap_err();
        assert_eq!((error.code().id, error.exit_status()), ("FRK-D024", 3));
        assert!(error.to_string().contains("turned.csv") && error.message().contains("wrong sign"), "{error}");
        let (_, warnings) = load_all(&[good, turned], |path| load_with_faults(path, &joint)).unwrap();
        let [warning] = &warnings[..] else { panic!("{warnings:?}") };
        assert!(warning.message.starts_with("in turned.csv the torque has the wrong sign"), "{}", warning.message);
        assert!(warning.is_finding() && warning.to_health().blocking);
    }
}
