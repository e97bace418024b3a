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

/// Numbers as they stand in the file; not finite where the cell is empty or says so.
#[derive(Default)]
struct Numbers {
    values: Vec<f64>,
    missing: usize,
    is_text: bool,
}

/// Reads the numbers of every column.
///
/// # Errors
/// `FRK-D005` and `FRK-D006` with row, column and value where a standard quantity is no number; `FRK-D014` for a missing parameter.
pub(super) fn convert(raw: &RawTable, assigned: &Assigned, joint: &Joint) -> Result<Converted> {
    let columns = &assigned.columns;
    let rows = raw.table.len();
    let is_time = |column: &Assignment| column.known.is_some_and(|known| known.quantity == Quantity::Time);
    let by_ticks = assigned.reading != Reading::Number;
    let (numbers, refused) = numbers(raw, columns, |column| by_ticks && is_time(column))?;
    let known = || columns.iter().zip(&numbers).filter(|(column, _)| column.known.is_some());
    let is_merged = known().any(|(_, numbers)| numbers.missing as f64 >= MERGED_SHARE * rows as f64);
    let gap_in_clock = known().any(|(column, numbers)| is_time(column) && numbers.missing > 0);
    let has_clock = columns.iter().any(is_time);
    if let Some(error) = refused.filter(|_| !is_merged || gap_in_clock || !has_clock) {
        return Err(error);
    }
    let mut converted = Converted { channels: Vec::new(), rows: None, notes: Vec::new() };
    for (column, numbers) in columns.iter().zip(numbers) {
        let name = &raw.table.header()[column.index];
        let dropped = numbers.is_text || (numbers.missing > 0 && !is_merged) || numbers.missing == rows;
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
        if is_time(column) {
            let relative = take_long_clock(&mut values, raw, column.index, assigned.reading, factor)?;
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

/// The numbers of the columns that are not to be passed over, and the first cell of a known one that is missing.
fn numbers(
    raw: &RawTable,
    columns: &[Assignment],
    pass_over: impl Fn(&Assignment) -> bool,
) -> Result<(Vec<Numbers>, Option<Error>)> {
    let mut numbers: Vec<Numbers> = Vec::new();
    numbers.resize_with(columns.len(), Numbers::default);
    let passed: Vec<bool> = columns.iter().map(pass_over).collect();
    let mut first = None;
    for row in 0..raw.table.len() {
        for (index, field) in raw.table.row(row).enumerate() {
            let (column, list) = (&columns[index], &mut numbers[index]);
            if list.is_text {
                continue;
            }
            if passed[index] {
                list.values.push(0.0);
                continue;
            }
            match raw.number(field, row, &raw.table.header()[index]) {
                Ok(number) => list.values.push(number),
                Err(error) => {
                    let missing = field.is_empty() || error.code() == &codes::NOT_FINITE;
                    list.is_text = !missing;
                    list.missing += usize::from(missing);
                    list.values.push(f64::NAN);
                    if column.known.is_some() {
                        let first = first.get_or_insert(error);
                        if !missing {
                            return Err(first.clone());
                        }
                    }
                }
            }
        }
    }
    Ok((numbers, first))
}

/// Puts the time in place that a double would have lost digits of, counted from the first row, or that is no plain number.
fn take_long_clock(values: &mut Vec<f64>, raw: &RawTable, index: usize, reading: Reading, factor: f64) -> Result<bool> {
    if reading == Reading::Number && values.first().is_none_or(|first| first.abs() < clock::LONG_AGO_S) {
        return Ok(false);
    }
    let mut ticks = Vec::with_capacity(raw.table.len());
    for row in 0..raw.table.len() {
        match clock::ticks(raw, row, index, reading) {
            Some(tick) => ticks.push(tick),
            // A number that no clock counts to; the checks will say so.
            None if reading == Reading::Number => return Ok(false),
            None => {
                let error = Error::new(&codes::NOT_A_NUMBER, "this is not a time").at_row(raw.table.line(row));
                return Err(error.in_column(&raw.table.header()[index]).with_value(raw.table.cell(row, index)));
            }
        }
    }
    let (seconds, from_first) = clock::seconds(&ticks, factor, reading);
    *values = seconds;
    Ok(from_first)
}
