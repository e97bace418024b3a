//! Joints that report no torque, with drawn constants: how near `trainer fit` comes to them by positions and commands alone, and whether
//! `trainer diagnose` names what is hidden beside a simulation.

use std::fmt::Write as _;
use std::path::Path;

use frikan_trainer::rollout::FREE_FALL_M_S2;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use serde_json::Value;

use crate::command::run;

/// Rate at which the drives close their loops, Hz, the low-pass of their velocities, and how many of their samples one row of the log stands for.
const DRIVE: &str = "[plant.drive]\nrate_Hz = 20000\n[plant.control]\nvelocity_corner_Hz = 2500\n";
const SAMPLES_PER_ROW: usize = 40;
/// Length of a recording, s.
const SECONDS: &str = "40";
/// Distance of a payload from the axis, m.
const PAYLOAD_M: f64 = 0.3;
/// Gains of the firmware, as it counts them, in the two recordings of a position servo.
const FIRMWARE_GAINS: [f64; 2] = [100.0, 300.0];
/// Supply of motors, V.
const SUPPLY_V: f64 = 24.0;

/// A kind of actuator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Torque by gains on position and velocity.
    Pd,
    /// A motor under a duty by a gain on the position.
    PositionServo,
    /// A recorded current.
    Current,
    /// A recorded duty.
    DcMotor,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Pd, Self::PositionServo, Self::Current, Self::DcMotor];

    /// Its name in joint.toml.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pd => "pd",
            Self::PositionServo => "position_servo",
            Self::Current => "current",
            Self::DcMotor => "dc_motor",
        }
    }
}

/// What a joint does otherwise than its simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hidden {
    /// Nothing.
    Nothing,
    /// An effect of `trainer simulate`, at a plausible strength.
    Effect(&'static str),
    /// A gain or torque constant that is smaller by this share.
    WeakGain(f64),
    /// Time until a command acts, s.
    Delay(f64),
    /// Largest torque over that of the payload at its highest.
    Limit(f64),
    /// Position error about which nothing is done, over that under Coulomb friction.
    DeadBand(f64),
}

impl Hidden {
    /// The name that a diagnosis has for it.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        match self {
            Self::Nothing => None,
            Self::Effect(name) => Some(name),
            Self::WeakGain(_) => Some("actuator_gain"),
            Self::Delay(_) => Some("command_delay"),
            Self::Limit(_) => Some("supply_or_duty_limit"),
            Self::DeadBand(_) => Some("dead_band"),
        }
    }

    /// Whether such an actuator can have it.
    #[must_use]
    pub fn is_of(self, kind: Kind) -> bool {
        // A drive with a position loop of its own does not stay stable with a late motor.
        !matches!(self, Self::DeadBand(_) | Self::Delay(_)) || matches!(kind, Kind::Pd | Kind::PositionServo)
    }
}

/// Constants of a joint, drawn from a seed.
#[derive(Clone, Debug)]
pub struct Joint {
    kind: Kind,
    seed: u64,
    /// Payloads of its two recordings, kg.
    payloads: [f64; 2],
    inertia: f64,
    coulomb: f64,
    viscous: f64,
    /// N m/A
    torque_constant: f64,
    /// ohm
    resistance: f64,
    /// N m/rad
    kp: f64,
    /// N m s/rad
    kd: f64,
}

/// A constant that was printed, or left open.
#[derive(Clone, Debug)]
pub struct Found {
    /// Its name.
    pub name: &'static str,
    /// What was found over the truth, and whether the 95 % interval holds that; nothing where it was told as not determined.
    pub value: Option<(f64, bool)>,
}

impl Joint {
    /// A joint of a kind.
    #[must_use]
    pub fn drawn(kind: Kind, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * (random.next_u64() as f64 / u64::MAX as f64);
        Self {
            kind,
            seed,
            payloads: [between(0.5, 1.0), between(1.5, 2.5)],
            inertia: between(0.2, 0.6),
            coulomb: between(0.8, 2.0),
            viscous: between(0.5, 1.5),
            torque_constant: between(2.0, 4.0),
            resistance: between(1.0, 2.5),
            kp: between(150.0, 350.0),
            kd: between(8.0, 16.0),
        }
    }

    /// Torque by the duty of a position servo, N m/rad and unit of its gain.
    fn error_gain(&self) -> f64 {
        self.kp / FIRMWARE_GAINS[1] / (SUPPLY_V * self.torque_constant / self.resistance)
    }

