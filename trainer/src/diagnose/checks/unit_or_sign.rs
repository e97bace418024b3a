//! Whether torque, position, velocity and the bodies that are given have one unit and one sign.

use crate::diagnose::checks::note::{HealthNote, Observation, TorquePart};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::measurement::signals::Signals;
use crate::numerics::derivatives::{first_derivative, second_derivative};
use crate::numerics::filter::windowed_sinc::ZeroPhase;
use crate::numerics::least_squares::{least_squares, residual};
use crate::physics::EffectId;

/// Factors that a wrong unit leaves: degrees for radians, turns for radians, milli for whole, and their inverses, by
/// definition of the units.
const UNIT_FACTORS: [(f64, &str); 6] = [
    (57.295_78, "deg taken for rad"),
    (std::f64::consts::TAU, "turns taken for rad"),
    (1000.0, "milli-units taken for units"),
    (0.017_453_29, "rad taken for deg"),
    (0.159_154_9, "rad taken for turns"),
    (0.001, "units taken for milli-units"),
];

/// Fitted factor of a given torque that a reversed sign leaves. Chosen by judgement: minus one, within a factor of two
/// for a wrong mass; wider takes an unrelated torque for a reversed one.
const REVERSED_FACTOR_RANGE: std::ops::Range<f64> = -2.0..-0.5;
/// Fitted factor over that of a confused unit. Chosen by judgement: one within a tenth, as a wrong mass may come close
/// to a unit's factor by chance.
const UNIT_RATIO_RANGE: std::ops::Range<f64> = 0.9..1.11;

/// Correlation of a recorded velocity and the derivative of the position, above which both are one motion. Chosen by
/// judgement: below it another shaft was recorded, and the ratio of the two says nothing of units.
const LEAST_CORRELATION: f64 = 0.9;
/// Recorded velocity over the derivative of the position where both have one unit. Chosen by judgement: one within a
/// quarter, for a drive that filters its velocity; the nearest confused unit is a factor of six away.
const SAME_UNIT_RATIO_RANGE: std::ops::Range<f64> = 0.8..1.25;

/// What a unit or a sign is seen behind: little of the encoder's grain.
fn slow_filter(signals: &Signals) -> ZeroPhase {
    ZeroPhase::new((0.05 / signals.period).min(15.0), signals.period)
}

/// A recorded velocity that goes with the derivative of the position, but is not it.
pub(crate) fn contradicting_velocity(signals: &Signals) -> Option<HealthNote> {
    let velocity = signals.velocity.as_ref()?;
    let filter = slow_filter(signals);
    let segments = &signals.segments;
    let derivative = first_derivative(&filter.over(&signals.position, segments), segments, signals.period);
    let velocity = filter.over(velocity, segments);
    let rows = || {
        segments.iter().flat_map(|segment| segment.start + filter.reach()..segment.end.saturating_sub(filter.reach()))
    };
    let product = |a: &[f64], b: &[f64]| rows().map(|i| a[i] * b[i]).sum::<f64>();
    let (recorded, derived) = (product(&velocity, &velocity), product(&derivative, &derivative));
    let both = product(&velocity, &derivative);
    let factor = both / derived.max(f64::MIN_POSITIVE);
    if both.powi(2) < LEAST_CORRELATION.powi(2) * recorded * derived
        || SAME_UNIT_RATIO_RANGE.contains(&factor)
        || both == 0.0
    {
        return None;
    }
    Some(HealthNote {
        effect: EffectId::UnitOrSign,
        blocking: true,
        observation: Observation::ContradictingVelocity { ratio: factor },
    })
}

