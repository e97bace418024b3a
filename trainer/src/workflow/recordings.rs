//! Recordings as they are safe to use, and what was wrong with them in sentences.

use super::source::{Reading, Source};
use crate::checks::{self, Fault, Note, Reviewed};
use crate::diagnose::checks::note::{HealthNote, Observation, RecordingNote};
use crate::error::{Error, Result};
use crate::joint::Joint;
use crate::physics::EffectId;
use crate::physics::units::Units;
use crate::recording::{Axis, Recording};
use crate::report::tell::folded::{Noted, folded};
use crate::report::tell::recording_note::recording_note;
use serde_json::{Value, json};
use std::fmt;

/// A note on a recording for a reader.
#[derive(Clone, Debug)]
pub struct Warning {
    note: RecordingNote,
    /// One sentence without a final stop.
    message: String,
}

/// What warnings say with their codes, in sentences without a final stop: what several recordings have in common is said once.
pub(crate) fn folded_warnings(warnings: &[Warning]) -> Vec<String> {
    let mut codes: Vec<(&str, Vec<Noted>)> = Vec::new();
    for (code, note) in warnings.iter().map(|warning| (warning.code(), warning.noted())) {
        match codes.iter_mut().find(|(other, _)| *other == code) {
            Some((_, notes)) => notes.push(note),
            None => codes.push((code, vec![note])),
        }
    }
    let told = |(code, notes): &(&str, Vec<Noted>)| {
        folded(notes).into_iter().map(|sentence| format!("{code} {sentence}")).collect::<Vec<_>>()
    };
    codes.iter().flat_map(told).collect()
}

/// Recordings of one joint, each read by `load`, with the warnings of all; where there are several, a warning names its own.
///
/// # Errors
/// As `load`.
pub(crate) fn load_all<'a, S: Into<Source<'a>>>(
    sources: impl IntoIterator<Item = S>,
    load: impl Fn(Source<'a>) -> Result<(Recording, Vec<Warning>)>,
) -> Result<(Vec<Recording>, Vec<Warning>)> {
    let loaded = sources.into_iter().map(|source| load(source.into())).collect::<Result<Vec<_>>>()?;
    let (recordings, mut warnings): (Vec<Recording>, Vec<Vec<Warning>>) = loaded.into_iter().unzip();
    let one_way = |warnings: &Vec<Warning>| warnings.iter().find_map(Warning::direction);
    // One way in one recording and the other way in another are both directions.
    let only = warnings.first().and_then(one_way);
    if warnings.iter().any(|warnings| one_way(warnings) != only) {
        warnings.iter_mut().for_each(|warnings| warnings.retain(|warning| warning.direction().is_none()));
    }
    if recordings.len() > 1 {
        for (recording, warnings) in recordings.iter().zip(&mut warnings) {
            warnings.iter_mut().for_each(|warning| warning.tell(&recording.label, recording));
        }
    }
    Ok((recordings, warnings.concat()))
}

/// A recording that may be fitted to, with what was put right.
///
/// # Errors
/// As [`Source::read`] and [`checks::review`], and the code of a fault that cannot be put right.
pub(crate) fn load<'a>(
    source: impl Into<Source<'a>>,
    joint: &Joint,
    reading: Reading<'_>,
) -> Result<(Recording, Vec<Warning>)> {
    let (recording, warnings) = load_with_faults(source, joint, reading)?;
    match warnings.iter().find(|warning| warning.is_blocking()) {
        Some(warning) => {
            Err(Error::new(warning.note.note.fault.code(), warning.message.clone()).in_file(recording.file()))
        }
        None => Ok((recording, warnings)),
    }
}

/// A recording that may be diagnosed: faults that cannot be put right are among the warnings.
///
/// # Errors
/// As [`Source::read`] and [`checks::review`].
pub(crate) fn load_with_faults<'a>(
    source: impl Into<Source<'a>>,
    joint: &Joint,
    reading: Reading<'_>,
) -> Result<(Recording, Vec<Warning>)> {
    checks::review(source.into().read_numbers(joint, reading)?, joint).map(with_warnings)
}

/// A recording of which only the motion is used, or a simulation.
///
/// # Errors
/// As [`checks::review_motion`].
pub(crate) fn motion(recording: Recording, joint: &Joint) -> Result<(Recording, Vec<Warning>)> {
    checks::review_motion(recording, joint).map(with_warnings)
}

