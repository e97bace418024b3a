//! Which blocks are learnt from, which chosen by, and which locked: so that what is locked is new.

use std::ops::Range;

use crate::samples::Samples;
use crate::samples::blocks::{Role, Split, split_in_turn};
use crate::samples::hold_out::{motions, period};

/// Fewest locked blocks, over all turns together, by whose scatter a difference can be judged.
const LEAST_LOCKED: usize = 6;
/// From so many motions on, one fifth of them is locked in one turn.
const MOST_IN_TURN: usize = 4;
/// Every so many blocks one is chosen by.
const CHOSEN_BY: usize = 5;

/// Why nothing can be held out.
#[derive(Clone, Debug)]
pub(in crate::fit) struct Repetition {
    /// In a sentence without its full stop.
    pub(in crate::fit) sentence: String,
    /// Share of the rows that shows something new.
    pub(in crate::fit) new_share: f64,
}

/// The turns in which `pieces` (ranges of positions in `rows`) are shared out, and why nothing is locked where nothing is.
///
/// Recordings of different motions are locked as a whole: each in its turn, or a fifth of them where they are many; but blocks of each, where what is
/// left would go one way only and all together do not. Of a single motion, blocks are locked; where it repeats itself, nothing is, since every
/// block would have its twin among those learnt from.
pub(in crate::fit) fn take(
    samples: &Samples,
    rows: &[usize],
    pieces: &[Range<usize>],
    correlation: usize,
) -> (Vec<Split>, Option<Repetition>) {
    let numbers = motions(samples);
    let of = |piece: &Range<usize>| {
        let row = rows.get(piece.start).copied().unwrap_or(0);
        let recording = samples.recordings.iter().position(|(_, range)| range.contains(&row));
        recording.map_or(0, |recording| numbers[recording])
    };
    let motion_of: Vec<usize> = pieces.iter().map(of).collect();
    let count = motion_of.iter().max().map_or(0, |most| most + 1);
    if count > 1 {
        let turns = if count > MOST_IN_TURN {
            vec![by_motion(pieces, &motion_of)]
        } else {
            (0..count).map(|held| without(pieces, &motion_of, held)).collect()
        };
        let all = Split { train: pieces.to_vec(), ..Split::default() };
        let goes_both_ways = |split: &Split| goes_both_ways(samples, rows, split);
        if !goes_both_ways(&all) || turns.iter().all(goes_both_ways) {
            return (turns, None);
        }
    } else if let Some(reason) = repetition(samples) {
        let none = vec![1; pieces.len()];
        return (vec![without(pieces, &none, 0)], Some(reason));
    }
    let needed = LEAST_LOCKED.div_ceil((pieces.len() / CHOSEN_BY).max(1)).clamp(1, CHOSEN_BY);
    let mut turns: Vec<Split> = (0..needed).map(|turn| split_in_turn(pieces, correlation, turn)).collect();
    turns.retain(|split| !split.train.is_empty() && !split.locked.is_empty());
    if turns.is_empty() {
        let none = vec![1; pieces.len()];
        return (
            vec![without(pieces, &none, 0)],
            Some(Repetition { sentence: "The recording is too short to hold anything out".to_owned(), new_share: 1.0 }),
        );
    }
    (turns, None)
}

/// Whether the rows that are learnt from go in both directions.
fn goes_both_ways(samples: &Samples, rows: &[usize], split: &Split) -> bool {
    let Some(velocity) = samples.velocity.as_deref() else { return true };
    let goes = |way: f64| split.train.iter().cloned().flatten().any(|row| way * velocity[rows[row]] > 0.0);
    goes(1.0) && goes(-1.0)
}

fn repetition(samples: &Samples) -> Option<Repetition> {
    let [(_, rows)] = &samples.recordings[..] else {
        let sentence = "All recordings show the same motion, so nothing new can be held out".to_owned();
        return Some(Repetition { sentence, new_share: 1.0 / samples.recordings.len() as f64 });
    };
    let period = period(samples, rows)? as f64;
    let every = samples.rate_hz.map_or_else(|| format!("{period} samples"), |rate| format!("{:.3} s", period / rate));
    let sentence = format!("The motion repeats itself every {every}, so nothing new can be held out");
    Some(Repetition { sentence, new_share: period / rows.len() as f64 })
}

/// One motion locked, of the blocks of the others every fifth chosen by.
fn without(pieces: &[Range<usize>], motion_of: &[usize], held: usize) -> Split {
    let mut split = Split::default();
    let mut open = 0;
    for (piece, motion) in pieces.iter().zip(motion_of) {
        if *motion == held {
            split.locked.push(piece.clone());
            continue;
        }
        open += 1;
        let role = if open % CHOSEN_BY == CHOSEN_BY - 1 { &mut split.validation } else { &mut split.train };
        role.push(piece.clone());
    }
    split
}

/// Of every five motions one is locked and one chosen by.
fn by_motion(pieces: &[Range<usize>], motion_of: &[usize]) -> Split {
    let mut split = Split::default();
    for (piece, motion) in pieces.iter().zip(motion_of) {
        match Role::in_turn(*motion, 0) {
            Role::Train => split.train.push(piece.clone()),
            Role::Validation => split.validation.push(piece.clone()),
            Role::Locked => split.locked.push(piece.clone()),
        }
    }
    split
}

/// Positions in the rows that are not locked: training and validation.
pub(in crate::fit) fn open(split: &Split) -> Vec<usize> {
    let mut open: Vec<usize> = split.train.iter().chain(&split.validation).cloned().flatten().collect();
    open.sort_unstable();
    open
}
