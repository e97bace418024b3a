//! Contiguous blocks, long enough to be nearly independent, for training, validation and a locked proof.

use std::ops::Range;

use super::Samples;

/// A block is at least this many correlation times long (rule P4).
const CORRELATION_TIMES: usize = 10;
/// With this many recordings or more, each is one block.
const RECORDINGS_AS_BLOCKS: usize = 8;
/// Most blocks that are cut; more would only cost time.
const MOST_BLOCKS: usize = 60;
/// Five consecutive blocks share out as three for training, one for validation, one locked.
const GROUP: [Role; 5] = [Role::Train, Role::Validation, Role::Train, Role::Locked, Role::Train];

/// What a block is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Parameters are fitted on it.
    Train,
    /// Choices between models are made on it.
    Validation,
    /// Opened once, to prove the gain.
    Locked,
}

impl Role {
    /// Role of block `index`; every further of five turns locks other blocks.
    #[must_use]
    pub fn in_turn(index: usize, turn: usize) -> Self {
        // From group to group the order moves on, so that no rhythm of the motion falls together with that of the roles.
        GROUP[(index + index / GROUP.len() + turn) % GROUP.len()]
    }
}

/// Blocks of samples by role, each list in order of time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Split {
    /// Blocks for fitting.
    pub train: Vec<Range<usize>>,
    /// Blocks for choices.
    pub validation: Vec<Range<usize>>,
    /// Blocks for the proof.
    pub locked: Vec<Range<usize>>,
}

/// Rest before each segment, s: from the last sample of the one before to its first; 0 before the first segment and without a
/// clock (empty `time`).
#[must_use]
pub fn rests(time: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
    let ends = std::iter::once(None).chain(segments.iter().map(|segment| segment.end.checked_sub(1)));
    let rest = |(segment, end): (&Range<usize>, Option<usize>)| Some(time.get(segment.start)? - time.get(end?)?);
    segments.iter().zip(ends).map(|pair| rest(pair).unwrap_or(0.0)).collect()
}

/// Correlation time of `values` in samples (at least one): the lag at which the autocorrelation, averaged over the
/// segments, falls below 1/e.
#[must_use]
pub fn correlation_time(values: &[f64], segments: &[Range<usize>]) -> usize {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let at_lag = |lag: usize| -> f64 {
        let products = segments.iter().map(|segment| {
            let part = &values[segment.clone()];
            let shifted = part.get(lag..).unwrap_or_default();
            part.iter().zip(shifted).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>()
        });
        products.sum()
    };
    let power = at_lag(0);
    let longest = segments.iter().map(Range::len).max().unwrap_or(0) / 4;
    // The lag is bracketed by doubling and then halved: autocorrelations of long recordings are costly.
    let below = |lag: usize| at_lag(lag) < power / std::f64::consts::E;
    let mut high = 1;
    while high < longest && !below(high) {
        high *= 2;
    }
    let mut low = high / 2;
    while high - low > 1 {
        let middle = low.midpoint(high);
        if below(middle) { high = middle } else { low = middle }
    }
    high.min(longest.max(1))
}

/// Cuts the samples into blocks: one a recording where there are at least eight, else contiguous pieces of at least
/// ten correlation times (given in samples); a segment shorter than that is one piece.
#[must_use]
pub fn blocks(samples: &Samples, correlation: usize) -> Vec<Range<usize>> {
    if samples.recordings.len() >= RECORDINGS_AS_BLOCKS {
        return samples.recordings.iter().map(|(_, range)| range.clone()).collect();
    }
    let shortest = (CORRELATION_TIMES * correlation).max(samples.len() / MOST_BLOCKS).max(1);
    let mut blocks = Vec::new();
    for segment in &samples.segments {
        let count = (segment.len() / shortest).max(1);
        let cut = |k: usize| segment.start + k * segment.len() / count;
        blocks.extend((0..count).map(|k| cut(k)..cut(k + 1)));
    }
    blocks
}

/// Shares blocks out: of every five consecutive ones three are for training, one for validation, one is locked, other ones in
/// each of five turns. A correlation time is dropped at both ends of validation and locked blocks that follow each other without
/// a gap.
#[must_use]
pub fn split_in_turn(blocks: &[Range<usize>], correlation: usize, turn: usize) -> Split {
    let mut split = Split::default();
    for (index, block) in blocks.iter().enumerate() {
        match Role::in_turn(index, turn) {
            Role::Train => split.train.push(block.clone()),
            Role::Validation => split.validation.push(inside(block, correlation)),
            Role::Locked => split.locked.push(inside(block, correlation)),
        }
    }
    split
}

/// The block without `margin` samples at each end, as long as most of it remains.
fn inside(block: &Range<usize>, margin: usize) -> Range<usize> {
    if block.len() > 4 * margin { block.start + margin..block.end - margin } else { block.clone() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{RngCore, SeedableRng};

    use super::*;

    #[test]
    fn a_rest_lasts_from_the_last_sample_to_the_first_of_the_next_segment() {
        let time = [0.0, 0.1, 0.2, 5.2, 5.3, 7.3];
        let segments = [0..3, 3..5, 5..6];
        assert_eq!(rests(&time, &segments), [0.0, 5.0, 2.0]);
        assert_eq!(rests(&[], &segments), [0.0; 3]);
    }

    #[test]
    fn the_correlation_time_of_a_first_order_process_is_its_time_constant() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut state = 0.0;
        let decay = (-1.0_f64 / 20.0).exp();
        let values: Vec<f64> = (0..40_000)
            .map(|_| {
                state = decay * state + (random.next_u64() as f64 / u64::MAX as f64 - 0.5);
                state
            })
            .collect();
        let lag = correlation_time(&values, &[0..20_000, 20_000..40_000]);
        assert!((15..=25).contains(&lag), "{lag}");
    }

    #[test]
    fn a_constant_or_a_short_signal_has_an_answer() {
        assert!(correlation_time(&[1.0; 10], &[0..5, 5..10]) >= 1);
        assert_eq!(correlation_time(&[], &[]), 1);
    }

    proptest! {
        #[test]
        fn every_block_has_one_role_and_each_is_locked_in_one_of_five_turns(
            count in 1..60usize, length in 1..50usize, margin in 0..20usize,
        ) {
            let blocks: Vec<Range<usize>> = (0..count).map(|k| k * length..(k + 1) * length).collect();
            let mut locked = 0;
            for turn in 0..5 {
                let shares = split_in_turn(&blocks, margin, turn);
                prop_assert_eq!(shares.train.len() + shares.validation.len() + shares.locked.len(), count);
                let mut all: Vec<_> = [&shares.train[..], &shares.validation, &shares.locked].concat();
                all.sort_by_key(|range| range.start);
                prop_assert!(all.windows(2).all(|pair| pair[0].end <= pair[1].start));
                locked += shares.locked.len();
            }
            prop_assert_eq!(locked, count);
        }
    }
}
