//! What `arm.toml` says of the room around an arm: boxes that it may not touch, and how far it keeps away.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Spanned, Table, Value};

use super::row_of;
use crate::error::{Error, Result, codes};

/// Distance that is kept where the file gives none, m: what boxes are off that were measured by tape, about a centimetre, and as much again for the
/// path that the arm takes beside the planned one.
const CLEARANCE_M: f64 = 0.02;
/// Least and largest distance that can be asked for, m: what an arm repeats, and the reach of a large one.
const CLEARANCES_M: [f64; 2] = [0.001, 10.0];
/// Furthest place and largest size, m: beyond any arm.
const FURTHEST_M: f64 = 1e3;

/// Keys at the top of arm.toml that are read here.
pub(super) const KEYS: [&str; 3] = ["obstacles", "clearance_m", LINK_RADIUS];
pub(super) const LINK_RADIUS: &str = "link_radius_m";

/// What is around an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    /// What stands around it.
    pub obstacles: Vec<Obstacle>,
    /// Distance that is kept from obstacles, and of links from each other, m; from 0.001 to 10.
    pub clearance_m: f64,
    /// Radius of what stands in for a link whose shape is not known, m, above zero; `None` where none shall.
    pub link_radius_m: Option<f64>,
    /// The same for what a single joint moves, by the name of the joint.
    pub link_radius_of_m: BTreeMap<String, f64>,
}

/// A box that does not move, in the frame of the robot's base.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// What it is called; by its place from one, as `1`, when absent.
    #[serde(default)]
    pub name: String,
    /// Middle, m.
    pub centre_m: [f64; 3],
    /// Lengths of its edges, m; above zero.
    pub size_m: [f64; 3],
    /// Turn about the fixed axes x, y and z, one after the other, rad.
    #[serde(default)]
    pub rpy_rad: [f64; 3],
}

#[derive(Deserialize)]
struct Keys {
    #[serde(default)]
    obstacles: Vec<Spanned<Obstacle>>,
    clearance_m: Option<f64>,
    link_radius_m: Option<f64>,
}

impl Default for Surroundings {
    fn default() -> Self {
        Self { obstacles: Vec::new(), clearance_m: CLEARANCE_M, link_radius_m: None, link_radius_of_m: BTreeMap::new() }
    }
}

impl Surroundings {
    /// Takes what belongs here out of the tables of an arm.toml: its top, and that of its joints.
    ///
    /// # Errors
    /// `FRK-D015` with row or key where a key or value is not understood.
    pub(super) fn take(text: &str, of_all: &mut Table, of_one: &mut Table) -> Result<Self> {
        let keys: Keys = toml::from_str(text).map_err(|error| {
            let report = Error::new(&codes::BAD_JOINT_FILE, error.message().replace('\n', "; "));
            error.span().map_or(report.clone(), |span| report.at_row(row_of(text, span.start)))
        })?;
        KEYS.iter().for_each(|key| drop(of_all.remove(*key)));
        let clearance_m = keys.clearance_m.unwrap_or(CLEARANCE_M);
        let [least, most] = CLEARANCES_M;
        if !(least..=most).contains(&clearance_m) {
            return Err(bad("clearance_m", &format!("this has to lie between {least} and {most}"), clearance_m));
        }
        let mut obstacles = Vec::with_capacity(keys.obstacles.len());
        for (index, spanned) in keys.obstacles.into_iter().enumerate() {
            let row = row_of(text, spanned.span().start);
            let mut obstacle = spanned.into_inner();
            if obstacle.name.is_empty() {
                obstacle.name = (index + 1).to_string();
            }
            obstacle.check().map_err(|error| error.at_row(row))?;
            obstacles.push(obstacle);
        }
        let link_radius_m = keys.link_radius_m.map(|radius| checked_radius(LINK_RADIUS, radius)).transpose()?;
        let mut link_radius_of_m = BTreeMap::new();
        for (joint, table) in of_one {
            let Some(given) = table.as_table_mut().and_then(|table| table.remove(LINK_RADIUS)) else { continue };
            let key = format!("joints.{joint}.{LINK_RADIUS}");
            let number = match given {
                Value::Float(number) => number,
                Value::Integer(number) => number as f64,
                other => return Err(bad(&key, "this has to be a number above zero", other)),
            };
            link_radius_of_m.insert(joint.clone(), checked_radius(&key, number)?);
        }
        Ok(Self { obstacles, clearance_m, link_radius_m, link_radius_of_m })
    }

    /// Radius of what stands in for a link that this joint moves; `None` is the base.
    #[must_use]
    pub fn link_radius(&self, joint: Option<&str>) -> Option<f64> {
        joint.and_then(|joint| self.link_radius_of_m.get(joint).copied()).or(self.link_radius_m)
    }
}

