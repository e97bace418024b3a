//! Inputs that exercise every path of an evaluation.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Values at which floating-point code goes wrong: zeros, subnormals, infinities, NaN of both signs and both kinds,
/// the largest and smallest normal values, and neighbours of one.
#[must_use]
pub fn special_values() -> Vec<f32> {
    let bits = [
        0x0000_0000,
        0x0000_0001,
        0x0000_0002,
        0x0040_0000,
        0x007F_FFFF,
        0x0080_0000,
        0x0080_0001,
        0x0D00_0000,
        0x3280_0000,
        0x3380_0000,
        0x3400_0000,
        0x3C7F_FFFF,
        0x3C80_0000,
        0x3F00_0000,
        0x3F7F_FFFF,
        0x3F80_0000,
        0x3F80_0001,
        0x4000_0000,
        0x4B00_0000,
        0x4F00_0000,
        0x4F7F_FFFF,
        0x4F80_0000,
        0x5F00_0000,
        0x7F00_0000,
        0x7F7F_FFFF,
        0x7F80_0000,
        0x7F80_0001,
        0x7FA0_0000,
        0x7FC0_0000,
        0x7FFF_FFFF,
    ];
    bits.into_iter().flat_map(|bits: u32| [bits, bits | 0x8000_0000]).map(f32::from_bits).collect()
}

/// `count` values: the special ones, an even sweep over `[-1.25 reach, 1.25 reach]`, and bit patterns drawn evenly from
/// all 2^32 of them, in equal parts. One seed, one vector.
#[must_use]
pub fn one_input(count: usize, reach: f32, seed: u64) -> Vec<f32> {
    let mut values = special_values();
    values.truncate(count);
    let sweep = (count - values.len()) / 2;
    let step = 2.5 * f64::from(reach) / sweep.max(1) as f64;
    values.extend((0..sweep).map(|index| (index as f64 * step - 1.25 * f64::from(reach)) as f32));
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    values.resize_with(count, || f32::from_bits(random.next_u32()));
    values
}

/// `count` counts of a drive without floating-point unit, as `i32` bits: the ends of the range, an even sweep over
/// `[-1.25 reach, 1.25 reach]`, and random ones over all 2^32. One seed, one vector.
#[must_use]
pub fn counts(count: usize, reach: i32, seed: u64) -> Vec<i32> {
    let mut values = vec![0, 1, -1, reach - 1, reach, reach + 1, 1 - reach, -reach, -reach - 1, i32::MAX, i32::MIN];
    values.extend([8191, 8192, 8193, -8191, -8192, -8193, i32::MIN + 1]);
    values.truncate(count);
    let sweep = (count - values.len()) / 2;
    let end = 1.25 * f64::from(reach);
    values.extend((0..sweep).map(|index| (index as f64 * 2.0 * end / sweep as f64 - end) as i32));
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    values.resize_with(count, || random.next_u32() as i32);
    values
}

/// `rows` rows of `reaches.len()` inputs that fill the box of the reaches evenly (additive recurrence on the roots of
/// `x^(d+1) = x + 1`; Roberts 2018), every 16th row with a special value in one of its inputs.
#[must_use]
pub fn space_filling(rows: usize, reaches: &[f32]) -> Vec<f32> {
    let specials = special_values();
    let dimensions = reaches.len();
    let mut root = 1.5_f64;
    for _ in 0..64 {
        root = (1.0 + root).powf(1.0 / (dimensions as f64 + 1.0));
    }
    let mut values = Vec::with_capacity(rows * dimensions);
    for row in 0..rows {
        for (dimension, reach) in reaches.iter().enumerate() {
            let step = root.powi(-(dimension as i32 + 1));
            let fraction = (0.5 + step * row as f64).fract();
            values.push((f64::from(*reach) * 1.25 * (2.0 * fraction - 1.0)) as f32);
        }
        if row % 16 == 15 {
            let index = row * dimensions + (row / 16) % dimensions;
            values[index] = specials[(row / 16) % specials.len()];
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_have_the_length_asked_for_and_repeat() {
        for count in [0, 1, 100, 4096] {
            let values = one_input(count, 2.0, 7);
            assert_eq!(values.len(), count);
            let again = one_input(count, 2.0, 7);
            assert!(values.iter().zip(&again).all(|(a, b)| a.to_bits() == b.to_bits()));
        }
    }

    #[test]
    fn space_filling_rows_spread_over_every_cell_of_a_coarse_grid() {
        let values = space_filling(4096, &[1.0, 1.0]);
        let mut hits = [[0; 8]; 8];
        for row in values.chunks_exact(2) {
            let cell = |value: f32| ((value / 1.25 + 1.0) * 4.0) as usize;
            if row.iter().all(|value| value.abs() < 1.25) {
                hits[cell(row[0])][cell(row[1])] += 1;
            }
        }
        assert!(hits.iter().flatten().all(|count| (40..90).contains(count)), "{hits:?}");
    }
}
