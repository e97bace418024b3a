//! MCAP, what ROS 2 records its bags in: every joint state becomes columns such as `/joint_states/elbow/position`.

use std::collections::BTreeMap;

use mcap::records::{Channel, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use super::MOST_CELLS;
use super::cursor::Number;
use super::joint_state::{JointState, of_ros1, of_ros2};
use super::names::Names;
use crate::error::{Error, Result, codes};
use crate::recording::table::{RawTable, TableBuilder};

/// Fields of a joint state, by which its columns are named.
const FIELDS: [&str; 3] = ["position", "velocity", "effort"];

/// Longest record of a bag that is read, bytes: a chunk of a megabyte is usual, and a length that is wrong asks for no more memory than this.
const LONGEST_RECORD: usize = 1 << 30;
/// Topics without joint states that are told, at most.
const MOST_OTHERS: usize = 20;

/// Joint states in the order of their stamps.
#[derive(Default)]
struct States {
    names: Names,
    rows: Vec<(i128, Vec<(usize, f64)>)>,
}

/// How a bag is read that may be cut short.
fn bounded() -> LinearReaderOptions {
    LinearReaderOptions::default().with_skip_end_magic(true).with_record_length_limit(LONGEST_RECORD)
}

/// What was read of a bag.
#[derive(Default)]
struct Bag {
    /// Names of schemas by their number.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    states: States,
    /// Topics with other messages.
    others: Vec<String>,
    /// Joint states that cannot be decoded.
    broken: usize,
}

impl Bag {
    /// Reads the records of a bag, or those of a chunk of one.
    fn stream(&mut self, mut reader: LinearReader, bytes: &[u8], is_chunk: bool) -> Result<(), McapError> {
        let mut left = bytes;
        while let Some(event) = reader.next_event() {
            match event? {
                LinearReadEvent::ReadRequest(asked) => {
                    let (now, later) = left.split_at(asked.min(left.len()));
                    reader.insert(now.len()).copy_from_slice(now);
                    reader.notify_read(now.len());
                    left = later;
                }
                LinearReadEvent::Record { opcode, data } => self.record(opcode, data, is_chunk)?,
            }
        }
        Ok(())
    }

    /// Reads the records of a chunk that is not compressed, none of which is longer than what is left of it.
    fn plain(&mut self, mut bytes: &[u8]) -> Result<(), McapError> {
        while let Some((&opcode, rest)) = bytes.split_first() {
            let (length, rest) = rest.split_first_chunk().ok_or(McapError::UnexpectedEoc)?;
            let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| McapError::UnexpectedEoc)?;
            let (data, later) = rest.split_at_checked(length).ok_or(McapError::UnexpectedEoc)?;
            self.record(opcode, data, true)?;
            bytes = later;
        }
        Ok(())
    }

    /// Reads the records of a compressed chunk, as those of a bag that holds it alone.
    fn compressed(&mut self, chunk: &[u8]) -> Result<(), McapError> {
        let no_checksum = [0; 4];
        let framed = |opcode: u8, record: &[u8]| [&[opcode], &(record.len() as u64).to_le_bytes()[..], record].concat();
        let alone = [framed(op::CHUNK, chunk), framed(op::DATA_END, &no_checksum)].concat();
        self.stream(LinearReader::new_with_options(bounded().with_skip_start_magic(true)), &alone, true)
    }

    fn record(&mut self, opcode: u8, record: &[u8], is_in_chunk: bool) -> Result<(), McapError> {
        match parse_record(opcode, record)? {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                self.channels.insert(channel.id, channel);
            }
            Record::Message { header, data } => {
                let unknown = McapError::UnknownChannel(header.sequence, header.channel_id);
                let channel = self.channels.get(&header.channel_id).ok_or(unknown)?;
                let schema = self.schemas.get(&channel.schema_id).map_or("", String::as_str);
                let decode = match (schema, channel.message_encoding.as_str()) {
                    ("sensor_msgs/msg/JointState", "cdr") => of_ros2,
                    ("sensor_msgs/JointState", "ros1") => of_ros1,
                    (kind, _) => {
                        let other = format!("{} ({kind})", channel.topic);
                        if self.others.len() < MOST_OTHERS && !self.others.contains(&other) {
                            self.others.push(other);
                        }
                        return Ok(());
                    }
                };
                match decode(&data) {
                    Some(state) => self.states.push(&channel.topic, state, header.log_time),
                    None => self.broken += 1,
                }
            }
            // A chunk holds no chunks.
            Record::Chunk { header, data } if !is_in_chunk => {
                if header.compression.is_empty() {
                    self.plain(&data)?;
                } else {
                    self.compressed(record)?;
                }
            }
            _ => {}
        }
        Ok(())
    }
}

/// Reads the joint states of a bag; of a bag that is cut short those that are whole.
pub(super) fn read(bytes: &[u8]) -> Result<RawTable> {
    let mut bag = Bag::default();
    let ended = bag.stream(LinearReader::new_with_options(bounded().with_emit_chunks(true)), bytes, false);
    let Bag { states, others, broken, .. } = bag;
    let mut notes = Vec::new();
    if let Err(error) = ended {
        if states.rows.is_empty() {
            let message = format!("the bag ends before a joint state is whole: {error}");
            return Err(Error::new(&codes::CUT_SHORT, message));
        }
        notes.push(format!("the bag is cut short behind {} joint states ({error})", states.rows.len()));
    }
    if states.rows.is_empty() {
        let message = format!("no joint state (sensor_msgs/msg/JointState) among its topics: {}", others.join(", "));
        return Err(Error::new(&codes::NO_KNOWN_COLUMN, message));
    }
    notes.extend((broken > 0).then(|| format!("{broken} joint states cannot be decoded and were left out")));
    let mut table = states.table()?;
    table.notes = notes;
    Ok(table)
}

impl States {
    fn push(&mut self, topic: &str, state: JointState, log_time: u64) {
        let mut row = Vec::new();
        for (joint, name) in state.names.iter().enumerate() {
            for (field, values) in FIELDS.iter().zip(&state.values) {
                // What a driver does not know it leaves out, or fills with NaN.
                if let Some(value) = values.get(joint).filter(|value| value.is_finite()) {
                    row.push((self.names.place(&format!("{topic}/{name}/{field}")), *value));
                }
            }
        }
        let stamp = if state.stamp_ns > 0 { state.stamp_ns } else { i128::from(log_time) };
        self.rows.push((stamp, row));
    }

    fn table(mut self) -> Result<RawTable> {
        self.rows.sort_by_key(|(stamp, _)| *stamp);
        let width = self.names.in_order.len() + 1;
        if width.saturating_mul(self.rows.len()) > MOST_CELLS {
            let message = format!("its joint states have more than {MOST_CELLS} cells together");
            return Err(Error::new(&codes::FILE_TOO_LARGE, message));
        }
        let header = std::iter::once("time_ns".to_owned()).chain(self.names.in_order).collect();
        let mut builder = TableBuilder::new(header, 1, &[])?;
        let mut cells = vec![String::new(); width];
        for (index, (stamp, row)) in self.rows.iter().enumerate() {
            cells.iter_mut().for_each(String::clear);
            cells[0] = stamp.to_string();
            row.iter().for_each(|(place, value)| cells[place + 1] = Number::Float(*value).to_string());
            builder.push(index as u64 + 1, cells.iter().map(String::as_str))?;
        }
        Ok(builder.finish())
    }
}