/// The motion of one joint of a recording, by a name that warnings tell.
///
/// # Errors
/// As [`motion`].
pub(crate) fn motion_of(name: &str, recording: Recording, joint: &Joint) -> Result<(Recording, Vec<Warning>)> {
    let (recording, mut warnings) = motion(recording, joint)?;
    warnings.iter_mut().for_each(|warning| warning.tell(name, &recording));
    Ok((recording, warnings))
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
    /// Names the recording in the message.
    fn tell(&mut self, name: &str, recording: &Recording) {
        self.note.recording = Some(name.to_owned());
        self.message = recording_note(&self.note, units(recording));
    }

    /// What was found, one sentence without a final stop.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What was found, the recording by itself where the message names one.
    pub(crate) fn noted(&self) -> Noted {
        let recording = self.note.recording.clone();
        let prefix = recording.as_ref().map_or_else(String::new, |recording| format!("in {recording} "));
        let sentence = self.message.strip_prefix(&prefix).unwrap_or(&self.message).to_owned();
        Noted { recording, sentence }
    }

    /// Stable code, message and times.
    pub(crate) fn to_json(&self) -> Value {
        json!({ "code": self.code(), "message": self.message, "when_s": self.note.note.when_s })
    }

    /// Stable code, as `trainer explain` takes it.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.note.note.fault.code().id
    }

    /// Stretches of time that it concerns, s.
    pub(crate) fn when_s(&self) -> &[[f64; 2]] {
        &self.note.note.when_s
    }

    /// Whether nothing may be fitted beside it.
    pub(crate) fn is_blocking(&self) -> bool {
        self.note.note.fault.is_blocking()
    }

    /// Whether it is a finding of its own: nothing of the physics explains it.
    pub(crate) fn is_finding(&self) -> bool {
        matches!(
            self.note.note.fault,
            Fault::WrongSign { .. } | Fault::WrongUnit(_) | Fault::TurnedTorque { .. } | Fault::LostSign { .. }
        )
    }

    /// The direction, where the joint moves in one only.
    fn direction(&self) -> Option<bool> {
        match self.note.note.fault {
            Fault::OneDirection { forward } => Some(forward),
            _ => None,
        }
    }

    /// The same as a diagnosis notes it.
    pub(crate) fn to_health(&self) -> HealthNote {
        let effect = match self.note.note.fault {
            Fault::RepeatedRows { .. } | Fault::RepeatedStamps { .. } | Fault::HeldSamples { .. } => {
                EffectId::Quantisation
            }
            Fault::FrozenTorque { .. } => EffectId::TransientEvent,
            Fault::OneDirection { .. } => EffectId::TorqueOffset,
            _ => EffectId::UnitOrSign,
        };
        let observation = Observation::Recording(self.note.clone());
        HealthNote { effect, blocking: self.note.note.fault.is_blocking(), observation }
    }
}

/// Units of a recording as they are printed.
pub(crate) fn units(recording: &Recording) -> Units {
    let channel = recording.actuator().or_else(|| recording.separated_friction());
    let actuator = match channel.map(|channel| channel.unit) {
        Some("N") => "N",
        Some("A") => "A",
        _ => "N m",
    };
    Units { actuator, rotary: recording.axis == Axis::Rotary }
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
        assert!(load(&good, &joint, Reading::default()).unwrap().1.is_empty());
        let error = load(&turned, &joint, Reading::default()).unwrap_err();
        assert_eq!((error.code().id, error.exit_status()), ("FRK-D024", 3));
        assert!(error.to_string().contains("turned.csv") && error.message().contains("wrong sign"), "{error}");
        let (_, warnings) =
            load_all(&[good, turned], |source| load_with_faults(source, &joint, Reading::default())).unwrap();
        let [warning] = &warnings[..] else { panic!("{warnings:?}") };
        assert!(warning.message.starts_with("in turned.csv the torque has the wrong sign"), "{}", warning.message);
        assert!(warning.is_finding() && warning.to_health().blocking);
    }

    #[test]
    fn one_way_in_one_recording_and_the_other_way_in_another_are_both_directions() {
        let folder = tempfile::tempdir().unwrap();
        let [there, back] = [("there.csv", 1.0), ("back.csv", -1.0)].map(|(name, sign)| {
            let path = folder.path().join(name);
            let mut text = String::from("time_s,position_rad,torque_Nm\n");
            for row in 0..3000 {
                let time = 0.01 * f64::from(row);
                let [way, speed] = [time - 0.5 * (1.3 * time).sin(), 1.0 - 0.65 * (1.3 * time).cos()];
                writeln!(text, "{time},{},{}", sign * way, sign * (0.8 + 0.3 * speed) + 0.05 * (37.0 * time).sin())
                    .unwrap();
            }
            std::fs::write(&path, text).unwrap();
            path
        });
        let codes = |paths: &[std::path::PathBuf]| {
            let (_, warnings) = load_all(paths, |source| load(source, &Joint::default(), Reading::default())).unwrap();
            warnings.iter().map(Warning::code).collect::<Vec<_>>()
        };
        assert_eq!(codes(std::slice::from_ref(&there)), ["FRK-W008"]);
        assert_eq!(codes(&[there.clone(), there.clone()]), ["FRK-W008", "FRK-W008"]);
        assert!(codes(&[there, back]).is_empty());
    }
}
