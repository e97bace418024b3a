//! Keys of `joint.toml` and `arm.toml` that nothing reads.

use super::Joint;
use crate::did_you_mean::hint;

/// Names at the top of `joint.toml` that are read here.
const TABLES: [&str; 10] =
    ["name", "forces", "columns", "simulation", "rigid_body", "drive", "limits", "actuator", "payload", "recordings"];

/// Tables that others read: the simulated plant.
const READ_ELSEWHERE: [&str; 1] = ["plant"];

impl Joint {
    /// What stands in the file and is read by nothing, a sentence each with the name that may have been meant.
    #[must_use]
    pub fn unknown_keys(&self) -> Vec<String> {
        unread(self.other.keys(), "joint.toml", &[])
    }
}

/// A sentence for each of the keys at the top of a file that nothing reads; `more` are read there beside those of joint.toml.
pub(super) fn unread<'a>(keys: impl Iterator<Item = &'a String>, file: &str, more: &[&str]) -> Vec<String> {
    let names = || TABLES.iter().chain(&READ_ELSEWHERE).chain(more).copied();
    let unknown = keys.filter(|key| names().all(|name| name != key.as_str()));
    unknown.map(|key| format!("nothing reads `{key}` of {file}{}", hint(key, names()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_that_nothing_reads_are_told() {
        let joint = Joint::parse("[colums]\nposition = \"q\"\n[plant]\n[rigidbody]\n[zebra]").unwrap();
        let [columns, body, zebra] = &joint.unknown_keys()[..] else { panic!("{:?}", joint.unknown_keys()) };
        assert!(columns.ends_with("did you mean `columns`?") && body.ends_with("did you mean `rigid_body`?"));
        assert_eq!(zebra, "nothing reads `zebra` of joint.toml");
    }
}
