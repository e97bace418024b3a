//! `joint.toml`: what a user knows about the joint. Every key is optional; units are in the keys.

mod actuator;
mod arm;
mod columns;
mod drive;
mod in_recording;
mod keys;
mod surroundings;
mod urdf;

use std::path::Path;

use serde::Deserialize;

pub use actuator::{ActuatorTable, OfRecording, OfRecordings, Payload};
pub use arm::ArmFile;
pub use columns::{ColumnMapping, Columns, Side, Simulation};
pub use drive::{Drive, Limits};
pub use surroundings::{Obstacle, Surroundings};

use crate::actuator::Kind;
use crate::error::{Error, Result, codes};
use crate::files;

/// Largest `joint.toml` that is read, in bytes.
const SIZE_LIMIT_BYTES: u64 = 1 << 20;

/// Largest URDF file that is read, in bytes.
const URDF_LIMIT_BYTES: u64 = 64 << 20;

/// Lowest speed and acceleration that a limit of a joint can be, rad/s and rad/s2 (m/s, m/s2): a turn in two hundred years. A motion
/// planned within less has no end.
const SLOWEST_LIMIT: f64 = 1e-9;

/// Furthest position and highest speed and acceleration that a limit can be, in the same units: beyond any joint.
const FURTHEST_LIMIT: f64 = 1e9;

/// What is known of a joint before a recording is read.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Joint {
    /// Name of the joint; carried into the image.
    pub name: Option<String>,
    /// Columns that are not named `<quantity>_<unit>`, by quantity.
    #[serde(default)]
    pub columns: Columns,
    /// The file of `diagnose --simulation`.
    #[serde(default)]
    pub simulation: Simulation,
    /// Known rigid-body parameters; what is absent is identified together with friction.
    #[serde(default)]
    pub rigid_body: RigidBody,
    /// Parameters of the drive.
    #[serde(default)]
    pub drive: Drive,
    /// Limits within which the joint may be moved.
    #[serde(default)]
    pub limits: Limits,
    /// What makes the torque, where that is not recorded.
    #[serde(default)]
    pub actuator: ActuatorTable,
    /// A known mass at the joint.
    pub payload: Option<Payload>,
    /// What differs from recording to recording.
    #[serde(default)]
    pub recordings: OfRecordings,
    /// Columns in proportion to which something else acts on the joint, such as a pressure; the factors are identified.
    #[serde(default)]
    pub forces: Vec<String>,
    /// Tables that other commands read (the simulated plant, for one), untouched.
    #[serde(flatten)]
    pub other: toml::Table,
}

/// Known rigid-body parameters: torque = inertia * acceleration + gravity_torque * sin(position + phase).
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidBody {
    /// Inertia seen by the joint, kg m2 (kg on a linear axis); above zero.
    pub inertia_kgm2: Option<f64>,
    /// Amplitude of the gravity torque, N m.
    #[serde(rename = "gravity_torque_Nm")]
    pub gravity_torque_nm: Option<f64>,
    /// Phase of the gravity torque, rad; zero when absent.
    pub gravity_phase_rad: Option<f64>,
    /// URDF file with the rigid body, relative to `joint.toml`; all other joints are taken to stand at zero.
    pub urdf: Option<String>,
    /// Name of this joint in the URDF file; may be absent where the file has a single moving joint.
    pub joint: Option<String>,
    /// Whether a recorded rigid-body torque is right as it is; otherwise its scale, and inertia beside it, are identified.
    #[serde(default)]
    pub recorded_is_exact: bool,
}

impl Joint {
    /// Whether a load torque beside a given inertia stands for the gravity that is not given: a recorded one does, and what the payload of a
    /// commanded joint takes is off its torque already.
    pub(crate) fn load_stands_for_gravity(&self) -> bool {
        self.actuator.kind == Kind::Torque && self.rigid_body.gravity_torque_nm.is_none()
    }

    /// Actuator unit per N m (or N) at the joint: 1 unless the actuator is a current, "A".
    ///
    /// # Errors
    /// `FRK-D014` beside a current when no torque constant is given.
    pub fn actuator_per_torque(&self, actuator_unit: &str) -> Result<f64> {
        if actuator_unit != "A" {
            return Ok(1.0);
        }
        self.drive.joint_torque_per_ampere().map(f64::recip).ok_or_else(|| {
            let message =
                "a rigid body in N m beside a current needs `torque_constant_Nm_A` under [drive] of joint.toml";
            Error::new(&codes::MISSING_PARAMETER, message)
        })
    }

    /// What is known of the joint where its simulation is read: `[simulation.columns]`, else `[columns]` as far as the file has them.
    #[must_use]
    pub fn of_simulation(&self) -> Self {
        let optional = |(quantity, mapping): (&String, &ColumnMapping)| {
            (quantity.clone(), ColumnMapping { may_be_absent: true, ..mapping.clone() })
        };
        let shared = || self.columns.iter().map(optional).collect();
        let columns = self.simulation.columns.clone().unwrap_or_else(shared);
        Self { columns, simulation: Simulation { is_read: true, ..self.simulation.clone() }, ..self.clone() }
    }

