//! Writes the files of a case and asks the command line what it says of them.

use super::recording::{Compared, Material, Recording};
use crate::command;
use serde_json::Value;
use std::path::Path;

/// One finding.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The named effect.
    pub effect: String,
    /// What the recording cannot tell from it.
    pub alternatives: Vec<String>,
}

/// What the diagnosis says.
#[derive(Clone, Debug)]
pub enum Answer {
    /// Its findings, in their order.
    Findings(Vec<Finding>),
    /// It refuses the recording with this message.
    Refused(String),
}

/// Writes the files into `folder` and diagnoses them there.
///
/// # Errors
/// What keeps the files from being written, the model from being fitted or the answer from being read.
pub fn diagnose(material: &Material, folder: &Path) -> Result<Answer, String> {
    write(folder, "real.csv", &material.real)?;
    let mut arguments = vec!["diagnose", "real.csv", "--json", "-", "--quiet"];
    if let Some(joint) = &material.joint {
        put(folder, "joint.toml", joint)?;
        arguments.extend(["--joint", "joint.toml"]);
    }
    match &material.compared {
        Compared::Itself => {}
        Compared::Simulation(simulation) => {
            write(folder, "simulation.csv", simulation)?;
            arguments.extend(["--simulation", "simulation.csv"]);
        }
        Compared::Model(recording) => {
            write(folder, "clean.csv", recording)?;
            fit(folder, material.joint.is_some())?;
            arguments.extend(["--model", "clean.frk"]);
        }
    }
    let run = command::run(folder, &arguments);
    if run.output.trim().is_empty() {
        return Ok(Answer::Refused(last_line(&run.messages)));
    }
    let json: Value = serde_json::from_str(&run.output).map_err(|error| format!("{error}: {}", run.output))?;
    let findings = json["findings"].as_array().ok_or("an answer without findings")?;
    findings.iter().map(finding).collect::<Result<_, _>>().map(Answer::Findings)
}

fn finding(json: &Value) -> Result<Finding, String> {
    let name = |json: &Value| json["effect"].as_str().map(str::to_owned).ok_or("a finding without an effect");
    let alternatives = json["alternatives"].as_array().ok_or("a finding without alternatives")?;
    let alternatives = alternatives.iter().map(name).collect::<Result<_, _>>()?;
    Ok(Finding { effect: name(json)?, alternatives })
}

fn fit(folder: &Path, with_joint: bool) -> Result<(), String> {
    let mut arguments = vec!["fit", "clean.csv", "-o", "clean.frk", "--quiet"];
    if with_joint {
        arguments.extend(["--joint", "joint.toml"]);
    }
    let run = command::run(folder, &arguments);
    // A fit that is not identifiable in every parameter is a model nevertheless.
    let is_there = folder.join("clean.frk").exists();
    if is_there { Ok(()) } else { Err(format!("no model: {}", last_line(&run.messages))) }
}

fn write(folder: &Path, name: &str, recording: &Recording) -> Result<(), String> {
    put(folder, name, &recording.csv())
}

fn put(folder: &Path, name: &str, text: &str) -> Result<(), String> {
    std::fs::write(folder.join(name), text).map_err(|error| format!("{name}: {error}"))
}

fn last_line(text: &str) -> String {
    text.trim().lines().last().unwrap_or("no message").to_owned()
}