    /// `[actuator]` with its constants, the identified ones left out where `is_open`.
    fn actuator(&self, is_open: bool) -> String {
        let mut text = format!("[actuator]\nkind = \"{}\"\n", self.kind.name());
        // Writing to a string cannot fail.
        let mut put = |key: &str, value: f64, is_identified: bool| {
            if !(is_open && is_identified) {
                let _ = writeln!(text, "{key} = {value}");
            }
        };
        if self.kind == Kind::Pd {
            put("kp_Nm_rad", self.kp, true);
            put("kd_Nms_rad", self.kd, true);
            return text;
        }
        put("torque_constant_Nm_A", self.torque_constant, true);
        if self.kind != Kind::Current {
            put("resistance_ohm", self.resistance, false);
            put("supply_V", SUPPLY_V, false);
        }
        if self.kind == Kind::PositionServo {
            put("firmware_error_gain", self.error_gain(), false);
        }
        text
    }

    /// joint.toml of what is simulated, with the payload at a place.
    fn simulated(&self, place: usize, hidden: Hidden) -> String {
        let mut joint = self.clone();
        let weight = self.payloads[place] * FREE_FALL_M_S2 * PAYLOAD_M;
        let mut more = String::new();
        match hidden {
            Hidden::WeakGain(share) => {
                joint.torque_constant *= 1.0 - share;
                joint.kp *= 1.0 - share;
            }
            Hidden::Delay(seconds) => more = format!("delay_s = {seconds}\n"),
            Hidden::Limit(share) => more = format!("torque_limit_Nm = {}\n", share * weight + self.coulomb),
            Hidden::DeadBand(share) => more = format!("dead_band_rad = {}\n", share * self.coulomb / self.kp),
            Hidden::Nothing | Hidden::Effect(_) => {}
        }
        if self.kind == Kind::PositionServo {
            let _ = writeln!(more, "firmware_kp = {}", FIRMWARE_GAINS[place]);
        }
        // What is in the firmware stays where the motor gets weaker.
        let actuator = joint.actuator(false).replace(
            &format!("firmware_error_gain = {}", joint.error_gain()),
            &format!("firmware_error_gain = {}", self.error_gain()),
        );
        let inertia = self.inertia + self.payloads[place] * PAYLOAD_M * PAYLOAD_M;
        format!(
            "{actuator}{more}[plant]\ninertia_kgm2 = {inertia}\ngravity_torque_Nm = [{weight}]\nload_channel = \"none\"\n\
             [plant.friction]\ncoulomb_torque_Nm = {}\nviscous_Nm_s_rad = {}\n{DRIVE}",
            self.coulomb, self.viscous
        )
    }

    /// Writes a recording of the payload at a place.
    fn record(&self, at: &Path, name: &str, place: usize, hidden: Hidden) {
        std::fs::write(at.join("simulated.toml"), self.simulated(place, hidden)).expect("it is a temporary folder");
        let seed = (2 * self.seed + place as u64).to_string();
        let mut words =
            vec!["simulate", "simulated.toml", "-o", name, "--duration", SECONDS, "--seed", &seed, "--quiet"];
        let effect = match hidden {
            Hidden::Effect(effect) => format!("{effect}=1"),
            _ => String::new(),
        };
        if !effect.is_empty() {
            words.extend(["--effect", &effect]);
        }
        let done = run(at, &words);
        assert_eq!(done.status, 0, "{}", done.messages);
        let path = at.join(name);
        let text = std::fs::read_to_string(&path).expect("the program wrote it");
        std::fs::write(&path, logged(&text)).expect("it is a temporary folder");
    }

    /// joint.toml as its owner has it.
    fn described(&self, is_open: bool) -> String {
        let mut text = self.actuator(is_open);
        for (place, payload) in self.payloads.iter().enumerate() {
            let _ = writeln!(text, "[recordings.\"*-{place}.csv\"]\npayload_kg = {payload}\npayload_m = {PAYLOAD_M}");
            if self.kind == Kind::PositionServo {
                let _ = writeln!(text, "firmware_kp = {}", FIRMWARE_GAINS[place]);
            }
        }
        text
    }

