//! Which column is which quantity, and its values in SI on the joint side.

use super::Channel;
use super::quantity::{Axis, ColumnName, Quantity, Unit, read_column_name};
use super::table::TextTable;
use super::text::RawTable;
use crate::error::{Error, Result, codes};
use crate::joint::{Joint, Side};

/// What a column of the file is taken for.
pub(super) struct Assignment {
    index: usize,
    known: Option<Known>,
}

#[derive(Clone, Copy)]
struct Known {
    quantity: Quantity,
    unit: &'static Unit,
    side: Side,
    scale: f64,
}

/// The columns of a file with what was noticed on the way.
pub(super) struct Assigned {
    pub(super) columns: Vec<Assignment>,
    pub(super) axis: Axis,
    /// Columns named as a quantity whose unit is not understood; an error only where the quantity is needed.
    pub(super) unusable: Vec<(Quantity, String)>,
    pub(super) notes: Vec<String>,
}

/// Decides what each column is: `[columns]` of `joint.toml` first, then its own name.
pub(super) fn assign(table: &TextTable, joint: &Joint) -> Result<Assigned> {
    let header = table.header();
    let mut columns: Vec<Assignment> = Vec::new();
    let mut unusable = Vec::new();
    let mapped = mapped_columns(header, joint)?;
    for (index, name) in header.iter().enumerate() {
        let known = match mapped.iter().find(|(column, _)| *column == index) {
            Some((_, known)) => Some(*known),
            None => match read_column_name(name) {
                // A mapped column takes the place of one that has the quantity's own name.
                ColumnName::Known(quantity, _) | ColumnName::UnknownUnit(quantity)
                    if mapped.iter().any(|(_, known)| known.quantity == quantity) =>
                {
                    None
                }
                ColumnName::Known(quantity, unit) => Some(Known { quantity, unit, side: Side::Joint, scale: 1.0 }),
                ColumnName::UnknownUnit(quantity) => {
                    unusable.push((quantity, name.clone()));
                    None
                }
                ColumnName::Other => None,
            },
        };
        if let Some(known) = known {
            refuse_second(&columns, header, known.quantity, name)?;
        }
        columns.push(Assignment { index, known });
    }
    if columns.iter().all(|column| column.known.is_none()) {
        if let Some((quantity, column)) = unusable.first() {
            return Err(unknown_unit(*quantity, column));
        }
        let message = "no column is named <quantity>_<unit>, as in time_s, position_rad, torque_Nm";
        return Err(Error::new(&codes::NO_KNOWN_COLUMN, message).at_row(1).with_value(header.join(",")));
    }
    // A quantity whose unit is not understood must not be replaced silently by a derived one.
    let recorded = |wanted| columns.iter().any(|column| column.known.is_some_and(|known| known.quantity == wanted));
    if let Some((quantity, column)) = unusable.iter().find(|(quantity, _)| !recorded(*quantity)) {
        return Err(unknown_unit(*quantity, column));
    }
    let notes = unusable
        .iter()
        .map(|(quantity, column)| {
            format!("column {column} is kept as a named channel: {} has its own", quantity.name())
        })
        .collect();
    let axis = axis_of(&columns, header)?;
    Ok(Assigned { columns, axis, unusable, notes })
}

/// The error of a column whose unit is not one of its quantity.
pub(super) fn unknown_unit(quantity: Quantity, column: &str) -> Error {
    let unit = column.strip_prefix(quantity.name()).map_or("", |rest| rest.trim_start_matches('_'));
    let message = if unit.is_empty() {
        format!("the name of this column has to end in its unit, one of: {}", quantity.suffixes())
    } else {
        format!("this is not a unit of {}, which are: {}", quantity.name(), quantity.suffixes())
    };
    Error::new(&codes::UNKNOWN_UNIT, message).at_row(1).in_column(column).with_value(unit)
}

fn mapped_columns(header: &[String], joint: &Joint) -> Result<Vec<(usize, Known)>> {
    let mut mapped: Vec<(usize, Known)> = Vec::new();
    for (key, mapping) in &joint.columns {
        let Some(quantity) = Quantity::from_name(key) else {
            let names: Vec<&str> = Quantity::ALL.iter().map(|(_, name)| *name).collect();
            let message = format!("the columns that joint.toml maps are of: {}", names.join(", "));
            return Err(Error::new(&codes::BAD_JOINT_FILE, message).with_value(key));
        };
        let suffix = mapping.unit.as_deref().unwrap_or(quantity.units()[0].suffix);
        let Some(unit) = quantity.unit(suffix) else {
            let message = format!("this is not a unit of {key}, which are: {}", quantity.suffixes());
            return Err(Error::new(&codes::UNKNOWN_UNIT, message).in_column(&mapping.name).with_value(suffix));
        };
        let Some(index) = header.iter().position(|name| *name == mapping.name) else {
            if mapping.may_be_absent {
                continue;
            }
            let message = format!("joint.toml maps {key} to a column that the recording does not have");
            return Err(Error::new(&codes::MISSING_COLUMN, message).at_row(1).in_column(&mapping.name));
        };
        mapped.push((index, Known { quantity, unit, side: mapping.side, scale: mapping.scale }));
    }
    Ok(mapped)
}

