//! What a fit tells of a joint that reports no torque.

use std::fmt::Write;

use crate::actuator::Constant;
use crate::servo::Identified;

/// The constants in force as `[actuator]` of a joint.toml.
pub(super) fn table(identified: &Identified) -> String {
    let mut text =
        String::from("# What was identified of the actuator, beside what joint.toml says of it.\n[actuator]\n");
    // Writing to a string cannot fail.
    let _ = writeln!(text, "kind = \"{}\"", identified.partial.actuator.kind.name());
    for (constant, value) in identified.partial.in_force() {
        let _ = writeln!(text, "{} = {value}", Constant::key(constant));
    }
    text
}
