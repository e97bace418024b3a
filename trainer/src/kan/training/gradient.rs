//! The loss of a network and its gradient, as every training by gradients sees them.

use super::dataset::{Dataset, row_count};
use super::jacobian::residual_sum_and_gradient;
use super::model::{Model, Unknowns};
use crate::kan::network::error::KanError;
use crate::kan::network::layers::Network;

/// Mean squared error over the training rows and its gradient with respect to the spline coefficients of all active edges
/// and the coefficients of the linear columns, target and columns normalised.
///
/// # Errors
/// [`KanError`] when the data do not belong to the network.
pub fn loss_and_gradient(
    network: &Network,
    linear_coefficients: &[f64],
    dataset: &Dataset,
) -> Result<(f64, Vec<f64>), KanError> {
    dataset.check(network.inputs.len())?;
    let rows = dataset.training_rows();
    let samples = row_count(&rows) as f64;
    let model = Model::resumed(network.clone(), linear_coefficients, dataset, &rows);
    let unknowns = Unknowns::of(&model, false);
    let (sum, gradient) = residual_sum_and_gradient(&model, &unknowns, dataset, &rows);
    Ok((sum / samples, gradient.into_iter().map(|g| g / samples).collect()))
}
