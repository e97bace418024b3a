//! Recordings in: formats, columns, units and checks. Knows no model.
//!
//! A recording is a text table whose columns are named `<quantity>_<unit>`. [`load`] reads a file and [`parse`] any
//! stream of bytes; both give every channel in SI or one [`Error`] with the place in the file.

mod clock;
mod columns;
mod convert;
mod formats;
mod guess;
mod health;
mod keep;
mod merged;
mod names;
mod numbers;
mod of_joints;
mod quantity;
mod select;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod text;
mod vectors;

use std::path::Path;

pub use formats::silence_readers_panics;
pub use guess::{Proposal, Taken};
pub(crate) use health::GAP_PERIODS;
pub use health::Health;
pub(crate) use keep::STRETCH_ROWS;
pub use quantity::{Axis, Quantity, Unit};
pub use select::Omission;
pub use table::TextTable;
pub use text::RECORD_LIMIT_BYTES;

use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use keep::{InUse, Keep};
use source::Fingerprinted;
use table::RawTable;

/// Fewest rows of data that a recording may have; below it no filter and no split makes sense.
pub const MINIMUM_ROWS: usize = 20;

/// A recording in SI units, joint side.
#[derive(Clone, Debug)]
pub struct Recording {
    /// File name without folder, or whatever [`parse`] was told.
    pub label: String,
    /// Rotary or linear.
    pub axis: Axis,
    /// Standard quantities and named channels, in the order of the file; all have [`Recording::len`] values.
    pub channels: Vec<Channel>,
    /// CRC-64/XZ of the bytes of the file: the same file gives the same number on any machine.
    pub content_hash: u64,
    /// Facts about clock, resolution and clipping, not yet judged.
    pub health: Health,
    /// The rows as text, as far as it was kept.
    pub table: TextTable,
    /// Whether its interruptions are those of an excerpt, between whose stretches the motion went on.
    pub is_excerpt: bool,
    /// Columns that nearly have the name of a quantity that no column has, with that name.
    pub nearly_named: Vec<(String, String)>,
    unusable: Vec<(Quantity, String)>,
    file: String,
}

/// One channel of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The standard quantity; `None` for a channel that is known by its column's name only.
    pub quantity: Option<Quantity>,
    /// Name as an input of a model: the quantity's name, or that of the column.
    pub name: String,
    /// Name of the column in the file.
    pub column: String,
    /// SI unit of `values`; empty for a named channel, which keeps the unit of its column.
    pub unit: &'static str,
    /// Unit suffix of the column in the file, as in `mNm`.
    pub column_unit: String,
    /// SI value per column unit; divide by it to write a value in the column's own unit.
    pub si_per_column_unit: f64,
    /// One value per row.
    pub values: Vec<f64>,
}

/// Reads a recording from a file, or from standard input where it is named `-`.
///
/// # Errors
/// `FRK-I...` when the file cannot be read, `FRK-D...` with row, column and value when its content cannot be used.
pub fn load(path: &Path, joint: &Joint) -> Result<Recording> {
    let (file, label) = names_of(path);
    let source = source::open(path)?;
    let mut recording = parse(&label, source, joint).map_err(|error| error.in_file(&file))?;
    recording.file = file;
    Ok(recording)
}

/// The same without the text of its rows, which a large file cannot afford: 8 B a number. Of a long one only those columns that are in use, as
/// `inputs` are, and of one that a memory (B) does not hold stretches spread over it.
///
/// # Errors
/// As [`load`].
pub(crate) fn load_numbers(path: &Path, joint: &Joint, inputs: &[String], memory_bytes: f64) -> Result<Recording> {
    let (file, label) = names_of(path);
    let keep = Keep::Numbers(InUse::of(joint, inputs, memory_bytes));
    let (raw, fingerprint) = read(source::open(path)?, keep).map_err(|error| error.in_file(&file))?;
    let mut recording = interpret(&label, raw, fingerprint, joint).map_err(|error| error.in_file(&file))?;
    recording.file = file;
    recording.table.forget_text();
    Ok(recording)
}

