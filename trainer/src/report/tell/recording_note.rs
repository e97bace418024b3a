//! What was wrong with a recording, in words.

use crate::checks::{Contradiction, Fault, WrongUnit};
use crate::diagnose::checks::note::RecordingNote;
use crate::figures::{digits, quantity};
use crate::physics::units::Units;
use crate::report::tell::folded::Noted;

/// The sentence of a note on a recording, in small letters and without a full stop; it names the recording where that is one of several.
#[must_use]
pub fn recording_note(found: &RecordingNote, units: Units) -> String {
    let Noted { recording, sentence } = noted(found, units);
    recording.map_or(sentence.clone(), |recording| format!("in {recording} {sentence}"))
}

/// The same, the recording by itself.
#[must_use]
pub fn noted(found: &RecordingNote, units: Units) -> Noted {
    Noted { recording: found.recording.clone(), sentence: fault(&found.note.fault, &found.actuator, units) }
}

fn fault(fault: &Fault, name: &str, units: Units) -> String {
    let Units { actuator: unit, rotary } = units;
    let travel = |value: f64| quantity(value, if rotary { "rad" } else { "m" });
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
            let at = value.map_or_else(String::new, |value| format!(" at {}", quantity(value, unit)));
            format!(
                "the {name} stands still{at} in {} in which the joint moves and it had to change: left out",
                rows(*count)
            )
        }
        Fault::TurnedTorque { rows: count } => {
            format!("the {name} has the opposite sign in {}, by the law of all others: left out", rows(*count))
        }
        Fault::WrongSign { work, dissipation: [power, _] } => {
            let [work_unit, power_unit] = match (unit, rotary) {
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
                        "hardly correlates with the derivative of the position (correlation {})",
                        digits(*correlation)
                    )
                }
            };
            format!("the recorded velocity {how}: it was left out and the position differentiated")
        }
        Fault::LostSign { left } => format!(
            "the {name} was recorded without its sign: it is never below zero, and a law leaves only {} of it once each row has the sign \
             that the motion asks for",
            digits(*left)
        ),
        Fault::SignBit { channel, offset, times } => format!(
            "negative numbers of the {channel} are {} too large ({times} jumps across zero), as where the sign is read as a digit: they \
             were put back",
            digits(*offset)
        ),
        Fault::OneDirection { .. } => {
            format!("the joint moves in one direction only: friction cannot be separated from an offset of the {name}")
        }
        Fault::NearlyNamed { column, known } => {
            format!("the column {column} is kept as a channel of that name: did you mean {known}?")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::Fault::{
        ContradictingVelocity, FrozenTorque, HeldSamples, LostSign, OneDirection, RepeatedRows, RepeatedStamps,
        RezeroedPosition, SignBit, TurnedTorque, WrappedPosition, WrongSign,
    };

    #[test]
    fn every_fault_has_a_sentence_with_its_figures() {
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
            (LostSign { left: 0.05 }, "leaves only 0.05 of it"),
            (SignBit { channel: "torque".into(), offset: 164.0, times: 7 }, "164 too large (7 jumps"),
            (OneDirection { forward: true }, "one direction only"),
            (
                Fault::NearlyNamed { column: "postion_rad".into(), known: "position_rad".into() },
                "did you mean position_rad?",
            ),
        ];
        for (seen, words) in cases {
            let sentence = fault(&seen, "torque", Units { actuator: "N m", rotary: true });
            assert!(sentence.contains(words), "{sentence}");
            assert!(!sentence.ends_with('.') && !sentence.contains("  "), "{sentence}");
        }
    }
}
