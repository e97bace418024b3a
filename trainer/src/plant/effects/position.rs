//! Dependence on position: ripple and friction along the way.

use super::mechanism::{Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;
use std::f64::consts::TAU;

/// Torque or friction ripple at one or two orders that a gear of this ratio can have (Holtz & Springob 1996), of which the
/// range shows three periods: with fewer it is gravity or position-dependent friction to any observer.
pub(super) fn ripple(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let ratio = setting.joint.drive.gear_ratio;
    let is_friction = draws.choice("friction_type", 2) == 1;
    let travel = (setting.range.1 - setting.range.0) / TAU;
    let mut orders = vec![1.0, 2.0, 8.0, ratio, 2.0 * ratio];
    orders.retain(|order| *order == ratio || order * travel >= 3.0);
    let first = orders[draws.index(orders.len())];
    draws.note("order", first);
    let size = draws.uniform("amplitude_Nm", 0.25, 0.5);
    let phase = draws.uniform("phase_rad", 0.0, TAU);
    // The second harmonic comes along weakly, as it does in a real motor.
    let second = size * draws.uniform("second_harmonic", 0.0, 0.3);
    let second_phase = draws.between(0.0, TAU);
    Mechanism::torque(move |m: &Moment, _| {
        let angle = first * m.position;
        let wave = size * (angle + phase).cos() + second * (2.0 * angle + second_phase).cos();
        if is_friction { Resistance::dry(wave) } else { Resistance::smooth(wave) }
    })
}

/// A few broad tight places along the way.
pub(super) fn friction(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let (low, high) = setting.range;
    let places: Vec<(f64, f64, f64)> = (0..3)
        .map(|i| {
            let place = low + (high - low) * (i as f64 + draws.between(0.1, 0.9)) / 3.0;
            (place, draws.between(0.12, 0.3) * (high - low), draws.sign() * draws.between(0.3, 0.8))
        })
        .collect();
    for &(place, width, level) in &places {
        draws.note("place_rad", place);
        draws.note("width_rad", width);
        draws.note("level_Nm", level);
    }
    Mechanism::torque(move |m: &Moment, _| {
        let level = places.iter().map(|(q, w, b)| b * (-((m.position - q) / w).powi(2)).exp()).sum();
        Resistance::dry(level)
    })
}