/// A path as it is shown, and the name of its file.
fn names_of(path: &Path) -> (String, String) {
    if path == Path::new("-") {
        return ("standard input".to_owned(), "standard input".to_owned());
    }
    let file = path.display().to_string();
    let label = path.file_name().map_or_else(|| file.clone(), |name| name.to_string_lossy().into_owned());
    (file, label)
}

/// Reads a recording of several joints: one recording a joint, in the order of `joints`, whose names tell which columns are whose.
///
/// # Errors
/// As [`load`]; `FRK-D013` where no column is the position of a joint.
pub fn load_joints(path: &Path, joints: &[Joint]) -> Result<Vec<Recording>> {
    let (file, label) = names_of(path);
    let recordings = source::open(path).and_then(|source| parse_joints(&label, source, joints));
    let mut recordings = recordings.map_err(|error| error.in_file(&file))?;
    recordings.iter_mut().for_each(|recording| recording.file.clone_from(&file));
    Ok(recordings)
}

/// The same from any stream of bytes.
///
/// # Errors
/// As [`parse`]; `FRK-D013` where no column is the position of a joint.
pub fn parse_joints(label: &str, source: impl std::io::Read, joints: &[Joint]) -> Result<Vec<Recording>> {
    let (raw, fingerprint) = read(source, Keep::Numbers(InUse::all()))?;
    let parts = of_joints::take_apart(&raw, joints)?;
    parts.into_iter().map(|(part, joint)| interpret(label, part, fingerprint, &joint)).collect()
}

/// Reads a recording from any stream of bytes, with bounded memory for a record of any length.
///
/// # Errors
/// `FRK-D...` with row, column and value; `FRK-I001` when the stream itself fails.
pub fn parse(label: &str, source: impl std::io::Read, joint: &Joint) -> Result<Recording> {
    let (raw, fingerprint) = read(source, Keep::Text)?;
    interpret(label, raw, fingerprint, joint)
}

/// Proposes a `joint.toml` for a file, or for standard input where it is named `-`, and reads the recording by it. Where the proposal cannot say what
/// the columns are, the second is the error that reading gives until somebody says it.
///
/// # Errors
/// As [`load`], where the file is no table, or what its columns hold cannot be used.
pub fn propose(path: &Path) -> Result<(Proposal, Result<Recording>)> {
    let (file, label) = names_of(path);
    let (raw, fingerprint) =
        read(source::open(path)?, Keep::Numbers(InUse::all())).map_err(|error| error.in_file(&file))?;
    let proposal = guess::propose(&raw);
    let joint = Joint::parse(&proposal.toml).map_err(|error| error.in_file(&file))?;
    if let Err(error) = columns::assign(&raw, &joint) {
        return Ok((proposal, Err(error.in_file(&file))));
    }
    let mut recording = interpret(&label, raw, fingerprint, &joint).map_err(|error| error.in_file(&file))?;
    recording.file = file;
    Ok((proposal, Ok(recording)))
}

/// The table in a stream of bytes, long enough, and the fingerprint of the stream.
fn read(source: impl std::io::Read, keep: Keep) -> Result<(RawTable, u64)> {
    let mut bytes = Fingerprinted::new(source);
    let raw = source::decompressed(&mut bytes)
        .map_err(|error| source::failed(&error))
        .and_then(|source| formats::read(source, keep))?;
    refuse_short(&raw.table)?;
    Ok((raw, bytes.fingerprint()))
}

fn interpret(label: &str, mut raw: RawTable, fingerprint: u64, joint: &Joint) -> Result<Recording> {
    let assigned = columns::assign(&raw, joint)?;
    let converted = convert::convert(&mut raw, &assigned, joint)?;
    let (channels, mut table) = (converted.channels, raw.table);
    if let Some(kept) = &converted.rows {
        table = table.with_rows(kept);
    }
    if let Some(time) = channels.iter().find(|channel| channel.quantity == Some(Quantity::Time)) {
        refuse_backward_time(time, &table)?;
    }
    let notes = [raw.notes, assigned.notes, converted.notes].concat();
    let health = Health::of(&channels, notes, Vec::new());
    Ok(Recording {
        label: label.to_owned(),
        axis: assigned.axis,
        channels,
        content_hash: fingerprint,
        health,
        table,
        is_excerpt: raw.is_excerpt,
        nearly_named: assigned.nearly,
        unusable: assigned.unusable,
        file: label.to_owned(),
    })
}