/// Fits scale x reference, rigid body or inertia with Coulomb, viscous and offset: friction that drives the joint, a given
/// body that enters with its sign turned or near a unit's factor betray a wrong sign or unit.
pub(crate) fn wrong_sign_or_unit(comparison: &Comparison) -> Option<HealthNote> {
    let Comparison { signals, reference, .. } = comparison;
    let filter = slow_filter(signals);
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
    let mut bodies: Vec<(TorquePart, Vec<f64>)> = match (
        reference.as_ref().map(|reference| &reference.torque),
        signals.rigid_body.as_ref(),
        signals.load.as_ref(),
    ) {
        (Some(reference), _, _) => vec![(TorquePart::Model, smooth(reference))],
        (None, Some(body), Some(load)) => {
            let inertial: Vec<f64> = body.iter().zip(load).map(|(b, l)| b - l).collect();
            vec![(TorquePart::Inertia, smooth(&inertial)), (TorquePart::Load, smooth(load))]
        }
        (None, Some(body), None) => vec![(TorquePart::RigidBody, smooth(body))],
        (None, None, _) => vec![(TorquePart::Acceleration, acceleration)],
    };
    bodies.retain(|(_, column)| column.iter().any(|v| *v != 0.0));
    let given = comparison.known().torque.is_some();
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
    let wrong =
        |observation: Observation| Some(HealthNote { effect: EffectId::UnitOrSign, blocking: true, observation });
    // A reference holds friction of its own, and what it has too much of comes out negative. Friction takes energy all in all: where the actuator
    // puts some in, something else that goes with the velocity is what drives.
    let speed = &columns[friction + 1];
    let work: f64 = runs.iter().flat_map(Clone::clone).map(|i| torque[i] * speed[i]).sum();
    let drives = reference.is_none() && coefficients[friction] < 0.0 && work < 0.0;
    if drives && share(friction) > 0.1 {
        return wrong(Observation::DrivingFriction);
    }
    for (column, &(part, _)) in bodies.iter().enumerate().filter(|(column, _)| share(*column) > 0.1) {
        let factor = coefficients[column];
        // Hysteresis turns with the position, and so against the acceleration: alone it makes no body negative that is given.
        if given && REVERSED_FACTOR_RANGE.contains(&factor) {
            return wrong(Observation::WrongFactor { part, factor, confusion: None });
        }
        let confusion = UNIT_FACTORS.iter().find(|(wanted, _)| given && UNIT_RATIO_RANGE.contains(&(factor / wanted)));
        if let Some(&(_, confusion)) = confusion {
            return wrong(Observation::WrongFactor { part, factor, confusion: Some(confusion) });
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
            assert_eq!(wrong_sign_or_unit(&signals.into()), None);
        }
    }

    #[test]
    fn a_velocity_in_another_unit_is_told_and_one_that_is_late_is_not() {
        let mut signals = swing(|_| None);
        let velocity = first_derivative(&signals.position, &signals.segments, signals.period);
        let mut answer = |factor: f64, late: usize| {
            let recorded = (0..velocity.len()).map(|i| factor * velocity[i.saturating_sub(late)]);
            signals.velocity = Some(recorded.collect());
            contradicting_velocity(&signals).map(|note| note.observation)
        };
        assert_eq!(answer(1.0, 20), None);
        for factor in [57.3, 0.01745, -1.0, 0.001, 100.0] {
            let Some(Observation::ContradictingVelocity { ratio }) = answer(factor, 3) else { panic!("{factor}") };
            assert!((ratio / factor - 1.0).abs() < 0.01, "{ratio} for {factor}");
        }
        assert_eq!(answer(0.0, 0), None);
    }

    #[test]
    fn a_sign_is_wrong_where_the_actuator_takes_energy_up_and_not_where_it_puts_some_in() {
        let joint = |coulomb: f64, viscous: f64| {
            let mut signals = swing(|_| None);
            let velocity = first_derivative(&signals.position, &signals.segments, signals.period);
            signals.torque = velocity.iter().map(|v| coulomb * (v / 0.01).tanh() + viscous * v).collect();
            wrong_sign_or_unit(&signals.into()).map(|note| note.observation)
        };
        assert_eq!(joint(0.3, 0.5), None);
        assert_eq!(joint(-0.3, -0.5), Some(Observation::DrivingFriction));
        // Drag that rises faster than the speed looks like viscous friction above a negative Coulomb level.
        assert_eq!(joint(-0.3, 50.0), None);
    }

    #[test]
    fn a_body_of_the_wrong_sign_is_told() {
        let heavy = |sign: f64| {
            let mut signals = swing(|a| Some(1000.0 * sign * a));
            let body = signals.rigid_body.clone().unwrap();
            signals.torque.iter_mut().zip(body).for_each(|(torque, body)| *torque += sign * body);
            signals
        };
        assert_eq!(wrong_sign_or_unit(&heavy(1.0).into()), None);
        assert!(wrong_sign_or_unit(&heavy(-1.0).into()).is_some_and(|note| note.blocking));
    }
}
