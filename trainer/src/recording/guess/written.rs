//! The text of a proposed `joint.toml`.

use std::fmt::Write as _;

use super::candidate::{Candidate, numbers, range};
use super::content::increases;
use super::{actuator, aliases, missing, units};
use crate::recording::quantity::Quantity;
use crate::recording::table::RawTable;

/// What time and position are counted in.
pub(super) struct Clock {
    /// Counts of a turn, where the position is in counts.
    pub(super) counts: Option<f64>,
    /// Rows per second.
    pub(super) rate_hz: Option<f64>,
}

/// `joint.toml` for what was found, with a reason for each line; `name` is that of the joint where the recording says it.
pub(super) fn written(
    raw: &RawTable,
    found: &[Candidate],
    name: Option<&str>,
    Clock { counts, rate_hz }: Clock,
    other_joints: &[String],
) -> String {
    let mut text =
        String::from("# Proposed from the recording: what stands behind a # is why. Correct what is wrong.\n");
    // Writing to a string cannot fail.
    let _ = match name {
        Some(name) => writeln!(text, "name = {}", quoted(name)),
        None => writeln!(text, "# name = \"...\"   # of the joint, as the simulator has it; carried into the image"),
    };
    if let Some(rate) = rate_hz {
        let _ = writeln!(text, "# recorded at {} Hz", units::short(rate));
    }
    if !other_joints.is_empty() {
        let _ = writeln!(text, "# other joints of the file: {}", other_joints.join(" ").escape_debug());
    }
    let _ = writeln!(text, "\n[columns]");
    for candidate in found {
        let column = &raw.table.header()[candidate.index];
        let unit = candidate.unit.map_or("", |unit| unit.suffix);
        let mark = if candidate.by_itself { "# " } else { "" };
        let scale = if candidate.scale < 0.0 { ", scale = -1.0" } else { "" };
        let (quantity, column, unit) = (candidate.quantity.name(), quoted(column), quoted(unit));
        let entry = format!("{mark}{quantity} = {{ name = {column}, unit = {unit}{scale} }}");
        let _ = writeln!(text, "{entry:<72} # {}", candidate.why);
    }
    missing::sentences(found).iter().for_each(|sentence| text += &format!("# {sentence}\n"));
    text += &others(raw, found);
    let _ = writeln!(
        text,
        "# side = \"motor\" in an entry says that it is measured before the gear, scale = -1.0 turns its sign"
    );
    if let Some(kind) = actuator::kind(found) {
        let _ = write!(text, "\n{}", actuator::sections(kind));
    }
    let _ = writeln!(text, "\n[drive]");
    if let Some(counts) = counts {
        let _ =
            writeln!(text, "counts_per_turn = {counts:.1}   # a guess: the power of two that the positions are within");
    }
    let _ = writeln!(text, "# gear_ratio = 1.0             # motor turns per joint turn");
    let _ = writeln!(text, "# torque_constant_Nm_A = 0.1   # of the motor, beside a current");
    text
}

/// The columns that nothing was taken for, each with what it could be.
fn others(raw: &RawTable, found: &[Candidate]) -> String {
    let missing = missing::quantities(found);
    let is_taken = |index: &usize| found.iter().any(|candidate| candidate.index == *index);
    let mut text = String::new();
    for index in (0..raw.table.header().len()).filter(|index| !is_taken(index)) {
        if text.is_empty() {
            text += "# nothing was taken for these, which are kept as channels by their names:\n";
        }
        let (name, values) = (&raw.table.header()[index], numbers(raw, index));
        let of_joint = aliases::read(name).filter(|reading| !reading.joint.is_empty()).map(|reading| {
            format!("{} of joint {}", reading.quantity.name().replace('_', " "), reading.joint.escape_debug())
        });
        let (holds, could_be) = match range(&values) {
            None => ("no numbers".to_owned(), Vec::new()),
            Some([low, high]) if low == high => (format!("{} in every row", units::short(low)), Vec::new()),
            Some([low, high]) => {
                let holds = format!("{} to {}", units::short(low), units::short(high));
                let could_be =
                    missing.iter().copied().filter(|quantity| *quantity != Quantity::Time || increases(&values));
                (holds, if of_joint.is_some() { Vec::new() } else { could_be.collect() })
            }
        };
        let why =
            [Some(holds), of_joint, could_be_sentence(&could_be)].into_iter().flatten().collect::<Vec<_>>().join("; ");
        let shown = format!("\"{}\"", name.escape_debug());
        let entry = match could_be.first() {
            Some(first) => {
                format!("# {} = {{ name = {shown}, unit = {} }}", first.name(), quoted(first.units()[0].suffix))
            }
            None => format!("# {shown}"),
        };
        let _ = writeln!(text, "{entry:<72} # {why}");
    }
    text
}

fn could_be_sentence(quantities: &[Quantity]) -> Option<String> {
    let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
    let (last, before) = names.split_last()?;
    Some(if before.is_empty() { format!("{last}?") } else { format!("{} or {last}?", before.join(", ")) })
}

/// A string of TOML, on one line.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
