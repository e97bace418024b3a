//! Table or expression: both are built from the open blocks and compared on the locked ones as the drive computes them.

use super::gather::Material;
use super::model::HostModel;
use super::outcome::Representation;
use super::predict::predict;
use crate::error::Result;
use crate::numerics::statistics::NORMAL_95;

/// An expression may be worse by this share and is still taken: it is shorter, and holds beyond the data.
const TOLERATED_SHARE: f64 = 0.02;
/// Where the difference does not stand out of its scatter over blocks, it may be worse by this share.
const TOLERATED_SHARE_UNCERTAIN: f64 = 0.10;
/// Errors of a candidate on the locked rows.
pub(super) struct Trial {
    pub(super) squares: Vec<f64>,
}

impl Trial {
    /// Evaluates a model on the locked rows.
    pub(super) fn of(model: &HostModel, material: &Material) -> Result<Self> {
        let predicted = predict(model, &material.samples)?.total();
        let samples = &material.samples;
        let measured = samples.friction.as_deref().or(samples.actuator.as_deref()).unwrap_or_default();
        let square = |position: usize| {
            let row = material.rows[position];
            (measured[row] - predicted[row]).powi(2)
        };
        Ok(Self { squares: material.locked().into_iter().map(square).collect() })
    }

    pub(super) fn rmse(&self) -> f64 {
        (self.squares.iter().sum::<f64>() / self.squares.len().max(1) as f64).sqrt()
    }
}

/// The better form and why, in one sentence.
pub(super) fn decide(table: &Trial, expression: &Trial, material: &Material, unit: &str) -> (Representation, String) {
    let (by_table, by_expression) = (table.rmse(), expression.rmse());
    let figures = format!("{by_expression:.4} {unit} against {by_table:.4} {unit} of the table on held-out blocks");
    if by_expression <= by_table * (1.0 + TOLERATED_SHARE) {
        return (Representation::Expression, format!("the expression is as good or better: {figures}"));
    }
    let (mean, standard_error) = difference(table, expression, material);
    if mean < NORMAL_95 * standard_error && by_expression <= by_table * (1.0 + TOLERATED_SHARE_UNCERTAIN) {
        let reason = format!("the expression is not distinguishably worse: {figures}");
        return (Representation::Expression, reason);
    }
    (Representation::Table, format!("the expression misses something that the network sees: {figures}"))
}

/// Mean and standard error over blocks of what the expression's squared error exceeds the table's by.
fn difference(table: &Trial, expression: &Trial, material: &Material) -> (f64, f64) {
    let locked = material.locked();
    let mut blocks: Vec<(usize, f64, usize)> = Vec::new();
    for ((position, a), b) in locked.iter().zip(&expression.squares).zip(&table.squares) {
        let label = material.labels[*position];
        match blocks.last_mut().filter(|(last, _, _)| *last == label) {
            Some((_, sum, count)) => (*sum, *count) = (*sum + a - b, *count + 1),
            None => blocks.push((label, a - b, 1)),
        }
    }
    let means: Vec<f64> = blocks.iter().map(|(_, sum, count)| sum / *count as f64).collect();
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    (mean, (variance / count).sqrt())
}
