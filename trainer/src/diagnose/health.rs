//! Measurement before physics: what is wrong with the recording itself.

use super::filter::{ZeroPhase, first_derivative, second_derivative};
use super::linear::{least_squares, residual};
use super::prepare::Prepared;
use super::signals::Signals;
use super::traces::WorstLocked;
use crate::figures::{digits, quantity};
use crate::physics::EffectId;
use crate::samples::spikes::Spikes;
use crate::statistics::quantile;
use serde::Serialize;

/// A note on the measurement chain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HealthNote {
    /// The effect of the catalogue it stands for.
    pub effect: EffectId,
    /// Whether a diagnosis of physics makes no sense before it is repaired.
    pub blocking: bool,
    /// One sentence with figures.
    pub sentence: String,
}

/// Share of samples at one extreme torque from which it counts as clipped.
const CLIPPED_SHARE: f64 = 0.02;
/// A torque step of this share of the usual torque hides friction.
const COARSE_TORQUE_SHARE: f64 = 0.05;
/// Band in Hz that the encoder has to leave for friction to be seen.
const LEAST_BAND_HZ: f64 = 10.0;
/// Factors that a wrong unit leaves: degrees for radians, turns for radians, milli for whole, and their inverses.
const UNIT_FACTORS: [(f64, &str); 6] = [
    (57.295_78, "deg taken for rad"),
    (std::f64::consts::TAU, "turns taken for rad"),
    (1000.0, "milli-units taken for units"),
    (0.017_453_29, "rad taken for deg"),
    (0.159_154_9, "rad taken for turns"),
    (0.001, "units taken for milli-units"),
];

/// Factor of what is given that its turned sign leaves, mass or gravity being as wrong as they usually are.
const AS_A_TURNED_SIGN_LEAVES: std::ops::Range<f64> = -2.0..-0.5;
/// How near a factor has to be to that of a unit: a body of the wrong mass may come close to it by chance.
const AS_A_UNIT_LEAVES: std::ops::Range<f64> = 0.9..1.11;

/// Looks at the signals alone.
pub fn examine(signals: &Signals) -> Vec<HealthNote> {
    let mut notes = Vec::new();
    notes.extend(signals.spikes.iter().map(replaced));
    notes.extend(clipped_torque(signals));
    notes.extend(wrong_sign_or_unit(signals));
    notes.extend(coarse_torque(signals));
    notes
}

/// Rows that no motion of the joint can explain and that were replaced.
fn replaced(spikes: &Spikes) -> HealthNote {
    let Spikes { channel, rows, time_s, height, unit } = spikes;
    let (height, time) = (quantity(*height, &unit.replace("Nm", "N m")), digits(*time_s));
    let sentence = if *rows == 1 {
        format!("one sample of the {channel} stands out alone, by {height} at {time} s: taken as a glitch and replaced")
    } else {
        format!(
            "{rows} samples of the {channel} stand out alone, the largest by {height} at {time} s: taken as glitches and replaced"
        )
    };
    HealthNote { effect: EffectId::TransientEvent, blocking: false, sentence }
}

/// Torque steps of more than the noise hide what happens between them.
fn coarse_torque(signals: &Signals) -> Option<HealthNote> {
    let steps: Vec<f64> =
        signals.torque.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0).collect();
    let typical = quantile(steps.iter().copied(), 0.5);
    let smallest = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = quantile(signals.torque.iter().map(|t| t.abs()), 0.9);
    // Most changes are a single step, and the step is a sizeable share of the torque.
    let coarse = typical < 1.5 * smallest && smallest > COARSE_TORQUE_SHARE * spread && steps.len() > 20;
    coarse.then(|| HealthNote {
        effect: EffectId::Quantisation,
        blocking: true,
        sentence: format!("the torque is recorded in steps of {smallest:.4}, coarser than its own noise"),
    })
}

