//! Columns that no name tells, by what they hold: a clock, and a position with its velocity.

use super::candidate::{Candidate, has, numbers, range};
use super::units;
use crate::recording::quantity::Quantity;
use crate::recording::table::RawTable;

/// Least correlation of a column with the derivative of another that makes them velocity and position. Friction alone goes with the velocity too: over
/// a sine that of a Coulomb torque is 0.90, and beside a viscous one of the same size 0.97.
const DERIVATIVE: f64 = 0.985;

/// Columns among which pairs are looked for: beyond them the file is no log of one joint.
const MOST_COLUMNS: usize = 64;

/// Adds the time, and position and velocity, where the names leave them open and the columns tell them.
pub(super) fn take(raw: &RawTable, found: &mut Vec<Candidate>) {
    let separated = has(found, &[Quantity::FrictionTorque, Quantity::FrictionForce]);
    // A law over velocity needs no time.
    if !has(found, &[Quantity::Time])
        && !separated
        && let Some(index) = clock(raw, &free(raw, found))
    {
        found.push(candidate(index, Quantity::Time, "it increases in every row".to_owned()));
    }
    let Some(time) = found.iter().find(|candidate| candidate.quantity == Quantity::Time) else { return };
    if has(found, &[Quantity::Position, Quantity::LinkPosition]) {
        return;
    }
    let (time, free) = (numbers(raw, time.index), free(raw, found));
    let velocity = found.iter().find(|candidate| candidate.quantity == Quantity::Velocity).map(|known| known.index);
    let velocities = velocity.map_or_else(|| free.clone(), |index| vec![index]);
    let Some((position, derivative)) = pair(raw, &time, &free, &velocities) else { return };
    let name = |index: usize| raw.table.header()[index].escape_debug();
    found.push(candidate(position, Quantity::Position, format!("{} is its derivative", name(derivative))));
    if velocity.is_none() {
        found.push(candidate(derivative, Quantity::Velocity, format!("the derivative of {}", name(position))));
    }
}

fn candidate(index: usize, quantity: Quantity, why: String) -> Candidate {
    Candidate { index, quantity, unit: None, scale: 1.0, by_itself: false, why }
}

/// Columns of numbers that change and that nothing was taken for.
fn free(raw: &RawTable, found: &[Candidate]) -> Vec<usize> {
    let is_free = |index: &usize| found.iter().all(|candidate| candidate.index != *index);
    let changes = |index: &usize| range(&numbers(raw, *index)).is_some_and(|[low, high]| low < high);
    (0..raw.table.header().len()).filter(is_free).filter(changes).take(MOST_COLUMNS).collect()
}

/// Whether every value is above the one before.
pub(super) fn increases(values: &[f64]) -> bool {
    values.len() > 1 && values.windows(2).all(|pair| pair[1] > pair[0])
}

/// The column that a clock is likely to be: the most even of those that increase and advance as clocks do. One that counts by ones may be a clock of 1 kHz
/// in milliseconds, or number the rows: somebody has to say it.
fn clock(raw: &RawTable, free: &[usize]) -> Option<usize> {
    let unevenness = |index: usize| {
        let values = numbers(raw, index);
        units::of_time(&values).filter(|_| increases(&values))?;
        let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let [shortest, longest] = range(&steps)?;
        (shortest != 1.0 || longest != 1.0).then_some((longest / shortest, index))
    };
    let clocks = free.iter().filter_map(|index| unevenness(*index));
    clocks.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, index)| index)
}

/// The position and the velocity that are so by each other: of a velocity and its own derivative the position is the one before both.
fn pair(raw: &RawTable, time: &[f64], positions: &[usize], velocities: &[usize]) -> Option<(usize, usize)> {
    let columns: Vec<Vec<f64>> =
        (0..raw.table.header().len())
            .map(|index| {
                if positions.contains(&index) || velocities.contains(&index) { numbers(raw, index) } else { Vec::new() }
            })
            .collect();
    let mut pairs = Vec::new();
    for &position in positions {
        let slope = units::slopes(&columns[position], time);
        for &velocity in velocities.iter().filter(|velocity| **velocity != position) {
            let correlation = units::compared(&slope, &columns[velocity]).1.abs();
            if correlation > DERIVATIVE {
                pairs.push((position, velocity, correlation));
            }
        }
    }
    let is_first = |(position, ..): &&(usize, usize, f64)| pairs.iter().all(|(_, velocity, _)| velocity != position);
    let first = pairs.iter().filter(is_first).max_by(|a, b| a.2.total_cmp(&b.2));
    first.map(|(position, velocity, _)| (*position, *velocity))
}