fn refuse_second(columns: &[Assignment], header: &[String], quantity: Quantity, name: &str) -> Result<()> {
    let first = columns.iter().find(|column| column.known.is_some_and(|known| known.quantity == quantity));
    match first {
        None => Ok(()),
        Some(first) => {
            let message = format!("this column and {} both give the {}", header[first.index], quantity.name());
            Err(Error::new(&codes::DUPLICATE_COLUMN, message).at_row(1).in_column(name))
        }
    }
}

/// Rotary unless a position or velocity is linear; without either, a force means linear.
fn axis_of(columns: &[Assignment], header: &[String]) -> Result<Axis> {
    let mut found: Option<(Axis, usize)> = None;
    for column in columns {
        let Some(axis) = column.known.and_then(|known| known.unit.axis) else { continue };
        match found {
            Some((first, index)) if first != axis => {
                let message = format!("this column and {} belong to axes of different kinds", header[index]);
                return Err(Error::new(&codes::MIXED_AXIS, message).at_row(1).in_column(&header[column.index]));
            }
            Some(_) => {}
            None => found = Some((axis, column.index)),
        }
    }
    let force = columns.iter().filter_map(|column| column.known).any(|known| known.unit.si == "N");
    Ok(found.map_or(if force { Axis::Linear } else { Axis::Rotary }, |(axis, _)| axis))
}

/// Numbers of every column in SI; a column of text that is no standard quantity stays text only.
pub(super) fn convert(raw: &RawTable, columns: &[Assignment], joint: &Joint) -> Result<Vec<Channel>> {
    let mut channels = Vec::new();
    let width = raw.table.header().len();
    let mut numbers: Vec<Option<Vec<f64>>> = vec![Some(Vec::with_capacity(raw.table.len())); width];
    for row in 0..raw.table.len() {
        for ((field, values), column) in raw.table.row(row).zip(&mut numbers).zip(columns) {
            let Some(list) = values else { continue };
            match raw.number(field, row, &raw.table.header()[column.index]) {
                Ok(number) => list.push(number),
                Err(error) if column.known.is_some() => return Err(error),
                Err(_) => *values = None,
            }
        }
    }
    for (values, column) in numbers.into_iter().zip(columns) {
        let name = &raw.table.header()[column.index];
        let Some(mut values) = values.filter(|_| !name.is_empty()) else { continue };
        let Some(known) = column.known else {
            channels.push(Channel {
                quantity: None,
                name: name.clone(),
                column: name.clone(),
                unit: "",
                column_unit: String::new(),
                si_per_column_unit: 1.0,
                values,
            });
            continue;
        };
        let factor = joint_side_factor(&known, name, joint)?;
        for value in &mut values {
            *value = *value * factor + known.unit.offset;
        }
        channels.push(Channel {
            quantity: Some(known.quantity),
            name: known.quantity.name().to_owned(),
            column: name.clone(),
            unit: known.unit.si,
            column_unit: known.unit.suffix.to_owned(),
            si_per_column_unit: factor,
            values,
        });
    }
    Ok(channels)
}

/// SI value on the joint side per unit of the column.
fn joint_side_factor(known: &Known, column: &str, joint: &Joint) -> Result<f64> {
    let missing = |parameter: &str| {
        let message = format!("this column needs `{parameter}` under [drive] of joint.toml");
        Error::new(&codes::MISSING_PARAMETER, message).at_row(1).in_column(column).with_value(known.unit.suffix)
    };
    let mut factor = known.unit.factor * known.scale;
    if known.unit.suffix.starts_with("count") {
        factor /= joint.drive.counts_per_turn.ok_or_else(|| missing("counts_per_turn"))?;
    }
    if known.side == Side::Motor {
        let ratio = joint.drive.gear_ratio.ok_or_else(|| missing("gear_ratio"))?;
        match known.quantity {
            Quantity::Position | Quantity::Velocity | Quantity::Acceleration | Quantity::ReferencePosition => {
                factor /= ratio;
            }
            Quantity::Torque | Quantity::FrictionTorque | Quantity::RigidBodyTorque | Quantity::LoadTorque => {
                factor *= ratio;
            }
            _ => {}
        }
    }
    Ok(factor)
}
