//! Linear interpolation over 256 equal steps: what many drives have.

use crate::Friction;

const ENTRIES: usize = 256;
const LOW: f32 = -2.0;
const HIGH: f32 = 2.0;

/// The law at [`ENTRIES`] equally spaced velocities.
pub static TABLE: [f32; ENTRIES] = tabulate();

/// Linear interpolation in Rust, ends held.
pub struct LinearTable;

impl Friction for LinearTable {
    fn friction(velocity: f32) -> f32 {
        let position = ((velocity - LOW) * ((ENTRIES - 1) as f32 / (HIGH - LOW))).clamp(0.0, (ENTRIES - 1) as f32);
        let index = (position as usize).min(ENTRIES - 2);
        let fraction = position - index as f32;
        match TABLE.get(index..index + 2) {
            Some([below, above]) => below + fraction * (above - below),
            _ => 0.0,
        }
    }
}

const fn tabulate() -> [f32; ENTRIES] {
    let mut table = [0.0; ENTRIES];
    let mut index = 0;
    while index < ENTRIES {
        let velocity = LOW as f64 + index as f64 * (HIGH - LOW) as f64 / (ENTRIES - 1) as f64;
        table[index] = friction(velocity) as f32;
        index += 1;
    }
    table
}

const fn friction(velocity: f64) -> f64 {
    let magnitude = velocity.abs();
    let tanh = 1.0 - 2.0 / (exp(100.0 * magnitude) + 1.0);
    let torque = (22.0 + 8.0 * exp(-magnitude / 0.1)) * tanh + 0.03 * magnitude;
    if velocity < 0.0 { -torque } else { torque }
}

/// `exp` at compile time: the series at `x / 2^10`, squared ten times.
const fn exp(x: f64) -> f64 {
    let reduced = x / 1024.0;
    let mut term = 1.0;
    let mut sum = 1.0;
    let mut order = 1.0;
    while order < 20.0 {
        term *= reduced / order;
        sum += term;
        order += 1.0;
    }
    let mut squarings = 0;
    while squarings < 10 {
        sum *= sum;
        squarings += 1;
    }
    sum
}
