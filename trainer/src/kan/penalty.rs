//! Quadratic penalties on differences of neighbouring coefficients, and how strong the data say they should be.

use std::ops::Range;

use super::dense::{Cholesky, dot};
use super::jacobian::NormalEquations;
use super::model::{Model, Unknowns};

/// `strength * |D c|^2` over the coefficients of several edges, `D` the differences of some order
/// (P-splines; Eilers and Marx, 1996).
#[derive(Clone, Debug)]
pub(super) struct Penalty {
    blocks: Vec<Range<usize>>,
    difference: usize,
    pub(super) strength: f64,
}

/// Signed binomial coefficients of the first and second difference.
fn stencil(difference: usize) -> &'static [f64] {
    match difference {
        1 => &[-1.0, 1.0],
        _ => &[1.0, -2.0, 1.0],
    }
}

impl Penalty {
    /// One smoothness penalty per input for the first layer (inputs differ in how much they bend) and one per later
    /// layer.
    pub(super) fn smoothness(model: &Model, unknowns: &Unknowns, strength: f64) -> Vec<Self> {
        let mut penalties = Vec::new();
        for (index, layer) in model.network.layers().iter().enumerate() {
            let groups = if index == 0 { layer.inputs } else { 1 };
            for group in 0..groups {
                let members = layer.edges.iter().enumerate().filter(|(position, _)| position % groups == group);
                let blocks: Vec<_> = members
                    .filter_map(|(position, edge)| {
                        unknowns.start(index, position).map(|start| start..start + edge.basis.len())
                    })
                    .collect();
                if !blocks.is_empty() {
                    penalties.push(Self { blocks, difference: 2, strength });
                }
            }
        }
        penalties
    }

    /// Rows of `D`: index of the first unknown of each.
    fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.blocks.iter().flat_map(|block| block.start..block.end.saturating_sub(self.difference).max(block.start))
    }

    fn applied(&self, first: usize, values: &[f64]) -> f64 {
        stencil(self.difference).iter().zip(&values[first..]).map(|(s, v)| s * v).sum()
    }

    /// `|D c|^2`.
    fn roughness(&self, values: &[f64]) -> f64 {
        self.rows().map(|first| self.applied(first, values).powi(2)).sum()
    }

    pub(super) fn energy(&self, values: &[f64]) -> f64 {
        self.strength * self.roughness(values)
    }

    /// Adds `factor` times half the gradient of the energy.
    pub(super) fn add_gradient(&self, values: &[f64], factor: f64, gradient: &mut [f64]) {
        for first in self.rows() {
            let applied = factor * self.strength * self.applied(first, values);
            stencil(self.difference).iter().zip(&mut gradient[first..]).for_each(|(s, g)| *g += s * applied);
        }
    }

    /// Adds half the second derivative of the energy to the upper triangle of a matrix.
    pub(super) fn add_curvature(&self, size: usize, matrix: &mut [f64]) {
        let stencil = stencil(self.difference);
        for first in self.rows() {
            for (i, a) in stencil.iter().enumerate() {
                for (j, b) in stencil.iter().enumerate().skip(i) {
                    matrix[(first + i) * size + first + j] += self.strength * a * b;
                }
            }
        }
    }

    /// `trace((H + S)^-1 D'D)` from the transposed inverse factor.
    fn trace(&self, inverse: &[f64], size: usize) -> f64 {
        let stencil = stencil(self.difference);
        self.rows()
            .map(|first| {
                let mut combined = vec![0.0; size - first];
                for (i, s) in stencil.iter().enumerate() {
                    let column = &inverse[(first + i) * size + first..(first + i + 1) * size];
                    combined.iter_mut().zip(column).for_each(|(sum, v)| *sum += s * v);
                }
                dot(&combined, &combined)
            })
            .sum()
    }
}

/// Re-estimates all strengths from the data by restricted maximum likelihood (generalised Fellner-Schall update;
/// Wood and Fasiolo, 2017). Each strength may change by at most `limit`-fold. Returns the effective degrees of freedom,
/// the trace of the influence matrix.
pub(super) fn reestimate(
    penalties: &mut [Penalty],
    normal: &NormalEquations,
    factor: &Cholesky,
    ridge: f64,
    values: &[f64],
    samples: usize,
    limit: f64,
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
        let rank = penalty.rows().count() as f64;
        let wanted =
            noise_variance * (rank - penalty.strength * trace).max(1e-6) / penalty.roughness(values).max(1e-30);
        let strength = wanted.clamp(penalty.strength / limit, penalty.strength * limit);
        penalty.strength = strength.clamp(STRENGTH_RANGE.start, STRENGTH_RANGE.end);
    }
    degrees_of_freedom
}

/// Strengths outside this range are indistinguishable from none and from a straight line.
const STRENGTH_RANGE: Range<f64> = 1e-12..1e12;
