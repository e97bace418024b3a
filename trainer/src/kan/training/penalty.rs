//! Quadratic penalties on second differences of neighbouring coefficients, and how strong the data say they should be.

use std::ops::Range;

use super::jacobian::NormalEquations;
use super::model::{Model, Unknowns};
use crate::kan::network::dense::{Cholesky, dot};

/// `strength * |D c|^2` over the coefficients of several edges (P-splines; Eilers and Marx, 1996).
#[derive(Clone, Debug)]
pub(in crate::kan) struct Penalty {
    /// Rows of `D`: pairs of unknown and weight, unknowns ascending.
    rows: Vec<Vec<(usize, f64)>>,
    pub(in crate::kan) strength: f64,
}

/// Which part of the second differences of an activation, about the middle of its grid, a penalty acts on. The two
/// together are all second differences; kept apart, the data decide by themselves how nearly odd or even a law is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Odd,
    Even,
}

impl Penalty {
    /// Two smoothness penalties, odd and even, per input for the first layer (inputs differ in how much they bend) and
    /// per later layer.
    pub(in crate::kan) fn smoothness(model: &Model, unknowns: &Unknowns, strength: f64) -> Vec<Self> {
        let mut penalties = Vec::new();
        for (index, layer) in model.network.layers().iter().enumerate() {
            let groups = if index == 0 { layer.inputs } else { 1 };
            for group in 0..groups {
                for part in [Part::Odd, Part::Even] {
                    let members = layer.edges.iter().enumerate().filter(|(position, _)| position % groups == group);
                    let rows: Vec<_> = members
                        .filter_map(|(position, edge)| Some((unknowns.start(index, position)?, edge.basis.len())))
                        .flat_map(|(start, count)| part_of_second_differences(part, start, count))
                        .collect();
                    if !rows.is_empty() {
                        penalties.push(Self { rows, strength });
                    }
                }
            }
        }
        penalties
    }

    /// `|D c|^2`.
    fn roughness(&self, values: &[f64]) -> f64 {
        self.rows.iter().map(|row| applied(row, values).powi(2)).sum()
    }

    pub(in crate::kan) fn value(&self, values: &[f64]) -> f64 {
        self.strength * self.roughness(values)
    }

    /// Adds `factor` times half the gradient of the penalty.
    pub(in crate::kan) fn add_gradient(&self, values: &[f64], factor: f64, gradient: &mut [f64]) {
        for row in &self.rows {
            let applied = factor * self.strength * applied(row, values);
            row.iter().for_each(|&(i, weight)| gradient[i] += weight * applied);
        }
    }

    /// Adds half the second derivative of the penalty to the upper triangle of a matrix.
    pub(in crate::kan) fn add_curvature(&self, size: usize, matrix: &mut [f64]) {
        for row in &self.rows {
            for (k, &(i, a)) in row.iter().enumerate() {
                for &(j, b) in &row[k..] {
                    matrix[i * size + j] += self.strength * a * b;
                }
            }
        }
    }

    /// `trace((H + S)^-1 D'D)` from the transposed inverse factor.
    fn trace(&self, inverse: &[f64], size: usize) -> f64 {
        let mut combined = vec![0.0; size];
        let squares = self.rows.iter().map(|row| {
            let first = row[0].0;
            combined[first..].fill(0.0);
            for &(i, weight) in row {
                let column = &inverse[i * size + i..(i + 1) * size];
                combined[i..].iter_mut().zip(column).for_each(|(sum, v)| *sum += weight * v);
            }
            dot(&combined[first..], &combined[first..])
        });
        squares.sum()
    }
}

fn applied(row: &[(usize, f64)], values: &[f64]) -> f64 {
    row.iter().map(|&(i, weight)| weight * values[i]).sum()
}

