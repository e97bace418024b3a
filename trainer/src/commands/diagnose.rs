//! `trainer diagnose`: what the model of a joint leaves out, in words, as JSON, as a page and as an improved image.

mod put_right;

use crate::commands::measurement::{self, Source, profile, rehearse};
use crate::commands::output::{Outputs, command_line, print, refuse_unwritable, say};
use crate::commands::progress::{Reporter, peak_memory_mb};
use crate::compile::profile::Profile;
use crate::diagnose::answer::outcome::{Finding, Verdict};
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::preparation::rows::Lock;
use crate::error::Result;
use crate::fit;
use crate::workflow::diagnose::{Against, Improvement, Request, Told, diagnose};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Compare a recording with a simulation, a model or a static friction model fitted to itself, and name the physics that is missing
///
/// Exit status: 0 nothing is missing, 1 something is, 2 usage, 3 the recording cannot be read (nothing is written) or is at fault itself
/// (`bad_data`: what was found is written), 5 input or output.
#[derive(Args, Clone, Debug)]
pub struct Diagnose {
    /// Recording of the real joint; several are taken one behind the other
    #[arg(value_name = "REAL", required = true)]
    pub recordings: Vec<PathBuf>,
    /// Simulation of the same commanded motion; its inverse law is learned and evaluated at the recorded states
    #[arg(long, value_name = "SIM", conflicts_with_all = ["model", "base"])]
    pub simulation: Option<PathBuf>,
    /// Fitted model to compare with
    #[arg(long, value_name = "MODEL.frk", conflicts_with = "base")]
    pub model: Option<PathBuf>,
    /// Static model of the same recording to start from, where neither simulation nor model is given
    #[arg(long, value_enum, default_value_t = StaticBase::CoulombViscous)]
    pub base: StaticBase,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// What is locked away for the proof: `spread` (a fifth of every block), `tail:SHARE` or `none`
    #[arg(long, value_name = "BLOCKS", default_value = "spread", value_parser = parse_lock)]
    pub lock: Lock,
    /// Drive that has to have room for the image, by its name as `verify` takes it; the smallest documented one when absent
    #[arg(long, value_name = "NAME", value_parser = profile)]
    pub target: Option<Profile>,
    /// Improved model to write
    #[arg(short, long, value_name = "IMPROVED.frk")]
    pub output: Option<PathBuf>,
    /// Trajectory to write that would tell apart what this recording cannot: time, position, velocity, acceleration
    #[arg(long, value_name = "TRAJECTORY.csv")]
    pub advise: Option<PathBuf>,
    /// Write the diagnosis as JSON; `-` for standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write a report to read in a browser
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Smallest effect worth acting on, as a share of the torque beside the rigid body (root mean square); what is smaller is listed,
    /// and does not count [default: 0.02 for the friction level of a simulation or model; for all else as much where the noise hides it]
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    pub least_effect: Option<f64>,
    /// Weigh sets of effects by one likelihood, simulation and recording in one model
    #[arg(long, hide = true)]
    pub by_likelihood: bool,
    /// Seed of the null draws: one seed, one result
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Memory to stay within, MB: of recordings that need more, stretches spread over them are read [default: 1000]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u32).range(200..))]
    pub memory: Option<u32>,
    /// Read and check the recordings, say what would be written, and stop there
    #[arg(long)]
    pub dry_run: bool,
    /// Say nothing but the result
    #[arg(long)]
    pub quiet: bool,
}

/// Static model to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StaticBase {
    /// Symmetric Coulomb and viscous friction.
    CoulombViscous,
    /// A symmetric spline over speed.
    Spline,
}