    /// The table of `joint.toml` that says what the columns of the file are that is read.
    #[must_use]
    pub fn columns_table(&self) -> &'static str {
        if self.simulation.is_read { "[simulation.columns]" } else { "[columns]" }
    }

    /// Reads `joint.toml` and the URDF file that it names.
    ///
    /// # Errors
    /// `FRK-I...` when it cannot be read, `FRK-D015` with its row when a key or value is not understood.
    pub fn load(path: &Path) -> Result<Self> {
        let text = files::read_text(path, SIZE_LIMIT_BYTES)?;
        let mut joint = Self::parse(&text).map_err(|error| error.in_file(path.display().to_string()))?;
        if let Some(urdf) = joint.rigid_body.urdf.clone() {
            joint.take_from_urdf(&path.with_file_name(urdf))?;
        }
        Ok(joint)
    }

    /// Fills in what `joint.toml` leaves open from the body that moves with the joint in a URDF file.
    fn take_from_urdf(&mut self, path: &Path) -> Result<()> {
        let text = files::read_text(path, URDF_LIMIT_BYTES)?;
        let body = &mut self.rigid_body;
        let moved = urdf::moved_body(&text, body.joint.as_deref());
        let moved = moved.map_err(|error| error.in_file(path.display().to_string()))?;
        body.inertia_kgm2.get_or_insert(moved.inertia);
        if let (Some((torque, phase)), None) = (moved.gravity, body.gravity_torque_nm) {
            body.gravity_torque_nm = Some(torque);
            body.gravity_phase_rad = Some(phase);
        }
        Ok(())
    }

    /// Parses the text of a `joint.toml`.
    ///
    /// # Errors
    /// `FRK-D015` with its row when a key or value is not understood.
    pub fn parse(text: &str) -> Result<Self> {
        let joint: Self = toml::from_str(text).map_err(|error| {
            let report = Error::new(&codes::BAD_JOINT_FILE, error.message().replace('\n', "; "));
            match error.span() {
                Some(span) => report.at_row(row_of(text, span.start)),
                None => report,
            }
        })?;
        joint.check()?;
        Ok(joint)
    }

    /// Refuses numbers that no joint can have.
    fn check(&self) -> Result<()> {
        let drive = &self.drive;
        let above_zero = [
            ("rigid_body.inertia_kgm2", self.rigid_body.inertia_kgm2),
            ("drive.torque_constant_Nm_A", drive.torque_constant_nm_a),
            ("drive.counts_per_turn", drive.counts_per_turn),
            ("drive.torque_limit_Nm", drive.torque_limit_nm),
            ("drive.rate_Hz", drive.rate_hz),
            ("drive.velocity_count_rad_s", drive.velocity_count_rad_s),
            ("drive.torque_count_Nm", drive.torque_count_nm),
        ];
        let finite = [
            ("rigid_body.gravity_torque_Nm", self.rigid_body.gravity_torque_nm),
            ("rigid_body.gravity_phase_rad", self.rigid_body.gravity_phase_rad),
            ("drive.gear_ratio", drive.gear_ratio),
        ];
        let rates = [
            ("limits.velocity_rad_s", self.limits.velocity_rad_s),
            ("limits.acceleration_rad_s2", self.limits.acceleration_rad_s2),
        ];
        let positions = [
            ("limits.lowest_position_rad", self.limits.lowest_position_rad),
            ("limits.highest_position_rad", self.limits.highest_position_rad),
        ];
        for (key, value) in rates {
            let rule = format!("this has to lie between {SLOWEST_LIMIT:e} and {FURTHEST_LIMIT:e}");
            refuse(key, value, &rule, |x| (SLOWEST_LIMIT..=FURTHEST_LIMIT).contains(&x))?;
        }
        for (key, value) in positions {
            let rule = format!("this has to lie between -{FURTHEST_LIMIT:e} and {FURTHEST_LIMIT:e}");
            refuse(key, value, &rule, |x| x.abs() <= FURTHEST_LIMIT)?;
        }
        for (key, value) in above_zero {
            refuse(key, value, "this has to be a finite number above zero", |x| x.is_finite() && x > 0.0)?;
        }
        for (key, value) in finite {
            refuse(key, value, "this has to be a finite number", f64::is_finite)?;
        }
        let (lowest, highest) = (self.limits.lowest_position_rad, self.limits.highest_position_rad);
        refuse("limits.highest_position_rad", highest, "this has to lie above the lowest position", |high| {
            lowest.is_none_or(|low| low < high)
        })?;
        refuse("drive.gear_ratio", drive.gear_ratio, "a gear ratio cannot be zero", |x| x.abs() > 0.0)?;
        let simulated = self.simulation.columns.iter().flatten().map(|entry| ("simulation.columns", entry));
        for (table, (quantity, mapping)) in self.columns.iter().map(|entry| ("columns", entry)).chain(simulated) {
            let key = format!("{table}.{quantity}.scale");
            refuse(&key, Some(mapping.scale), "this has to be finite and not zero", |x| {
                x.is_finite() && x.abs() > 0.0
            })?;
        }
        self.check_actuator()
    }
}

