//! `arm.toml`: what a user knows about the joints of an arm. Its top is a `joint.toml` for all of them, `[joints.NAME]` one for a single joint.

use toml::{Table, Value};

use super::columns::ColumnMapping;
use super::keys::unread;
use super::surroundings::{self, Surroundings};
use super::{Joint, row_of};
use crate::error::{Error, Result, codes};

/// Names at the top of `arm.toml` that a `joint.toml` has not, beside those of its surroundings, and in a table of a single joint.
const OF_ALL: [&str; 3] = ["gravity_m_s2", "held", "joints"];
const OF_ONE: [&str; 1] = [surroundings::LINK_RADIUS];

/// What is known of an arm before a recording is read. Every key is optional.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmFile {
    /// Acceleration of gravity in the frame of the robot's root, m/s2; straight down along z when absent.
    pub gravity_m_s2: Option<[f64; 3]>,
    /// Joints that stand at zero and are not recorded, such as those of a gripper.
    pub held: Vec<String>,
    /// What a planned motion keeps clear of.
    pub surroundings: Surroundings,
    of_all: Table,
    of_one: Table,
}

impl ArmFile {
    /// Parses the text of an `arm.toml`.
    ///
    /// # Errors
    /// `FRK-D015` with its row when it is no TOML, gravity is no vector, or an obstacle no box.
    pub fn parse(text: &str) -> Result<Self> {
        let mut of_all: Table = toml::from_str(text).map_err(|error: toml::de::Error| {
            let report = Error::new(&codes::BAD_JOINT_FILE, error.message().replace('\n', "; "));
            error.span().map_or(report.clone(), |span| report.at_row(row_of(text, span.start)))
        })?;
        let bad = |key: &str, rule: &str| Err(Error::new(&codes::BAD_JOINT_FILE, rule).in_column(key));
        let gravity_m_s2 = match of_all.remove("gravity_m_s2").map(Value::try_into::<[f64; 3]>) {
            None => None,
            Some(Ok(gravity)) if gravity.iter().all(|value| value.is_finite()) => Some(gravity),
            Some(_) => return bad("gravity_m_s2", "three finite numbers are needed here"),
        };
        let held = match of_all.remove("held").map(Value::try_into::<Vec<String>>) {
            None => Vec::new(),
            Some(Ok(held)) => held,
            Some(Err(_)) => return bad("held", "this has to be a list of names of joints"),
        };
        let mut of_one = match of_all.remove("joints") {
            None => Table::new(),
            Some(Value::Table(of_one)) if of_one.values().all(Value::is_table) => of_one,
            Some(_) => return bad("joints", "this has to hold a table for each joint, as in [joints.elbow.drive]"),
        };
        let surroundings = Surroundings::take(text, &mut of_all, &mut of_one)?;
        Ok(Self { gravity_m_s2, held, surroundings, of_all, of_one })
    }

    /// What stands in the file and is read by nothing, a sentence each with the name that may have been meant.
    #[must_use]
    pub fn unknown_keys(&self) -> Vec<String> {
        let mut unknown = unread(self.of_all.keys(), "arm.toml", &[&OF_ALL[..], &surroundings::KEYS].concat());
        for (joint, table) in &self.of_one {
            let keys = table.as_table().into_iter().flat_map(Table::keys);
            unknown.extend(unread(keys, &format!("[joints.{joint}] of arm.toml"), &OF_ONE));
        }
        unknown
    }

    /// What is known of each of these joints. In the names of columns for all, `{joint}` stands for the name of the joint, `{index}` for its
    /// place counted from zero, `{number}` from one.
    ///
    /// # Errors
    /// `FRK-D015` when a key or value is not understood, or a joint is named that there is not.
    pub fn joints(&self, names: &[String]) -> Result<Vec<Joint>> {
        if let Some(unknown) = self.of_one.keys().find(|key| !names.contains(key)) {
            let message = format!("the robot has no moving joint of this name, but {}", names.join(", "));
            return Err(Error::new(&codes::BAD_JOINT_FILE, message).in_column("joints").with_value(unknown));
        }
        let joint = |(index, name): (usize, &String)| {
            let mut table = self.of_all.clone();
            if let Some(Value::Table(own)) = self.of_one.get(name) {
                lay_over(&mut table, own);
            }
            let of = || format!("joints.{name}");
            let text = toml::to_string(&table)
                .map_err(|error| Error::new(&codes::BAD_JOINT_FILE, error.to_string()).in_column(of()))?;
            // The row would be one of the text that was put together.
            let mut joint = Joint::parse(&text).map_err(|error| {
                let again =
                    Error::new(error.code(), error.message()).in_column(error.column().map_or_else(of, str::to_owned));
                again.with_value(error.value().unwrap_or_default())
            })?;
            joint.name = Some(name.clone());
            let filled = |mapping: &ColumnMapping| {
                let name = mapping.name.replace("{joint}", name);
                name.replace("{index}", &index.to_string()).replace("{number}", &(index + 1).to_string())
            };
            for mapping in joint.columns.values_mut() {
                mapping.name = filled(mapping);
            }
            Ok(joint)
        };
        names.iter().enumerate().map(joint).collect()
    }
}

