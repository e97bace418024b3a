//! Glitches of a line or a converter: one to three rows in which a channel leaves its neighbours and comes back.

use crate::numerics::statistics::quantile;
use crate::recording::{Quantity, Recording};
use std::borrow::Cow;
use std::ops::Range;

/// Rows that a glitch lasts at most.
const LONGEST: usize = 3;
/// Rows to each side on which the usual bend, the second difference of three rows, is taken.
const AROUND: usize = 50;
/// Share of those bends that are smaller than the usual one.
const USUAL: f64 = 0.9;
/// Height of a glitch over the usual bend at least, which noise reaches with a quarter of that.
const NO_NOISE: f64 = 4.0;
/// Differences of the rows in a glitch, and between the line across it and the series that comes in or goes on, over its height,
/// at most: it leaves all at once and comes back to where it left.
const UNEVEN: f64 = 0.2;
/// Share of the largest value up to which equal values may lie apart once they are printed with few digits.
pub(crate) const PRINTED: f64 = 1e-6;
/// Rows to each side in which the joint must not turn or rest, and its speed there over that of the fastest at least.
const MOVING: usize = 6;
const SLOW: f64 = 0.05;
/// Share of the rows from which it is no accident of the recording.
const TOO_MANY: f64 = 0.01;

/// Rows of a channel that were glitches.
#[derive(Clone, Debug, PartialEq)]
pub struct Spikes {
    /// Name of the channel.
    pub channel: String,
    /// Number of rows.
    pub rows: usize,
    /// Time of the largest, in s.
    pub time_s: f64,
    /// By how much it leaves its neighbours, in the channel's SI unit.
    pub height: f64,
    /// That unit.
    pub unit: &'static str,
}

/// The recording with the glitches of actuator and position replaced by a straight line between their neighbours. Without a
/// clock and a position it stays as it is.
#[must_use]
pub fn without_spikes(recording: &Recording) -> (Cow<'_, Recording>, Vec<Spikes>) {
    let mut clean = Cow::Borrowed(recording);
    let (Some(time), Some(position)) = (recording.values(Quantity::Time), recording.values(Quantity::Position)) else {
        return (clean, Vec::new());
    };
    let mut found = Vec::new();
    let mut clear = |quantity, spikes: Vec<Spike>| {
        let Some(largest) = spikes.iter().max_by(|a, b| a.height.abs().total_cmp(&b.height.abs())) else { return };
        let channels = &mut clean.to_mut().channels;
        let Some(channel) = channels.iter_mut().find(|channel| channel.quantity == Some(quantity)) else { return };
        found.push(Spikes {
            channel: channel.name.clone(),
            rows: spikes.iter().map(|spike| spike.rows.len()).sum(),
            time_s: time[largest.rows.start],
            height: largest.height,
            unit: channel.unit,
        });
        spikes.iter().for_each(|spike| bridge(&mut channel.values, &spike.rows));
    };
    clear(Quantity::Position, spikes(position, |_| 0.0));
    let actuator = recording.actuator().or_else(|| recording.separated_friction());
    if let Some((quantity, values)) = actuator.and_then(|channel| Some((channel.quantity?, &channel.values))) {
        // Where the joint turns or rests, friction turns or breaks away within a row; a glitch is what goes beyond all torques.
        let span = quantile(values.iter().copied(), 0.98) - quantile(values.iter().copied(), 0.02);
        let travel = |from: usize, to: usize| position[to.min(position.len() - 1)] - position[from];
        let far = quantile((0..position.len()).map(|row| travel(row, row + MOVING).abs()), USUAL);
        let moves = |row: usize| {
            let (before, after) = (travel(row.saturating_sub(MOVING), row), travel(row, row + MOVING));
            before * after > 0.0 && before.abs().min(after.abs()) > SLOW * far
        };
        clear(quantity, spikes(values, |row| if moves(row) { 0.0 } else { span }));
    }
    (clean, found)
}

