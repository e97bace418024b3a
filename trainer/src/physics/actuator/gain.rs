//! H6: the actuator's gain is not the one compared with, which is larger by a share epsilon of what it is.

use super::by_need;
use crate::actuator::{Actuator, Kind};
use crate::physics::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(in crate::physics) struct ActuatorGain;

/// Variant in which the torque by the position error, the current or the voltage is off.
const GAIN: f64 = 0.0;
/// Variant in which the torque by the velocity error of a controller is.
const DAMPING: f64 = 1.0;
/// Variant in which the torque constant of the motor is: all that a controller asks for, or the torque by the voltage and, twice as much, what
/// the induced voltage takes of it.
const TORQUE: f64 = 2.0;

/// Torque of a part of an actuator, N m a sample, by what the joint needs of it; none where it does not follow its command. That by a velocity error is
/// taken as recorded: what is left for it holds what the position error made, the noise of the torque with it.
fn part(state: &JointState, variant: f64) -> Vec<f64> {
    let Some(known) = &state.known else { return vec![0.0; state.len()] };
    by_need(state, known, |actuator, applied, [needed, beside_gain]| match (actuator.kind, variant) {
        (Kind::Pd, DAMPING) => applied.by_kd * actuator.kd,
        (Kind::Pd, TORQUE) => needed,
        (_, TORQUE) => needed + beside_gain,
        _ => needed - beside_gain,
    })
}

impl Hypothesis for ActuatorGain {
    fn id(&self) -> EffectId {
        EffectId::ActuatorGain
    }

    fn equation(&self) -> &'static str {
        "dF = epsilon tau_gain"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(commanded) = state.commanded.as_ref().filter(|_| state.known.is_some()) else { return Vec::new() };
        let any = |is: fn(&Actuator) -> bool| commanded.actuators.iter().any(|(_, actuator)| is(actuator));
        let mut shapes = Vec::new();
        if any(|actuator| actuator.kind != Kind::Torque) {
            shapes.push(vec![GAIN]);
        }
        if any(|actuator| actuator.kind == Kind::Pd && actuator.kd > 0.0) {
            shapes.extend([vec![DAMPING], vec![TORQUE]]);
        } else if any(|actuator| actuator.kind.is_motor()) {
            shapes.push(vec![TORQUE]);
        }
        shapes
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        vec![part(state, shape[0])]
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let name = match shape[0] {
            DAMPING => "damping_gain_error",
            TORQUE => "torque_constant_error",
            _ => "actuator_gain_error",
        };
        vec![(name, "epsilon", Dimension::One)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}
