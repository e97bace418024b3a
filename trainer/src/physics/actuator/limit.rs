//! H7: supply or firmware let the actuator do less than its command asks for.

use super::{asked_of_gain, missing_torque, motion};
use crate::actuator::{Actuator, Command, Limits};
use crate::numerics::statistics::quantile;
use crate::physics::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(in crate::physics) struct SupplyOrDutyLimit;

/// Quantiles of what is limited at which limits are tried, refined between the first and the last: under a limit that half of the samples are
/// beyond a joint does not follow its reference, and few beyond it show nothing.
const QUANTILES: [f64; 7] = [0.5, 0.65, 0.77, 0.86, 0.92, 0.96, 0.985];

/// Variant in which torque or current are limited.
const TORQUE: f64 = 0.0;
/// Variant in which the duty is.
const DUTY: f64 = 1.0;
/// Variant in which the speed of the reference is.
const REFERENCE_SPEED: f64 = 2.0;
/// Variant in which the supply has less voltage than the one compared with: the level is the share that is left.
const VOLTAGE: f64 = 3.0;
/// Share of the voltage that is left where that is tried: its column is the same at every share.
const LESS_VOLTAGE: f64 = 0.8;

/// Levels of what a limit of a variant holds down; none where there is no such thing.
fn levels(state: &JointState, variant: f64) -> Vec<f64> {
    let Some(commanded) = &state.commanded else { return Vec::new() };
    let values = if variant == TORQUE {
        commanded.torque(|i| motion(state, i))
    } else if variant == DUTY {
        let duty = |actuator: &Actuator, command: &Command, i: usize| {
            actuator.duty(command, motion(state, i)).map_or(0.0, |duty| duty.clamp(-1.0, 1.0))
        };
        commanded.map(duty)
    } else {
        let is_followed = commanded.actuators.iter().all(|(_, actuator)| actuator.kind.follows_position());
        let reference = commanded.map(|_, command, _| if is_followed { command.reference } else { 0.0 });
        state.rate_of(&reference)
    };
    // Of an actuator that is off nothing is held down.
    let asked: Vec<f64> =
        values.iter().zip(&commanded.commands).filter(|(_, c)| c.enabled).map(|(value, _)| value.abs()).collect();
    let at = |share| quantile(asked.iter().copied(), share);
    QUANTILES.into_iter().map(at).filter(|level| *level > 0.0).collect()
}

impl Hypothesis for SupplyOrDutyLimit {
    fn id(&self) -> EffectId {
        EffectId::SupplyOrDutyLimit
    }

    fn equation(&self) -> &'static str {
        "dF = c (tau(command) - tau(limited command))"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(commanded) = &state.commanded else { return Vec::new() };
        let of = |variant: f64| levels(state, variant).into_iter().map(move |level| vec![level, variant]);
        let mut shapes: Vec<Shape> = [TORQUE, DUTY, REFERENCE_SPEED].into_iter().flat_map(of).collect();
        if commanded.actuators.iter().any(|(_, actuator)| actuator.kind.is_motor()) {
            shapes.push(vec![LESS_VOLTAGE, VOLTAGE]);
        }
        shapes
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let (level, variant) = (shape[0], shape[1]);
        let limited = |limits: fn(Limits, f64) -> Limits| {
            missing_torque(state, |c| {
                c.with(|actuator| Actuator { limits: limits(actuator.limits, level), ..*actuator })
            })
        };
        vec![if variant == TORQUE {
            limited(|limits, level| Limits { torque: limits.torque.min(level), ..limits })
        } else if variant == DUTY {
            limited(|limits, level| Limits { duty: limits.duty.min(level), ..limits })
        } else if variant == VOLTAGE {
            let known = state.known.as_ref().unwrap_or(&state.predicted);
            asked_of_gain(state, known).into_iter().map(|torque| (1.0 - level) * torque).collect()
        } else {
            missing_torque(state, |commanded| commanded.rate_limited(&state.segments, state.period, level))
        }]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("withheld_share", "c", Dimension::One)]
    }

    fn shape_names(&self, shape: &[f64]) -> Vec<ShapeName> {
        let level = match shape.get(1).copied().unwrap_or(TORQUE) {
            DUTY => ShapeName::new("duty_limit", "u_max", Dimension::One),
            REFERENCE_SPEED => ShapeName::new("velocity_limit", "v_max", Dimension::Velocity),
            VOLTAGE => ShapeName::new("supply_share", "u", Dimension::One),
            _ => ShapeName::new("torque_limit", "tau_max", Dimension::Torque),
        };
        vec![level, ShapeName::new("variant", "variant", Dimension::One)]
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn known_coefficient(&self, shape: &[f64]) -> Option<f64> {
        // The column of a lower voltage is the same at every share: there the coefficient is what is lacking.
        (shape[1] != VOLTAGE).then_some(1.0)
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        if index != 0 || shape[1] == VOLTAGE {
            return None;
        }
        let levels = levels(state, shape[1]);
        Some((*levels.first()?, *levels.last()?))
    }
}
