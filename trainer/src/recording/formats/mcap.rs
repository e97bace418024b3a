//! MCAP, what ROS 2 records its bags in: every joint state becomes columns such as `/joint_states/elbow/position`.

use mcap::MessageStream;
use mcap::read::Options;

use super::cursor::Number;
use super::joint_state::{JointState, of_ros1, of_ros2};
use super::names::Names;
use super::{MOST_CELLS, damaged};
use crate::error::{Error, Result, codes};
use crate::recording::table::{RawTable, TableBuilder};

/// Fields of a joint state, by which its columns are named.
const FIELDS: [&str; 3] = ["position", "velocity", "effort"];

/// Joint states in the order of their stamps.
#[derive(Default)]
struct States {
    names: Names,
    rows: Vec<(i128, Vec<(usize, f64)>)>,
}

/// Reads the joint states of a bag; of a bag that is cut short those that are whole.
pub(super) fn read(bytes: &[u8]) -> Result<RawTable> {
    let stream = MessageStream::new_with_options(bytes, Options::IgnoreEndMagic.into()).map_err(damaged)?;
    let (mut states, mut others, mut notes, mut broken) = (States::default(), Vec::new(), Vec::new(), 0);
    for message in stream {
        let message = match message {
            Ok(message) => message,
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
        let kind = message.channel.schema.as_ref().map_or("", |schema| schema.name.as_str());
        let decode = match (kind, message.channel.message_encoding.as_str()) {
            ("sensor_msgs/msg/JointState", "cdr") => of_ros2,
            ("sensor_msgs/JointState", "ros1") => of_ros1,
            _ => {
                let other = format!("{} ({kind})", message.channel.topic);
                if others.len() < 20 && !others.contains(&other) {
                    others.push(other);
                }
                continue;
            }
        };
        match decode(&message.data) {
            Some(state) => states.push(&message.channel.topic, state, message.log_time),
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
