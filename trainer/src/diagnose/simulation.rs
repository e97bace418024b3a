//! What a simulator computes: its inverse law, learned from its recording as a function of the state, so that neither clock
//! nor sampling nor length of the two recordings have to agree (Atkeson, An and Hollerbach 1986 for the linear form).

use super::base::{BaseKind, friction_basis};
use super::linear::{least_squares, residual};
use super::prepare::{Lock, Prepared};
use super::reference::{Reference, tabulated_velocities};
use super::signals::Signals;
use crate::physics::JointState;

/// Least rows of motion from which a law is learned.
const LEAST_ROWS: usize = 100;
/// Least travel in rad over which gravity can be told from an offset.
const GRAVITY_TRAVEL_RAD: f64 = 0.2;

/// Why no law can be learned from a simulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unlearnable {
    /// The simulated joint rests, or nearly always does.
    #[error("the simulation holds only {rows} rows of motion behind the filter; its law cannot be learned from rest")]
    Rest {
        /// Rows of motion.
        rows: usize,
    },
    /// The simulated motion does not determine the law.
    #[error("the simulated motion does not determine a law: one velocity, or no change of direction")]
    Undetermined,
}

/// The learned law: rigid body and friction over velocity, linear in its coefficients.
#[derive(Clone, Debug)]
pub struct InverseLaw {
    sign_velocity: f64,
    top_speed: f64,
    gravity: bool,
    given: bool,
    coefficients: Vec<f64>,
    /// Number of friction columns; the rigid body follows.
    friction_columns: usize,
    /// Root mean square of what the law leaves of the simulation, in the unit of the actuator.
    pub rmse: f64,
}

/// Learns the law of a simulation. `given` says that both recordings carry a rigid-body torque.
///
/// # Errors
/// [`Unlearnable`] for a simulation of rest or of one velocity.
pub fn learn(simulation: &Signals, given: bool) -> Result<InverseLaw, Unlearnable> {
    let prepared = Prepared::new(simulation, Lock::Nothing);
    let state = &prepared.state;
    let rows = prepared.rows.len();
    if rows < LEAST_ROWS {
        return Err(Unlearnable::Rest { rows });
    }
    let (low, high) = state.travel();
    let mut law = InverseLaw {
        sign_velocity: state.sign_velocity,
        top_speed: state.top_speed(),
        gravity: state.rotary && high - low > GRAVITY_TRAVEL_RAD,
        given: given && simulation.rigid_body.is_some(),
        coefficients: Vec::new(),
        friction_columns: law_friction(1.0, 1.0, 1.0).len(),
        rmse: 0.0,
    };
    let columns: Vec<Vec<f64>> = law.columns(state).iter().map(|column| prepared.filtered(column)).collect();
    let target = prepared.filtered(&prepared.torque);
    let runs = prepared.open_runs();
    law.coefficients = least_squares(&columns, &target, &runs).ok_or(Unlearnable::Undetermined)?;
    let rest = residual(&columns, &target, &law.coefficients);
    law.rmse = (rest.iter().map(|r| r * r).sum::<f64>() / rows as f64).sqrt();
    Ok(law)
}

/// Friction columns at one velocity: an odd spline, and Coulomb and viscous friction that differ between the directions.
fn law_friction(velocity: f64, sign_velocity: f64, top_speed: f64) -> Vec<f64> {
    let mut columns = friction_basis(BaseKind::Spline, velocity, (velocity / sign_velocity).tanh(), top_speed);
    columns.extend([(velocity / sign_velocity).tanh().abs(), velocity.abs()]);
    columns
}

impl InverseLaw {
    fn columns(&self, state: &JointState) -> Vec<Vec<f64>> {
        let basis: Vec<Vec<f64>> =
            state.velocity.iter().map(|v| law_friction(*v, self.sign_velocity, self.top_speed)).collect();
        let mut columns: Vec<Vec<f64>> =
            (0..self.friction_columns).map(|j| basis.iter().map(|row| row[j]).collect()).collect();
        columns.push(state.acceleration.clone());
        columns.push(vec![1.0; state.len()]);
        if self.gravity {
            columns.push(state.map(|i| state.position[i].sin()));
            columns.push(state.map(|i| state.position[i].cos()));
        }
        if self.given {
            columns.extend(state.rigid_body.clone());
        }
        columns
    }

