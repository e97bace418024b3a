//! Recordings of single joints of an arm as files.

use std::collections::BTreeSet;

use super::fitted::file_name;
use crate::arm::fit::JointOutcome;
use crate::csv_text::csv_text;
use crate::recording::{Channel, Recording};

/// What `fit` and `diagnose` have to know to take the torque of the bodies as it is.
const JOINT_FILE: &str = "# The torque of the bodies beside the joint's own is that of the whole arm.\n[rigid_body]\nrecorded_is_exact = true\n";

/// The files of a joint.
pub(super) fn of_joint(joint: &JointOutcome) -> Vec<(String, String)> {
    let name = file_name(&joint.name);
    let mut seen = BTreeSet::new();
    let mut files = vec![(format!("{name}.toml"), format!("name = {:?}\n{JOINT_FILE}", joint.name))];
    for recording in &joint.recordings {
        let stem = recording.label.split('.').next().unwrap_or("recording");
        let mut file = format!("{}-{name}.csv", file_name(stem));
        while !seen.insert(file.clone()) {
            file = format!("again-{file}");
        }
        files.push((file, csv(recording)));
    }
    files
}

/// The channels of a recording in SI.
fn csv(recording: &Recording) -> String {
    let suffix = |channel: &Channel| {
        let units = channel.quantity.map_or(&[][..], |quantity| quantity.units());
        units.iter().find(|unit| unit.si == channel.unit && unit.factor == 1.0).map_or("", |unit| unit.suffix)
    };
    let columns = recording.channels.iter();
    let named: Vec<_> =
        columns.map(|channel| (format!("{}_{}", channel.name, suffix(channel)), &channel.values[..])).collect();
    csv_text(&named)
}
