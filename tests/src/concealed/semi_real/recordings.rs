//! The recordings of `shared/recordings`, each as a diagnosis takes it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use frikan_trainer::diagnose::{Lock, Options, Signals};
use frikan_trainer::error::Result;
use frikan_trainer::joint::Joint;
use frikan_trainer::recording::{self, Omission, Quantity};

/// Longest stretch of a file that is diagnosed, s.
const LONGEST_S: f64 = 60.0;

/// A recording, or the passes of one joint one behind the other.
#[derive(Clone, Debug)]
pub struct Real {
    /// Folder and file, without the pass.
    pub name: String,
    /// Its signals.
    pub signals: Signals,
    /// How it is diagnosed.
    pub options: Options,
}

/// Files of each recording under a folder, by its name. What lists the runs or was not recorded over time is none.
pub fn listed(folder: &Path) -> BTreeMap<String, Vec<PathBuf>> {
    let inside = |path: &Path| {
        let mut paths: Vec<PathBuf> =
            std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
        paths.sort();
        paths
    };
    let mut found: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for file in inside(folder).iter().filter(|path| path.is_dir()).flat_map(|path| inside(path)) {
        if holds_time(&file) {
            found.entry(name(folder, &file)).or_default().push(file);
        }
    }
    found
}

fn holds_time(file: &Path) -> bool {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    text.lines().next().is_some_and(|header| header.split(',').any(|column| column == "time_s"))
}

/// Passes of an axis of the KR300 share one name.
fn name(folder: &Path, file: &Path) -> String {
    let name = file.strip_prefix(folder).unwrap_or(file).with_extension("").display().to_string();
    match name.split_once('-') {
        Some((axis, _)) if name.starts_with("kr300/") => axis.to_owned(),
        _ => name,
    }
}

/// Description of the joint and rows that are locked away. The motor is recorded in counts; motor and pin repeat one motion, so that
/// every fifth block is a memory of its neighbours.
fn described(name: &str) -> (&'static str, Lock) {
    match name.split('/').next() {
        Some("odrive_cogging") => ("[drive]\ncounts_per_turn = 8192\n", Lock::Tail(0.5)),
        Some("tribometer") => ("", Lock::Tail(0.5)),
        _ => ("", Lock::Spread),
    }
}

impl Real {
    /// Reads a recording; of each file no more than its first minute.
    ///
    /// # Errors
    /// What keeps it from being diagnosed.
    pub fn load(name: &str, files: &[PathBuf]) -> std::result::Result<Self, String> {
        let (joint, lock) = described(name);
        let joint = Joint::parse(joint).map_err(|e| e.to_string())?;
        let mut parts = files.iter().map(|file| first_minute(file, &joint).map_err(|e| e.to_string()));
        let mut signals = parts.next().ok_or("no file")??;
        for part in parts {
            signals.append(part?).map_err(|e| e.to_string())?;
        }
        Ok(Self { name: name.to_owned(), signals, options: Options { lock, ..Options::default() } })
    }
}

fn first_minute(file: &Path, joint: &Joint) -> Result<Signals> {
    let recording = recording::load(file, joint)?;
    let time = recording.values(Quantity::Time).unwrap_or_default();
    let kept: Vec<usize> = (0..time.len()).filter(|row| time[*row] - time[0] <= LONGEST_S).collect();
    Signals::of(&recording.clone().with_rows(&kept, Omission::Interrupted), joint)
}
