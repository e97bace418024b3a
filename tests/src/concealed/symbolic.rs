//! A Stribeck law fitted to the very recording, as the model that a diagnosis starts from: whatever the law can swallow of a
//! hidden effect, it has swallowed.

use crate::laws::{data, velocity};
use frikan_trainer::diagnose::{Comparison, Reference, Signals};
use frikan_trainer::law::{KnownForm, fit_form};

/// Most samples that the law is fitted to.
const MOST_SAMPLES: usize = 4000;
/// Relative step of the central differences.
const STEP: f64 = 1e-4;

/// Fits the law to the friction of the signals (a rigid-body torque given) and makes it what they are compared with.
///
/// # Errors
/// What keeps the law from being fitted.
pub fn compare_with_own_law(signals: Signals) -> Result<Comparison, String> {
    let state = signals.states();
    let rigid_body = state.rigid_body.clone().ok_or("no rigid-body torque is given")?;
    let moving: Vec<usize> = (0..state.len()).filter(|&i| !state.memory.at_rest[i]).collect();
    let step = moving.len().div_ceil(MOST_SAMPLES).max(1);
    let picked: Vec<usize> = moving.into_iter().step_by(step).collect();
    let friction = picked.iter().map(|&i| state.torque[i] - rigid_body[i]).collect();
    let samples = data(vec![velocity(picked.iter().map(|&i| state.velocity[i]).collect())], friction);
    let law = fit_form(KnownForm::Stribeck, &samples, None).map_err(|e| e.to_string())?.law;
    let constants: Vec<f64> = law.parameters.iter().map(|parameter| parameter.value).collect();
    let friction = |v: f64, constants: &[f64]| law.template.value(&[v], constants);
    let moved = |index: usize, by: f64| {
        let mut moved = constants.clone();
        moved[index] += by;
        moved
    };
    let jacobian = (0..constants.len()).map(|index| {
        let by = STEP * constants[index].abs().max(STEP);
        let (up, down) = (moved(index, by), moved(index, -by));
        let column = state.velocity.iter().map(|v| (friction(*v, &up) - friction(*v, &down)) / (2.0 * by)).collect();
        ("model_parameter", column)
    });
    let reach = 1.2 * state.top_speed();
    let reference = Reference {
        torque: state.velocity.iter().zip(&rigid_body).map(|(v, body)| friction(*v, &constants) + body).collect(),
        jacobian: jacobian.collect(),
        friction: (-200..=200).map(|k| f64::from(k) / 200.0 * reach).map(|v| (v, friction(v, &constants))).collect(),
        rigid_body,
        ..Reference::default()
    };
    Ok(Comparison::with(signals, reference))
}
