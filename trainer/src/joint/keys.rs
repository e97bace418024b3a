//! Keys of `joint.toml` that nothing reads.

use super::Joint;

/// Names at the top of `joint.toml` that are read here.
const TABLES: [&str; 6] = ["name", "columns", "simulation", "rigid_body", "drive", "limits"];

/// Tables that others read: the simulated plant, and what is known of the actuator.
const READ_ELSEWHERE: [&str; 2] = ["plant", "actuator"];

/// Likeness by Jaro and Winkler (0..1) from which on a name is proposed for another, as the command line proposes options.
const DID_YOU_MEAN: f64 = 0.8;

impl Joint {
    /// What stands in the file and is read by nothing, a sentence each with the name that may have been meant.
    #[must_use]
    pub fn unknown_keys(&self) -> Vec<String> {
        let unknown = self.other.keys().filter(|key| !READ_ELSEWHERE.contains(&key.as_str()));
        let nearest = |key: &str| {
            let names = TABLES.iter().chain(&READ_ELSEWHERE);
            let near = names.map(|name| (strsim::jaro_winkler(&key.to_lowercase(), name), *name));
            near.filter(|(likeness, _)| *likeness > DID_YOU_MEAN)
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .map(|(_, name)| name)
        };
        let sentence = |key: &String| match nearest(key) {
            Some(name) => format!("nothing reads `{key}` of joint.toml; did you mean `{name}`?"),
            None => format!("nothing reads `{key}` of joint.toml"),
        };
        unknown.map(sentence).collect()
    }
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
