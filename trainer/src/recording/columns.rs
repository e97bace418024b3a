//! Which column is which quantity, and its values in SI on the joint side.

use std::collections::BTreeSet;

use super::clock::{self, Reading};
use super::names::{self, JointState};
use super::quantity::{Axis, ColumnName, Quantity, Unit};
use super::table::RawTable;
use crate::error::{Error, Result, codes};
use crate::joint::{Joint, Side};

/// What a column of the file is taken for.
pub(super) struct Assignment {
    pub(super) index: usize,
    pub(super) known: Option<Known>,
}

/// A standard quantity and the way from the column to it.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) quantity: Quantity,
    pub(super) unit: &'static Unit,
    side: Side,
    scale: f64,
}

impl Known {
    fn by_name(quantity: Quantity, unit: &'static Unit) -> Self {
        Self { quantity, unit, side: Side::Joint, scale: 1.0 }
    }
}

/// The columns of a file with what was noticed on the way.
pub(super) struct Assigned {
    pub(super) columns: Vec<Assignment>,
    pub(super) axis: Axis,
    /// How the time column is read.
    pub(super) reading: Reading,
    /// Columns that nearly have the name of a quantity that no column has, with that name.
    pub(super) nearly: Vec<(String, String)>,
    /// Columns named as a quantity whose unit is not understood; an error only where the quantity is needed.
    pub(super) unusable: Vec<(Quantity, String)>,
    pub(super) notes: Vec<String>,
}