    /// Friction at a velocity.
    #[must_use]
    pub fn friction(&self, velocity: f64) -> f64 {
        let columns = law_friction(velocity, self.sign_velocity, self.top_speed);
        columns.iter().zip(&self.coefficients).map(|(column, coefficient)| column * coefficient).sum()
    }

    /// Inertia, constant torque, gravity with sine and cosine, and factor of a given rigid-body torque.
    #[must_use]
    pub fn rigid_body(&self) -> [f64; 5] {
        let mut rest = self.coefficients[self.friction_columns..].iter().copied();
        let mut next = |present: bool| if present { rest.next().unwrap_or(0.0) } else { 0.0 };
        [next(true), next(true), next(self.gravity), next(self.gravity), next(self.given)]
    }

    /// The law at the states of the real recording. Coulomb and viscous friction may move.
    #[must_use]
    pub fn at(&self, state: &JointState) -> Reference {
        let columns = self.columns(state);
        let sum = |from: usize| {
            let mut torque = vec![0.0; state.len()];
            for (column, coefficient) in columns.iter().zip(&self.coefficients).skip(from) {
                torque.iter_mut().zip(column).for_each(|(t, c)| *t += coefficient * c);
            }
            torque
        };
        Reference {
            torque: sum(0),
            rigid_body: sum(self.friction_columns),
            jacobian: vec![state.sign.clone(), state.velocity.clone()],
            friction: tabulated_velocities(1.2 * self.top_speed).map(|v| (v, self.friction(v))).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moving(seconds: f64, rate: f64, phase: f64) -> Signals {
        let period = 1.0 / rate;
        let time: Vec<f64> = (0..(seconds * rate) as usize).map(|i| i as f64 * period).collect();
        let swing = |t: f64| [(1.0, 0.8), (0.6, 2.1), (0.3, 5.3)].map(|(a, w): (f64, f64)| (a, w, w * t + phase));
        let sum = |f: fn((f64, f64, f64)) -> f64| -> Vec<f64> {
            time.iter().map(|t| swing(*t).into_iter().map(f).sum()).collect()
        };
        let position = sum(|(a, _, x)| a * x.sin());
        let velocity = sum(|(a, w, x)| a * w * x.cos());
        let acceleration = sum(|(a, w, x)| -a * w * w * x.sin());
        let torque = (0..time.len())
            .map(|i| {
                0.4 * acceleration[i] + 3.0 * position[i].sin() + 2.0 * (velocity[i] / 0.002).tanh() + 0.5 * velocity[i]
            })
            .collect();
        Signals {
            period,
            segments: std::iter::once(0..time.len()).collect(),
            time,
            position,
            torque,
            rotary: true,
            ..Signals::default()
        }
    }

    #[test]
    fn a_law_learned_elsewhere_holds_at_other_states() {
        // Shorter, shifted in time and sampled differently.
        let law = learn(&moving(20.0, 400.0, 1.3), false).unwrap();
        let real = moving(31.0, 500.0, 0.0);
        let reference = law.at(&real.states());
        let error: f64 =
            reference.torque.iter().zip(&real.torque).skip(500).take(14000).map(|(a, b)| (a - b).powi(2)).sum();
        assert!((error / 14000.0).sqrt() < 0.15, "{}", (error / 14000.0).sqrt());
        let [inertia, _, sine, _, _] = law.rigid_body();
        assert!((inertia - 0.4).abs() < 0.02 && (sine - 3.0).abs() < 0.1, "{inertia} {sine}");
    }

    #[test]
    fn rest_teaches_nothing() {
        let mut still = moving(5.0, 400.0, 0.0);
        still.position.fill(0.3);
        assert!(learn(&still, false).is_err());
    }
}
