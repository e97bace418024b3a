//! What of a candidate's evidence may be an error of the law that the recording is compared with: a law that was learned from a
//! noisy simulation has an uncertainty of its own.

use crate::numerics::least_squares::{dot, orthonormal, project_out, weighted};
use std::ops::Range;

/// The uncertainty of a reference beside a base, whitened.
pub(crate) struct LawUncertainty {
    /// Torque of each uncertain direction at one standard deviation.
    torque: Vec<Vec<f64>>,
    /// Orthonormal directions that the base takes up.
    base: Vec<Vec<f64>>,
    runs: Vec<Range<usize>>,
}

impl LawUncertainty {
    /// Uncertainty given as whitened torque beside whitened base columns.
    pub fn beside(base: &[Vec<f64>], torque: Vec<Vec<f64>>, runs: Vec<Range<usize>>) -> Self {
        let base = if torque.is_empty() { Vec::new() } else { orthonormal(base, &runs) };
        Self { torque, base, runs }
    }

    /// Variance that noise alone gives the evidence of a torque over that beside noise and uncertainty, above 0 and at most 1. The torque is
    /// given as whitened columns and their coefficients.
    pub fn trust(&self, columns: &[Vec<f64>], coefficients: &[f64]) -> f64 {
        if self.torque.is_empty() {
            return 1.0;
        }
        let mut free = weighted(columns, coefficients);
        project_out(&mut free, &self.base, &self.runs);
        let energy = dot(&free, &free, &self.runs);
        let doubt: f64 = self.torque.iter().map(|torque| dot(&free, torque, &self.runs).powi(2)).sum();
        if energy == 0.0 { 1.0 } else { 1.0 / (1.0 + doubt / energy) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evidence_along_a_doubt_counts_less_and_across_it_as_much() {
        let axis =
            |place: usize, length: f64| (0..4).map(|i| if i == place { length } else { 0.0 }).collect::<Vec<f64>>();
        let all = std::iter::once(0..4).collect::<Vec<_>>();
        let uncertainty = LawUncertainty::beside(&[axis(0, 2.0)], vec![axis(0, 9.0), axis(1, 3.0)], all.clone());
        assert!((uncertainty.trust(&[axis(1, 0.5)], &[1.0]) - 0.1).abs() < 1e-12);
        assert_eq!(uncertainty.trust(&[axis(2, 0.5)], &[1.0]), 1.0);
        assert!((uncertainty.trust(&[axis(1, 1.0), axis(2, 1.0)], &[1.0, 1.0]) - 1.0 / 5.5).abs() < 1e-12);
        assert_eq!(LawUncertainty::beside(&[axis(0, 2.0)], Vec::new(), all).trust(&[axis(1, 0.5)], &[1.0]), 1.0);
    }
}