/// Something that happened once, in rows that were locked away.
pub(crate) fn unexplained_event(worst: WorstLocked, actuator: &str) -> HealthNote {
    let ([from, to], rms) = (worst.when_s.map(digits), quantity(worst.rms, actuator));
    HealthNote {
        effect: EffectId::TransientEvent,
        blocking: false,
        sentence: format!(
            "between {from} and {to} s the model is wrong by {rms} (root mean square), which nothing in the other rows is like"
        ),
    }
}

/// An encoder so coarse that its grain alone left only a few hertz of the motion.
pub(crate) fn coarse_position(signals: &Signals, prepared: &Prepared) -> Option<HealthNote> {
    let cut_off = prepared.filter.cut_off_hz;
    let coarse = prepared.grain_limited && cut_off < LEAST_BAND_HZ;
    coarse.then(|| HealthNote {
        effect: EffectId::Quantisation,
        blocking: true,
        sentence: format!(
            "the position is recorded in steps of {:.2e}: its grain drowns everything above {cut_off} Hz",
            signals.position_resolution
        ),
    })
}

fn clipped_torque(signals: &Signals) -> Option<HealthNote> {
    let top = signals.torque.iter().fold(0.0f64, |m, t| m.max(t.abs()));
    let at_top = signals.torque.iter().filter(|t| t.abs() >= top * (1.0 - 1e-6)).count();
    let share = at_top as f64 / signals.torque.len().max(1) as f64;
    (top > 0.0 && share > CLIPPED_SHARE).then(|| HealthNote {
        effect: EffectId::Saturation,
        blocking: false,
        sentence: format!("the torque stands at its limit of {top:.4} in {:.1} % of the samples", 100.0 * share),
    })
}

