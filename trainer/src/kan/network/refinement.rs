//! Finer grids under a trained network (Liu et al., 2024): every cell halved, every activation as it was.

use super::dense::Cholesky;
use super::error::KanError;
use super::layers::Network;
use super::spline::{Grid, SplineBasis};

impl Network {
    /// The same network on cells of half the width. Within their grids the activations do not change but for rounding: the
    /// finer splines contain the coarser ones.
    ///
    /// # Errors
    /// [`KanError::Grid`] where cells are too narrow to be halved.
    pub fn refined(&self) -> Result<Self, KanError> {
        let edges = || self.layers.iter().flat_map(|layer| &layer.edges);
        let bases: Vec<SplineBasis> = edges()
            .map(|edge| SplineBasis::new(Grid { order: edge.basis.order(), breaks: halved(edge.basis.breaks()) }))
            .collect::<Result<_, _>>()?;
        let mut finer = self.clone();
        finer.set_bases(bases);
        for (edge, coarse) in finer.layers.iter().flat_map(|layer| &layer.edges).zip(edges()) {
            let coefficients = carried_over(&coarse.basis, &self.parameters[coarse.coefficients()], &edge.basis);
            finer.parameters[edge.coefficients()].copy_from_slice(&coefficients);
            finer.parameters[edge.scale()] = self.parameters[coarse.scale()];
            finer.parameters[edge.base()] = self.parameters[coarse.base()];
        }
        Ok(finer)
    }
}

/// Boundaries with one more in the middle of every cell.
fn halved(breaks: &[f64]) -> Vec<f64> {
    let inner = breaks.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
    inner.chain(breaks.last().copied()).collect()
}

/// Coefficients with which the finer basis draws the same curve: least squares at more points than a cell has freedom.
fn carried_over(coarse: &SplineBasis, coefficients: &[f64], fine: &SplineBasis) -> Vec<f64> {
    let size = fine.len();
    let points = fine.order() + 2;
    let (mut matrix, mut right) = (vec![0.0; size * size], vec![0.0; size]);
    for cell in fine.breaks().windows(2) {
        for k in 0..points {
            let x = cell[0] + (cell[1] - cell[0]) * (k as f64 + 0.5) / points as f64;
            let before = coarse.at(x);
            let value: f64 = (0..=coarse.order()).map(|i| before.value[i] * coefficients[before.first + i]).sum();
            let local = fine.at(x);
            for i in 0..=fine.order() {
                right[local.first + i] += local.value[i] * value;
                for j in i..=fine.order() {
                    matrix[(local.first + i) * size + local.first + j] += local.value[i] * local.value[j];
                }
            }
        }
    }
    // Points within every cell determine every function, so that there is a factor.
    Cholesky::new(&matrix, size).map_or_else(|| vec![0.0; size], |factor| factor.solve(&right))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kan::Architecture;

    #[test]
    fn a_refined_network_computes_the_same() {
        let mut network = Network::zeros(&"[2,[2,1],1]".parse::<Architecture>().unwrap()).unwrap();
        // Small enough for hidden values to stay within their grids.
        network.parameters.iter_mut().enumerate().for_each(|(i, p)| *p = 0.1 * (i as f64 * 0.7).sin());
        let finer = network.refined().unwrap();
        assert!(finer.layers()[0].edges[0].basis.breaks().len() == 21);
        for i in 0..200 {
            let point = [(0.37 * f64::from(i)).sin(), (0.61 * f64::from(i)).cos()];
            let (coarse, fine) = (network.evaluate(&point), finer.evaluate(&point));
            assert!((coarse - fine).abs() < 1e-12, "{point:?}: {coarse} and {fine}");
        }
    }
}
