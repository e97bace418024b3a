//! What the columns of a file are likely to be: a `joint.toml` that reads it, with the reason for each of its lines.

mod actuator;
pub(super) mod aliases;
mod candidate;
mod content;
mod missing;
mod units;
mod words;
mod written;

use super::clock;
use super::names::{self, JointState};
use super::quantity::{Axis, ColumnName, Quantity, Unit};
use super::table::RawTable;
use aliases::Reading;
use candidate::{Candidate, has, numbers, range};
use units::Told;
use written::{Clock, written};

/// What a gear changes.
const BEHIND_THE_GEAR: [Quantity; 3] = [Quantity::Position, Quantity::Velocity, Quantity::Torque];

/// What one column is taken for.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// Name of the column in the file.
    pub column: String,
    /// What it is.
    pub quantity: Quantity,
    /// Unit suffix, as in `mNm`.
    pub unit: String,
    /// Why.
    pub why: String,
}

/// A `joint.toml` for a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// The text of `joint.toml`.
    pub toml: String,
    /// What each column is taken for, in the order of the quantities.
    pub taken: Vec<Taken>,
    /// Columns that are kept as channels by their names.
    pub channels: Vec<String>,
    /// Other joints of the file.
    pub other_joints: Vec<String>,
    /// Rate of the clock, Hz.
    pub rate_hz: Option<f64>,
    /// What was not found, in sentences without a full stop.
    pub missing: Vec<String>,
}

/// Proposes a `joint.toml` for a table.
pub(super) fn propose(raw: &RawTable) -> Proposal {
    let header = raw.table.header();
    let readings: Vec<Option<Reading>> = header.iter().map(|column| aliases::read(column)).collect();
    let joint = busiest_joint(raw, &readings);
    let mut found: Vec<Candidate> = Vec::new();
    if let Some(time) = clock::self_told(raw) {
        let why = "a clock that says its unit itself".to_owned();
        let (index, unit) = (time.index, Some(time.unit));
        found.push(Candidate { index, quantity: Quantity::Time, unit, scale: 1.0, by_itself: true, why });
    }
    for (index, column) in header.iter().enumerate() {
        if let ColumnName::Known(quantity, unit) = names::read_name(column, raw.unit_below(index))
            && !found.iter().any(|other| other.quantity == quantity)
        {
            let why = "named so".to_owned();
            found.push(Candidate { index, quantity, unit: Some(unit), scale: 1.0, by_itself: true, why });
        }
    }
    let mut likely: Vec<(usize, &Reading)> =
        readings.iter().enumerate().filter_map(|(index, reading)| Some((index, reading.as_ref()?))).collect();
    likely.sort_by_key(|(_, reading)| reading.rank);
    for (index, reading) in likely {
        let of_joint = reading.joint.is_empty() || reading.joint == joint;
        let taken = |other: &Candidate| other.quantity == reading.quantity || other.index == index;
        if of_joint && is_number(raw, index) && !found.iter().any(taken) {
            let below = Some(raw.unit_below(index)).filter(|unit| !unit.is_empty());
            let unit =
                reading.unit.as_deref().or(below).and_then(|unit| reading.quantity.unit(names::unbracketed(unit)));
            let by_itself = JointState::of(&header[index]).is_some();
            let mut why = format!("by its name, {}", reading.quantity.name().replace('_', " "));
            if header[index].to_lowercase().starts_with("motor") && BEHIND_THE_GEAR.contains(&reading.quantity) {
                why += "; before the gear? then add side = \"motor\"";
            }
            found.push(Candidate { index, quantity: reading.quantity, unit, scale: 1.0, by_itself, why });
        }
    }
    content::take(raw, &mut found);
    found.sort_by_key(|candidate| candidate.quantity);
    let counts = tell_units(raw, &mut found);
    let time = found.iter().find(|candidate| candidate.quantity == Quantity::Time);
    let period = time.and_then(|time| Some(units::median_step(&numbers(raw, time.index))? * time.unit?.factor));
    let rate_hz = period.map(|period| 1.0 / period);
    // Other names of a joint are numbers of columns.
    let name = joint.rsplit_once('/').map(|(_, name)| name);
    let mut other_joints: Vec<String> = readings.iter().flatten().map(|reading| reading.joint.clone()).collect();
    other_joints.sort();
    other_joints.dedup();
    other_joints.retain(|other| !other.is_empty() && *other != joint);
    let missing = missing::sentences(&found);
    let toml = written(raw, &found, name, Clock { counts, rate_hz }, &other_joints);
    let taken = found.iter().map(|candidate| Taken {
        column: header[candidate.index].clone(),
        quantity: candidate.quantity,
        unit: candidate.unit.map_or("", |unit| unit.suffix).to_owned(),
        why: candidate.why.clone(),
    });
    let is_taken = |index: &usize| found.iter().any(|candidate| candidate.index == *index);
    let channels = (0..header.len()).filter(|index| !is_taken(index)).map(|index| header[index].clone()).collect();
    Proposal { toml, taken: taken.collect(), channels, other_joints, rate_hz, missing }
}

