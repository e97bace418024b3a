//! The order of the source: files and rooms import each other in one direction, rooms know only what they may, files and
//! folders stay small.

mod circles;
mod crates;
mod exempt;
mod names;
mod source;
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crates::{Crate, crates};
use exempt::{Violation, lies_in, none_but};

/// Files that import each other in a circle. This list shall become empty.
const FILES_IN_CIRCLES: [&str; 11] = [
    "runtime/src/effects",
    "tests/src/models",
    "tests/src/paper/page",
    "tests/src/second_opinion",
    "trainer/src/compile/steps",
    "trainer/src/diagnose/advice",
    "trainer/src/diagnose/comparison/simulation",
    "trainer/src/error",
    "trainer/src/physics",
    "trainer/src/recording",
    "trainer/src/samples",
];

/// Modules side by side that import each other in a circle. This list shall become empty.
const ROOMS_IN_CIRCLES: [&str; 2] = ["tests/src/second_opinion/singles", "trainer/src/samples"];

/// Most lines of a file.
const MOST_LINES: usize = 350;

/// Most files of a folder.
const MOST_FILES: usize = 15;

/// Folders with more files. This list shall become empty but for `physics`, which has one file for each effect.
const CROWDED: [&str; 1] = ["trainer/src/physics"];

/// A place, and the files or paths of other crates that nothing in it may import.
type Never = (&'static str, &'static [&'static str]);

/// What must not know what.
const NEVER: [Never; 18] = [
    ("shared", &["frikan_runtime", "frikan_trainer", "frikan_tests"]),
    ("runtime", &["frikan_trainer", "frikan_tests"]),
    ("trainer", &["frikan_tests"]),
    ("trainer/src/samples", FILES_AND_USERS),
    ("trainer/src/kan", FILES_AND_USERS),
    ("trainer/src/law", FILES_AND_USERS),
    ("trainer/src/physics", FILES_AND_USERS),
    ("trainer/src/diagnose", FILES_AND_USERS),
    ("trainer/src/plant", FILES_AND_USERS),
    ("trainer/src/actuator", FILES_AND_USERS),
    ("trainer/src/rollout", FILES_AND_USERS),
    ("trainer/src/servo", FILES_AND_USERS),
    // What identifies a joint shares no code with the simulator that rehearses it.
    ("trainer/src/rollout", &["trainer/src/plant"]),
    ("trainer/src/fleet", FILES_AND_USERS),
    ("trainer/src/arm", FILES_AND_USERS),
    // The proof on concealed data would prove nothing if simulator and diagnosis shared code.
    ("trainer/src/plant", &["trainer/src/diagnose", "trainer/src/physics"]),
    ("trainer/src/diagnose", &["trainer/src/plant"]),
    ("trainer/src/physics", &["trainer/src/plant"]),
];

/// What the core must not know.
const FILES_AND_USERS: &[&str] = &["trainer/src/commands", "trainer/src/report", "trainer/src/files", "std::fs"];

/// Places that import what they must not. This list shall stay empty.
const IN_THE_WRONG_DIRECTION: [&str; 0] = [];

#[test]
fn no_files_import_each_other_in_a_circle() {
    none_but(&FILES_IN_CIRCLES, &crates().iter().flat_map(circles::of_files).collect::<Vec<_>>());
}

#[test]
fn no_rooms_import_each_other_in_a_circle() {
    none_but(&ROOMS_IN_CIRCLES, &crates().iter().flat_map(circles::of_rooms).collect::<Vec<_>>());
}

#[test]
fn rooms_know_only_what_they_may() {
    none_but(&IN_THE_WRONG_DIRECTION, &crates().iter().flat_map(|of| wrong_directions(of, &NEVER)).collect::<Vec<_>>());
}

#[test]
fn files_and_folders_stay_small() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the repository");
    let crates = crates();
    let files: BTreeSet<&Path> = crates.iter().flat_map(|of| &of.modules).map(|module| &*module.file).collect();
    let mut folders: BTreeMap<&Path, usize> = BTreeMap::new();
    let mut long = Vec::new();
    for file in files {
        *folders.entry(file.parent().expect("a file lies in a folder")).or_default() += 1;
        let lines = std::fs::read_to_string(top.join(file)).expect("a module can be read").lines().count();
        if lines > MOST_LINES {
            let text = format!("    {} has {lines} lines, more than {MOST_LINES}", file.display());
            long.push(Violation { text, places: vec![file.display().to_string()] });
        }
    }
    none_but(&[], &long);
    let crowded = folders.into_iter().filter(|(_, count)| *count > MOST_FILES).map(|(folder, count)| Violation {
        text: format!("    {} has {count} files, more than {MOST_FILES}", folder.display()),
        places: vec![folder.display().to_string()],
    });
    none_but(&CROWDED, &crowded.collect::<Vec<_>>());
}

/// Imports that a rule forbids.
fn wrong_directions(of: &Crate, rules: &[Never]) -> Vec<Violation> {
    let name = |file: &Path| file.display().to_string();
    let files = of.imports.files.keys().map(|(from, to)| (name(from), name(to)));
    let outside = of.imports.outside.iter().map(|(from, path)| (name(from), path.clone()));
    let mut found = Vec::new();
    for (from, to) in files.chain(outside) {
        let forbids = |(place, never): &Never| {
            lies_in(&from, place)
                && never.iter().any(|never| lies_in(&to.replace("::", "/"), &never.replace("::", "/")))
        };
        if rules.iter().any(forbids) {
            found.push(Violation { text: format!("    {from} must not import {to}"), places: vec![from] });
        }
    }
    found
}