    /// What `fit` prints of two recordings; the message of one that ends without an image.
    ///
    /// # Errors
    /// What the program says where it refuses.
    pub fn fitted(&self, at: &Path) -> Result<Vec<Found>, String> {
        std::fs::write(at.join("joint.toml"), self.described(true)).expect("it is a temporary folder");
        for place in [0, 1] {
            self.record(at, &format!("real-{place}.csv"), place, Hidden::Nothing);
        }
        let words =
            "fit real-0.csv real-1.csv --joint joint.toml -o model.frk --inputs velocity --json told.json --quiet";
        let done = run(at, &words.split(' ').collect::<Vec<_>>());
        if done.status != 0 {
            return Err(done.messages);
        }
        let json = read(&at.join("told.json"));
        let constants: Vec<(&'static str, f64)> = match self.kind {
            Kind::Pd => vec![("kp", self.kp), ("kd", self.kd)],
            Kind::Current => vec![("torque_constant", self.torque_constant)],
            Kind::PositionServo | Kind::DcMotor => vec![("torque_per_volt", self.torque_constant / self.resistance)],
        };
        let of_joint =
            [("coulomb_torque", self.coulomb), ("viscous_coefficient", self.viscous), ("inertia", self.inertia)];
        let truths = of_joint.into_iter().chain(constants);
        Ok(truths.map(|(name, truth)| Found { name, value: found(&json, name, truth) }).collect())
    }

    /// What a diagnosis beside a simulation names, each finding with what may stand in for it.
    #[must_use]
    pub fn diagnosed(&self, at: &Path, hidden: Hidden) -> Vec<Vec<String>> {
        std::fs::write(at.join("joint.toml"), self.described(false)).expect("it is a temporary folder");
        self.record(at, "simulation-1.csv", 1, Hidden::Nothing);
        self.record(at, "real-1.csv", 1, hidden);
        let words = "diagnose real-1.csv --simulation simulation-1.csv --joint joint.toml --json told.json --quiet";
        let done = run(at, &words.split(' ').collect::<Vec<_>>());
        assert!(done.status <= 1, "{:?} {hidden:?}: {}", self.kind, done.messages);
        let json = read(&at.join("told.json"));
        let name = |value: &Value| value["effect"].as_str().unwrap_or_default().to_owned();
        let set = |finding: &Value| {
            let rivals = finding["alternatives"].as_array().into_iter().flatten().map(name);
            std::iter::once(name(finding)).chain(rivals).collect()
        };
        json["findings"].as_array().into_iter().flatten().map(set).collect()
    }
}

/// What a drive logs of its samples, as CSV: every column as [`logged_column`] has it.
fn logged(samples: &str) -> String {
    let mut lines = samples.lines();
    let head = lines.next().unwrap_or_default();
    let mut columns: Vec<(&str, Vec<f64>)> = head.split(',').map(|name| (name, Vec::new())).collect();
    for line in lines {
        for ((_, values), cell) in columns.iter_mut().zip(line.split(',')) {
            values.push(cell.parse().expect("it is a number"));
        }
    }
    let logged: Vec<Vec<f64>> = columns.iter().map(|(name, values)| logged_column(name, values)).collect();
    let mut text = format!("{head}\n");
    for row in 0..logged.first().map_or(0, Vec::len) {
        text += &logged.iter().map(|values| values[row].to_string()).collect::<Vec<_>>().join(",");
        text.push('\n');
    }
    text
}

/// What a drive logs of the samples of a column: a current or duty as its mean about each row, since one sample of it holds what the
/// differentiated encoder makes of its counts; of the others the sample at the row.
#[must_use]
pub fn logged_column(name: &str, samples: &[f64]) -> Vec<f64> {
    if ["current_A", "duty"].contains(&name) {
        return mean_about_rows(samples);
    }
    samples.iter().step_by(SAMPLES_PER_ROW).copied().collect()
}

/// Mean of the samples about each row of the log.
#[must_use]
pub fn mean_about_rows(samples: &[f64]) -> Vec<f64> {
    let mean = |at: usize| {
        let about = &samples[at.saturating_sub(SAMPLES_PER_ROW / 2)..(at + SAMPLES_PER_ROW / 2).min(samples.len())];
        about.iter().sum::<f64>() / about.len() as f64
    };
    (0..samples.len()).step_by(SAMPLES_PER_ROW).map(mean).collect()
}

/// A printed parameter over its truth, and whether its interval holds that.
fn found(json: &Value, name: &str, truth: f64) -> Option<(f64, bool)> {
    let parameter = json["parameters"].as_array()?.iter().find(|parameter| parameter["name"] == name)?;
    let bounds = parameter["ci95"].as_array()?;
    let [low, high] = [bounds.first()?.as_f64()?, bounds.get(1)?.as_f64()?];
    Some((parameter["value"].as_f64()? / truth, low <= truth && truth <= high))
}

fn read(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).expect("the program wrote it");
    serde_json::from_str(&text).expect("it is JSON")
}
