//! A table that merges topics of different times, each row holding the cells of one of them: brought onto the times of one topic.

use super::health::GAP_PERIODS;
use super::quantity::Quantity;
use super::{Channel, MINIMUM_ROWS};
use crate::error::{Error, Result, codes};

/// The topic whose times are kept, the first that is recorded: what is measured least often is hardest to interpolate.
const LEADING: [Quantity; 7] = [
    Quantity::FrictionTorque,
    Quantity::FrictionForce,
    Quantity::Torque,
    Quantity::Force,
    Quantity::Current,
    Quantity::Position,
    Quantity::Velocity,
];

/// Brings every channel to the times at which the leading one is known, by lines between neighbours; values that are missing are not
/// finite. Gives the rows that are kept: those around which everything that moves is known.
///
/// # Errors
/// `FRK-D002` where hardly any are left.
pub(super) fn onto_one_clock(channels: &mut [Channel]) -> Result<Vec<usize>> {
    let values =
        |wanted| channels.iter().find(|channel| channel.quantity == Some(wanted)).map(|channel| &channel.values);
    let time = values(Quantity::Time).cloned().unwrap_or_default();
    let leading = LEADING.into_iter().find_map(values);
    let mut kept: Vec<usize> =
        (0..time.len()).filter(|row| leading.is_none_or(|values| values[*row].is_finite())).collect();
    let mut moved = Vec::with_capacity(channels.len());
    for channel in channels.iter() {
        let (lines, near) = on_lines(&time, &channel.values);
        if channel.quantity.is_some_and(|quantity| !is_slow(quantity)) {
            kept.retain(|row| near[*row]);
        }
        moved.push(lines);
    }
    if kept.len() < MINIMUM_ROWS {
        let message = "the columns have hardly any times in common: each is empty where another is not";
        return Err(Error::new(&codes::TOO_FEW_ROWS, message).with_value(kept.len().to_string()));
    }
    for (channel, lines) in channels.iter_mut().zip(moved) {
        channel.values = kept.iter().map(|row| lines[*row]).collect();
    }
    Ok(kept)
}

/// What changes slowly is held where it is not known.
fn is_slow(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::Temperature | Quantity::Voltage)
}

/// Values at every row on lines between those that are known, held before the first and after the last, and where the known ones
/// are not further apart than in a gap.
fn on_lines(time: &[f64], values: &[f64]) -> (Vec<f64>, Vec<bool>) {
    let known: Vec<usize> = (0..values.len()).filter(|row| values[*row].is_finite()).collect();
    let (Some(first), Some(last)) = (known.first(), known.last()) else {
        return (vec![0.0; values.len()], vec![false; values.len()]);
    };
    let mut steps: Vec<f64> = known.windows(2).map(|pair| time[pair[1]] - time[pair[0]]).collect();
    steps.sort_by(f64::total_cmp);
    let longest = steps.get(steps.len() / 2).map_or(0.0, |period| GAP_PERIODS * period);
    let mut lines = vec![values[*first]; values.len()];
    let mut near = vec![false; values.len()];
    lines[*last..].fill(values[*last]);
    near[*last] = true;
    for pair in known.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let span = time[to] - time[from];
        for row in from..to {
            let share = if span > 0.0 { (time[row] - time[from]) / span } else { 0.0 };
            lines[row] = if row == from { values[from] } else { values[from] + share * (values[to] - values[from]) };
            near[row] = row == from || span <= longest;
        }
    }
    // Rows with the stamp of one that is known.
    for row in 1..values.len() {
        if time[row] <= time[row - 1] && near[row - 1] && !near[row] {
            (lines[row], near[row]) = (lines[row - 1], true);
        }
    }
    for row in (1..values.len()).rev() {
        if time[row] <= time[row - 1] && near[row] && !near[row - 1] {
            (lines[row - 1], near[row - 1]) = (lines[row], true);
        }
    }
    (lines, near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_are_on_a_line_and_gaps_are_not_bridged() {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 20.0, 40.0, 40.0];
        let gap = f64::NAN;
        let (lines, near) = on_lines(&time, &[gap, 10.0, gap, 30.0, gap, 50.0, gap, 70.0, gap]);
        assert_eq!(lines[..6], [10.0, 10.0, 20.0, 30.0, 40.0, 50.0]);
        assert_eq!(near, [false, true, true, true, true, true, false, true, true]);
        assert_eq!(lines[8], 70.0);
    }
}
