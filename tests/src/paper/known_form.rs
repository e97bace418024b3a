//! P1 and P2: the known form, on shares of clean data and under heavy noise.

use frikan_trainer::law::{FormFit, KnownForm, fit_form};

use super::{Effort, JOINTS, SAMPLES, SMOOTHING, friction, r2};
use crate::laws::joint;

/// Names of `k1 .. k4`.
pub const NAMES: [&str; 4] = ["coulomb_torque", "stribeck_extra_torque", "stribeck_velocity", "viscous_coefficient"];
/// Noise of P2, as a share of the range of friction.
const HEAVY: f64 = 0.25;

fn place(fit: &FormFit, name: &str) -> usize {
    fit.law.parameters.iter().position(|p| p.name == name).expect("the form has the constants of the paper")
}

fn fitted(joint_index: usize, rows: usize, share: f64, seed: u64) -> FormFit {
    let data = joint(JOINTS[joint_index], rows, share, seed);
    fit_form(KnownForm::Stribeck, &data, Some(SMOOTHING)).expect("usable samples")
}

/// Largest relative error of the constants of a joint from a share of 1000 clean samples.
#[must_use]
pub fn clean_error(joint_index: usize, share: f64, seed: u64) -> f64 {
    let fit = fitted(joint_index, (share * SAMPLES as f64) as usize, 0.0, seed);
    let error = |(name, truth): (&str, f64)| (fit.law.parameters[place(&fit, name)].value / truth - 1.0).abs();
    NAMES.into_iter().zip(JOINTS[joint_index]).map(error).fold(0.0, f64::max)
}

/// What heavy noise does to one joint.
#[derive(Clone, Debug)]
pub struct Noisy {
    /// R2 against the clean truth of the first draw.
    pub clean_r2: f64,
    /// R2 against its noisy samples.
    pub noisy_r2: f64,
    /// Draws in which each constant is within two standard errors of the truth.
    pub within: [u64; 4],
}

/// Many draws of one joint under noise of a quarter of the range.
#[must_use]
pub fn noisy(joint_index: usize, effort: Effort) -> Noisy {
    let k = JOINTS[joint_index];
    let mut result = Noisy { clean_r2: 0.0, noisy_r2: 0.0, within: [0; 4] };
    for seed in 0..effort.coverage {
        let fit = fitted(joint_index, SAMPLES, HEAVY, 31_000 + seed);
        for (within, (name, truth)) in result.within.iter_mut().zip(NAMES.into_iter().zip(k)) {
            let at = place(&fit, name);
            let miss = (fit.law.parameters[at].value - truth).abs();
            *within += u64::from(miss <= 2.0 * fit.uncertainty.standard_errors[at]);
        }
        if seed == 0 {
            let data = joint(k, SAMPLES, HEAVY, 31_000);
            let v = &data.channels[0].values;
            let predicted: Vec<f64> = v.iter().map(|v| fit.law.expression.value(&[*v], &[])).collect();
            let truth: Vec<f64> = v.iter().map(|v| friction(k, *v)).collect();
            (result.clean_r2, result.noisy_r2) = (r2(&truth, &predicted), r2(&data.target, &predicted));
        }
    }
    result
}
