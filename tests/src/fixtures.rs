//! What the generated fixtures hold: recordings of the published law, and outputs of golden images as bits.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::MAX_INPUTS;
use frikan_trainer::fit::HostModel;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use crate::paper::friction;

/// Points at which a golden image is held still.
const GOLDEN_POINTS: usize = 400;

/// The folder `fixtures` of the workspace.
#[must_use]
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures")
}

/// A recording of separated friction: `rows` velocities uniform in `[-1, 1]` rad/s from a seed.
#[must_use]
pub fn separated_recording(constants: [f64; 4], rows: usize, seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut text = String::from("velocity_rad_s,friction_torque_Nm\n");
    for _ in 0..rows {
        let velocity = 2.0 * (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64 - 1.0;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{velocity},{}", friction(constants, velocity));
    }
    text
}

/// Outputs of a model over its first input, a fifth beyond the trained range on either side, as one line of bits a point.
#[must_use]
pub fn output_bits(model: &HostModel) -> String {
    let mut text = String::new();
    let Some(input) = model.inputs.first() else { return text };
    for index in 0..=GOLDEN_POINTS {
        let share = index as f32 / GOLDEN_POINTS as f32 * 1.4 - 0.2;
        let mut point = [0.0; MAX_INPUTS];
        point[0] = input.low + (input.high - input.low) * share;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:08x} {:08x}", point[0].to_bits(), evaluate(model, &point).to_bits());
    }
    text
}
