//! Which rows are worked on, in which blocks, and which blocks are locked away.

use crate::diagnose::measurement::signals::Signals;
use crate::numerics::filter::windowed_sinc::ZeroPhase;
use crate::numerics::least_squares::rows_in;
use crate::physics::JointState;
use crate::samples::SLIDING_SPEED_SHARE;
use std::ops::Range;

/// Working samples a period of the cut-off: fine enough for the transition of the filter.
pub(crate) const ROWS_PER_CUT_OFF: f64 = 2.5;
/// Least number of blocks for held-out evidence.
const LEAST_BLOCKS: usize = 10;

/// Times the reach of the filter that a part of a block has to be long for it to be sealed: what the border costs is then small.
const SEALED_OVER_REACH: usize = 3;

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

/// What a part of the recording is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Use {
    /// Fitting and search.
    Open,
    /// The decision whether a finding stands.
    Locked,
    /// Nothing but the figures that are told of the written model.
    Sealed,
}

/// Working rows with their blocks, and the parts that no row is taken from.
pub(crate) struct Division {
    /// Sample index of each working row.
    pub rows: Vec<usize>,
    /// Their blocks.
    pub blocks: Vec<Block>,
    /// Sample ranges that decide nothing.
    pub sealed: Vec<Range<usize>>,
}

/// Divides a recording. `left_out` marks samples that no row may see: where the joint sticks, or the law that it is compared with
/// was not fitted.
pub(crate) fn divide(state: &JointState, left_out: &[bool], filter: &ZeroPhase, lock: Lock) -> Division {
    let step = ((1.0 / (ROWS_PER_CUT_OFF * filter.cut_off_hz * state.period)).round() as usize).max(1);
    let reach = filter.reach();
    let pieces = pieces(state, reach, step);
    let duration = rows_in(&pieces);
    let mut division = Division { rows: Vec::new(), blocks: Vec::new(), sealed: Vec::new() };
    let mut before = 0;
    let mut last = None;
    for (index, piece) in pieces.into_iter().enumerate() {
        let mut open = Block { runs: Vec::new(), locked: false };
        let mut shut = Block { runs: Vec::new(), locked: true };
        for (part, purpose) in
            split_for_lock(&piece, reach, index, (before + piece.len() / 2) as f64 / duration as f64, lock)
        {
            // What the filter sees across a border between parts of different use belongs to neither side.
            let is_border = last
                .replace((part.end, purpose))
                .is_some_and(|(end, use_before)| end == part.start && use_before != purpose);
            let inner = part.start + if is_border { reach } else { 0 }..part.end;
            match purpose {
                Use::Sealed => division.sealed.extend(stretches_of_motion(state, left_out, inner)),
                Use::Open | Use::Locked => {
                    let runs = runs_of_motion(state, left_out, reach, inner.step_by(step), &mut division.rows);
                    if purpose == Use::Locked { &mut shut } else { &mut open }.runs.extend(runs);
                }
            }
        }
        division.blocks.extend([open, shut].into_iter().filter(|block| !block.runs.is_empty()));
        before += piece.len();
    }
    division
}

/// Parts of a block's samples with what each is for. `index` is the block's number, `middle` the place of its middle as a share of the
/// recording.
fn split_for_lock(
    piece: &Range<usize>,
    reach: usize,
    index: usize,
    middle: f64,
    lock: Lock,
) -> Vec<(Range<usize>, Use)> {
    match lock {
        Lock::Nothing => vec![(piece.clone(), Use::Open)],
        Lock::Tail(share) => {
            let purpose = if middle >= 1.0 - share { Use::Locked } else { Use::Open };
            vec![(piece.clone(), purpose)]
        }
        Lock::Spread | Lock::SpreadElsewhere => {
            // One fifth of every block, another one in each, so that every kind of motion is proved.
            let at = |tenth: usize| piece.start + piece.len() * tenth / 10;
            let first = if lock == Lock::Spread { 1 } else { 3 };
            let fifth = 2 * ((2 * index + first) % 5);
            // The tenths that decide nothing are the same whichever fifth is locked, and never inside it.
            let tenth = 2 * ((2 * index + 2) % 5);
            let sealed = tenth..tenth + sealed_tenths(piece.len(), reach, index);
            let purpose = |part: usize| match part {
                _ if sealed.contains(&part) => Use::Sealed,
                _ if part == fifth || part == fifth + 1 => Use::Locked,
                _ => Use::Open,
            };
            let mut parts: Vec<(Range<usize>, Use)> = Vec::new();
            for part in 0..10 {
                match parts.last_mut().filter(|(_, before)| *before == purpose(part)) {
                    Some((range, _)) => range.end = at(part + 1),
                    None => parts.push((at(part)..at(part + 1), purpose(part))),
                }
            }
            parts
        }
    }
}

