//! Which columns of a long recording are kept: those that something may read.

use super::super::names::{JointState, plain, read_name};
use super::super::quantity::{ColumnName, Quantity};
use super::thinning::Thinning;
use crate::joint::Joint;

/// Rows up to which every column is kept, so that a fit can say what else friction goes with: more than it looks at in any recording.
const MOST_ROWS_OF_ALL: usize = 1 << 21;

/// Columns that have no name of a quantity and are read all the same.
const NAMED: [&str; 1] = ["trajectory"];

/// The columns that are in use.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct InUse<'a> {
    /// Tells what columns are; without one all are in use.
    joint: Option<&'a Joint>,
    /// Inputs that are asked for.
    asked: &'a [String],
    /// Memory to stay within, B.
    memory_bytes: f64,
    /// Rows from which on nothing else is kept.
    pub(in crate::recording) from_rows: usize,
}

impl<'a> InUse<'a> {
    /// All columns.
    pub(in crate::recording) fn all() -> Self {
        Self { joint: None, asked: &[], memory_bytes: f64::INFINITY, from_rows: usize::MAX }
    }

    /// Those of a joint, beside inputs that are asked for, as many rows as a memory holds.
    pub(in crate::recording) fn of(joint: &'a Joint, asked: &'a [String], memory_bytes: f64) -> Self {
        Self { joint: Some(joint), asked, memory_bytes, from_rows: MOST_ROWS_OF_ALL }
    }

    /// Which rows of a file with such columns are kept.
    pub(in crate::recording) fn thinning(&self, header: &[String]) -> Thinning {
        if self.memory_bytes.is_infinite() {
            return Thinning::none();
        }
        Thinning::within(self.memory_bytes, header.iter().filter(|column| self.holds(column)).count())
    }

    /// The same from so many rows on.
    #[cfg(test)]
    pub(in crate::recording) fn from(self, from_rows: usize) -> Self {
        Self { from_rows, ..self }
    }

    /// Whether a column is one of them: it is or nearly is a quantity of this joint or of another one, a clock, or named by somebody.
    pub(in crate::recording) fn holds(&self, column: &str) -> bool {
        let Some(joint) = self.joint else { return true };
        let mapped = || joint.columns.iter().any(|(_, mapping)| mapping.name == column);
        let is_named =
            || NAMED.contains(&column) || self.asked.iter().chain(&joint.forces).any(|name| name == column) || mapped();
        is_named() || is_clock(column) || JointState::of(column).is_some() || is_quantity(column)
    }
}

/// Whether a name may be that of a clock, or of a part of one.
fn is_clock(column: &str) -> bool {
    let name = column.to_ascii_lowercase();
    let last = name.rsplit('/').next().unwrap_or(&name);
    last == "t" || ["time", "stamp", "date", "sec"].iter().any(|word| last.contains(word))
}

/// Whether a name is that of a quantity, whatever stands before it, or `q`, `dq` and `ddq` with a number.
fn is_quantity(column: &str) -> bool {
    let ends = std::iter::once(column).chain(column.match_indices('_').map(|(at, _)| &column[at + 1..]));
    let is_known =
        |name: &str| !matches!(read_name(name, ""), ColumnName::Other) || Quantity::from_name(&plain(name)).is_some();
    let number = column.trim_start_matches('d').strip_prefix('q');
    ends.into_iter().any(is_known) || number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_read_is_in_use_and_nothing_else() {
        let joint =
            Joint::parse("forces = [\"pressure\"]\n[columns]\nvelocity = { name = \"speed\", unit = \"rad/s\" }")
                .unwrap();
        let asked = ["humidity".to_owned()];
        let in_use = InUse::of(&joint, &asked, 1e9);
        let columns = "time_s position_rad torque torque_kNm motor_temperature_C joint2_position_rad dq3 stamp.sec nanosec \
                       speed pressure humidity trajectory /joint_states/elbow/effort position";
        assert!(columns.split(' ').all(|column| in_use.holds(column)));
        let others = ["drive_temperature_raw", "bus_voltage_raw", "supply_current_raw", "status_word", "", "x"];
        assert!(others.iter().all(|column| !in_use.holds(column)));
        assert!(others.iter().all(|column| InUse::all().holds(column)));
    }
}
