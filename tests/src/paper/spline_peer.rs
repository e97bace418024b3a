//! What a statistician would pick in place of a network: one least-squares cubic spline whose knots crowd about zero velocity.

use frikan_trainer::fit::outcome::Score;
use frikan_trainer::kan::{Architecture, FitOptions, Grid, SplineBasis};
use nalgebra::{DMatrix, DVector};

use super::network::{learn_with, noisy_options};
use super::{JOINTS, friction};

/// Coefficients of the comparison.
pub const COEFFICIENTS: usize = 19;

/// Root mean square errors against the clean truth, N m: of the network `[1,1]` and of the spline with as many coefficients,
/// learnt from the same samples of a joint with noise of `share` times the range.
#[must_use]
pub fn at_equal_count(joint: usize, share: f64, seed: u64) -> [f64; 2] {
    let architecture = Architecture::additive(1, &[]).with_resolution(COEFFICIENTS - ORDER, ORDER);
    let options = FitOptions { architecture, restarts: 8, ..noisy_options(seed) };
    let learnt = learn_with(joint, share, seed, &options);
    let spline = SinhSpline::fit(&learnt.samples.velocity, &learnt.samples.noisy, COEFFICIENTS);
    let truth: Vec<f64> = learnt.test_velocity.iter().map(|v| friction(JOINTS[joint], *v)).collect();
    let predicted: Vec<f64> = learnt.test_velocity.iter().map(|v| spline.value(*v)).collect();
    [learnt.rmse[2], Score::of(&truth, &predicted).rmse]
}

/// Polynomial order.
const ORDER: usize = 3;
/// Crowdings of the knots that are tried; the one that leaves least on the samples is kept.
const WARPS: [f64; 8] = [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];

/// A cubic spline over `[-1, 1]` whose inner knots are equal steps of `asinh`.
#[derive(Clone, Debug)]
pub struct SinhSpline {
    basis: SplineBasis,
    coefficients: DVector<f64>,
}

impl SinhSpline {
    /// The least-squares spline of `count` coefficients, at least 5, through samples of velocity in `[-1, 1]` and torque.
    ///
    /// # Panics
    /// With fewer samples than coefficients.
    #[must_use]
    pub fn fit(velocity: &[f64], torque: &[f64], count: usize) -> Self {
        assert!(count > ORDER + 1 && velocity.len() >= count, "{count} coefficients from {} samples", velocity.len());
        let fits = WARPS.map(|warp| {
            let grid = Grid { order: ORDER, breaks: breaks(count - ORDER, warp) };
            let basis = SplineBasis::new(grid).expect("breaks ascend");
            let mut design = DMatrix::zeros(velocity.len(), count);
            for (row, v) in velocity.iter().enumerate() {
                let local = basis.at(*v);
                (0..=ORDER).for_each(|i| design[(row, local.first + i)] = local.value[i]);
            }
            let target = DVector::from_column_slice(torque);
            let svd = design.clone().svd(true, true);
            let coefficients = svd.solve(&target, 1e-12).expect("both factors were asked for");
            ((design * &coefficients - target).norm(), Self { basis, coefficients })
        });
        fits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("several warps").1
    }

    /// Torque at a velocity in `[-1, 1]`.
    #[must_use]
    pub fn value(&self, velocity: f64) -> f64 {
        let local = self.basis.at(velocity);
        (0..=ORDER).map(|i| self.coefficients[local.first + i] * local.value[i]).sum()
    }
}

/// Boundaries of `cells` cells over `[-1, 1]` in equal steps of `asinh`.
fn breaks(cells: usize, warp: f64) -> Vec<f64> {
    let step = |i: usize| 2.0 * i as f64 / cells as f64 - 1.0;
    (0..=cells).map(|i| (warp * step(i)).sinh() / warp.sinh()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_met_exactly() {
        let velocity: Vec<f64> = (0..101).map(|i| f64::from(i) / 50.0 - 1.0).collect();
        let cubic = |v: f64| 1.0 - 2.0 * v + 3.0 * v * v - 4.0 * v * v * v;
        let torque: Vec<f64> = velocity.iter().map(|v| cubic(*v)).collect();
        let spline = SinhSpline::fit(&velocity, &torque, 9);
        for v in [-1.0, -0.99, -0.3, 0.0, 0.01, 0.77, 1.0] {
            assert!((spline.value(v) - cubic(v)).abs() < 1e-9, "{v}: {}", spline.value(v));
        }
    }
}
