//! Which rows are worked on, in which blocks, and which blocks are locked away.

use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::filter::ZeroPhase;
use crate::numerics::least_squares::rows_in;
use crate::physics::JointState;
use std::ops::Range;

/// Working samples a period of the cut-off: fine enough for the transition of the filter.
const ROWS_PER_CUT_OFF: f64 = 2.5;
/// Least number of blocks for held-out evidence.
const LEAST_BLOCKS: usize = 10;

/// Which rows are locked away from all fitting and naming.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lock {
    /// A fifth of every block, spread over the recording.
    Spread,
    /// Another fifth of every block: what happened once may have been locked away.
    SpreadElsewhere,
    /// The last share (0..1) of the recording.
    Tail(f64),
    /// Nothing is locked: proof must come from another recording.
    Nothing,
}

/// One block of consecutive working rows that belongs together in folds and proofs.
#[derive(Clone, Debug)]
pub struct Block {
    /// Runs of consecutive working rows (uninterrupted by rest or gaps).
    pub runs: Vec<Range<usize>>,
    /// Whether the block is locked away until the proof.
    pub locked: bool,
}

/// Working rows, as sample indices, and their blocks. `left_out` marks samples that no row may see: where
/// the joint sticks, or the law that it is compared with was not fitted.
pub(crate) fn rows_and_blocks(
    state: &JointState,
    left_out: &[bool],
    filter: &ZeroPhase,
    lock: Lock,
) -> (Vec<usize>, Vec<Block>) {
    let step = ((1.0 / (ROWS_PER_CUT_OFF * filter.cut_off_hz * state.period)).round() as usize).max(1);
    let reach = filter.reach();
    let pieces = pieces(state, reach, step);
    let duration = rows_in(&pieces);
    let mut rows = Vec::new();
    let mut blocks = Vec::new();
    let mut before = 0;
    let mut last = None;
    for (index, piece) in pieces.into_iter().enumerate() {
        let mut open = Block { runs: Vec::new(), locked: false };
        let mut shut = Block { runs: Vec::new(), locked: true };
        for (part, locked) in split_for_lock(&piece, index, before, duration, lock) {
            // What the filter sees across a border between open and locked samples belongs to neither side.
            let is_border = last.replace((part.end, locked)) == Some((part.start, !locked));
            let inner = part.start + if is_border { reach } else { 0 }..part.end;
            let runs = runs_of_motion(state, left_out, reach, inner.step_by(step), &mut rows);
            if locked { &mut shut } else { &mut open }.runs.extend(runs);
        }
        blocks.extend([open, shut].into_iter().filter(|block| !block.runs.is_empty()));
        before += piece.len();
    }
    (rows, blocks)
}

/// Parts of a block's samples with whether each is locked.
fn split_for_lock(
    piece: &Range<usize>,
    index: usize,
    before: usize,
    duration: usize,
    lock: Lock,
) -> Vec<(Range<usize>, bool)> {
    match lock {
        Lock::Nothing => vec![(piece.clone(), false)],
        Lock::Tail(share) => {
            let border = ((1.0 - share) * duration as f64) as usize;
            if before + piece.len() / 2 >= border { vec![(piece.clone(), true)] } else { vec![(piece.clone(), false)] }
        }
        Lock::Spread | Lock::SpreadElsewhere => {
            // One fifth of every block, another one in each, so that every kind of motion is proved.
            let at = |k: usize| piece.start + piece.len() * k / 5;
            let first = if lock == Lock::Spread { 1 } else { 3 };
            let fifth = (2 * index + first) % 5;
            [(piece.start..at(fifth), false), (at(fifth)..at(fifth + 1), true), (at(fifth + 1)..piece.end, false)]
                .into_iter()
                .filter(|(part, _)| !part.is_empty())
                .collect()
        }
    }
}

/// Adds the samples of a part that see neither standstill nor what is left out to the rows and returns their runs.
fn runs_of_motion(
    state: &JointState,
    left_out: &[bool],
    reach: usize,
    samples: impl Iterator<Item = usize>,
    rows: &mut Vec<usize>,
) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let mut begin = rows.len();
    for i in samples {
        // A row that sees standstill sees a torque that no law of motion can predict.
        let near_rest = (i - reach / 2..=i + reach / 2).any(|j| left_out[j] || state.memory.at_rest[j]);
        if !near_rest {
            rows.push(i);
            continue;
        }
        if rows.len() > begin {
            runs.push(begin..rows.len());
        }
        begin = rows.len();
    }
    if rows.len() > begin {
        runs.push(begin..rows.len());
    }
    runs
}

/// Samples at which the encoder shows no motion over four milliseconds: the joint sticks, if only for a moment.
pub(crate) fn standstill(signals: &Signals) -> Vec<bool> {
    const WINDOW_S: f64 = 0.004;
    let mut stuck = vec![false; signals.position.len()];
    let steps = ((WINDOW_S / signals.period).round() as usize).max(1);
    for segment in &signals.segments {
        for begin in segment.start..segment.end.saturating_sub(steps) {
            let moved = (signals.position[begin + steps] - signals.position[begin]).abs();
            if moved <= 1.5 * signals.position_resolution {
                stuck[begin + steps / 2..=begin + steps.div_ceil(2)].fill(true);
            }
        }
    }
    stuck
}

/// Samples at which the joint is slower than `slow` and then goes on in the same direction: whether it sticks in between, no
/// encoder tells.
pub(crate) fn hesitation(velocity: &[f64], slow: f64, segments: &[Range<usize>]) -> Vec<bool> {
    let mut hesitates = vec![false; velocity.len()];
    for segment in segments {
        let mut end = segment.start;
        for stretch in velocity[segment.clone()].chunk_by(|a, b| (a.abs() < slow) == (b.abs() < slow)) {
            let begin = end;
            end += stretch.len();
            let goes_on = || velocity[begin - 1] * velocity[end] > 0.0;
            if stretch[0].abs() < slow && begin > segment.start && end < segment.end && goes_on() {
                hesitates[begin..end].fill(true);
            }
        }
    }
    hesitates
}

/// Sample ranges of the blocks: the segments where there are enough of them, else segments cut into pieces. What the
/// filter reaches at both ends of a segment is left out.
fn pieces(state: &JointState, reach: usize, step: usize) -> Vec<Range<usize>> {
    let inner: Vec<Range<usize>> = state
        .segments
        .iter()
        .map(|s| s.start + reach + 3..s.end.saturating_sub(reach + 3))
        .filter(|s| s.end > s.start + 20 * step)
        .collect();
    if inner.len() >= LEAST_BLOCKS {
        return inner;
    }
    let total = rows_in(&inner);
    let length = (total / (LEAST_BLOCKS + 2)).max(1);
    inner
        .into_iter()
        .flat_map(|segment| {
            let count = (segment.len() as f64 / length as f64).round().max(1.0) as usize;
            (0..count).map(move |k| {
                let at = |k: usize| segment.start + segment.len() * k / count;
                at(k)..at(k + 1)
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_that_goes_on_after_a_near_stop_hesitates_and_one_that_turns_back_does_not() {
        let velocity = [0.0, 1.0, 0.1, -0.1, 1.0, 0.1, -0.1, -1.0, -0.1, -1.0, 0.0];
        let segments = [0..7, 7..11];
        let slow = hesitation(&velocity, 0.5, &segments);
        let expected = [2, 3, 8];
        assert_eq!((0..velocity.len()).filter(|&i| slow[i]).collect::<Vec<_>>(), expected);
    }
}
