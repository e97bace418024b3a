//! Recordings as they are safe to use, and what was wrong with them in sentences.

use crate::checks::{self, Contradiction, Fault, Note, Reviewed, WrongUnit};
use crate::diagnose::HealthNote;
use crate::error::{Error, Result};
use crate::figures::{digits, quantity};
use crate::joint::Joint;
use crate::physics::EffectId;
use crate::recording::{self, Axis, Recording};
use serde_json::{Value, json};
use std::path::Path;

/// A note on a recording for a reader.
#[derive(Clone, Debug)]
pub(super) struct Warning {
    note: Note,
    /// One sentence without a final stop.
    pub(super) message: String,
}

/// A recording that may be fitted to, with what was put right.
///
/// # Errors
/// As [`recording::load`] and [`checks::review`], and the code of a fault that cannot be put right.
pub(super) fn load(path: &Path, joint: &Joint) -> Result<(Recording, Vec<Warning>)> {
    let reviewed = checks::review(recording::load(path, joint)?, joint)?;
    match reviewed.blocking() {
        Some(note) => {
            let message = sentence(&note.fault, &reviewed.recording);
            Err(Error::new(note.fault.code(), message).in_file(reviewed.recording.file()))
        }
        None => Ok(with_warnings(reviewed)),
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
    let warning = |note: Note| {
        let message = format!("{}: {}", recording.label, sentence(&note.fault, &recording));
        Warning { note, message }
    };
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