/// Fits scale x reference, rigid body or inertia with Coulomb, viscous and offset: friction that drives the joint, a negative
/// inertia or a scale near a unit's factor betray a wrong sign or unit.
fn wrong_sign_or_unit(signals: &Signals) -> Option<HealthNote> {
    if signals.period <= 0.0 {
        return None;
    }
    let cut_off = (0.05 / signals.period).min(15.0);
    let filter = ZeroPhase::new(cut_off, signals.period);
    let segments = &signals.segments;
    let position = filter.over(&signals.position, segments);
    let velocity = first_derivative(&position, segments, signals.period);
    let acceleration = second_derivative(&position, segments, signals.period);
    let top = velocity.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if top <= 0.0 {
        return None;
    }
    let sign: Vec<f64> = velocity.iter().map(|v| (v / (0.02 * top)).tanh()).collect();
    let torque = filter.over(&signals.torque, segments);
    let runs: Vec<_> = segments
        .iter()
        .map(|s| (s.start + filter.reach()).min(s.end)..s.end.saturating_sub(filter.reach()).max(s.start))
        .filter(|r| r.start < r.end)
        .collect();
    // Inertial and static part apart where both are known: a wrong unit of position scales the inertial part alone.
    let smooth = |series: &[f64]| filter.over(series, segments);
    let mut bodies: Vec<(&str, Vec<f64>)> = match (
        signals.reference.as_ref().map(|reference| &reference.torque),
        signals.rigid_body.as_ref(),
        signals.load.as_ref(),
    ) {
        (Some(reference), _, _) => vec![("torque of the model", smooth(reference))],
        (None, Some(body), Some(load)) => {
            let inertial: Vec<f64> = body.iter().zip(load).map(|(b, l)| b - l).collect();
            vec![("inertial torque", smooth(&inertial)), ("load torque", smooth(load))]
        }
        (None, Some(body), None) => vec![("rigid-body torque", smooth(body))],
        (None, None, _) => vec![("acceleration", acceleration)],
    };
    bodies.retain(|(_, column)| column.iter().any(|v| *v != 0.0));
    let given = signals.known_torque().is_some();
    let mut columns: Vec<Vec<f64>> = bodies.iter().map(|(_, column)| column.clone()).collect();
    let friction = columns.len();
    columns.extend([sign, velocity, vec![1.0; position.len()]]);
    let coefficients = least_squares(&columns, &torque, &runs)?;
    let rest = residual(&columns, &torque, &coefficients);
    let energy = |series: &[f64]| runs.iter().flat_map(|r| &series[r.clone()]).map(|v| v * v).sum::<f64>();
    let total = energy(&torque).max(f64::MIN_POSITIVE);
    if 1.0 - energy(&rest) / total < 0.5 {
        return None;
    }
    let share = |column: usize| coefficients[column].abs() * (energy(&columns[column]) / total).sqrt();
    let wrong = |sentence: String| Some(HealthNote { effect: EffectId::UnitOrSign, blocking: true, sentence });
    // A reference holds friction of its own, and what it has too much of comes out negative.
    let drives = signals.reference.is_none() && coefficients[friction] < 0.0;
    if drives && share(friction) > 0.1 {
        return wrong("friction comes out as driving the joint: torque and motion have opposite signs".into());
    }
    for (column, (name, _)) in bodies.iter().enumerate().filter(|(column, _)| share(*column) > 0.1) {
        let factor = coefficients[column];
        // Hysteresis turns with the position, and so against the acceleration: alone it makes no body negative that is given.
        if given && AS_A_TURNED_SIGN_LEAVES.contains(&factor) {
            return wrong(format!(
                "the {name} enters with factor {factor:.3}: its sign is opposite to the recording's"
            ));
        }
        let story = UNIT_FACTORS.iter().find(|(wanted, _)| given && AS_A_UNIT_LEAVES.contains(&(factor / wanted)));
        if let Some((_, story)) = story {
            return wrong(format!("the {name} enters with factor {factor:.4}, as with {story}"));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slow swing of a joint whose friction builds up over 2 mrad after each reversal (Dahl 1968), with a body of 0.1 kg m2.
    fn swing(body: impl Fn(f64) -> Option<f64>) -> Signals {
        let period = 0.002;
        let time: Vec<f64> = (0..20_000).map(|i| period * f64::from(i)).collect();
        let phase = |t: f64| 0.6 * t;
        let position: Vec<f64> = time.iter().map(|t| 0.02 * phase(*t).sin() + 0.005 * phase(2.7 * t).sin()).collect();
        let mut bristle = 0.0f64;
        let steps = position.windows(2).map(|pair| pair[1] - pair[0]);
        let friction: Vec<f64> = std::iter::once(0.0)
            .chain(steps.map(|step| {
                bristle = (bristle + step).clamp(-2e-3, 2e-3);
                1000.0 * bristle
            }))
            .collect();
        let acceleration = super::second_derivative(&position, &[0..time.len()], period);
        let torque = friction.iter().zip(&acceleration).map(|(f, a)| f + 0.1 * a).collect();
        let rigid_body = acceleration.iter().map(|a| body(*a)).collect();
        let segments = vec![0..time.len()];
        Signals { period, time, position, torque, rigid_body, segments, rotary: true, ..Signals::default() }
    }

    #[test]
    fn hysteresis_is_no_body_of_the_wrong_sign() {
        for signals in [swing(|_| None), swing(|a| Some(0.1 * a))] {
            assert_eq!(wrong_sign_or_unit(&signals), None);
        }
    }

    #[test]
    fn a_body_of_the_wrong_sign_is_told() {
        let heavy = |sign: f64| {
            let mut signals = swing(|a| Some(1000.0 * sign * a));
            let body = signals.rigid_body.clone().unwrap();
            signals.torque.iter_mut().zip(body).for_each(|(torque, body)| *torque += sign * body);
            signals
        };
        assert_eq!(wrong_sign_or_unit(&heavy(1.0)), None);
        assert!(wrong_sign_or_unit(&heavy(-1.0)).is_some_and(|note| note.blocking));
    }
}