/// Puts the keys of one table over those of another, table by table.
fn lay_over(below: &mut Table, above: &Table) {
    for (key, value) in above {
        match (below.get_mut(key), value) {
            (Some(Value::Table(below)), Value::Table(above)) => lay_over(below, above),
            _ => drop(below.insert(key.clone(), value.clone())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Vec<String> {
        ["shoulder", "elbow"].map(str::to_owned).to_vec()
    }

    #[test]
    fn what_holds_for_all_joints_is_filled_in_and_overridden_by_what_holds_for_one() {
        let file = ArmFile::parse(
            r#"
            gravity_m_s2 = [0.0, 9.81, 0.0]
            held = ["finger"]
            [columns]
            time = "t"
            position = { name = "actual_q_{index}", unit = "deg" }
            torque = "tau{number}_{joint}"
            [drive]
            gear_ratio = 100
            torque_constant_Nm_A = 0.1
            [joints.elbow.drive]
            gear_ratio = 50
            [joints.elbow.columns]
            torque = "e"
            "#,
        )
        .unwrap();
        assert_eq!((file.gravity_m_s2, &file.held[..]), (Some([0.0, 9.81, 0.0]), &["finger".to_owned()][..]));
        let [shoulder, elbow] = &file.joints(&names()).unwrap()[..] else { panic!() };
        assert_eq!((shoulder.drive.gear_ratio, elbow.drive.gear_ratio), (Some(100.0), Some(50.0)));
        assert_eq!((shoulder.drive.torque_constant_nm_a, elbow.drive.torque_constant_nm_a), (Some(0.1), Some(0.1)));
        assert_eq!(
            (shoulder.columns["torque"].name.as_str(), elbow.columns["torque"].name.as_str()),
            ("tau1_shoulder", "e")
        );
        assert_eq!(elbow.columns["position"].name, "actual_q_1");
        assert_eq!(elbow.name.as_deref(), Some("elbow"));
        assert_eq!(ArmFile::default().joints(&names()).unwrap().len(), 2);
    }

    #[test]
    fn what_nothing_reads_is_told() {
        let file = ArmFile::parse("[[obstacle]]\nsize_m = 1\n[drive]\n[joints.elbow]\nlink_radius = 1").unwrap();
        let [obstacle, radius] = &file.unknown_keys()[..] else { panic!("{:?}", file.unknown_keys()) };
        assert_eq!(obstacle, "nothing reads `obstacle` of arm.toml; did you mean `obstacles`?");
        assert_eq!(radius, "nothing reads `link_radius` of [joints.elbow] of arm.toml; did you mean `link_radius_m`?");
    }

    #[test]
    fn what_no_arm_can_have_is_refused_by_key() {
        for (text, told) in [
            ("[joints.wrist]", "shoulder, elbow"),
            ("[joints]\nelbow = 3", "[joints.elbow.drive]"),
            ("gravity_m_s2 = [0, 1]", "gravity_m_s2"),
            ("held = 3", "held"),
            ("[drive]\ngear_ration = 3", "gear_ration"),
            ("[joints.elbow.drive]\ngear_ratio = 0", "drive.gear_ratio"),
            ("[drive", "FRK-D015"),
        ] {
            let error = ArmFile::parse(text).and_then(|file| file.joints(&names())).unwrap_err();
            assert_eq!(error.code(), &codes::BAD_JOINT_FILE, "{text}");
            assert!(error.to_string().contains(told), "{text}: {error}");
        }
    }
}
