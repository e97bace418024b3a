//! A table with the columns of several joints, taken apart: which column is which quantity of which joint.

use std::collections::BTreeMap;

use super::clock::{self, Reading as ClockReading};
use super::guess::aliases::{self, Reading};
use super::names::{plain, read_name};
use super::quantity::{ColumnName, Quantity};
use super::table::RawTable;
use crate::error::{Error, Result, codes};
use crate::joint::{ColumnMapping, Joint, Side};

/// Channel that numbers the trajectories of a campaign.
const TRAJECTORY: &str = "trajectory";

/// What a joint needs of a table.
const OF_JOINTS: [Quantity; 7] = [
    Quantity::Position,
    Quantity::Velocity,
    Quantity::Torque,
    Quantity::Force,
    Quantity::Current,
    Quantity::Temperature,
    Quantity::LinkPosition,
];

/// A column as it is read for one joint.
struct Found {
    quantity: Quantity,
    column: usize,
    unit: Option<String>,
    rank: usize,
}

/// Adds to what is known of each joint the columns of the table that are its own, by its name or its place among the numbered ones, and leaves
/// what `[columns]` says. The tables hold the columns of one joint each.
///
/// # Errors
/// `FRK-D013` when no position of a joint is found.
pub(super) fn take_apart(raw: &RawTable, joints: &[Joint]) -> Result<Vec<(RawTable, Joint)>> {
    let header = raw.table.header();
    let time = shared_time(raw);
    let found = columns(raw, joints);
    let part = |(joint, found): (&Joint, &Vec<Found>)| {
        let mut joint = joint.clone();
        let mut map = |quantity: Quantity, column: usize, unit: Option<&String>| {
            let (name, unit) = (header[column].clone(), unit.cloned());
            let mapping = ColumnMapping { name, unit, side: Side::Joint, scale: 1.0, may_be_absent: false };
            joint.columns.entry(quantity.name().to_owned()).or_insert(mapping);
        };
        for own in found {
            map(own.quantity, own.column, own.unit.as_ref());
        }
        if let Some(time) = time {
            map(Quantity::Time, time, None);
        }
        let mapped = |name: &String| joint.columns.values().any(|mapping| mapping.name == *name);
        let is_shared = |index: usize, name: &String| {
            matches!(read_name(name, raw.unit_below(index)), ColumnName::Known(..)) || name == TRAJECTORY
        };
        let is_clock = |index| {
            clock::self_told(raw).is_some_and(|clock| {
                clock.index == index || matches!(clock.reading, ClockReading::WithNanoseconds(other) if other == index)
            })
        };
        let kept: Vec<usize> = (0..header.len())
            .filter(|&index| mapped(&header[index]) || is_shared(index, &header[index]) || is_clock(index))
            .collect();
        if !joint.columns.contains_key(Quantity::Position.name()) {
            return Err(no_position(header, &joint));
        }
        Ok((raw.with_columns(&kept), joint))
    };
    joints.iter().zip(&found).map(part).collect()
}

/// A column that is the time by another name, where none is by its own.
fn shared_time(raw: &RawTable) -> Option<usize> {
    let header = raw.table.header();
    let is_named = |(index, name): (usize, &String)| {
        matches!(read_name(name, raw.unit_below(index)), ColumnName::Known(Quantity::Time, _))
    };
    if header.iter().enumerate().any(is_named) || clock::self_told(raw).is_some() {
        return None;
    }
    let rank = |name: &String| {
        aliases::read(name)
            .filter(|read| read.quantity == Quantity::Time && read.joint.is_empty())
            .map(|read| read.rank)
    };
    let ranked = header.iter().enumerate().filter_map(|(index, name)| Some((rank(name)?, index)));
    ranked.min().map(|(_, index)| index)
}

/// The columns of each joint.
fn columns(raw: &RawTable, joints: &[Joint]) -> Vec<Vec<Found>> {
    let header = raw.table.header();
    let names: Vec<String> = joints.iter().map(|joint| plain(joint.name.as_deref().unwrap_or_default())).collect();
    let mut found: Vec<Vec<Found>> = joints.iter().map(|_| Vec::new()).collect();
    // Columns of one quantity and name, each with its number.
    let mut numbered: BTreeMap<(Quantity, usize), Vec<(usize, Found)>> = BTreeMap::new();
    for (column, name) in header.iter().enumerate() {
        if let Some((joint, rest)) = of_name(name, &names) {
            if let Some(Reading { quantity, rank, unit, .. }) = read(&rest) {
                found[joint].push(Found { quantity, column, unit, rank });
            }
        } else if let Some(Reading { quantity, rank, joint, unit }) = read(name) {
            let number = joint.trim_matches(['[', ']', '_']).parse::<usize>();
            if let Ok(number) = number {
                numbered.entry((quantity, rank)).or_default().push((number, Found { quantity, column, unit, rank }));
            }
        }
    }
    for mut columns in numbered.into_values() {
        columns.sort_by_key(|(number, found)| (*number, found.column));
        let numbers: Vec<usize> = columns.iter().map(|(number, _)| *number).collect();
        let counts_from = |first: usize| numbers.iter().copied().eq(first..first + joints.len());
        if counts_from(0) || counts_from(1) {
            found.iter_mut().zip(columns).for_each(|(of, (_, column))| of.push(column));
        }
    }
    for of in &mut found {
        of.retain(|found| OF_JOINTS.contains(&found.quantity));
        // The likelier name first; the second of a quantity is left.
        of.sort_by_key(|found| (found.quantity, found.rank, found.column));
        of.dedup_by_key(|found| found.quantity);
    }
    found
}

