//! What a model makes of the filtered torque, which is what the samples show: its law averaged over the states that each sample averages over, and
//! gravity as the filter lets it pass.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::Quantity;

use super::data::gather::Material;
use super::model::HostModel;
use super::predict::{Prediction, channels, predict};
use crate::error::Result;
use crate::samples::states::States;

/// Predicts the filtered torque of every sample; the law of samples that are not learnt from is that of their own velocity.
///
/// # Errors
/// As [`predict`].
pub(super) fn predict_filtered(model: &HostModel, material: &Material) -> Result<Vec<f64>> {
    let samples = &material.samples;
    let Prediction { mut friction, rigid_body } = predict(model, samples)?;
    if let Some(states) = &material.states {
        let averaged = states.averages.over(&of_states(model, &channels(model, samples)?, states));
        for (&row, averaged) in states.rows.iter().zip(averaged) {
            friction[row] = averaged;
        }
    }
    let held_back = |row: usize| {
        samples.position.as_deref().map_or(0.0, |position| {
            let (sine, cosine) = position[row].sin_cos();
            let gravity =
                f64::from(model.rigid_body.gravity_sin) * sine + f64::from(model.rigid_body.gravity_cos) * cosine;
            (1.0 - samples.passed_share_of_sine(row)) * gravity
        })
    };
    Ok((0..friction.len()).map(|row| friction[row] + rigid_body[row] - held_back(row)).collect())
}

/// The law at every state: its own velocity, what else the law reads as the nearest row has it.
fn of_states(model: &HostModel, channels: &[&[f64]], states: &States) -> Vec<f64> {
    let mut point = [0.0f32; MAX_INPUTS];
    let of_state = |(velocity, nearest): (&f64, &usize)| {
        let row = states.rows[*nearest];
        for ((slot, input), channel) in point.iter_mut().zip(&model.inputs).zip(channels) {
            *slot = if input.quantity == Quantity::Velocity { *velocity as f32 } else { channel[row] as f32 };
        }
        f64::from(evaluate(model, &point))
    };
    states.velocity.iter().zip(&states.nearest).map(of_state).collect()
}
