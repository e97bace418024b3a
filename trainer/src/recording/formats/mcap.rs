//! MCAP, what ROS 2 records its bags in: every joint state becomes columns such as `/joint_states/elbow/position`.

use std::collections::BTreeMap;

use mcap::records::{Channel, Record};
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

/// The messages of a bag that may be cut short, one after the other.
struct Messages<'a> {
    reader: LinearReader,
    left: &'a [u8],
    /// Names of schemas by their number.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
}

/// A message with what its bag says of it.
struct Message {
    topic: String,
    schema: String,
    encoding: String,
    log_time: u64,
    data: Vec<u8>,
}

impl<'a> Messages<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let options = LinearReaderOptions::default().with_skip_end_magic(true).with_record_length_limit(LONGEST_RECORD);
        let reader = LinearReader::new_with_options(options);
        Self { reader, left: bytes, schemas: BTreeMap::new(), channels: BTreeMap::new() }
    }

    fn next(&mut self) -> Result<Option<Message>, McapError> {
        while let Some(event) = self.reader.next_event() {
            let (opcode, data) = match event? {
                LinearReadEvent::ReadRequest(asked) => {
                    let (now, later) = self.left.split_at(asked.min(self.left.len()));
                    self.reader.insert(now.len()).copy_from_slice(now);
                    self.reader.notify_read(now.len());
                    self.left = later;
                    continue;
                }
                LinearReadEvent::Record { opcode, data } => (opcode, data),
            };
            match parse_record(opcode, data)? {
                Record::Schema { header, .. } => {
                    self.schemas.insert(header.id, header.name);
                }
                Record::Channel(channel) => {
                    self.channels.insert(channel.id, channel);
                }
                Record::Message { header, data } => {
                    let channel = self.channels.get(&header.channel_id);
                    let channel = channel.ok_or(McapError::UnknownChannel(header.sequence, header.channel_id))?;
                    return Ok(Some(Message {
                        topic: channel.topic.clone(),
                        schema: self.schemas.get(&channel.schema_id).cloned().unwrap_or_default(),
                        encoding: channel.message_encoding.clone(),
                        log_time: header.log_time,
                        data: data.into_owned(),
                    }));
                }
                _ => {}
            }
        }
        Ok(None)
    }
}

/// Joint states in the order of their stamps.
#[derive(Default)]
struct States {
    names: Names,
    rows: Vec<(i128, Vec<(usize, f64)>)>,
}

/// Reads the joint states of a bag; of a bag that is cut short those that are whole.
pub(super) fn read(bytes: &[u8]) -> Result<RawTable> {
    let mut messages = Messages::of(bytes);
    let (mut states, mut others, mut notes, mut broken) = (States::default(), Vec::new(), Vec::new(), 0);
    loop {
        let message = match messages.next() {
            Ok(Some(message)) => message,
            Ok(None) => break,
            Err(error) if states.rows.is_empty() => {
                return Err(Error::new(
                    &codes::CUT_SHORT,
                    format!("the bag ends before a joint state is whole: {error}"),
                ));
            }
            Err(error) => {
                notes.push(format!("the bag is cut short behind {} joint states ({error})", states.rows.len()));
                break;
            }
        };
        let decode = match (message.schema.as_str(), message.encoding.as_str()) {
            ("sensor_msgs/msg/JointState", "cdr") => of_ros2,
            ("sensor_msgs/JointState", "ros1") => of_ros1,
            (kind, _) => {
                let other = format!("{} ({kind})", message.topic);
                if others.len() < 20 && !others.contains(&other) {
                    others.push(other);
                }
                continue;
            }
        };
        match decode(&message.data) {
            Some(state) => states.push(&message.topic, state, message.log_time),
            None => broken += 1,
        }
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
