//! Rows that were written twice.

use super::note::{Fault, Note};
use super::rows::{others, stretches};
use crate::numerics::resolution::resolution;
use crate::recording::{Channel, Omission, Quantity, Recording};

/// Speed, in steps of the encoder from one row to the next, above which a moving joint does not show the same position twice.
const MOVING_STEPS: f64 = 3.0;
/// Stretches of time that a note lists at most; more of them say nothing that the count does not.
const LISTED: usize = 50;

/// The recording without the rows whose stamp is that of the row before.
pub(super) fn without_repeated_stamps(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let time = recording.values(Quantity::Time)?;
    let rows: Vec<usize> = (1..time.len()).filter(|row| time[*row] <= time[*row - 1]).collect();
    let equal = rows.iter().filter(|row| is_equal(recording, **row)).count();
    let fault = if equal == rows.len() {
        Fault::RepeatedRows { rows: rows.len() }
    } else {
        Fault::RepeatedStamps { rows: rows.len() }
    };
    left_out(recording, &rows, fault)
}

/// The recording without the rows that repeat position, velocity and torque of the row before while the joint moves: a logger that
/// was not served in time.
pub(super) fn without_repeated_rows(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let position = recording.values(Quantity::Position)?;
    recording.actuator().or_else(|| recording.separated_friction())?;
    let fast = MOVING_STEPS * resolution(position).unwrap_or(0.0);
    // On to the same side before and after: where a joint turns round it is twice at one place.
    let moves = |row: usize| {
        let step = |to: usize| position[to] - position[to - 1];
        row >= 2
            && row + 1 < position.len()
            && step(row - 1).abs().min(step(row + 1).abs()) > fast
            && step(row - 1) * step(row + 1) > 0.0
    };
    let rows: Vec<usize> = (1..position.len())
        .filter(|row| position[*row] == position[row - 1] && moves(*row) && is_equal(recording, *row))
        .collect();
    left_out(recording, &rows, Fault::RepeatedRows { rows: rows.len() })
}

fn left_out(recording: &Recording, rows: &[usize], fault: Fault) -> Option<(Option<Recording>, Note)> {
    if rows.is_empty() {
        return None;
    }
    let mended = recording.clone().with_rows(&others(recording.len(), rows), Omission::Bridged);
    let mut when_s = stretches(recording, rows);
    if when_s.len() > LISTED {
        when_s.clear();
    }
    Some((Some(mended), Note { fault, when_s }))
}

/// Whether a row has the same standard quantities, other than time, as the row before.
fn is_equal(recording: &Recording, row: usize) -> bool {
    let compared = |channel: &&Channel| channel.quantity.is_some_and(|quantity| quantity != Quantity::Time);
    recording.channels.iter().filter(compared).all(|channel| channel.values[row] == channel.values[row - 1])
}
