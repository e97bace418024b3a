//! Runs the scripts of `tests/simulators` and the command line.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use frikan_tests::command::{Run, run};
use serde_json::Value;

/// The Python of the newest simulators that has a module; `None` where it could not be installed.
pub fn python(module: &str) -> Option<PathBuf> {
    python_of("simulators", module)
}

/// The Python of an environment `target/NAME` that has some modules; `None` where they could not be installed.
pub fn python_of(name: &str, module: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../target/{name}/bin/python"));
    let import = format!("import {module}");
    if path.exists() && Command::new(&path).args(["-c", &import]).output().is_ok_and(|run| run.status.success()) {
        return Some(path);
    }
    eprintln!("skipped: no {module} under target/{name} (tests/setup.sh installs it where there is a network)");
    None
}

/// What a script of `tests/simulators` prints.
pub fn script(python: &Path, words: &[&str]) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("simulators");
    let Output { status, stdout, stderr } =
        Command::new(python).arg("-B").current_dir(folder).args(words).output().expect("Python starts");
    assert!(status.success(), "{words:?}\n{}", String::from_utf8_lossy(&stderr));
    String::from_utf8_lossy(&stdout).into_owned()
}

fn trainer(folder: &Path, line: &str) -> Run {
    run(folder, &line.split_whitespace().collect::<Vec<_>>())
}

/// What a text says as JSON.
pub fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Runs `trainer export`, which succeeds.
pub fn export(folder: &Path, line: &str) {
    let exported = trainer(folder, &format!("export {line}"));
    assert_eq!(exported.status, 0, "{}", exported.messages);
}

/// Writes `better.frk` and `found.json` from the logs of a pair.
pub fn diagnosed(folder: &Path) -> Run {
    let files = "--quiet --json found.json -o better.frk";
    let found = trainer(folder, &format!("diagnose real.csv --simulation simulated.csv --joint joint.toml {files}"));
    assert_eq!(found.status, 1, "{}", found.messages);
    found
}

/// The numbers of the first attribute of that name in an XML file.
pub fn numbers(xml: &str, name: &str) -> Vec<f64> {
    let (_, rest) = xml.split_once(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name}: {xml}"));
    let (value, _) = rest.split_once('"').expect("an attribute ends");
    value.split_whitespace().map(|word| word.parse().unwrap()).collect()
}