/// What a column is by its name and unit, as `position_rad`, `q` or `pos_deg`.
fn read(name: &str) -> Option<Reading> {
    match read_name(name, "") {
        ColumnName::Known(quantity, unit) => {
            Some(Reading { quantity, rank: 0, joint: String::new(), unit: Some(unit.suffix.to_owned()) })
        }
        _ => aliases::read(name),
    }
}

/// The joint whose name is a word of a column's name, the longest where there are several, and the name without it.
fn of_name(column: &str, names: &[String]) -> Option<(usize, String)> {
    let small = plain(column);
    let place = |name: &String| {
        if name.is_empty() {
            return None;
        }
        let ends = |text: &str, letter: Option<char>| text.is_empty() || letter.is_some_and(|l| !l.is_alphanumeric());
        small.match_indices(name.as_str()).map(|(at, _)| at).find(|&at| {
            let (before, after) = (&small[..at], &small[at + name.len()..]);
            ends(before, before.chars().next_back()) && ends(after, after.chars().next())
        })
    };
    let named = names.iter().enumerate().filter_map(|(joint, name)| Some((name.len(), joint, place(name)?)));
    let (length, joint, at) = named.max()?;
    // The case of a unit counts.
    let kept = if small.len() == column.len() { column } else { &small };
    let (before, after) = (kept.get(..at)?, kept.get(at + length..)?);
    let marks = ['/', '_', '.', ' ', '-'];
    let rest = match (after.trim_start_matches(marks), before.trim_end_matches(marks)) {
        ("", before) => before.rsplit('/').next().unwrap_or(before),
        (after, _) => after,
    };
    Some((joint, if rest == "effort" { "torque".to_owned() } else { rest.to_owned() }))
}

fn no_position(header: &[String], joint: &Joint) -> Error {
    let name = joint.name.as_deref().unwrap_or_default();
    let message = format!(
        "no column is the position of joint {name}: name it {name}_position_rad, number the columns of all joints as in q1 or position[0], or \
         say what they are under [columns] of arm.toml, as in position = \"q_{{index}}\""
    );
    Error::new(&codes::NO_KNOWN_COLUMN, message).at_row(1).with_value(header.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::keep::{InUse, Keep};

    fn joints(names: [&str; 2]) -> Vec<Joint> {
        names.map(|name| Joint { name: Some(name.to_owned()), ..Joint::default() }).to_vec()
    }

    fn parts(header: &str, names: [&str; 2]) -> Result<Vec<(RawTable, Joint)>> {
        let row = vec!["1"; header.split(',').count()].join(",");
        let text = format!("{header}\n{}", format!("{row}\n").repeat(30));
        take_apart(&super::super::read(text.as_bytes(), Keep::Numbers(InUse::all())).unwrap().0, &joints(names))
    }

    #[test]
    fn columns_are_known_by_the_name_or_the_number_of_a_joint() {
        for header in [
            "time_s,shoulder_position_rad,elbow_position_rad,shoulder_torque_Nm,elbow_torque_Nm",
            "time_s,position_rad/shoulder,position_rad/elbow,torque_Nm/shoulder,torque_Nm/elbow",
            "time_s,/joint_states/shoulder/position,/joint_states/elbow/position,/joint_states/shoulder/effort,/joint_states/elbow/effort",
            "t,q1,q2,tau1,tau2",
            "timestamp,actual_q_0,actual_q_1,actual_torque_0,actual_torque_1",
            "time_s,joint1_position_rad,joint2_position_rad,joint1_torque_Nm,joint2_torque_Nm",
            "time,position[0],position[1],effort[0],effort[1]",
        ] {
            let names: Vec<&str> = header.split(',').collect();
            for (index, (table, joint)) in parts(header, ["shoulder", "elbow"]).unwrap().into_iter().enumerate() {
                assert_eq!(joint.columns["position"].name, names[1 + index], "{header}");
                assert_eq!(joint.columns["torque"].name, names[3 + index], "{header}");
                assert_eq!(table.table.header(), [names[0], names[1 + index], names[3 + index]], "{header}");
            }
        }
    }

    #[test]
    fn a_longer_name_is_not_taken_for_a_shorter_one_and_units_are_read() {
        let header = "time_s,wrist_position_deg,wrist_2_position_deg,wrist_2_current_mA,wrist_current_mA";
        let [first, second] = &parts(header, ["wrist", "wrist_2"]).unwrap()[..] else { panic!() };
        assert_eq!(first.1.columns["current"].name, "wrist_current_mA");
        assert_eq!(second.1.columns["position"].unit.as_deref(), Some("deg"));
        assert_eq!(second.1.columns["current"].name, "wrist_2_current_mA");
    }

    #[test]
    fn a_joint_without_a_position_is_told() {
        let error = parts("time_s,q1,q2,q3,tau1", ["shoulder", "elbow"]).unwrap_err();
        assert!(error.message().contains("joint shoulder") && error.code() == &codes::NO_KNOWN_COLUMN);
    }
}