fn refuse(key: &str, value: Option<f64>, rule: &str, accept: impl Fn(f64) -> bool) -> Result<()> {
    match value {
        Some(number) if !accept(number) => {
            Err(Error::new(&codes::BAD_JOINT_FILE, rule).in_column(key).with_value(number.to_string()))
        }
        _ => Ok(()),
    }
}

fn row_of(text: &str, offset: usize) -> u64 {
    1 + text.bytes().take(offset).filter(|byte| *byte == b'\n').count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_documented_key_is_read() {
        let joint = Joint::parse(
            r#"
            name = "elbow"
            [columns]
            velocity = { name = "dq", unit = "deg/s", side = "motor", scale = -1 }
            position = "position[1]"
            [simulation.columns]
            velocity = "qvel"
            [rigid_body]
            inertia_kgm2 = 0.5
            gravity_torque_Nm = 4.0
            gravity_phase_rad = 0.1
            [drive]
            torque_constant_Nm_A = 0.1
            gear_ratio = 100
            counts_per_turn = 8192
            torque_limit_Nm = 50
            rate_Hz = 1000
            velocity_count_rad_s = 0.001
            torque_count_Nm = 0.05
            [limits]
            lowest_position_rad = -1.5
            highest_position_rad = 2.0
            velocity_rad_s = 3.0
            acceleration_rad_s2 = 20.0
            [plant]
            anything = 1
            "#,
        )
        .unwrap();
        assert_eq!(joint.name.as_deref(), Some("elbow"));
        assert_eq!(joint.columns["velocity"].side, Side::Motor);
        assert_eq!(joint.columns["position"].name, "position[1]");
        assert_eq!(joint.of_simulation().columns.into_keys().collect::<Vec<_>>(), ["velocity"]);
        assert!((joint.drive.joint_torque_per_ampere().unwrap() - 10.0).abs() < 1e-12);
        assert!(joint.other.contains_key("plant"));
    }

    #[test]
    fn a_misspelt_key_is_refused_with_its_row() {
        let error = Joint::parse("[drive]\nrate_Hz = 1000\ngear_ration = 3\n").unwrap_err();
        assert_eq!((error.code(), error.row()), (&codes::BAD_JOINT_FILE, Some(3)));
    }

    #[test]
    fn impossible_numbers_are_refused_by_key() {
        for text in [
            "[drive]\ncounts_per_turn = 0",
            "[drive]\ngear_ratio = nan",
            "[drive]\nvelocity_count_m_s = 0",
            "[drive]\ntorque_count_A = -1",
            "[rigid_body]\ninertia_kgm2 = -1",
            "[limits]\nlowest_position_rad = 1\nhighest_position_rad = 0",
            "[simulation.columns]\nposition = { name = \"q\", scale = 0 }",
            "[limits]\nvelocity_rad_s = 1e-18",
            "[limits]\nacceleration_rad_s2 = 1e-300",
            "[limits]\nhighest_position_rad = inf",
        ] {
            let error = Joint::parse(text).unwrap_err();
            assert_eq!(error.code(), &codes::BAD_JOINT_FILE);
            assert!(error.column().is_some() && error.value().is_some());
        }
    }

    #[test]
    fn a_urdf_beside_joint_toml_fills_in_what_is_left_open() {
        let folder = tempfile::tempdir().unwrap();
        let urdf = r#"<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
            </inertial></link><joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/></joint>
            </robot>"#;
        std::fs::write(folder.path().join("arm.urdf"), urdf).unwrap();
        let path = folder.path().join("joint.toml");
        std::fs::write(&path, "[rigid_body]\nurdf = \"arm.urdf\"\njoint = \"j\"").unwrap();
        let body = Joint::load(&path).unwrap().rigid_body;
        assert!((body.inertia_kgm2.unwrap() - 0.5).abs() < 1e-12);
        assert!((body.gravity_torque_nm.unwrap() - 9.806_65).abs() < 1e-9);
        assert!(body.gravity_phase_rad.unwrap().abs() < 1e-9);
        std::fs::write(&path, "[rigid_body]\nurdf = \"absent.urdf\"").unwrap();
        assert_eq!(Joint::load(&path).unwrap_err().code(), &codes::FILE_NOT_FOUND);
    }
}
