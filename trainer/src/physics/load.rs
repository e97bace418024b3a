//! B3 and B3b: friction grows with the transmitted load (Dohring, Lee and Newman 1993; Hamon, Gautier and Garrec 2010),
//! differently when driving and backdriving.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};
use crate::numerics::statistics::quantile;

pub(super) struct LoadFriction;

/// Shares (0..1) of the inertia behind the gear that are tried beside all of it.
const ROTOR_SHARES: [f64; 2] = [0.0, 0.5];

/// Shares of an actuator's torque that its gear turns into friction where that is tried, refined afterwards: from a belt to a worm.
const LOSSES: [f64; 3] = [0.1, 0.2, 0.4];

/// Whether the load varies enough to be told from a constant.
fn varied_load(state: &JointState) -> Option<&[f64]> {
    let load = state.load.as_deref()?;
    let spread = |share| quantile(load.iter().map(|l| l.abs()), share);
    (spread(0.95) - spread(0.05) > 1e-6 * (1.0 + spread(0.95))).then_some(load)
}

/// What the load has beside gravity: the torque of the inertia. `None` where the load was recorded, or no rigid body is given.
fn of_inertia(state: &JointState) -> Option<Vec<f64>> {
    let (load, gravity) = (state.load.as_deref()?, state.gravity.as_deref()?);
    let inertial = state.map(|i| load[i] - gravity[i]);
    inertial.iter().any(|torque| *torque != 0.0).then_some(inertial)
}

/// The load where only a share (0..1) of the inertia is behind the gear: the rest is the rotor's, whose torque no tooth carries.
fn carried(state: &JointState, share: f64) -> Option<Vec<f64>> {
    let load = state.load.clone()?;
    match of_inertia(state).filter(|_| share < 1.0) {
        Some(inertial) => Some(state.map(|i| load[i] - (1.0 - share) * inertial[i])),
        None => Some(load),
    }
}

/// What an actuator that reports no torque has to put out by the law compared with: the rigid body, its friction and what a payload takes.
fn of_actuator(state: &JointState) -> Option<Vec<f64>> {
    let (commanded, known) = (state.commanded.as_ref()?, state.known.as_ref()?);
    Some(commanded.needed(known))
}

impl Hypothesis for LoadFriction {
    fn id(&self) -> EffectId {
        EffectId::LoadFriction
    }

    fn equation(&self) -> &'static str {
        "dF = mu |tau_l|^m (1 + kappa exp(-(v/v_s)^2)) tanh(v/v_eps), tau_l = gravity + s J a where it is the given body's"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if varied_load(state).is_none() {
            return Vec::new();
        }
        let top = state.top_speed();
        let mut velocities = vec![0.0];
        velocities.extend(geometric_grid(0.015 * top, 0.12 * top, 3));
        let mut shapes = vec![vec![2.0, 0.0, 1.0]];
        let mut add = |share: f64| shapes.extend(velocities.iter().map(|velocity| vec![1.0, *velocity, share]));
        add(1.0);
        if of_inertia(state).is_some() {
            ROTOR_SHARES.into_iter().for_each(add);
        }
        if state.commanded.is_some() {
            shapes.extend(LOSSES.map(|loss| vec![1.0, 0.0, 1.0, loss]));
        }
        shapes
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(load) = carried(state, shape[2]) else { return Vec::new() };
        let scale = quantile(load.iter().map(|l| l.abs()), 0.9).max(f64::MIN_POSITIVE);
        let grow = |l: f64| if shape[0] == 1.0 { l.abs() } else { scale * (l.abs() / scale).powf(shape[0]) };
        // Friction of the torque that the actuator puts in is part of that torque: driving adds to the load, backdriving takes from it.
        let put_in = match shape.get(3) {
            Some(loss) => {
                let by_law = of_actuator(state).unwrap_or(load);
                state.map(|i| by_law[i] / (1.0 - loss * (by_law[i] * state.velocity[i]).signum()))
            }
            None => load,
        };
        let mut columns = vec![state.map(|i| grow(put_in[i]) * state.sign[i])];
        if shape[1] > 0.0 {
            columns.push(state.map(|i| columns[0][i] * (-(state.velocity[i] / shape[1]).powi(2)).exp()));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let mut names = vec![("load_friction_coefficient", "mu", Dimension::One)];
        if shape[1] > 0.0 {
            names.push(("load_stribeck_coefficient", "mu kappa", Dimension::One));
        }
        names
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("load_exponent", "m", Dimension::One),
            ShapeName::new("load_stribeck_velocity", "v_s", Dimension::Velocity),
            ShapeName::new("inertia_behind_gear", "s", Dimension::One),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        match index {
            1 if shape[1] > 0.0 => Some((0.005 * state.top_speed(), 0.3 * state.top_speed())),
            2 if shape[2] < 1.0 => Some((0.0, 1.0)),
            3 => Some((0.5 * LOSSES[0], 1.5 * LOSSES[LOSSES.len() - 1])),
            _ => None,
        }
    }

    fn step(&self, _state: &JointState, index: usize, shape: &[f64]) -> f64 {
        if index == 2 { 0.25 } else { 0.25 * shape[index].abs() }
    }
}

pub(super) struct DriveBackdrive;

impl Hypothesis for DriveBackdrive {
    fn id(&self) -> EffectId {
        EffectId::DriveBackdrive
    }

    fn equation(&self) -> &'static str {
        "dF = (mu_d [tau_l v > 0] + mu_b [tau_l v < 0]) |tau_l| tanh(v/v_eps)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if varied_load(state).is_some() { vec![vec![0.0], vec![1.0], vec![2.0]] } else { Vec::new() }
    }

    /// Losses of opposite signs would be a torque scale.
    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(load) = &state.load else { return Vec::new() };
        let loss = |i: usize, driving: bool| {
            if (load[i] * state.velocity[i] > 0.0) == driving { load[i].abs() * state.sign[i] } else { 0.0 }
        };
        let mut columns = Vec::new();
        if shape[0] != 1.0 {
            columns.push(state.map(|i| loss(i, true)));
        }
        if shape[0] != 0.0 {
            columns.push(state.map(|i| loss(i, false)));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let driving = ("driving_loss", "mu_d", Dimension::One);
        let backdriving = ("backdriving_loss", "mu_b", Dimension::One);
        match shape[0] {
            0.0 => vec![driving],
            1.0 => vec![backdriving],
            _ => vec![driving, backdriving],
        }
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;

    #[test]
    fn what_a_rotor_takes_to_accelerate_loads_no_gear() {
        let period = 0.01;
        let time: Vec<f64> = (0..3000).map(|i| period * f64::from(i)).collect();
        let position: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let mut state = Signals::without_gap(period, time, position.clone(), position).states();
        state.gravity = Some(state.map(|i| 6.0 * state.position[i].sin()));
        let body = |inertia: f64| state.map(|i| 6.0 * state.position[i].sin() + inertia * state.acceleration[i]);
        let (all, link) = (body(2.0), body(0.6));
        state.load = Some(all);
        let shares = |state: &JointState| {
            let mut shares: Vec<f64> = LoadFriction.shapes(state).iter().map(|shape| shape[2]).collect();
            shares.dedup();
            shares
        };
        assert_eq!(shares(&state), [1.0, 0.0, 0.5]);
        let column = &LoadFriction.columns(&state, &[1.0, 0.0, 0.3])[0];
        assert!((0..state.len()).all(|i| (column[i] - link[i].abs() * state.sign[i]).abs() < 1e-12));
        // A load that was recorded is what the gear transmits.
        state.gravity = state.load.clone();
        assert_eq!(shares(&state), [1.0]);
    }
}
