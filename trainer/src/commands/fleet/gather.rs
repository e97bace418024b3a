//! `trainer gather`: the results of all tasks as one table, and which joints differ from their siblings.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use rayon::prelude::*;
use serde_json::Value;

use super::gathered::{Fitted, Gathered, Unfitted};
use super::stamp::day;
use super::table::{self, table};
use super::task::{Done, FLEET_FILE, Task, Tasks};
use super::told::{json, text};
use crate::commands::output::{Outputs, command_line, refuse_unwritable};
use crate::commands::progress::Reporter;
use crate::error::{Error, Result, codes};
use crate::files::{create_folder, refuse_folder};
use crate::fleet::{FittedLaw, Measured, Ripple, survey};
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;
use crate::report;

/// Gather the results of all tasks into a table of all joints (joints.csv, joints.parquet, fleet.json, fleet.html), and say which joints
/// differ from their siblings.
///
/// Joints of one kind are described by one law, the best for all. Each is compared with its siblings by its friction at three speeds, its
/// strongest ripple, its residual and the trend of its friction, as far as known; each quantity has a spread of its own among siblings,
/// and of the joints that are flagged a share of at most `--false-share` is expected to be healthy.
///
/// Exit status: 0 all is well, 1 a joint is flagged or a task failed or is missing, 3 the list is none, 5 input or output.
#[derive(Args, Clone, Debug)]
pub struct Gather {
    /// List that `plan` wrote
    #[arg(long, value_name = "TASKS.jsonl")]
    pub tasks: PathBuf,
    /// Folder for the tables; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Share of the flagged joints that may be healthy (Benjamini and Hochberg)
    #[arg(long, value_name = "SHARE", default_value_t = 0.05, value_parser = parse_share)]
    pub false_share: f64,
    /// Also write the result as JSON here; `-` for standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// What a task left.
enum Left<'a> {
    Fit(Fitted<'a>, Measured),
    NoFit(Unfitted<'a>),
}

/// Runs the command and returns its exit status.
///
/// # Errors
/// `FRK-D044` for a list that is none, `FRK-I...` where a file cannot be read or written.
pub fn run(arguments: &Gather) -> Result<u8> {
    refuse_unwritable(&arguments.json, &[&arguments.tasks])?;
    refuse_folder(&arguments.output)?;
    let tasks = Tasks::in_file(&arguments.tasks);
    let list = tasks.all()?;
    let reporter = Reporter::new(arguments.quiet);
    let (read, all) = (AtomicUsize::new(0), list.len());
    let left = |task| {
        reporter.say(&format!("reading result {} of {all}", read.fetch_add(1, Ordering::Relaxed) + 1));
        left_by(task, tasks.result(task)?)
    };
    let results: Vec<Result<Left<'_>>> = list.par_iter().map(left).collect();
    reporter.say("comparing joints with their siblings");
    let (mut measured, mut fitted, mut unfitted) = (Vec::new(), Vec::new(), Vec::new());
    for result in results {
        match result? {
            Left::Fit(task, of_siblings) => {
                fitted.push(task);
                measured.push(of_siblings);
            }
            Left::NoFit(task) => unfitted.push(task),
        }
    }
    let survey = survey(&measured, arguments.false_share);
    let gathered = Gathered { survey, fitted, unfitted };
    reporter.say("writing tables");
    let columns = table(&gathered);
    let mut outputs = Outputs::default();
    let at = |name: &str| arguments.output.join(name);
    outputs.add(&at("joints.csv"), table::csv(&columns)?);
    #[cfg(feature = "parquet")]
    outputs.add(&at("joints.parquet"), table::parquet(&columns)?);
    let json = json(&gathered);
    outputs.add_json(&at(FLEET_FILE), json.clone());
    let (headline, lines) = text(&gathered);
    let origin = report::Origin { command: &command_line(), recordings: &[], settings: "" };
    outputs.add(&at("fleet.html"), report::fleet(&gathered.survey, &headline, &lines, &curves(&measured), &origin));
    if let Some(path) = &arguments.json {
        outputs.add_json(path, json);
    }
    if arguments.json.as_deref() != Some(Path::new("-")) {
        let lines: String = lines.iter().map(|line| format!("  * {line}\n")).collect();
        outputs.add(Path::new("-"), format!("{headline}\n{lines}"));
    }
    outputs.refuse_overwriting(&[&arguments.tasks])?;
    create_folder(&arguments.output)?;
    drop(reporter);
    outputs.write()?;
    let is_well = gathered.unfitted.is_empty() && !gathered.survey.members.iter().any(|member| member.is_outlier);
    Ok(u8::from(!is_well))
}

/// Friction curves by joint, as the page draws them.
fn curves(measured: &[Measured]) -> Vec<(&str, &[[f64; 3]])> {
    measured.iter().map(|recording| (recording.joint.as_str(), recording.curve.as_slice())).collect()
}

/// What a task left, of which the JSON is read and let go.
fn left_by(task: &Task, done: Option<Done>) -> Result<Left<'_>> {
    let Some(done) = done else { return Ok(Left::NoFit(Unfitted { task, failure: None })) };
    let Some(fit) = &done.fit else { return Ok(Left::NoFit(Unfitted { task, failure: done.error })) };
    let measured = measured(task, fit, done.ripple)?;
    let warnings = fit["warnings"].as_array().into_iter().flatten();
    let warnings = warnings.filter_map(|warning| Some(warning["code"].as_str()?.to_owned())).collect();
    Ok(Left::Fit(Fitted { task, doubt: done.error, warnings }, measured))
}

/// What siblings are compared by, from the JSON of a fit and its strongest wave.
fn measured(task: &Task, fit: &Value, ripple: Option<[f64; 2]>) -> Result<Measured> {
    let missing = |what: &str| {
        let message = format!("the result of task {} has no `{what}`; run it again with `--force`", task.index);
        Error::new(&codes::BAD_TASKS, message)
    };
    let list = |value: &Value, what: &str| value[what].as_array().cloned().ok_or_else(|| missing(what));
    let law = |law: &Value| {
        Some(FittedLaw {
            name: law["name"].as_str()?.to_owned(),
            bic: law["bic"].as_f64()?,
            parameters: law["parameters"].as_array()?.iter().filter_map(parameter).collect(),
        })
    };
    // Where the band has no width that is known, siblings say how far the curves scatter.
    let band = list(&fit["band"], "points")?;
    let error = |velocity: f64| {
        let point = band.iter().find(|point| point[0].as_f64().is_some_and(|there| there >= velocity))?;
        Some(0.5 * (point[2].as_f64()? - point[1].as_f64()?) / NORMAL_95)
    };
    let point = |point: &Value| {
        let (velocity, friction) = (point[0].as_f64()?, point[1].as_f64()?);
        Some([velocity, friction, error(velocity).unwrap_or(0.0)])
    };
    Ok(Measured {
        joint: task.joint.clone(),
        kind: task.kind.clone(),
        day: task.date.as_deref().and_then(day),
        unit: fit["unit"].as_str().unwrap_or_default().to_owned(),
        laws: list(fit, "classical")?.iter().filter_map(law).collect(),
        curve: list(&fit["curve"], "points")?.iter().filter_map(point).collect(),
        residual: fit["train"]["moving"]["rmse"].as_f64().ok_or_else(|| missing("train"))?,
        ripple: ripple.map(|[amplitude, order]| Ripple { amplitude, order }),
    })
}

/// A constant from JSON; an interval without an end, which JSON has no number for, is infinite.
fn parameter(value: &Value) -> Option<Parameter> {
    let text = |key: &str| Some(value[key].as_str()?.to_owned());
    let end = |index: usize, infinite: f64| value["ci95"][index].as_f64().unwrap_or(infinite);
    Some(Parameter {
        name: text("name")?,
        symbol: text("symbol")?,
        value: value["value"].as_f64()?,
        unit: text("unit")?,
        ci95: [end(0, f64::NEG_INFINITY), end(1, f64::INFINITY)],
    })
}

fn parse_share(text: &str) -> std::result::Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| *share > 0.0 && *share < 1.0);
    share.ok_or_else(|| "a share above 0 and below 1 is expected".to_string())
}
