//! `sensor_msgs/JointState` as ROS 2 (CDR: OMG DDS-XTypes 7.4) and ROS 1 write it.

use super::cursor::Cursor;

/// One message.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct JointState {
    /// Stamp of the measurement, ns; zero where the driver sets none.
    pub(super) stamp_ns: i128,
    pub(super) names: Vec<String>,
    /// Positions, velocities and efforts, in the order of the names; empty where they are not given.
    pub(super) values: [Vec<f64>; 3],
}

/// Where numbers are aligned from, and to what at most.
struct Message<'a> {
    cursor: Cursor<'a>,
    widest: usize,
    /// Whether the length of a text counts a zero at its end.
    ends_in_zero: bool,
}

impl Message<'_> {
    fn align(&mut self, size: usize) {
        self.cursor.align(size.min(self.widest));
    }

    fn u32(&mut self) -> Option<u32> {
        self.align(4);
        self.cursor.u32()
    }

    fn text(&mut self) -> Option<String> {
        let length = usize::try_from(self.u32()?).ok()?;
        let bytes = self.cursor.take(length)?;
        let bytes = if self.ends_in_zero { bytes.strip_suffix(&[0]).unwrap_or(bytes) } else { bytes };
        Some(String::from_utf8_lossy(bytes).into_owned())
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        let count = self.u32()?;
        let mut numbers = Vec::new();
        for _ in 0..count {
            self.align(8);
            numbers.push(self.cursor.f64()?);
        }
        Some(numbers)
    }

    fn rest(&mut self, seconds: i128) -> Option<JointState> {
        let nanoseconds = i128::from(self.u32()?);
        self.text()?;
        let count = self.u32()?;
        let mut names = Vec::new();
        for _ in 0..count {
            names.push(self.text()?);
        }
        let values = [self.numbers()?, self.numbers()?, self.numbers()?];
        Some(JointState { stamp_ns: seconds * 1_000_000_000 + nanoseconds, names, values })
    }
}

/// Reads a message of ROS 2; `None` where it ends early or is of another type.
pub(super) fn of_ros2(bytes: &[u8]) -> Option<JointState> {
    let (header, body) = bytes.split_at_checked(4)?;
    // Plain CDR of version 1 aligns to eight bytes, that of version 2 to four.
    let widest = match header[1] {
        0 | 1 => 8,
        6 | 7 => 4,
        _ => return None,
    };
    let mut message = Message { cursor: Cursor::new(body, header[1] % 2 == 0), widest, ends_in_zero: true };
    let seconds = i128::from(message.u32()?.cast_signed());
    message.rest(seconds)
}

/// Reads a message of ROS 1.
pub(super) fn of_ros1(bytes: &[u8]) -> Option<JointState> {
    let mut message = Message { cursor: Cursor::new(bytes, false), widest: 1, ends_in_zero: false };
    message.u32()?;
    let seconds = i128::from(message.u32()?);
    message.rest(seconds)
}
