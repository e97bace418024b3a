//! Motions of other joints among the named channels of a recording: `other_position_rad`, `joint2_velocity_deg_s`,
//! `axis3_acceleration_rad_s2`, `j4_position_rad`; or `q2`, `dq2`, `ddq2` in SI units.

use crate::recording::{Quantity, Recording};
use crate::samples::EvenClock;
use std::ops::Range;

/// Words for another joint in front of the quantity of a column; a number may follow.
const JOINT_WORDS: [&str; 4] = ["other", "joint", "axis", "j"];

/// Quantities that determine a motion, best first, with how often each has to be integrated.
const MOTION_QUANTITIES: [(Quantity, usize); 3] =
    [(Quantity::Position, 0), (Quantity::Velocity, 1), (Quantity::Acceleration, 2)];

/// Positions of the other joints on the even clock, in rad or m, in the order in which they stand in the file. Where only a
/// derivative is recorded, the position is its integral, of mean zero.
pub(crate) fn other_positions(recording: &Recording, even: &EvenClock) -> Vec<Vec<f64>> {
    let own = recording.channel(Quantity::Position).and_then(|own| joint_of(&own.column)).map(|(joint, ..)| joint);
    let named = recording.channels.iter().filter(|channel| channel.quantity.is_none());
    let found: Vec<_> = named
        .filter_map(|channel| {
            let (joint, quantity, factor) = joint_of(&channel.column)?;
            let (_, derivative) = *MOTION_QUANTITIES.iter().find(|(of_motion, _)| *of_motion == quantity)?;
            (Some(joint) != own).then_some((joint, derivative, factor, even.named(&channel.name)?))
        })
        .collect();
    let mut joints: Vec<&str> = found.iter().map(|(joint, ..)| *joint).collect();
    let mut seen = Vec::new();
    joints.retain(|joint| {
        !seen.contains(joint) && {
            seen.push(joint);
            true
        }
    });
    let position = |joint: &&str| {
        let of_joint = found.iter().filter(|(of, ..)| of == joint);
        of_joint.min_by_key(|(_, derivative, ..)| *derivative).map(|(_, derivative, factor, values)| {
            let recorded: Vec<f64> = values.iter().map(|value| value * factor).collect();
            (0..*derivative).fold(recorded, |series, _| integrated(&series, &even.segments, even.period_s))
        })
    };
    joints.iter().filter_map(position).collect()
}

/// Joint, quantity and factor to SI of a column `<joint>_<quantity>_<unit>`, in SI units where none is given, or of `q`, `dq` and
/// `ddq` with a number.
fn joint_of(column: &str) -> Option<(&str, Quantity, f64)> {
    if let Some((derivatives, number)) = column.split_once('q').filter(|(_, number)| is_number(number)) {
        let order = MOTION_QUANTITIES.iter().find(|(_, order)| derivatives == &"dd"[..*order])?;
        return Some((number, order.0, 1.0));
    }
    let (joint, rest) = column.split_once('_')?;
    let word = joint.trim_end_matches(|c: char| c.is_ascii_digit());
    let with_unit = || Quantity::of_column(rest).map(|(quantity, unit)| (quantity, unit.factor));
    let (quantity, factor) = Quantity::from_name(rest).map(|quantity| (quantity, 1.0)).or_else(with_unit)?;
    JOINT_WORDS.contains(&word).then_some((joint, quantity, factor))
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Integral of a series by the trapezoidal rule, of mean zero in every segment: where it began is not recorded.
fn integrated(series: &[f64], segments: &[Range<usize>], period: f64) -> Vec<f64> {
    let mut integral = vec![0.0; series.len()];
    for segment in segments {
        for i in segment.start + 1..segment.end {
            integral[i] = integral[i - 1] + 0.5 * period * (series[i - 1] + series[i]);
        }
        let mean = integral[segment.clone()].iter().sum::<f64>() / segment.len().max(1) as f64;
        integral[segment.clone()].iter_mut().for_each(|value| *value -= mean);
    }
    integral
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;
    use crate::recording::parse;

    fn positions(header: &str, columns: impl Fn(f64) -> Vec<f64>) -> Vec<Vec<f64>> {
        let row = |i: usize| {
            let time = 0.002 * i as f64;
            let others: String = columns(time).iter().map(|value| format!(",{value}")).collect();
            format!("{time},{},1{others}\n", time.sin())
        };
        let rows: String = (0..5000).map(row).collect();
        let text = format!("time_s,position_rad,torque_Nm,{header}\n{rows}");
        let recording = parse("r.csv", text.as_bytes(), &Joint::default()).unwrap();
        other_positions(&recording, &EvenClock::of(&recording).unwrap())
    }

    #[test]
    fn joints_are_known_by_their_columns_and_by_whatever_of_their_motion_is_recorded() {
        let (a, b) = (2.0, 0.7 * std::f64::consts::TAU);
        let header = "goal_position_rad,joint2_acceleration_rad_s2,axis3_position_deg,axis3_velocity_deg_s,j4_velocity,dq5,q,dddq1";
        let found = positions(header, |t| {
            let [sine, cosine] = [(b * t).sin(), (b * t).cos()];
            vec![9.0, -a * b * b * sine, 90.0 * cosine, 0.0, a * b * cosine, a * b * cosine, 7.0, 7.0]
        });
        assert_eq!(found.len(), 4);
        for i in (100..4900).step_by(100) {
            let (sine, cosine) = ((b * 0.002 * i as f64).sin(), (b * 0.002 * i as f64).cos());
            assert!((found[0][i] - a * sine).abs() < 0.05 * a, "{i}: {}", found[0][i]);
            assert!((found[1][i] - 0.5 * std::f64::consts::PI * cosine).abs() < 1e-9);
            assert!((found[2][i] - a * sine).abs() < 0.05 * a, "{i}: {}", found[2][i]);
            assert_eq!(found[2][i], found[3][i]);
        }
    }
}