fn refuse_short(table: &TextTable) -> Result<()> {
    if table.len() >= MINIMUM_ROWS {
        return Ok(());
    }
    let message = format!("a recording needs at least {MINIMUM_ROWS} rows of data");
    let last = table.len().checked_sub(1).map_or(table.header_line(), |index| table.line(index));
    Err(Error::new(&codes::TOO_FEW_ROWS, message).at_row(last).with_value(table.len().to_string()))
}

/// A stamp that stands twice is left to the checks.
fn refuse_backward_time(time: &Channel, table: &TextTable) -> Result<()> {
    match time.values.windows(2).position(|pair| pair[1] < pair[0]) {
        None => Ok(()),
        Some(before) => {
            let column = table.header().iter().position(|name| *name == time.column).unwrap_or(0);
            let error = Error::new(&codes::TIME_NOT_INCREASING, "time has to increase from row to row")
                .at_row(table.line(before + 1))
                .in_column(&time.column);
            let number = || (time.values[before + 1] / time.si_per_column_unit).to_string();
            Err(error.with_value(table.kept(before + 1, column).map_or_else(number, str::to_owned)))
        }
    }
}

impl Recording {
    /// Name and fingerprint of the content.
    #[must_use]
    pub fn source(&self) -> (String, u64) {
        (self.label.clone(), self.content_hash)
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Whether there is no row; [`parse`] never returns such a recording.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// Path as it was given, for messages.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The channel of a standard quantity, if recorded.
    #[must_use]
    pub fn channel(&self, quantity: Quantity) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.quantity == Some(quantity))
    }

    /// The channel of this name, standard or not.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// The values of a standard quantity, if recorded.
    #[must_use]
    pub fn values(&self, quantity: Quantity) -> Option<&[f64]> {
        self.channel(quantity).map(|channel| channel.values.as_slice())
    }

    /// The actuator's channel: torque, else force, else current.
    #[must_use]
    pub fn actuator(&self) -> Option<&Channel> {
        [Quantity::Torque, Quantity::Force, Quantity::Current].into_iter().find_map(|quantity| self.channel(quantity))
    }

    /// The channel of friction that somebody already separated.
    #[must_use]
    pub fn separated_friction(&self) -> Option<&Channel> {
        [Quantity::FrictionTorque, Quantity::FrictionForce].into_iter().find_map(|quantity| self.channel(quantity))
    }

    /// Where a torque that is not recorded may come from, to go on with a message; `None` where no column speaks of an actuator.
    fn actuator_hint(&self) -> Option<String> {
        let told = [Quantity::ReferencePosition, Quantity::Duty, Quantity::Voltage].into_iter();
        let channel = told.filter_map(|quantity| self.channel(quantity)).next()?;
        Some(format!(
            "; of a joint that reports no torque `[actuator]` of joint.toml says what makes it of {} (docs/servos.md)",
            channel.name
        ))
    }

    /// The first of `wanted` that is recorded.
    ///
    /// # Errors
    /// `FRK-D010` when a column has the name of one of them but not its unit, `FRK-D009` when there is none.
    pub fn require(&self, wanted: &[Quantity], purpose: &str) -> Result<&Channel> {
        if let Some(channel) = wanted.iter().find_map(|quantity| self.channel(*quantity)) {
            return Ok(channel);
        }
        let misnamed = self.unusable.iter().find(|(quantity, _)| wanted.contains(quantity));
        Err(match misnamed {
            Some((quantity, column)) => columns::unknown_unit(*quantity, column, "[columns]"),
            None => {
                let names: Vec<String> = wanted.iter().map(|quantity| quantity.column()).collect();
                let mut message = format!("{purpose} needs a column such as {}", names.join(" or "));
                if let Some(hint) = self.actuator_hint().filter(|_| wanted.contains(&Quantity::Torque)) {
                    message += &hint;
                }
                Error::new(&codes::MISSING_COLUMN, message).at_row(1).in_column(names[0].clone())
            }
        }
        .in_file(&self.file))
    }
}