/// Tenths of a block that are sealed: a twentieth of the recording, in as many parts as are long beside the reach of the filter, which each of
/// their borders costs. None where a fifth of a block is too short.
fn sealed_tenths(block: usize, reach: usize, index: usize) -> usize {
    let is_enough = |tenths: usize| block * tenths / 10 >= SEALED_OVER_REACH * reach;
    match index % 4 {
        1 if !is_enough(1) && is_enough(2) => 2,
        1 | 3 if is_enough(1) => 1,
        _ => 0,
    }
}

/// Stretches of a part in which the joint moves: at rest friction is anything within break-away, and no model is wrong or right.
fn stretches_of_motion(state: &JointState, left_out: &[bool], part: Range<usize>) -> Vec<Range<usize>> {
    let rests = |sample: &usize| left_out[*sample] || state.memory.at_rest[*sample];
    let samples: Vec<usize> = part.filter(|sample| !rests(sample)).collect();
    samples.chunk_by(|before, after| before + 1 == *after).map(|run| run[0]..run[run.len() - 1] + 1).collect()
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

/// Samples at which the encoder shows no motion over four milliseconds, or over as long as it takes to show that of a joint that slides, by its top
/// speed: the joint sticks, if only for a moment.
pub(crate) fn standstill(signals: &Signals, top_speed: f64) -> Vec<bool> {
    const WINDOW_S: f64 = 0.004;
    /// Steps of the encoder that tell no motion: one is rounding, and the half lies between one and two.
    const STEPS_OF_REST: f64 = 1.5;
    let still = STEPS_OF_REST * signals.position_resolution;
    let shown_s = still / (SLIDING_SPEED_SHARE * top_speed).max(f64::MIN_POSITIVE);
    let mut stuck = vec![false; signals.position.len()];
    let steps = ((WINDOW_S.max(shown_s) / signals.period).round() as usize).max(1);
    for segment in &signals.segments {
        for begin in segment.start..segment.end.saturating_sub(steps) {
            let moved = (signals.position[begin + steps] - signals.position[begin]).abs();
            if moved <= still {
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

    /// An encoder of 12 bits at 1 kHz shows a step in 3 ms of a joint that does 0.5 rad/s.
    #[test]
    fn a_joint_that_slides_does_not_stand_still_behind_a_coarse_encoder_and_one_that_is_held_does() {
        let step = std::f64::consts::TAU / 4096.0;
        let position = |i: i32| if i < 1000 { 5e-4 * f64::from(i) } else { 0.5 };
        let read = (0..2000).map(|i| (position(i) / step).round() * step).collect();
        let time = (0..2000).map(|i| 1e-3 * f64::from(i)).collect();
        let signals = Signals { position_resolution: step, ..Signals::without_gap(1e-3, time, read, vec![0.0; 2000]) };
        let stuck = standstill(&signals, 2.0);
        let share = |rows: Range<usize>| rows.clone().filter(|row| stuck[*row]).count() as f64 / rows.len() as f64;
        assert!(share(10..980) < 0.1 && share(1010..1990) == 1.0, "{} {}", share(10..980), share(1010..1990));
    }

    #[test]
    fn as_much_is_sealed_of_short_blocks_in_fewer_and_longer_parts() {
        let tenths = |block: usize| [0, 1, 2, 3, 4, 5].map(|index| sealed_tenths(block, 10, index));
        assert_eq!(tenths(300), [0, 1, 0, 1, 0, 1]);
        assert_eq!(tenths(299), [0, 2, 0, 0, 0, 2]);
        assert_eq!(tenths(149), [0; 6]);
    }
}