/// The joint with most quantities, empty where the names say none; of several, the one whose position moves furthest.
fn busiest_joint(raw: &RawTable, readings: &[Option<Reading>]) -> String {
    let mut joints: Vec<(usize, f64, &str)> = Vec::new();
    for (index, reading) in readings.iter().enumerate() {
        let Some(reading) = reading.as_ref().filter(|reading| reading.quantity != Quantity::Time) else { continue };
        let span = if reading.quantity == Quantity::Position { span(&numbers(raw, index)) } else { 0.0 };
        match joints.iter_mut().find(|(.., joint)| *joint == reading.joint) {
            Some((count, furthest, _)) => (*count, *furthest) = (*count + 1, furthest.max(span)),
            None => joints.push((1, span, &reading.joint)),
        }
    }
    let best = joints.iter().max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    best.map_or_else(String::new, |(.., joint)| (*joint).to_owned())
}

fn span(values: &[f64]) -> f64 {
    range(values).map_or(0.0, |[low, high]| high - low)
}

/// Fills in the units that no name says; counts of a turn where the position is in counts.
fn tell_units(raw: &RawTable, found: &mut [Candidate]) -> Option<f64> {
    let axis = found.iter().filter_map(|candidate| candidate.unit).find_map(|unit| unit.axis);
    let force = has(found, &[Quantity::Force, Quantity::FrictionForce]);
    let axis = axis.unwrap_or(if force { Axis::Linear } else { Axis::Rotary });
    let (mut time, mut position, mut counts) = (Vec::new(), Vec::new(), None);
    for candidate in found.iter_mut() {
        let values = || numbers(raw, candidate.index);
        let told: Option<Told> = match candidate.quantity {
            _ if candidate.unit.is_some() => None,
            Quantity::Time => units::of_time(&values()),
            Quantity::Position | Quantity::LinkPosition | Quantity::ReferencePosition => {
                units::of_position(&values(), &time, axis)
            }
            Quantity::Velocity => units::of_velocity(&values(), &time, &position, axis),
            _ => None,
        };
        if let Some(told) = told {
            candidate.why = format!("{}; {}", candidate.why, told.why);
            (candidate.unit, candidate.scale) = (Some(told.unit), told.scale);
        }
        let of_axis = |unit: &&Unit| unit.axis.is_none_or(|of| of == axis);
        let unit = *candidate.unit.get_or_insert_with(|| {
            let units = candidate.quantity.units();
            let unit = units.iter().find(of_axis).unwrap_or(&units[0]);
            candidate.why = format!("{}; {} as nothing says otherwise", candidate.why, unit.suffix);
            unit
        });
        if unit.suffix.starts_with("count") && counts.is_none() {
            counts = Some(units::counts_per_turn(&values()));
        }
        let factor = unit.factor / if unit.suffix.starts_with("count") { counts.unwrap_or(1.0) } else { 1.0 };
        let scaled = || values().into_iter().map(|value| value * factor).collect();
        match candidate.quantity {
            Quantity::Time => time = scaled(),
            Quantity::Position => position = scaled(),
            _ => {}
        }
    }
    counts
}

