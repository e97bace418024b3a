//! How far the rigid body of a shipped model may be off, constants that make up for each other taken together: what another motion may
//! show of it is no physics that came later.

use super::data::gather::Material;
use super::law_error::Residual;
use crate::numerics::hat_functions::law_error_hats;
use crate::numerics::jackknife::Jackknife;
use crate::samples::rigid_body::TermKind;
use frikan_shared::model::{RIGID_BODY_CONSTANTS, RigidBodyError, SLOW_SHARE};
use nalgebra::DMatrix;
use std::ops::Range;

/// Covariance of the identified constants of the rigid body: the delete-one-block jackknife of least squares with a friction law that is
/// free to bend, which allows for noise that is correlated within blocks and for few of them (`MacKinnon`, Nielsen & Webb 2023), and how far
/// the shipped constants are from those of the rows at which the joint slides (Hausman 1978): near rest friction that is no function of
/// velocity passes for inertia.
pub(super) fn rigid_body_error(material: &Material, residual: &Residual<'_>) -> RigidBodyError {
    let velocity = material.pick(residual.velocity);
    let rigid: Vec<Vec<f64>> = material.columns.iter().map(|column| material.pick(&column.values)).collect();
    let places: Vec<usize> = material.columns.iter().map(|column| place(column.kind)).collect();
    let law = law_error_hats(&velocity, None, residual.top_speed);
    let sliding = runs_above(&velocity, SLOW_SHARE * residual.top_speed);
    let errors = errors(&rigid, law, &material.pick(&residual.left), &sliding);
    let mut whole = DMatrix::zeros(errors.nrows(), RIGID_BODY_CONSTANTS);
    for (&place, error) in places.iter().zip(errors.column_iter()) {
        whole.column_mut(place).copy_from(&error);
    }
    factor(whole)
}

/// Runs of rows at more than a speed.
fn runs_above(velocity: &[f64], speed: f64) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut begin = 0;
    for run in velocity.chunk_by(|a, b| (a.abs() > speed) == (b.abs() > speed)) {
        if run[0].abs() > speed {
            runs.push(begin..begin + run.len());
        }
        begin += run.len();
    }
    runs
}

/// Place of a constant in a `RigidBody`.
fn place(kind: TermKind) -> usize {
    match kind {
        TermKind::Inertia | TermKind::ExtraInertia => 0,
        TermKind::GravitySine => 1,
        TermKind::GravityCosine => 2,
        TermKind::TorqueOffset => 3,
        TermKind::TorqueScale => 4,
    }
}

/// Errors whose products add up to the covariance of the coefficients of `rigid`, a row each: what each block alone moves them by, and what
/// the rows at which the joint slides say of the target. No rows where the columns cannot be told apart.
fn errors(rigid: &[Vec<f64>], law: Vec<Vec<f64>>, target: &[f64], sliding: &[Range<usize>]) -> DMatrix<f64> {
    let columns = [rigid, &law].concat();
    let jackknife = Jackknife::new(&columns, target);
    let mut rows = jackknife.errors();
    rows.extend(jackknife.of(sliding));
    DMatrix::from_fn(rows.len(), rigid.len(), |row, column| rows[row][column])
}

/// The upper triangle R of a QR decomposition: the sum of the products of all rows is R'R.
fn factor(errors: DMatrix<f64>) -> RigidBodyError {
    let triangle = errors.qr().unpack_r();
    let mut factor = [0.0; _];
    let places = (0..RIGID_BODY_CONSTANTS).flat_map(|row| (row..RIGID_BODY_CONSTANTS).map(move |column| (row, column)));
    for (slot, (row, column)) in factor.iter_mut().zip(places) {
        let value = triangle.get((row, column)).map_or(0.0, |value| *value as f32);
        *slot = if value.is_finite() { value } else { 0.0 };
    }
    RigidBodyError { factor }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::least_squares::weighted;
    use crate::numerics::random::normal;
    use crate::numerics::regression::least_squares;
    use nalgebra::DVector;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    const ROWS: usize = 3000;

    /// Gravity and offset along a swing of 0.8 rad, the hats of a law, and the rows at which the joint slides.
    fn swing() -> ([Vec<Vec<f64>>; 2], Vec<Range<usize>>) {
        let angle = |i: usize| 0.02 * i as f64;
        let position = |i: usize| 0.4 * angle(i).sin() + 0.2 * (1.7 * angle(i)).sin();
        let velocity: Vec<f64> = (0..ROWS).map(|i| 0.4 * angle(i).cos() + 0.34 * (1.7 * angle(i)).cos()).collect();
        let gravity = (0..ROWS).map(|i| position(i).cos()).collect();
        ([vec![gravity, vec![1.0; ROWS]], law_error_hats(&velocity, None, 0.8)], runs_above(&velocity, 0.08))
    }

    #[test]
    fn it_is_as_large_as_what_noise_does_to_the_constants_and_says_which_make_up_for_each_other() {
        let ([rigid, law], sliding) = swing();
        let columns = [rigid.clone(), law.clone()].concat();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let draws = 60;
        let (mut true_covariance, mut told) = (DMatrix::zeros(2, 2), DMatrix::zeros(2, 2));
        for _ in 0..draws {
            let mut drift = 0.0;
            let mut noise = || {
                drift = 0.9 * drift + normal(&mut random);
                drift
            };
            let target: Vec<f64> = (0..ROWS).map(|_| noise()).collect();
            let fit = least_squares(&columns, &target, &[]);
            let error = DVector::from_column_slice(&fit.coefficients[..2]);
            true_covariance += &error * error.transpose();
            let errors = errors(&rigid, law.clone(), &fit.residuals, &sliding);
            told += errors.transpose() * errors;
        }
        for place in [(0, 0), (1, 1), (0, 1)] {
            let ratio = told[place] / true_covariance[place];
            assert!((0.6..2.0).contains(&ratio), "{place:?} {ratio}");
        }
        let correlation = told[(0, 1)] / (told[(0, 0)] * told[(1, 1)]).sqrt();
        assert!(correlation < -0.99, "{correlation}");
    }

    #[test]
    fn constants_that_are_not_those_of_least_squares_are_off_by_the_difference() {
        let ([rigid, law], sliding) = swing();
        let target = weighted(&rigid, &[0.3, -0.2]);
        let errors = errors(&rigid, law, &target, &sliding);
        let covariance = errors.transpose() * &errors;
        assert!((covariance[(0, 0)] / 0.09 - 1.0).abs() < 1e-3 && (covariance[(0, 1)] / -0.06 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_rows_of_the_factor_have_the_covariance() {
        let errors = DMatrix::from_fn(9, RIGID_BODY_CONSTANTS, |row, column| ((3 * row + 2 * column) as f64).sin());
        let covariance = errors.transpose() * &errors;
        let factor = factor(errors);
        for i in 0..RIGID_BODY_CONSTANTS {
            for j in 0..RIGID_BODY_CONSTANTS {
                let product = |k: usize| f64::from(factor.row(k)[i]) * f64::from(factor.row(k)[j]);
                let sum: f64 = (0..RIGID_BODY_CONSTANTS).map(product).sum();
                assert!((sum - covariance[(i, j)]).abs() < 1e-5, "{i} {j}");
            }
        }
        assert_eq!(super::factor(DMatrix::zeros(0, RIGID_BODY_CONSTANTS)), RigidBodyError::default());
    }
}
