//! What was seen of the measurement, in words.

use crate::diagnose::checks::note::{Observation, TorquePart};
use crate::figures::{digits, quantity};
use crate::physics::units::Units;
use crate::report::tell::recording_note::recording_note;
use crate::samples::spikes::Spikes;

/// Ratios between the units of a velocity, or of a position and a velocity, and what was confused.
const VELOCITY_UNITS: [(f64, &str); 6] = [
    (1.0, "two directions"),
    (57.295_78, "deg and rad"),
    (9.549_297, "rpm and rad/s"),
    (std::f64::consts::TAU, "turns and rad"),
    (6.0, "rpm and deg/s"),
    (1000.0, "milli-units and units"),
];
/// How near a ratio has to be to that of two units, so that the units are named.
const NEAR_UNIT_RATIO: std::ops::Range<f64> = 0.9..1.11;

/// The sentence of an observation, in small letters and without a full stop.
#[must_use]
pub fn observation(seen: &Observation, units: Units) -> String {
    let torque = |value: f64| quantity(value, units.actuator);
    let percent = |share: f64| 100.0 * share;
    match seen {
        Observation::Recording(note) => recording_note(note, units),
        Observation::Glitches(spikes) => glitches(spikes),
        Observation::ClippedTorque { limit, share } => {
            format!("the torque stands at its limit of {} in {:.1} % of the samples", torque(*limit), percent(*share))
        }
        Observation::CommandBeyondLimit { limit, largest, share } => format!(
            "the recorded torque goes beyond the drive's limit of {} N m in {:.1} % of the samples, up to {} N m: it is the \
             command, and the limit is taken for what the joint felt",
            digits(*limit),
            percent(*share),
            digits(*largest)
        ),
        Observation::CoarseTorque { step } => {
            format!("the torque is recorded in steps of {}, coarser than its own noise", torque(*step))
        }
        Observation::CoarsePosition { step, cut_off_hz } => format!(
            "the position is recorded in steps of {}: its quantisation noise masks everything above {cut_off_hz} Hz",
            quantity(*step, if units.rotary { "rad" } else { "m" })
        ),
        Observation::SamplingJitter { deviation_s, period_s } => format!(
            "the error of the position grows with the speed, as by a sampling jitter of {} ({} samples) that the time column does \
             not show: its derivatives have the same error",
            quantity(*deviation_s, "s"),
            digits(deviation_s / period_s)
        ),
        Observation::RealignedTorque { delay_s, period_s } => format!(
            "the torque was recorded {} ({} samples) {} than the position, as drives do: it was put back",
            quantity(delay_s.abs(), "s"),
            digits((delay_s / period_s).abs()),
            if *delay_s > 0.0 { "later" } else { "earlier" }
        ),
        Observation::ContradictingVelocity { ratio } => {
            let is_near = |units: f64| NEAR_UNIT_RATIO.contains(&(ratio.abs() / units));
            let confused = VELOCITY_UNITS.iter().find(|(units, _)| is_near(*units) || is_near(1.0 / units));
            let confused = confused.map_or(String::new(), |(_, units)| format!(", as between {units}"));
            format!("the recorded velocity is {} times the derivative of the position{confused}", digits(*ratio))
        }
        Observation::DrivingFriction => {
            "friction comes out as driving the joint: torque and motion have opposite signs".to_string()
        }
        Observation::WrongFactor { part, factor, confusion: None } => {
            format!("the {} enters with factor {factor:.3}: its sign is opposite to the recording's", name(*part))
        }
        Observation::WrongFactor { part, factor, confusion: Some(confusion) } => {
            format!("the {} enters with factor {factor:.4}, as with {confusion}", name(*part))
        }
        Observation::BeyondModelRange { channels, share } => {
            let range = |(channel, [low, high], unit): &(String, [f64; 2], String)| {
                format!("{channel} from {} to {} {unit}", digits(*low), digits(*high))
            };
            let ranges = channels.iter().map(range).collect::<Vec<_>>().join(", ");
            format!(
                "the model was fitted on {ranges}: the {:.1} % of the recording beyond that are not compared with it",
                percent(*share)
            )
        }
        Observation::LockedEvent { when_s: [from, to], rms } => format!(
            "between {} and {} s the model's error is {} (root mean square), unlike that of all other rows",
            digits(*from),
            digits(*to),
            torque(*rms)
        ),
    }
}

fn glitches(Spikes { channel, rows, time_s, height, unit }: &Spikes) -> String {
    let (height, time) = (quantity(*height, &unit.replace("Nm", "N m")), digits(*time_s));
    if *rows == 1 {
        format!("one sample of the {channel} stands out alone, by {height} at {time} s: taken as a glitch and replaced")
    } else {
        format!(
            "{rows} samples of the {channel} stand out alone, the largest by {height} at {time} s: taken as glitches and replaced"
        )
    }
}

fn name(part: TorquePart) -> &'static str {
    match part {
        TorquePart::Model => "torque of the model",
        TorquePart::Inertia => "inertial torque",
        TorquePart::Load => "load torque",
        TorquePart::RigidBody => "rigid-body torque",
        TorquePart::Acceleration => "acceleration",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_in_another_unit_names_the_units() {
        let told = |ratio: f64| {
            let units = Units { actuator: "N m", rotary: true };
            observation(&Observation::ContradictingVelocity { ratio }, units)
        };
        for (ratio, units) in
            [(57.3, "deg and rad"), (0.01745, "deg and rad"), (-1.0, "two directions"), (0.001, "milli")]
        {
            assert!(told(ratio).contains(units), "{ratio}");
        }
        assert!(told(100.0).ends_with("100 times the derivative of the position"));
    }
}