/// Rows that leave those beside them, and by how much.
struct Spike {
    rows: Range<usize>,
    height: f64,
}

/// The glitches of a series of which each is higher than `least` at its row; none where they are too many to be accidents.
fn spikes(values: &[f64], least: impl Fn(usize) -> f64) -> Vec<Spike> {
    let bends: Vec<f64> = values.windows(3).map(|rows| (rows[0] - 2.0 * rows[1] + rows[2]).abs()).collect();
    let dust = PRINTED * values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs()));
    // A step of a coarse converter, up and down again, is no glitch.
    let smallest = bends.iter().copied().filter(|bend| *bend > dust).fold(f64::INFINITY, f64::min);
    let usual_of = |bends: &[f64]| quantile(bends.iter().copied(), USUAL).max(smallest);
    let usual = usual_of(&bends);
    let mut found: Vec<Spike> = Vec::new();
    let mut row = 1;
    while row + 1 < values.len() {
        // More than half of its height lies between its first row and the row before: most rows are done with that.
        if (values[row] - values[row - 1]).abs() <= 0.5 * NO_NOISE * usual {
            row += 1;
            continue;
        }
        let spike = (row + 1..(row + LONGEST + 1).min(values.len())).find_map(|end| {
            let height = height(values, row..end)?;
            let around = row.saturating_sub(AROUND)..(row + AROUND).min(bends.len());
            let is_high = |usual: f64| height.abs() > NO_NOISE * usual;
            let is_spike = height.abs() > least(row) && is_high(usual) && is_high(usual_of(&bends[around]));
            is_spike.then_some(Spike { rows: row..end, height })
        });
        row = spike.as_ref().map_or(row, |spike| spike.rows.end) + 1;
        found.extend(spike);
    }
    let rows: usize = found.iter().map(|spike| spike.rows.len()).sum();
    if rows as f64 > TOO_MANY * values.len() as f64 { Vec::new() } else { found }
}

/// By how much rows leave the straight line between the row before and the row after, where they leave it alike and beyond both
/// ends, and where the series comes in or goes on along that line.
fn height(values: &[f64], rows: Range<usize>) -> Option<f64> {
    let line = line(values, &rows);
    let off = |row: usize| Some(values.get(row)? - line(row));
    let inside = || rows.clone().filter_map(off);
    let (low, high) = (inside().fold(f64::INFINITY, f64::min), inside().fold(f64::NEG_INFINITY, f64::max));
    let height = if low > 0.0 { low } else { high };
    let beside = [rows.start.checked_sub(2), Some(rows.end + 1)].into_iter().flatten().filter_map(off);
    let beside = beside.map(f64::abs).fold(f64::INFINITY, f64::min);
    // A curve that bends leaves a line as well, but not both of its ends.
    let neighbours = [values[rows.start - 1], values[rows.end]];
    let leaves =
        rows.clone().all(|row| neighbours.iter().all(|end| (values[row] - end) * height.signum() > 0.5 * height.abs()));
    (low * high > 0.0 && leaves && beside.max(high - low) < UNEVEN * height.abs()).then_some(height)
}

/// The straight line between the row before and the row after.
fn line(values: &[f64], rows: &Range<usize>) -> impl Fn(usize) -> f64 + use<> {
    let (first, before, after) = (rows.start - 1, values[rows.start - 1], values[rows.end]);
    let slope = (after - before) / (rows.len() + 1) as f64;
    move |row| before + slope * (row as f64 - first as f64)
}