/// Rows of the odd or even part of the second differences of `count` coefficients from `start` on.
fn part_of_second_differences(part: Part, start: usize, count: usize) -> Vec<Vec<(usize, f64)>> {
    let differences = count.saturating_sub(2);
    let pairs = (0..differences.div_ceil(2)).map(|i| (i, differences - 1 - i));
    pairs
        .filter(|(i, mirrored)| i != mirrored || part == Part::Even)
        .map(|(i, mirrored)| {
            // Under reflection the differences change places: their sums are even, what is left is odd.
            let (weight, mirrored_weight) = match (i == mirrored, part) {
                (true, _) => (1.0, 0.0),
                (false, Part::Even) => (std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2),
                (false, Part::Odd) => (std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2),
            };
            let mut row: Vec<(usize, f64)> = Vec::with_capacity(6);
            for (first, factor) in [(i, weight), (mirrored, mirrored_weight)] {
                for (k, stencil) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                    match row.iter_mut().find(|(index, _)| *index == start + first + k) {
                        Some((_, sum)) => *sum += factor * stencil,
                        None => row.push((start + first + k, factor * stencil)),
                    }
                }
            }
            row.sort_by_key(|(index, _)| *index);
            row
        })
        .collect()
}

/// Factor by which smoothing may change per step.
const SMOOTHING_LIMIT: f64 = 100.0;

/// Re-estimates all strengths from the data by restricted maximum likelihood (generalised Fellner-Schall update;
/// Wood and Fasiolo, 2017). Each strength may change by at most [`SMOOTHING_LIMIT`]-fold. Returns the effective degrees of freedom,
/// the trace of the influence matrix.
pub(in crate::kan) fn reestimate(
    penalties: &mut [Penalty],
    normal: &NormalEquations,
    factor: &Cholesky,
    ridge: f64,
    values: &[f64],
    samples: usize,
) -> f64 {
    let size = normal.size;
    let inverse = factor.inverse_factor_transposed();
    let traces: Vec<f64> = penalties.iter().map(|penalty| penalty.trace(&inverse, size)).collect();
    let penalised: f64 = penalties.iter().zip(&traces).map(|(penalty, trace)| penalty.strength * trace).sum();
    let degrees_of_freedom = (size as f64 - penalised - ridge * dot(&inverse, &inverse)).clamp(0.0, size as f64);
    // More unknowns than samples leave no residual to measure noise by: keep at least a tenth of the samples.
    let spare = (samples as f64 - degrees_of_freedom).max(0.1 * samples as f64);
    let noise_variance = normal.residual_sum / spare;
    for (penalty, trace) in penalties.iter_mut().zip(traces) {
        let rank = penalty.rows.len() as f64;
        let wanted =
            noise_variance * (rank - penalty.strength * trace).max(1e-6) / penalty.roughness(values).max(1e-30);
        let strength = wanted.clamp(penalty.strength / SMOOTHING_LIMIT, penalty.strength * SMOOTHING_LIMIT);
        penalty.strength = strength.clamp(STRENGTH_RANGE.start, STRENGTH_RANGE.end);
    }
    degrees_of_freedom
}

/// Strengths outside this range are indistinguishable from none and from a straight line.
const STRENGTH_RANGE: Range<f64> = 1e-12..1e12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_and_even_parts_together_are_all_second_differences() {
        for count in 3..14 {
            let values: Vec<f64> = (0..count + 1).map(|i| (1.7 * i as f64).sin()).collect();
            let part = |part| -> f64 {
                part_of_second_differences(part, 1, count).iter().map(|row| applied(row, &values).powi(2)).sum()
            };
            let all: f64 = values[1..].windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2)).sum();
            assert!((part(Part::Odd) + part(Part::Even) - all).abs() < 1e-12, "{count}");
        }
    }

    #[test]
    fn an_odd_curve_has_no_even_part() {
        let odd: Vec<f64> = (0..13).map(|i| (f64::from(i) - 6.0).powi(3) + 5.0).collect();
        let even: Vec<f64> = (0..13).map(|i| (f64::from(i) - 6.0).powi(2)).collect();
        let roughness = |part, values: &[f64]| -> f64 {
            part_of_second_differences(part, 0, 13).iter().map(|row| applied(row, values).powi(2)).sum()
        };
        assert!(roughness(Part::Even, &odd) < 1e-18 && roughness(Part::Odd, &odd) > 1.0);
        assert!(roughness(Part::Odd, &even) < 1e-18 && roughness(Part::Even, &even) > 1.0);
    }
}
