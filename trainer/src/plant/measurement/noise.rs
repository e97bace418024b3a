//! Noise of the torque signal: white, coloured, state-dependent, and a vibrating base.

use crate::plant::joint::{Joint, NoiseKind};
use crate::plant::random::{Draws, Purpose};
use std::f64::consts::TAU;

/// Noise at the sample instants, N m. `velocity`, `acceleration` and `torque` are the true ones.
pub(crate) fn torque_noise(
    joint: &Joint,
    velocity: &[f64],
    acceleration: &[f64],
    torque: &[f64],
    seed: u64,
) -> Vec<f64> {
    let noise = &joint.noise;
    let step = 1.0 / joint.drive.rate_hz;
    let mut draws = Draws::new(seed, Purpose::Noise, 0);
    let (white, coloured) = match noise.kind {
        NoiseKind::White => (noise.white_torque_nm.hypot(noise.coloured_torque_nm), 0.0),
        _ => (noise.white_torque_nm, noise.coloured_torque_nm),
    };
    let memory = (-step / noise.correlation_time_s).exp();
    let refresh = coloured * (1.0 - memory * memory).sqrt();
    let mut slow = coloured * draws.normal();
    let mut values: Vec<f64> = velocity
        .iter()
        .zip(acceleration)
        .map(|(v, a)| {
            let scale = match noise.kind {
                // From two thirds at rest to about twice at full speed.
                NoiseKind::StateDependent => 0.65 * (0.35 * v.abs() + 0.02 * a.abs()).min(2.0).exp(),
                _ => 1.0,
            };
            slow = memory * slow + refresh * draws.normal();
            scale * (slow + white * draws.normal())
        })
        .collect();
    if noise.kind == NoiseKind::FlexibleBase {
        let vibration = base_vibration(joint, torque, &mut draws);
        values.iter_mut().zip(vibration).for_each(|(value, extra)| *value += extra);
    }
    values
}

/// Inertial torque of a base that vibrates under the joint, N m: an oscillator driven by the floor and, through
/// `inertia_ratio`, by the reaction to the joint's own torque.
fn base_vibration(joint: &Joint, torque: &[f64], draws: &mut Draws) -> Vec<f64> {
    let base = &joint.noise.base;
    let omega = TAU * base.frequency_hz;
    let step = 1.0 / joint.drive.rate_hz;
    let drag = 2.0 * base.damping_ratio * omega;
    // Under white acceleration of density S the oscillator's own part of its acceleration has the
    // variance omega^4 x^2 with x^2 = S / (4 zeta omega^3).
    let floor = base.vibration_torque_nm / joint.inertia_kgm2 * (4.0 * base.damping_ratio / (omega * step)).sqrt();
    let reaction = if base.inertia_ratio > 0.0 { 1.0 / (base.inertia_ratio * joint.inertia_kgm2) } else { 0.0 };
    let (mut position, mut velocity) = (0.0, 0.0);
    torque
        .iter()
        .map(|torque| {
            let restoring = -drag * velocity - omega * omega * position;
            let pushed = restoring - reaction * torque;
            velocity += (pushed + floor * draws.normal()) * step;
            position += velocity * step;
            // The floor's own white kick is not seen through the base: only its smooth response is.
            joint.inertia_kgm2 * pushed
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviation(values: &[f64]) -> f64 {
        (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
    }

    #[test]
    fn every_kind_has_the_size_it_was_given() {
        let still = vec![0.0; 200_000];
        for kind in NoiseKind::ALL {
            let mut joint = Joint::default();
            joint.noise.kind = kind;
            let expected = match kind {
                NoiseKind::StateDependent => 0.65 * 0.37_f64.hypot(0.06),
                NoiseKind::FlexibleBase => 0.37_f64.hypot(0.06).hypot(0.1),
                _ => 0.37_f64.hypot(0.06),
            };
            let measured = deviation(&torque_noise(&joint, &still, &still, &still, 11));
            assert!((measured / expected - 1.0).abs() < 0.03, "{kind:?}: {measured} against {expected}");
        }
    }
}
