//! The numbers of every column in SI. A column of text that is no standard quantity stays text only.

use super::Channel;
use super::clock::{self, Reading};
use super::columns::{Assigned, Assignment, joint_side_factor};
use super::merged;
use super::quantity::Quantity;
use super::table::RawTable;
use crate::error::{Error, Result, codes};
use crate::joint::Joint;

/// Least share of its rows that a column is missing from where a table merges topics of different times: of two of them one has
/// half of the stamps at most.
const MERGED_SHARE: f64 = 0.5;

/// Channels in SI.
pub(super) struct Converted {
    pub(super) channels: Vec<Channel>,
    /// The rows that the channels are of, where the table merges topics of different times.
    pub(super) rows: Option<Vec<usize>>,
    pub(super) notes: Vec<String>,
}

/// Reads the numbers of every column.
///
/// # Errors
/// `FRK-D005` and `FRK-D006` with row, column and value where a standard quantity is no number; `FRK-D014` for a missing parameter.
pub(super) fn convert(raw: &mut RawTable, assigned: &Assigned, joint: &Joint) -> Result<Converted> {
    let columns = &assigned.columns;
    let rows = raw.table.len();
    let is_time = |column: &Assignment| column.known.is_some_and(|known| known.quantity == Quantity::Time);
    let by_ticks = assigned.reading != Reading::Number;
    let told_by_ticks = |column: &Assignment| by_ticks && is_time(column);
    let refused = refused(raw, columns, told_by_ticks)?;
    let known = || columns.iter().filter(|column| column.known.is_some() && !told_by_ticks(column));
    let missing = |column: &Assignment| raw.numbers[column.index].missing;
    let is_merged = known().any(|column| missing(column) as f64 >= MERGED_SHARE * rows as f64);
    let gap_in_clock = known().any(|column| is_time(column) && missing(column) > 0);
    let has_clock = columns.iter().any(is_time);
    if let Some(error) = refused.filter(|_| !is_merged || gap_in_clock || !has_clock) {
        return Err(error);
    }
    let mut long_clock = match columns.iter().find(|column| is_time(column)) {
        Some(column) => long_clock(raw, column, assigned.reading, joint)?,
        None => None,
    };
    let numbers = std::mem::take(&mut raw.numbers);
    let mut converted = Converted { channels: Vec::new(), rows: None, notes: Vec::new() };
    for (column, numbers) in columns.iter().zip(numbers) {
        let name = &raw.table.header()[column.index];
        let dropped = numbers.values.len() < rows
            || numbers.is_text
            || (numbers.missing > 0 && !is_merged)
            || numbers.missing == rows;
        if name.is_empty() || (column.known.is_none() && dropped) {
            continue;
        }
        let Some(known) = column.known else {
            converted.channels.push(Channel {
                quantity: None,
                name: name.clone(),
                column: name.clone(),
                unit: "",
                column_unit: String::new(),
                si_per_column_unit: 1.0,
                values: numbers.values,
            });
            continue;
        };
        let factor = joint_side_factor(&known, name, joint)?;
        let mut values = numbers.values;
        for value in &mut values {
            *value = *value * factor + known.unit.offset;
        }
        if let Some((seconds, relative)) = is_time(column).then(|| long_clock.take()).flatten() {
            values = seconds;
            converted.notes.extend(relative.then(|| "the time is counted from the first row".to_owned()));
        }
        converted.channels.push(Channel {
            quantity: Some(known.quantity),
            name: known.quantity.name().to_owned(),
            column: name.clone(),
            unit: known.unit.si,
            column_unit: known.unit.suffix.to_owned(),
            si_per_column_unit: factor,
            values,
        });
    }
    if is_merged {
        let kept = merged::onto_one_clock(&mut converted.channels)?;
        converted.notes.push(format!(
            "columns of different times were brought to those of one: {} of {rows} rows are used",
            kept.len()
        ));
        converted.rows = Some(kept);
    }
    Ok(converted)
}

/// The first cell of a known column that is missing; an error where one is text. Columns to be passed over may hold anything.
fn refused(raw: &RawTable, columns: &[Assignment], pass_over: impl Fn(&Assignment) -> bool) -> Result<Option<Error>> {
    let known = || columns.iter().filter(|column| column.known.is_some() && !pass_over(column));
    let numbers = |column: &Assignment| &raw.numbers[column.index];
    let first = known().filter_map(|column| numbers(column).refused.as_ref().map(|(line, text)| (*line, column, text)));
    let first = first.min_by_key(|(line, column, _)| (*line, column.index));
    let error = first.map(|(line, column, text)| raw.refusal(text, line, &raw.table.header()[column.index]));
    match error {
        Some(error) if known().any(|column| numbers(column).is_text) => Err(error),
        other => Ok(other),
    }
}

/// The time (s) where a double would have lost digits of it, counted from the first row, or where it is no plain number; whether it is so counted.
fn long_clock(
    raw: &RawTable,
    column: &Assignment,
    reading: Reading,
    joint: &Joint,
) -> Result<Option<(Vec<f64>, bool)>> {
    let (index, name) = (column.index, &raw.table.header()[column.index]);
    let Some(known) = column.known else { return Ok(None) };
    let factor = joint_side_factor(&known, name, joint)?;
    let first = raw.numbers[index].values.first();
    if reading == Reading::Number && first.is_none_or(|first| (first * factor).abs() < clock::LONG_AGO_S) {
        return Ok(None);
    }
    let mut ticks = Vec::with_capacity(raw.table.len());
    for row in 0..raw.table.len() {
        match clock::ticks(raw, row, index, reading) {
            Some(tick) => ticks.push(tick),
            // A number that no clock counts to; the checks will say so.
            None if reading == Reading::Number => return Ok(None),
            None => {
                let error = Error::new(&codes::NOT_A_NUMBER, "this is not a time").at_row(raw.table.line(row));
                return Err(error.in_column(name).with_value(raw.table.cell(row, index)));
            }
        }
    }
    Ok(Some(clock::seconds(&ticks, factor, reading)))
}
