//! How much more the evidence for a torque scatters than noise of unit variance lets it: the noise is never quite what its model says, and
//! blocks that disagree show it (White 1980 from row to row; Liang & Zeger 1986 from block to block).

use crate::numerics::least_squares::dot;
use std::ops::Range;

/// Variance of the product of a torque with whitened noise over that with noise of unit variance, at least 1: the larger of what rows and what
/// blocks show.
pub(crate) fn overdispersion(torque: &[f64], noise: &[f64], blocks: &[Vec<Range<usize>>]) -> f64 {
    let energy: f64 = blocks.iter().map(|runs| dot(torque, torque, runs)).sum();
    if energy == 0.0 {
        return 1.0;
    }
    let squares = |run: &Range<usize>| -> f64 {
        torque[run.clone()].iter().zip(&noise[run.clone()]).map(|(torque, noise)| (torque * noise).powi(2)).sum()
    };
    let from_rows: f64 = blocks.iter().flatten().map(squares).sum();
    let from_blocks: f64 = blocks.iter().map(|runs| dot(torque, noise, runs).powi(2)).sum();
    (from_rows.max(from_blocks) / energy).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    /// Forty blocks of noise, with the deviation that a row has.
    fn seen(torque: impl Fn(usize) -> f64, deviation: impl Fn(usize, f64) -> f64) -> f64 {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let noise: Vec<f64> = (0..8000).map(|row| deviation(row, normal(&mut random))).collect();
        let torque: Vec<f64> = (0..8000).map(torque).collect();
        let blocks: Vec<Vec<Range<usize>>> =
            (0..40).map(|block| std::iter::once(200 * block..200 * block + 200).collect()).collect();
        overdispersion(&torque, &noise, &blocks)
    }

    #[test]
    fn noise_that_is_larger_at_the_time_of_an_event_is_seen_and_white_noise_is_not() {
        let event = |row: usize| f64::from(u8::from((1000..1100).contains(&row)));
        let is_larger = seen(event, |row, noise| noise * (1.0 + 2.0 * event(row)));
        assert!((5.0..14.0).contains(&is_larger), "{is_larger}, and 9 is true");
        let white = seen(|row| (0.01 * row as f64).sin(), |_, noise| noise);
        assert!((1.0..1.6).contains(&white), "{white}");
    }

    #[test]
    fn blocks_that_disagree_are_seen() {
        let slow = seen(|_| 1.0, |row, noise| noise + 0.5 * if row / 200 % 2 == 0 { 1.0 } else { -1.0 });
        assert!((40.0..65.0).contains(&slow), "{slow}, and 51 is true");
    }
}