/// Runs the command and returns the exit status: 0 consistent, 1 something is missing, 3 the measurement is at fault.
///
/// # Errors
/// Whatever reading a recording, joint or model reports; `FRK-D016` where the motion determines nothing. Nothing is
/// written then.
pub fn run(arguments: &Diagnose) -> Result<u8> {
    let read = [arguments.joint.as_ref(), arguments.simulation.as_ref(), arguments.model.as_ref()];
    let read = arguments.recordings.iter().chain(read.into_iter().flatten()).map(PathBuf::as_path);
    let written = [&arguments.output, &arguments.advise, &arguments.json, &arguments.report];
    refuse_unwritable(written.into_iter().flatten(), &read.collect::<Vec<_>>())?;
    let reporter = Reporter::new(arguments.quiet);
    reporter.say("reading");
    let mut joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    if let Some(model) = &arguments.model {
        joint = measurement::with_identified(joint, model)?;
    }
    let model = arguments.model.as_deref().map(fit::model::load).transpose()?;
    if arguments.dry_run {
        let recordings: Vec<Source<'_>> = arguments.recordings.iter().map(Source::from).collect();
        return print(&rehearse(&recordings, &joint, &written.into_iter().flatten().collect::<Vec<_>>())?).map(|()| 0);
    }
    let against = match (&arguments.simulation, model, arguments.base) {
        (Some(path), ..) => Against::Simulation(path.into()),
        (None, Some((_, image)), _) => Against::Model(image),
        (None, None, StaticBase::CoulombViscous) => Against::Itself(BaseKind::CoulombViscous),
        (None, None, StaticBase::Spline) => Against::Itself(BaseKind::Spline),
    };
    let request = Request {
        recordings: arguments.recordings.iter().map(Source::from).collect(),
        against,
        lock: arguments.lock,
        target: arguments.target,
        least_effect: arguments.least_effect,
        by_likelihood: arguments.by_likelihood,
        seed: arguments.seed,
        memory_mb: arguments.memory,
    };
    let found = diagnose(&request, &joint, &|stage| reporter.say(stage))?;
    reporter.say("writing");
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.json {
        outputs.add_json(path, found.json());
    }
    if arguments.json.as_deref() != Some(Path::new("-")) {
        outputs.add(Path::new("-"), found.text());
    }
    let mut remarks = Vec::new();
    if let (Some(_), Improvement::Written(improved)) = (&arguments.output, &found.improvement) {
        remarks.clone_from(&improved.remarks);
    }
    let mut unwritten = None;
    match (&arguments.output, found.image()) {
        (Some(path), Some(image)) => outputs.add(path, image),
        (Some(_), None) => unwritten = Some(why_unwritten(&found.improvement)),
        (None, _) => {}
    }
    let is_worse = found.sealed().is_some_and(SealedScore::is_worse);
    let is_missing = found.diagnosis.verdict == Verdict::MissingPhysics;
    let is_improved = is_missing && found.diagnosis.findings.iter().any(Finding::is_of_the_image) && !is_worse;
    if arguments.simulation.is_some() && is_improved {
        remarks.push(put_right::command(arguments.output.as_deref(), joint.name.as_deref()));
    }
    if let Some(path) = &arguments.report {
        let remarks: Vec<String> = remarks.iter().chain(&unwritten).cloned().collect();
        let image = arguments.output.as_deref().filter(|_| found.image().is_some());
        let put_right = image.map(|image| put_right::export(image, joint.name.as_deref()));
        let told = Told { remarks: &remarks, put_right: put_right.as_deref(), command: &command_line() };
        outputs.add(path, found.report(&compared_with(arguments), told));
    }
    match (&arguments.advise, found.trajectory()) {
        (Some(path), Some(trajectory)) => outputs.add(path, trajectory),
        (Some(_), None) => {
            let has_rivals = found.diagnosis.findings.iter().any(|finding| !finding.alternatives.is_empty());
            let reason = if has_rivals {
                "no trajectory is written: no motion within the limits tells the rivals apart"
            } else {
                "no trajectory is needed: nothing that was found has a rival"
            };
            remarks.push(reason.to_string());
        }
        (None, _) => {}
    }
    outputs.write()?;
    drop(reporter);
    // Who asks for a file and gets none is told so in any case.
    unwritten.iter().for_each(|sentence| say(sentence));
    if !arguments.quiet {
        remarks.iter().for_each(|sentence| say(sentence));
        let memory = peak_memory_mb().map_or_else(String::new, |mb| format!(", {mb:.0} MB of memory"));
        let (label, rows, hz) = (&found.label, found.diagnosis.rows, found.diagnosis.cut_off_hz);
        say(&format!(
            "{label}: {} samples, {rows} rows behind {hz:.0} Hz, {:.1} s{memory}",
            found.samples, found.seconds
        ));
    }
    Ok(exit_status(found.diagnosis.verdict))
}

fn why_unwritten(improvement: &Improvement) -> String {
    let why = match improvement {
        Improvement::Blocked => "the measurement has to be put right first".to_owned(),
        Improvement::Refused(error) => error.to_string(),
        Improvement::Written(_) => "it would leave more of the torque than the model compared with".to_owned(),
    };
    format!("no model is written: {why}")
}

fn compared_with(arguments: &Diagnose) -> String {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match (&arguments.simulation, &arguments.model, arguments.base) {
        (Some(path), _, _) => format!("the simulation {}", name(path)),
        (None, Some(path), _) => format!("the model {}", name(path)),
        (None, None, StaticBase::CoulombViscous) => {
            "symmetric Coulomb and viscous friction, fitted to the same recording".to_string()
        }
        (None, None, StaticBase::Spline) => "a symmetric friction curve, fitted to the same recording".to_string(),
    }
}

fn exit_status(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Consistent => 0,
        Verdict::MissingPhysics | Verdict::Unexplained => 1,
        Verdict::BadData => 3,
    }
}

fn parse_share(text: &str) -> std::result::Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| (0.0..1.0).contains(share));
    share.ok_or_else(|| "a share from 0 to below 1 is expected".to_string())
}

fn parse_lock(text: &str) -> std::result::Result<Lock, String> {
    match text {
        "spread" => Ok(Lock::Spread),
        "none" => Ok(Lock::Nothing),
        _ => match text.strip_prefix("tail:").and_then(|share| share.parse::<f64>().ok()) {
            Some(share) if share > 0.0 && share < 0.9 => Ok(Lock::Tail(share)),
            _ => Err("`spread`, `none` or `tail:SHARE` with a share between 0 and 0.9 is expected".to_string()),
        },
    }
}