fn is_number(raw: &RawTable, column: usize) -> bool {
    numbers(raw, column).iter().any(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::super::{Quantity, read};
    use super::{Proposal, propose};
    use crate::joint::Joint;
    use crate::recording::keep::{InUse, Keep};

    fn proposed(text: &str) -> Proposal {
        propose(&read(text.as_bytes(), Keep::Numbers(InUse::all())).unwrap().0)
    }

    #[test]
    fn the_joint_that_is_measured_best_is_proposed_and_the_others_told() {
        let mut text = String::from("timestamp,q1,q2,dq2,tau1,tau2,temp2,mode\n");
        for row in 0..100 {
            let time = f64::from(row) * 0.01;
            text += &format!("{},{},{},{},1,2,30,auto\n", 1_714_557_600.0 + time, time.sin(), time.cos(), -time.sin());
        }
        let proposal = proposed(&text);
        assert_eq!(proposal.other_joints, ["1"]);
        assert_eq!(proposal.channels, ["q1", "tau1", "mode"]);
        assert!((proposal.rate_hz.unwrap() - 100.0).abs() < 0.01);
        let joint = Joint::parse(&proposal.toml).unwrap();
        assert_eq!(joint.columns["position"].name, "q2");
        assert_eq!((joint.columns["velocity"].name.as_str(), joint.columns["velocity"].scale), ("dq2", 1.0));
        assert!(proposal.taken.iter().any(|taken| taken.quantity == Quantity::Time && taken.unit == "s"));
    }

    #[test]
    fn columns_beside_those_of_other_joints_are_the_joint() {
        let rows: String = (0..30).map(|row| format!("{},{row}e-2,1,2,3\n", f64::from(row) * 0.005)).collect();
        let proposal =
            proposed(&format!("time_s,position_rad,torque_Nm,joint1_position_rad,joint3_position_rad\n{rows}"));
        assert_eq!(proposal.channels, ["joint1_position_rad", "joint3_position_rad"]);
        assert!(Joint::parse(&proposal.toml).unwrap().columns.is_empty());
    }

    /// A joint that swings by two sines, its columns by these names.
    fn swing(header: &str, columns: impl Fn(f64) -> Vec<f64>) -> String {
        let row = |row: i32| {
            let values = columns(f64::from(row) * 0.004);
            values.iter().map(f64::to_string).collect::<Vec<_>>().join(";")
        };
        let rows: Vec<String> = (0..500).map(row).collect();
        format!("{header}\n{}\n", rows.join("\n"))
    }

    #[test]
    fn what_no_name_tells_is_told_by_what_the_columns_hold() {
        let columns = |t: f64| {
            let (position, velocity) = (t.sin() + 0.3 * (3.1 * t).sin(), t.cos() + 0.93 * (3.1 * t).cos());
            let acceleration = -t.sin() - 0.3 * 3.1 * 3.1 * (3.1 * t).sin();
            vec![velocity.signum() + 0.4 * velocity + acceleration, velocity, position, acceleration, t, 5.0]
        };
        let proposal = proposed(&swing("a;b;c;d;e;h", columns));
        let named =
            |quantity| proposal.taken.iter().find(|taken| taken.quantity == quantity).map(|taken| &taken.column[..]);
        assert_eq!(named(Quantity::Time), Some("e"), "{}", proposal.toml);
        assert_eq!((named(Quantity::Position), named(Quantity::Velocity)), (Some("c"), Some("b")));
        assert_eq!(proposal.channels, ["a", "d", "h"]);
        assert_eq!(proposal.missing.len(), 1, "{:?}", proposal.missing);
        assert!(proposal.toml.contains("# torque = { name = \"a\", unit = \"Nm\" }"), "{}", proposal.toml);
        assert!(proposal.toml.contains("5 in every row"), "{}", proposal.toml);
        assert_eq!(Joint::parse(&proposal.toml).unwrap().name, None);
    }

    #[test]
    fn a_position_is_found_by_its_velocity_and_a_counter_is_no_clock_beside_one() {
        let columns = |t: f64| vec![t / 0.004, t + 1e-5 * (1e4 * t).sin(), t.sin(), t.cos(), t.cos()];
        let proposal = proposed(&swing("n;ticks;foo;velocity_rad_s;torque_Nm", columns));
        let joint = Joint::parse(&proposal.toml).unwrap();
        assert_eq!(joint.columns["position"].name, "foo");
        assert_eq!(joint.columns["time"].name, "ticks");
        assert!(proposal.missing.is_empty(), "{:?}", proposal.missing);
        // A torque that friction makes goes with the velocity, and is none.
        let columns = |t: f64| vec![t, t.sin(), 0.3 * t.cos() + t.cos().signum(), -t.sin()];
        let proposal = proposed(&swing("time_s;foo;bar;torque_Nm", columns));
        assert!(proposal.missing[0].contains("position or the velocity"), "{:?}", proposal.missing);
    }
}