/// Decides what each column is: `[columns]` of `joint.toml` first, then its own name, then what it holds.
pub(super) fn assign(raw: &RawTable, joint: &Joint) -> Result<Assigned> {
    let header = raw.table.header();
    let mut columns: Vec<Assignment> = Vec::with_capacity(header.len());
    let mut unusable = Vec::new();
    let mapped = mapped_columns(header, joint)?;
    for (index, name) in header.iter().enumerate() {
        let known = match mapped.iter().find(|(column, _)| *column == index) {
            Some((_, known)) => Some(*known),
            None => match names::read_name(name, raw.unit_below(index)) {
                // A mapped column takes the place of one that has the quantity's own name.
                ColumnName::Known(quantity, _) | ColumnName::UnknownUnit(quantity)
                    if mapped.iter().any(|(_, known)| known.quantity == quantity) =>
                {
                    None
                }
                ColumnName::Known(quantity, unit) => Some(Known::by_name(quantity, unit)),
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
    take_joint_states(&mut columns, header, joint.name.as_deref())?;
    let reading = take_clock(&mut columns, raw, &mut unusable);
    if columns.iter().all(|column| column.known.is_none_or(|known| known.quantity == Quantity::Time)) {
        if let Some((quantity, column)) = unusable.first() {
            return Err(unknown_unit(*quantity, column, joint.columns_table()));
        }
        if columns.iter().all(|column| column.known.is_none()) {
            return Err(no_known_column(header, raw.table.header_line(), joint.columns_table()));
        }
    }
    // A quantity whose unit is not understood must not be replaced silently by a derived one.
    let recorded = |wanted| columns.iter().any(|column| column.known.is_some_and(|known| known.quantity == wanted));
    if let Some((quantity, column)) = unusable.iter().find(|(quantity, _)| !recorded(*quantity)) {
        return Err(unknown_unit(*quantity, column, joint.columns_table()));
    }
    let notes = unusable
        .iter()
        .map(|(quantity, column)| {
            format!("column {column} is kept as a named channel: {} has its own", quantity.name())
        })
        .collect();
    let named = columns.iter().filter(|column| column.known.is_none()).map(|column| &header[column.index]);
    let nearly = named.filter_map(|name| names::meant(name).map(|(quantity, known)| (name, quantity, known)));
    let nearly = nearly.filter(|(_, quantity, _)| !recorded(*quantity));
    let nearly = nearly.map(|(name, _, known)| (name.clone(), known.to_owned())).collect();
    let axis = axis_of(&columns, header)?;
    Ok(Assigned { columns, axis, reading, nearly, unusable, notes })
}

/// Takes a column for the time that says so by what it holds, where none says it by its name; how the time column is read.
fn take_clock(columns: &mut [Assignment], raw: &RawTable, unusable: &mut Vec<(Quantity, String)>) -> Reading {
    let is_time = |column: &&Assignment| column.known.is_some_and(|known| known.quantity == Quantity::Time);
    if let Some(time) = columns.iter().find(is_time) {
        return clock::reading_of(raw, time.index);
    }
    match clock::self_told(raw).filter(|found| columns[found.index].known.is_none()) {
        None => Reading::Number,
        Some(found) => {
            columns[found.index].known = Some(Known::by_name(Quantity::Time, found.unit));
            unusable.retain(|(quantity, _)| *quantity != Quantity::Time);
            found.reading
        }
    }
}

/// Takes the joint states of one joint, as ROS names them: the only one, or that of the joint's name.
fn take_joint_states(columns: &mut [Assignment], header: &[String], joint: Option<&str>) -> Result<()> {
    let states = || header.iter().filter_map(|name| JointState::of(name));
    let all: BTreeSet<&str> = states().map(|state| state.source).collect();
    let of_name = states().filter(|state| joint.is_some_and(|name| name == state.joint() || name == state.source));
    let mut meant: BTreeSet<&str> = of_name.map(|state| state.source).collect();
    if meant.is_empty() {
        meant.clone_from(&all);
    }
    let taken: Vec<Quantity> = columns.iter().filter_map(|column| column.known).map(|known| known.quantity).collect();
    if meant.len() > 1 {
        // Beside columns that are known anyway they are channels of other joints.
        return if taken.iter().any(|quantity| *quantity != Quantity::Time) {
            Ok(())
        } else {
            Err(which_joint(&meant))
        };
    }
    for column in columns.iter_mut().filter(|column| column.known.is_none()) {
        if let Some(state) = JointState::of(&header[column.index])
            && meant.contains(state.source)
            && !taken.contains(&state.quantity)
        {
            column.known = Some(Known::by_name(state.quantity, state.unit));
        }
    }
    Ok(())
}

fn which_joint(sources: &BTreeSet<&str>) -> Error {
    let names: Vec<&str> = sources.iter().map(|source| source.rsplit('/').next().unwrap_or(source)).collect();
    let distinct = names.iter().collect::<BTreeSet<_>>().len() == names.len();
    let shown = if distinct { names } else { sources.iter().copied().collect() };
    let first = shown.first().copied().unwrap_or_default();
    let message = format!(
        "several joints are recorded: {}; joint.toml says which is meant: name = \"{first}\"",
        shown.join(", ")
    );
    Error::new(&codes::SEVERAL_JOINTS, message).at_row(1)
}

fn no_known_column(header: &[String], line: u64, table: &str) -> Error {
    let message = if header.first().is_some_and(|name| name == "column[0]") {
        format!(
            "the names of the columns are missing, and the first row holds numbers only: name them by their place under {table} of \
             joint.toml, as in position = {{ name = \"column[0]\", unit = \"rad\" }}"
        )
    } else {
        let example = header.iter().find(|name| !name.is_empty()).map_or("q", String::as_str);
        format!(
            "no column is named <quantity>_<unit>, as in time_s, position_rad, torque_Nm: say what they are under {table} of \
             joint.toml, as in position = {{ name = \"{example}\", unit = \"rad\" }}; `trainer init` writes one that lists them all"
        )
    };
    Error::new(&codes::NO_KNOWN_COLUMN, message).at_row(line).with_value(header.join(","))
}

/// The error of a column whose unit is not one of its quantity; `table` of joint.toml may say what it is.
pub(super) fn unknown_unit(quantity: Quantity, column: &str, table: &str) -> Error {
    let unit = match names::split_unit(column) {
        Some((_, unit)) => unit,
        None => column.strip_prefix(quantity.name()).map_or("", |rest| rest.trim_start_matches('_')),
    };
    let what = if unit.is_empty() {
        format!("the name of this column has to end in its unit, one of: {}", quantity.suffixes())
    } else {
        format!("this is not a unit of {}, which are: {}", quantity.name(), quantity.suffixes())
    };
    let (name, suffix) = (quantity.name(), quantity.units()[0].suffix);
    let message = format!(
        "{what}; or say it under {table} of joint.toml: {name} = {{ name = \"{column}\", unit = \"{suffix}\" }}"
    );
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

/// SI value on the joint side per unit of the column.
pub(super) fn joint_side_factor(known: &Known, column: &str, joint: &Joint) -> Result<f64> {
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
            Quantity::Position
            | Quantity::Velocity
            | Quantity::Acceleration
            | Quantity::ReferencePosition
            | Quantity::ReferenceVelocity => {
                factor /= ratio;
            }
            Quantity::Torque
            | Quantity::FrictionTorque
            | Quantity::RigidBodyTorque
            | Quantity::LoadTorque
            | Quantity::FeedForward => {
                factor *= ratio;
            }
            _ => {}
        }
    }
    Ok(factor)
}
