//! Friction that is free to bend: straight pieces over speed, linear in its coefficients. Only to take the rigid body
//! off fairly; the law itself is found later.

use crate::error::{Error, Result, codes};
use crate::numerics::averages::Averages;

/// Velocity knots on each side of zero, at squared spacing: denser at zero.
const KNOTS: usize = 12;
/// Fewest samples between two knots.
const SAMPLES_PER_KNOT: usize = 8;

/// Friction as straight pieces between knots of speed, a set of its own for each direction.
pub(crate) struct BendingLaw {
    forward: Vec<f64>,
    backward: Vec<f64>,
}

impl BendingLaw {
    pub(crate) fn over(velocity: &[f64]) -> Result<Self> {
        let forward = knots(velocity.iter().copied().filter(|v| *v > 0.0).collect());
        let backward = knots(velocity.iter().map(|v| -v).filter(|v| *v > 0.0).collect());
        if forward.len() + backward.len() < 4 {
            let message = "the velocity hardly changes, so friction cannot be separated from an offset";
            let shown = velocity.first().copied().unwrap_or(0.0);
            return Err(Error::new(&codes::NO_MOTION, message).in_column("velocity").with_value(shown.to_string()));
        }
        Ok(Self { forward, backward })
    }

    /// One column for every knot forward, then for every knot backward; each is the torque at its knot.
    pub(crate) fn columns(&self, velocity: &[f64]) -> Vec<Vec<f64>> {
        self.columns_as(velocity, |column| column)
    }

    /// The same averaged over states of such velocities.
    pub(crate) fn averaged_columns(&self, velocity: &[f64], averages: &Averages) -> Vec<Vec<f64>> {
        self.columns_as(velocity, |column| averages.over(&column))
    }

    fn columns_as(&self, velocity: &[f64], made: impl Fn(Vec<f64>) -> Vec<f64>) -> Vec<Vec<f64>> {
        let side = |knots: &[f64], sign: f64| -> Vec<Vec<f64>> {
            let value = |knot: usize, v: f64| if sign * v > 0.0 { hat(knots, knot, v.abs()) } else { 0.0 };
            let column = |knot: usize| velocity.iter().map(|&v| value(knot, v)).collect();
            (0..knots.len()).map(|knot| made(column(knot))).collect()
        };
        let mut columns = side(&self.forward, 1.0);
        columns.extend(side(&self.backward, -1.0));
        columns
    }

    /// Weights of the knots in the mean of both directions, averaged over the speeds that were driven.
    pub(crate) fn even_part(&self, velocity: &[f64]) -> Vec<f64> {
        let share = 0.5 / velocity.len() as f64;
        let mean = |knots: &[f64], knot| velocity.iter().map(|v| hat(knots, knot, v.abs())).sum::<f64>() * share;
        let forward = (0..self.forward.len()).map(|knot| mean(&self.forward, knot));
        let backward = (0..self.backward.len()).map(|knot| mean(&self.backward, knot));
        forward.chain(backward).collect()
    }
}

/// Speeds of the knots: zero, then squared spacing up to the top speed, wherever enough samples lie between.
fn knots(mut speeds: Vec<f64>) -> Vec<f64> {
    speeds.sort_by(f64::total_cmp);
    let Some(&top) = speeds.last() else { return Vec::new() };
    let mut knots = vec![0.0];
    let mut used = 0;
    for k in 1..=KNOTS {
        let speed = top * (k as f64 / KNOTS as f64).powi(2);
        let below = speeds.partition_point(|v| *v <= speed);
        let left = speeds.len() - below;
        if below - used >= SAMPLES_PER_KNOT && (left >= SAMPLES_PER_KNOT || k == KNOTS) {
            knots.push(speed);
            used = below;
        }
    }
    knots
}

/// Hat function number `index` over increasing `knots`; constant beyond the last.
fn hat(knots: &[f64], index: usize, speed: f64) -> f64 {
    let here = knots[index];
    if speed < here {
        match index.checked_sub(1).map(|left| knots[left]) {
            Some(left) if speed > left => (speed - left) / (here - left),
            _ => 0.0,
        }
    } else {
        match knots.get(index + 1) {
            Some(right) if speed < *right => (right - speed) / (right - here),
            Some(_) => 0.0,
            None => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_with_straight_branches_comes_back_with_its_offset() {
        let velocity: Vec<f64> = (1..401).map(|i| (f64::from(i) * 0.0731).sin()).collect();
        let law = BendingLaw::over(&velocity).unwrap();
        let torque: Vec<f64> = velocity.iter().map(|v| 2.0 * v.signum() + 0.7 * v - 0.3).collect();
        let fit = crate::numerics::regression::least_squares(&law.columns(&velocity), &torque, &[0..200, 200..400]);
        assert!(fit.rmse < 1e-9, "{}", fit.rmse);
        let weights = law.even_part(&velocity);
        let offset: f64 = weights.iter().zip(&fit.coefficients).map(|(w, c)| w * c).sum();
        assert!((offset + 0.3).abs() < 1e-6, "{offset}");
    }

    #[test]
    fn one_speed_is_refused() {
        assert_eq!(BendingLaw::over(&[0.5; 100]).err().map(|e| e.code().id), Some("FRK-D016"));
    }

    #[test]
    fn hats_add_up_to_one() {
        let knots = [0.0, 0.1, 0.5, 2.0];
        for speed in [0.0, 0.05, 0.1, 0.3, 1.9, 2.0, 7.0] {
            let sum: f64 = (0..knots.len()).map(|k| hat(&knots, k, speed)).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{speed}");
        }
    }
}
