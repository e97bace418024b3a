//! Limited-memory BFGS (Liu and Nocedal, 1989) with a line search that always ends.

use crate::kan::network::dense::dot;
use std::collections::VecDeque;

/// Pairs of step and gradient change that are remembered.
const HISTORY: usize = 10;

/// Most evaluations of one line search.
const LINE_EVALUATIONS: usize = 20;

/// Armijo and curvature constants of the strong Wolfe conditions (Nocedal and Wright, 2006, 3.1).
const SUFFICIENT_FALL: f64 = 1e-4;
const CURVATURE: f64 = 0.9;

/// Value and gradient at a point.
pub(super) type Objective<'a> = dyn FnMut(&[f64]) -> (f64, Vec<f64>) + 'a;

/// What one iteration hands to its observer, which returns true to stop.
pub(super) struct Iterate<'a> {
    pub(super) values: &'a [f64],
    pub(super) loss: f64,
    pub(super) gradient: &'a [f64],
}

/// Why the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Flat,
    NoDescent,
    Stopped,
    Limit,
}

/// Minimises `objective`, which returns value and gradient; leaves the best point in `values`.
pub(super) fn minimise(
    values: &mut Vec<f64>,
    steps: usize,
    tolerance: f64,
    objective: &mut Objective,
    observe: &mut dyn FnMut(&Iterate) -> bool,
) -> End {
    let (mut loss, mut gradient) = objective(values);
    let mut pairs: VecDeque<(Vec<f64>, Vec<f64>, f64)> = VecDeque::with_capacity(HISTORY);
    let mut idle = 0;
    for step in 0.. {
        if observe(&Iterate { values, loss, gradient: &gradient }) {
            return End::Stopped;
        }
        if gradient.iter().all(|g| g.abs() <= f64::EPSILON) || idle >= 5 {
            return End::Flat;
        }
        if step >= steps {
            break;
        }
        let mut direction = quasi_newton(&pairs, &gradient);
        if dot(&direction, &gradient) >= 0.0 {
            pairs.clear();
            direction = gradient.iter().map(|g| -g).collect();
        }
        let first = if pairs.is_empty() { 1.0 / norm(&gradient).max(1.0) } else { 1.0 };
        let Some((moved, new_loss, new_gradient)) = search(values, loss, &gradient, &direction, first, objective)
        else {
            if pairs.is_empty() {
                return End::NoDescent;
            }
            // The remembered curvature misleads: once more along the gradient.
            pairs.clear();
            continue;
        };
        let change: Vec<f64> = moved.iter().zip(values.iter()).map(|(a, b)| a - b).collect();
        let bend: Vec<f64> = new_gradient.iter().zip(&gradient).map(|(a, b)| a - b).collect();
        let curvature = dot(&change, &bend);
        if curvature > 1e-10 * norm(&change) * norm(&bend) {
            if pairs.len() == HISTORY {
                pairs.pop_front();
            }
            pairs.push_back((change, bend, 1.0 / curvature));
        }
        idle = if loss - new_loss < tolerance * loss.abs() { idle + 1 } else { 0 };
        *values = moved;
        (loss, gradient) = (new_loss, new_gradient);
    }
    End::Limit
}

/// Two-loop recursion: minus the approximate inverse Hessian times the gradient.
fn quasi_newton(pairs: &VecDeque<(Vec<f64>, Vec<f64>, f64)>, gradient: &[f64]) -> Vec<f64> {
    let mut direction: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut weights = Vec::with_capacity(pairs.len());
    for (change, bend, inverse) in pairs.iter().rev() {
        let weight = inverse * dot(change, &direction);
        add(&mut direction, -weight, bend);
        weights.push(weight);
    }
    if let Some((_, bend, inverse)) = pairs.back() {
        let scale = 1.0 / (inverse * dot(bend, bend));
        direction.iter_mut().for_each(|d| *d *= scale);
    }
    for ((change, bend, inverse), weight) in pairs.iter().zip(weights.iter().rev()) {
        let correction = weight - inverse * dot(bend, &direction);
        add(&mut direction, correction, change);
    }
    direction
}

/// Bisection for the strong Wolfe conditions; after its budget the best point with sufficient fall is taken.
fn search(
    values: &[f64],
    loss: f64,
    gradient: &[f64],
    direction: &[f64],
    first: f64,
    objective: &mut Objective,
) -> Option<(Vec<f64>, f64, Vec<f64>)> {
    let slope = dot(gradient, direction);
    let (mut low, mut high, mut length) = (0.0, f64::INFINITY, first);
    let mut best: Option<(Vec<f64>, f64, Vec<f64>)> = None;
    for _ in 0..LINE_EVALUATIONS {
        let moved: Vec<f64> = values.iter().zip(direction).map(|(v, d)| v + length * d).collect();
        let (new_loss, new_gradient) = objective(&moved);
        let new_slope = dot(&new_gradient, direction);
        let falls = new_loss <= loss + SUFFICIENT_FALL * length * slope;
        if !falls || !new_loss.is_finite() {
            high = length;
        } else {
            let done = new_slope.abs() <= CURVATURE * slope.abs();
            if best.as_ref().is_none_or(|(_, least, _)| new_loss < *least) {
                best = Some((moved, new_loss, new_gradient));
            }
            if done {
                break;
            }
            if new_slope < 0.0 { low = length } else { high = length }
        }
        length = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * length };
    }
    best
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn add(target: &mut [f64], factor: f64, values: &[f64]) {
    target.iter_mut().zip(values).for_each(|(t, v)| *t += factor * v);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_minimum_of_rosenbrocks_valley() {
        let mut evaluations = 0;
        let mut valley = |x: &[f64]| {
            evaluations += 1;
            let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
            (a * a + 100.0 * b * b, vec![-2.0 * a - 400.0 * x[0] * b, 200.0 * b])
        };
        let mut values = vec![-1.2, 1.0];
        minimise(&mut values, 200, 1e-15, &mut valley, &mut |_| false);
        assert!((values[0] - 1.0).abs() < 1e-6 && (values[1] - 1.0).abs() < 1e-6, "{values:?}");
        assert!(evaluations < 150, "{evaluations}");
    }

    #[test]
    fn ends_where_there_is_no_minimum() {
        let mut evaluations = 0;
        let mut cliff = |x: &[f64]| {
            evaluations += 1;
            (if x[0] > 0.5 { f64::NAN } else { -x[0] }, vec![-1.0])
        };
        let mut values = vec![0.0];
        minimise(&mut values, 100, 0.0, &mut cliff, &mut |_| false);
        assert!(values[0] <= 0.5 && evaluations <= 100 * LINE_EVALUATIONS + 1);
    }
}
