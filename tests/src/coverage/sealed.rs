//! Whether the 95 % interval of a diagnosis' sealed ratio holds the ratio of the two models on a recording that neither has seen.

use std::path::Path;

use serde_json::Value;

use crate::command::called;
use crate::table::columns;

/// Effects that are hidden, with their amplitude.
pub const EFFECTS: [&str; 4] = ["position_ripple=2", "presliding=1", "direction_asymmetry=1", "viscous_nonlinearity=2"];
/// Length of a recording that is diagnosed, s.
const RECORDED_S: u32 = 60;
/// Length of the fresh recording, s: twenty times what lies within the sealed rows of the diagnosed one, and more.
const FRESH_S: u32 = 300;
/// Motion seeds of the fresh recordings lie so far from those of the diagnosed ones.
const FRESH_SEED: u64 = 1 << 32;

/// One diagnosed recording.
#[derive(Clone, Debug)]
pub struct Case {
    /// Ratio on the sealed rows.
    pub ratio: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Ratio on the fresh recording.
    pub fresh: f64,
    /// Stretches of sealed rows.
    pub stretches: usize,
}

impl Case {
    /// Whether the interval holds what the fresh recording gives.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.ci95[0] <= self.fresh && self.fresh <= self.ci95[1]
    }
}

/// Writes joint and law that all recordings are compared with into `folder`: the law is fitted to a recording that hides nothing.
///
/// # Panics
/// Where a command fails.
pub fn prepare(folder: &Path) {
    std::fs::copy(crate::fixtures::folder().join("elbow.toml"), folder.join("joint.toml")).expect("it is a fixture");
    called(folder, "simulate joint.toml --duration 60 --seed 1 -o plain.csv --quiet");
    called(folder, "fit plain.csv --joint joint.toml --inputs velocity -o law.frk --quiet --steps 30 --restarts 1");
}

/// Hides an effect in a recording, diagnoses it, and compares its sealed ratio with a fresh recording's; `None` where nothing was found
/// or no row is sealed. `folder` is the case's own, beneath that of [`prepare`].
///
/// # Panics
/// Where a command fails.
#[must_use]
pub fn case(folder: &Path, effect: &str, seed: u64) -> Option<Case> {
    let simulate = |seconds: u32, motion: u64, file: &str| {
        let words =
            format!("--effect {effect} --duration {seconds} --seed {seed} --motion-seed {motion} -o {file} --quiet");
        called(folder, &format!("simulate ../joint.toml {words}"));
    };
    simulate(RECORDED_S, seed, "real.csv");
    let status = called(
        folder,
        "diagnose real.csv --model ../law.frk --joint ../joint.toml -o improved.frk --json told.json --quiet",
    );
    let told: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("told.json")).ok()?).ok()?;
    let sealed = &told["sealed"];
    // A model that is worse on its sealed rows is not written.
    if status == 0 || sealed.is_null() || !folder.join("improved.frk").exists() {
        return None;
    }
    let when_s: Vec<[f64; 2]> = serde_json::from_value(sealed["when_s"].clone()).ok()?;
    let figure = |value: &Value| value.as_f64().expect("a figure of the diagnosis");
    simulate(FRESH_S, seed + FRESH_SEED, "fresh.csv");
    // What the recording has not shown is extrapolation, of which its sealed rows cannot tell.
    let shown = Shown::by(&residuals(folder, "../law.frk", "real.csv"));
    let [before, after] =
        ["../law.frk", "improved.frk"].map(|model| shown.energy(&residuals(folder, model, "fresh.csv")));
    Some(Case {
        ratio: figure(&sealed["ratio"]),
        ci95: [figure(&sealed["ci95"][0]), figure(&sealed["ci95"][1])],
        fresh: (after / before).sqrt(),
        stretches: when_s.len(),
    })
}

/// A row of a prediction.
struct Row {
    time: f64,
    position: f64,
    residual: f64,
}

/// The positions, rad, and the largest speed, rad/s, of a recording.
struct Shown {
    positions: [f64; 2],
    speed: f64,
}

/// Speed from a row to the next, rad/s; 0 for a resting joint, which shows the same position twice.
fn speed(pair: &[Row]) -> f64 {
    ((pair[1].position - pair[0].position) / (pair[1].time - pair[0].time)).abs()
}

impl Shown {
    fn by(rows: &[Row]) -> Self {
        let positions = rows.iter().map(|row| row.position);
        Self {
            positions: [positions.clone().fold(f64::INFINITY, f64::min), positions.fold(f64::NEG_INFINITY, f64::max)],
            speed: rows.windows(2).map(speed).fold(0.0, f64::max),
        }
    }

    /// Sum of the squared residuals of the rows of such motion.
    fn energy(&self, rows: &[Row]) -> f64 {
        let [low, high] = self.positions;
        let is_shown = |pair: &&[Row]| {
            let speed = speed(pair);
            speed > 0.0 && speed <= self.speed && (low..=high).contains(&pair[0].position)
        };
        rows.windows(2).filter(is_shown).map(|pair| pair[0].residual * pair[0].residual).sum()
    }
}

fn residuals(folder: &Path, model: &str, file: &str) -> Vec<Row> {
    called(folder, &format!("predict {model} {file} --joint ../joint.toml -o predicted.csv --quiet"));
    let rows = columns(&folder.join("predicted.csv"), ["time_s", "position_rad", "residual_Nm"]);
    rows.into_iter().map(|[time, position, residual]| Row { time, position, residual }).collect()
}