/// Replaces rows by that line.
fn bridge(values: &mut [f64], rows: &Range<usize>) {
    let line = line(values, rows);
    rows.clone().for_each(|row| values[row] = line(row));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;
    use crate::recording::parse;

    /// A joint that swings to and fro, with friction and noise; `torque_beside` comes on top, row by row.
    fn swinging(torque_beside: impl Fn(usize) -> f64, position_beside: impl Fn(usize) -> f64) -> Recording {
        let mut noise = 1u64;
        let rows: String = (0..2000)
            .map(|row| {
                let phase = 0.01 * row as f64;
                noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let disturbance = 0.1 * ((noise >> 11) as f64 / (1u64 << 53) as f64 - 0.5);
                let torque = 2.0 * phase.cos().signum() + phase.cos() + disturbance + torque_beside(row);
                let position = (phase.sin() / 1e-4).round() * 1e-4 + position_beside(row);
                format!("{},{position},{torque}\n", row as f64 / 500.0)
            })
            .collect();
        parse("swing.csv", format!("time_s,position_rad,torque_Nm\n{rows}").as_bytes(), &Joint::default()).unwrap()
    }

    fn within(rows: Range<usize>, height: f64) -> impl Fn(usize) -> f64 {
        move |row| if rows.contains(&row) { height } else { 0.0 }
    }

    #[test]
    fn up_to_three_rows_that_leave_and_come_back_are_replaced() {
        for (rows, height) in [(200..201, 1.5), (900..903, -1.5), (700..702, 65_535.0)] {
            let recording = swinging(within(rows.clone(), height), |_| 0.0);
            let (clean, found) = without_spikes(&recording);
            let [spikes] = found.as_slice() else { panic!("{found:?}") };
            assert_eq!((spikes.channel.as_str(), spikes.rows, spikes.unit), ("torque", rows.len(), "Nm"));
            assert!((spikes.height - height).abs() < 0.2 && spikes.time_s == rows.start as f64 / 500.0, "{spikes:?}");
            let torque = &clean.actuator().unwrap().values;
            assert!(rows.clone().all(|row| (torque[row] - torque[rows.start - 1]).abs() < 0.2));
        }
        let recording = swinging(|_| 0.0, within(400..401, 3.0));
        let (clean, found) = without_spikes(&recording);
        assert_eq!((found.len(), found[0].channel.as_str()), (1, "position"));
        assert!((clean.values(Quantity::Position).unwrap()[400] - 4.0_f64.sin()).abs() < 1e-3);
    }

    #[test]
    fn what_a_joint_does_stays_as_it_is() {
        // A step, a slope with flanks, four rows, and a peak as the joint turns that stays within all torques.
        let flanks = |row: usize| 3.0 - 1.5 * (row as f64 - 200.0).abs();
        let flanks = move |row| flanks(row).max(0.0);
        let turning = 157..158;
        let cases: [Box<dyn Fn(usize) -> f64>; 5] = [
            Box::new(|_| 0.0),
            Box::new(within(700..2000, 3.0)),
            Box::new(flanks),
            Box::new(within(200..204, 3.0)),
            Box::new(within(turning.clone(), 3.0)),
        ];
        for (case, torque_beside) in cases.into_iter().enumerate() {
            let recording = swinging(torque_beside, |_| 0.0);
            let (clean, found) = without_spikes(&recording);
            assert!(found.is_empty() && clean.channels == recording.channels, "{case}: {found:?}");
        }
        let (_, found) = without_spikes(&swinging(within(turning, 30.0), |_| 0.0));
        assert_eq!(found.len(), 1, "beyond all torques");
    }

    #[test]
    fn a_step_of_a_coarse_converter_up_and_down_again_is_no_glitch() {
        let step = 0.533_333_333;
        let stepping = |row: usize| (3.0 * (0.01 * row as f64).cos() / step).round() + f64::from(row % 97 == 50);
        // Printed with eight decimals, so that equal steps differ by a rounding.
        let values: Vec<f64> = (0..4000).map(|row| (stepping(row) * step * 1e8).round() * 1e-8).collect();
        assert!(spikes(&values, |_| 0.0).is_empty());
    }

    #[test]
    fn too_many_are_no_accidents() {
        let every_fiftieth = |row: usize| if row % 50 == 20 { 9.0 } else { 0.0 };
        assert!(without_spikes(&swinging(every_fiftieth, |_| 0.0)).1.is_empty());
    }
}
