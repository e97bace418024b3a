//! Recordings as they are safe to use, and what was wrong with them in sentences.

use crate::checks::{self, Contradiction, Fault, Note, Reviewed, WrongUnit};
use crate::diagnose::HealthNote;
use crate::error::{Error, Result};
use crate::figures::{digits, quantity};
use crate::joint::Joint;
use crate::physics::EffectId;
use crate::recording::{self, Axis, Recording};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A note on a recording for a reader.
#[derive(Clone, Debug)]
pub(super) struct Warning {
    note: Note,
    /// One sentence without a final stop.
    pub(super) message: String,
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
    let (recordings, mut warnings): (Vec<_>, Vec<_>) = loaded.into_iter().unzip();
    if paths.len() > 1 {
        for (recording, warnings) in recordings.iter().zip(&mut warnings) {
            warnings
                .iter_mut()
                .for_each(|warning| warning.message = format!("in {} {}", recording.label, warning.message));
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
    match warnings.iter().find(|warning| warning.note.fault.is_blocking()) {
        Some(warning) => Err(Error::new(warning.note.fault.code(), warning.message.clone()).in_file(recording.file())),
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
    let warning = |note: Note| Warning { message: sentence(&note.fault, &recording), note };
    let warnings = notes.into_iter().map(warning).collect();
    (recording, warnings)
}

impl Warning {
    /// Stable code, message and times.
    pub(super) fn to_json(&self) -> Value {
        json!({ "code": self.code(), "message": self.message, "when_s": self.note.when_s })
    }

    pub(super) fn code(&self) -> &'static str {
        self.note.fault.code().id
    }

    pub(super) fn when_s(&self) -> &[[f64; 2]] {
        &self.note.when_s
    }

    /// Whether it is a finding of its own: nothing of the physics explains it.
    pub(super) fn is_finding(&self) -> bool {
        matches!(self.note.fault, Fault::WrongSign { .. } | Fault::WrongUnit(_) | Fault::TurnedTorque { .. })
    }

    /// The same as a diagnosis notes it.
    pub(super) fn to_health(&self) -> HealthNote {
        let effect = match self.note.fault {
            Fault::RepeatedRows { .. } | Fault::RepeatedStamps { .. } | Fault::HeldSamples { .. } => {
                EffectId::Quantisation
            }
            Fault::FrozenTorque { .. } => EffectId::TransientEvent,
            Fault::OneDirection => EffectId::TorqueOffset,
            _ => EffectId::UnitOrSign,
        };
        HealthNote { effect, blocking: self.note.fault.is_blocking(), sentence: self.message.clone() }
    }
}

/// One sentence, lower case and without a final stop.
fn sentence(fault: &Fault, recording: &Recording) -> String {
    let rotary = recording.axis == Axis::Rotary;
    let travel = |value: f64| quantity(value, if rotary { "rad" } else { "m" });
    let actuator = recording.separated_friction().or_else(|| recording.actuator());
    let (name, unit) = actuator.map_or(("torque", "Nm"), |channel| (channel.name.as_str(), channel.unit));
    let unit = unit.replace("Nm", "N m");
    let rows = |rows: usize| if rows == 1 { "1 row".to_owned() } else { format!("{rows} rows") };
    match fault {
        Fault::RepeatedRows { rows: count } => {
            format!("{} that repeat the row before say nothing new and were left out", rows(*count))
        }
        Fault::RepeatedStamps { rows: count } => {
            format!("{} with the time of the row before but other values were left out", rows(*count))
        }
        Fault::HeldSamples { channel, every, rate_hz } => format!(
            "the {channel} is new in one row of {every} only: the rows in which it is were used, at {}",
            quantity(*rate_hz, "Hz")
        ),
        Fault::WrappedPosition { period, times } => format!(
            "the position starts anew every {} ({times} times): its turns were put together again",
            travel(*period)
        ),
        Fault::RezeroedPosition { by } => format!(
            "the position jumps by {} while the motion goes on, as when it is set to zero anew: what follows was shifted back and the \
             motion taken as interrupted",
            travel(*by)
        ),
        Fault::FrozenTorque { rows: count, value } => {
            let at = value.map_or_else(String::new, |value| format!(" at {}", quantity(value, &unit)));
            format!(
                "the {name} stands still{at} in {} in which the joint moves and it had to change: left out",
                rows(*count)
            )
        }
        Fault::TurnedTorque { rows: count } => {
            format!("the {name} has the opposite sign in {}, by the law of all others: left out", rows(*count))
        }
        Fault::WrongSign { work, dissipation: [power, _] } => {
            let [work_unit, power_unit] = match (unit.as_str(), rotary) {
                ("A", true) => ["A rad", "A rad/s"],
                ("A", false) => ["A m", "A m/s"],
                _ => ["J", "W"],
            };
            format!(
                "the {name} has the wrong sign: beside inertia, gravity and offset friction gives {} in place of taking it up, and the \
                 actuator takes up {}",
                quantity(-power, power_unit),
                quantity(-work, work_unit)
            )
        }
        Fault::WrongUnit(WrongUnit::VelocityOverDerivative(factor)) => format!(
            "the recorded velocity is {} times the derivative of the position: position, velocity or time is in {}",
            digits(*factor),
            if *factor < 0.0 { "the opposite direction" } else { "another unit than its column says" }
        ),
        Fault::WrongUnit(WrongUnit::PositionInDegrees(share)) => format!(
            "the position is in degrees where its column says radians: gravity repeats every 360 of it (what a law leaves of the \
             {name} is then {} of what it leaves with radians)",
            digits(*share)
        ),
        Fault::ContradictingVelocity(how) => {
            let how = match how {
                Contradiction::Constant(value) => format!("stays at {} while the position changes", digits(*value)),
                Contradiction::Late(lag) if *lag > 0.0 => format!("comes {} after the position", quantity(*lag, "s")),
                Contradiction::Late(lag) => format!("comes {} before the position", quantity(-lag, "s")),
                Contradiction::Scaled(factor) => format!("is {} times the derivative of the position", digits(*factor)),
                Contradiction::Unrelated(correlation) => {
                    format!(
                        "has little to do with the derivative of the position (correlation {})",
                        digits(*correlation)
                    )
                }
            };
            format!("the recorded velocity {how}: it was left out and the position differentiated")
        }
        Fault::OneDirection => {
            format!("the joint moves in one direction only: friction cannot be told from an offset of the {name}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::Fault::{
        ContradictingVelocity, FrozenTorque, HeldSamples, OneDirection, RepeatedRows, RepeatedStamps, RezeroedPosition,
        TurnedTorque, WrappedPosition, WrongSign,
    };
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

    #[test]
    fn every_fault_has_a_sentence_with_its_figures() {
        let recording = recording::parse("swing.csv", swing(1.0).as_bytes(), &Joint::default()).unwrap();
        let cases = [
            (RepeatedRows { rows: 12 }, "12 rows"),
            (RepeatedStamps { rows: 1 }, "1 row with"),
            (
                HeldSamples { channel: "position".into(), every: 10, rate_hz: 50.0 },
                "one row of 10 only: the rows in which it is were used, at 50 Hz",
            ),
            (WrappedPosition { period: 6.5, times: 3 }, "every 6.5 rad (3 times)"),
            (RezeroedPosition { by: 0.37 }, "jumps by 0.37 rad"),
            (FrozenTorque { rows: 500, value: Some(0.0) }, "the torque stands still at 0 N m in 500 rows"),
            (FrozenTorque { rows: 500, value: None }, "the torque stands still in 500 rows"),
            (TurnedTorque { rows: 70 }, "opposite sign in 70 rows"),
            (WrongSign { work: -63.0, dissipation: [-1.5, 0.1] }, "gives 1.5 W"),
            (Fault::WrongUnit(WrongUnit::VelocityOverDerivative(0.01745)), "another unit"),
            (Fault::WrongUnit(WrongUnit::VelocityOverDerivative(-1.0)), "opposite direction"),
            (Fault::WrongUnit(WrongUnit::PositionInDegrees(0.1)), "in degrees"),
            (ContradictingVelocity(Contradiction::Constant(0.0)), "velocity stays at 0"),
            (ContradictingVelocity(Contradiction::Late(0.03)), "velocity comes 0.03 s after"),
            (ContradictingVelocity(Contradiction::Late(-0.03)), "velocity comes 0.03 s before"),
            (ContradictingVelocity(Contradiction::Scaled(50.0)), "velocity is 50 times"),
            (ContradictingVelocity(Contradiction::Unrelated(0.1)), "(correlation 0.1)"),
            (OneDirection, "one direction only"),
        ];
        for (fault, words) in cases {
            let sentence = sentence(&fault, &recording);
            assert!(sentence.contains(words), "{sentence}");
            assert!(!sentence.ends_with('.') && !sentence.contains("  "), "{sentence}");
        }
    }
}