impl Obstacle {
    fn check(&self) -> Result<()> {
        let place = format!("this has to lie between -{FURTHEST_M} and {FURTHEST_M}");
        let size = format!("this has to be a number above zero, {FURTHEST_M} at most");
        for value in self.centre_m {
            if !(-FURTHEST_M..=FURTHEST_M).contains(&value) {
                return Err(bad("obstacles.centre_m", &place, value));
            }
        }
        for value in self.size_m {
            if !(value > 0.0 && value <= FURTHEST_M) {
                return Err(bad("obstacles.size_m", &size, value));
            }
        }
        match self.rpy_rad.iter().find(|angle| !angle.is_finite()) {
            Some(angle) => Err(bad("obstacles.rpy_rad", "this has to be a finite number", angle)),
            None => Ok(()),
        }
    }
}

fn checked_radius(key: &str, radius: f64) -> Result<f64> {
    if radius > 0.0 && radius <= FURTHEST_M {
        Ok(radius)
    } else {
        Err(bad(key, "this has to be a number above zero", radius))
    }
}

fn bad(key: &str, rule: &str, value: impl ToString) -> Error {
    Error::new(&codes::BAD_JOINT_FILE, rule).in_column(key).with_value(value.to_string())
}

#[cfg(test)]
mod tests {
    use super::super::ArmFile;
    use super::*;

    #[test]
    fn obstacles_and_radii_are_read_and_are_no_keys_of_joints() {
        let file = ArmFile::parse(
            r#"
            clearance_m = 0.05
            link_radius_m = 0.1
            [[obstacles]]
            name = "table"
            centre_m = [0.5, 0, -0.1]
            size_m = [1, 1, 0.2]
            [[obstacles]]
            centre_m = [0.0, 0.0, 2.0]
            size_m = [1.0, 1.0, 0.1]
            rpy_rad = [0.0, 0.1, 0.0]
            [joints.elbow]
            link_radius_m = 1
            "#,
        )
        .unwrap();
        let around = &file.surroundings;
        assert_eq!((around.clearance_m, around.obstacles.len()), (0.05, 2));
        assert_eq!((around.obstacles[0].name.as_str(), around.obstacles[1].name.as_str()), ("table", "2"));
        assert_eq!((around.obstacles[0].size_m, around.obstacles[1].rpy_rad), ([1.0, 1.0, 0.2], [0.0, 0.1, 0.0]));
        assert_eq!(
            [Some("elbow"), Some("wrist"), None].map(|joint| around.link_radius(joint)),
            [Some(1.0), Some(0.1), Some(0.1)]
        );
        let joints = file.joints(&["elbow".to_owned()]).unwrap();
        assert!(joints[0].other.is_empty(), "{:?}", joints[0].other);
        let without = ArmFile::parse("").unwrap().surroundings;
        assert_eq!((without.clearance_m, without.link_radius(Some("elbow"))), (CLEARANCE_M, None));
        assert_eq!(without, ArmFile::default().surroundings);
    }

    #[test]
    fn boxes_that_cannot_be_are_refused_by_row_and_key() {
        let table = "\n[[obstacles]]\nname = \"t\"\ncentre_m = [0, 0, 0]\nsize_m = [1, 1, 1]\n";
        for (text, row, told) in [
            (table.replace("size_m", "sice_m"), Some(5), "size_m"),
            (table.replace("size_m = [1, 1, 1]", ""), Some(2), "size_m"),
            (table.replace("[1, 1, 1]", "[1, 0, 1]"), Some(2), "obstacles.size_m"),
            (table.replace("[1, 1, 1]", "[1, nan, 1]"), Some(2), "obstacles.size_m"),
            (table.replace("[1, 1, 1]", "[1, 1]"), Some(5), "3"),
            (table.replace("[0, 0, 0]", "[0, inf, 0]"), Some(2), "obstacles.centre_m"),
            (format!("{table}rpy_rad = [0, nan, 0]"), Some(2), "obstacles.rpy_rad"),
            ("obstacles = 3".to_owned(), Some(1), "obstacles"),
            ("clearance_m = 0".to_owned(), None, "clearance_m"),
            ("clearance_m = -1".to_owned(), None, "clearance_m"),
            ("clearance_m = \"far\"".to_owned(), Some(1), "clearance_m"),
            ("link_radius_m = 0".to_owned(), None, "link_radius_m"),
            ("[joints.elbow]\nlink_radius_m = nan".to_owned(), None, "joints.elbow.link_radius_m"),
            ("[joints.elbow]\nlink_radius_m = \"wide\"".to_owned(), None, "joints.elbow.link_radius_m"),
        ] {
            let error = ArmFile::parse(&text).unwrap_err();
            assert_eq!((error.code(), error.row()), (&codes::BAD_JOINT_FILE, row), "{text}: {error}");
            let said =
                format!("{error} {}", text.lines().nth(error.row().unwrap_or(1) as usize - 1).unwrap_or_default());
            assert!(said.contains(told), "{text}: {error}");
        }
    }
}
