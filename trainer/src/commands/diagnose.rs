//! `trainer diagnose`: what the model of a joint leaves out, in words, as JSON, as a page and as an improved image.

use crate::commands::output::Outputs;
use crate::diagnose::improve::{Origin, improve};
use crate::diagnose::sentence::{Story, Units, tell};
use crate::diagnose::simulation::{self, InverseLaw};
use crate::diagnose::{
    BaseKind, Diagnosis, Finding, Lock, Options, Refusal, Settings, Signals, Verdict, diagnose, model,
};
use crate::error::{Error, Result, codes};
use crate::fit::{self, HostModel};
use crate::joint::{self, Joint};
use crate::recording::{self, Axis, Quantity, Recording};
use crate::report::{self, DiagnosisPage};
use clap::{Args, ValueEnum};
use frikan_shared::image::Image;
use frikan_shared::model::RigidBody;
use frikan_shared::units::Unit;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Compare a recording with a simulation, a model or the best static model of itself, and name the physics that is missing.
#[derive(Args, Clone, Debug)]
pub struct Diagnose {
    /// Recording of the real joint
    #[arg(value_name = "REAL")]
    pub recording: PathBuf,
    /// Simulation of the same commanded motion; its inverse law is learned and evaluated at the recorded states
    #[arg(long, value_name = "SIM", conflicts_with_all = ["model", "base"])]
    pub simulation: Option<PathBuf>,
    /// Fitted model to compare with
    #[arg(long, value_name = "MODEL.frk", conflicts_with = "base")]
    pub model: Option<PathBuf>,
    /// Static model of the same recording to start from, where neither simulation nor model is given
    #[arg(long, value_enum, default_value_t = StaticBase::CoulombViscous)]
    pub base: StaticBase,
    /// Description of the joint
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// What is locked away for the proof: `spread` (every fifth block), `tail:SHARE` or `none`
    #[arg(long, value_name = "BLOCKS", default_value = "spread", value_parser = parse_lock)]
    pub lock: Lock,
    /// Improved model to write
    #[arg(short, long, value_name = "IMPROVED.frk")]
    pub output: Option<PathBuf>,
    /// Write the diagnosis as JSON; `-` for standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write a report to read in a browser
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Seed of the null draws: one seed, one result
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
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
    let begin = Instant::now();
    let joint = arguments.joint.as_deref().map(Joint::load).transpose()?.unwrap_or_default();
    let real = recording::load(&arguments.recording, &joint)?;
    let (signals, compared) = compared_signals(arguments, &real, &joint)?;
    let units = units(&real);
    let options = Options {
        base: base_kind(arguments),
        lock: arguments.lock,
        settings: Settings { seed: arguments.seed, ..Settings::default() },
    };
    let diagnosis = diagnose(&signals, units.actuator, &options).map_err(|refusal| refused(&refusal, &real))?;
    let story = tell(&diagnosis, units);
    let seconds = begin.elapsed().as_secs_f64();
    let summary = arguments.json.as_ref().map(|_| summary(&diagnosis, &story, seconds, arguments.seed).to_string());
    let mut outputs = Outputs::default();
    if let (Some(path), Some(text)) = (&arguments.json, summary) {
        outputs.add(path, text + "\n");
    }
    if arguments.json.as_deref() != Some(Path::new("-")) {
        outputs.add(Path::new("-"), text_of(&story));
    }
    let mut export = Vec::new();
    if let Some(path) = &arguments.output {
        let (image, remarks) = improved_image(arguments, (&real, &joint), &diagnosis, &signals, &compared)?;
        outputs.add(path, image);
        export = remarks;
    }
    if let Some(path) = &arguments.report {
        let page = DiagnosisPage {
            recording: &real.label,
            compared_with: &compared_with(arguments),
            diagnosis: &diagnosis,
            story: &story,
            units,
            export: &export,
        };
        outputs.add(path, report::diagnosis(&page));
    }
    let inputs = [Some(&arguments.recording), arguments.simulation.as_ref(), arguments.model.as_ref()];
    outputs.refuse_overwriting(&inputs.into_iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>())?;
    outputs.write()?;
    if !arguments.quiet {
        export.iter().for_each(|sentence| eprintln!("{sentence}"));
    }
    if !arguments.quiet {
        let rows = diagnosis.rows;
        eprintln!("{}: {rows} rows behind {:.0} Hz in {seconds:.1} s", real.label, diagnosis.cut_off_hz);
    }
    Ok(exit_status(diagnosis.verdict))
}

/// What the recording is compared with.
enum Compared {
    Itself(Box<RigidBody>),
    Simulation(Box<InverseLaw>),
    Model(Box<HostModel>),
}

/// Signals of the real recording beside what they are compared with.
fn compared_signals(arguments: &Diagnose, real: &Recording, joint: &Joint) -> Result<(Signals, Compared)> {
    if let Some(path) = &arguments.simulation {
        let simulated = recording::load(path, joint)?;
        same_units(real, &simulated)?;
        let mut signals = Signals::of(real, joint)?;
        let simulation = Signals::of(&simulated, joint)?;
        let law = simulation::learn(&simulation, signals.rigid_body.is_some())
            .map_err(|error| Error::new(&codes::NO_MOTION, error.to_string()).in_file(simulated.file()))?;
        let reference = law.at(&states(&signals, real)?);
        signals.compare_with(reference);
        Ok((signals, Compared::Simulation(Box::new(law))))
    } else if let Some(path) = &arguments.model {
        let (_, image) = fit::model::load(path)?;
        // The image carries the rigid body of the joint file already; what is recorded is handed to it.
        let bare = Joint { rigid_body: joint::RigidBody::default(), ..joint.clone() };
        let mut signals = Signals::of(real, &bare)?;
        let state = states(&signals, real)?;
        let reference =
            model::at(&image.model, &state, state.rigid_body.as_deref()).map_err(|error| error.in_file(real.file()))?;
        signals.compare_with(reference);
        Ok((signals, Compared::Model(Box::new(image.model))))
    } else {
        Ok((Signals::of(real, joint)?, Compared::Itself(Box::new(given_rigid_body(real, joint)))))
    }
}

/// The rigid body of the joint file, where it stands for the recording's own.
fn given_rigid_body(real: &Recording, joint: &Joint) -> RigidBody {
    let mut body = RigidBody::default();
    if real.channel(Quantity::RigidBodyTorque).is_none() {
        let (gravity, phase) = (joint.rigid_body.gravity_torque_nm, joint.rigid_body.gravity_phase_rad);
        let (gravity, phase) = (gravity.unwrap_or(0.0), phase.unwrap_or(0.0));
        body.inertia = joint.rigid_body.inertia_kgm2.unwrap_or(0.0) as f32;
        body.gravity_sin = (gravity * phase.cos()) as f32;
        body.gravity_cos = (gravity * phase.sin()) as f32;
    }
    body
}

/// The improved image, with what it holds in sentences.
fn improved_image(
    arguments: &Diagnose,
    (real, joint): (&Recording, &Joint),
    diagnosis: &Diagnosis,
    signals: &Signals,
    compared: &Compared,
) -> Result<(Vec<u8>, Vec<String>)> {
    let origin = match compared {
        Compared::Itself(body) => Origin::Recording(**body),
        Compared::Simulation(law) => Origin::Simulation(law),
        Compared::Model(model) => Origin::Model(model),
    };
    let unit = match units(real).actuator {
        "N" => Unit::Newton,
        "A" => Unit::Ampere,
        _ => Unit::NewtonMetre,
    };
    let improved = improve(diagnosis, signals, origin, unit)
        .ok_or_else(|| Error::new(&codes::BAD_IMAGE, "the findings and the law together make no valid model"))?;
    let name = joint.name.as_deref().unwrap_or_default();
    let provenance = fit::model::provenance(name, std::slice::from_ref(real), arguments.seed);
    let image = Image { provenance, model: *improved.model };
    Ok((fit::model::to_bytes(&image)?, improved.remarks))
}

/// The states of the recording, which need a segment longer than its filter.
fn states(signals: &Signals, real: &Recording) -> Result<crate::physics::JointState> {
    let moving = signals.position.iter().any(|q| *q != signals.position[0]);
    if moving {
        return Ok(signals.states());
    }
    Err(Error::new(&codes::NO_MOTION, "the joint does not move in this recording").in_file(real.file()))
}

fn same_units(real: &Recording, simulated: &Recording) -> Result<()> {
    if units(real) == units(simulated) {
        return Ok(());
    }
    let message = format!(
        "the simulation gives {}, the real recording {}; both have to be of one axis and one actuator quantity",
        units(simulated).actuator,
        units(real).actuator
    );
    Err(Error::new(&codes::RECORDINGS_DISAGREE, message).in_file(simulated.file()))
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

fn base_kind(arguments: &Diagnose) -> BaseKind {
    match (arguments.simulation.is_some() || arguments.model.is_some(), arguments.base) {
        (true, _) => BaseKind::Reference,
        (false, StaticBase::CoulombViscous) => BaseKind::CoulombViscous,
        (false, StaticBase::Spline) => BaseKind::Spline,
    }
}

/// Unit of the actuator and kind of the axis.
fn units(recording: &Recording) -> Units {
    let channel = recording.actuator().or_else(|| recording.separated_friction());
    let actuator = match channel.map(|channel| channel.unit) {
        Some("N") => "N",
        Some("A") => "A",
        _ => "N m",
    };
    Units { actuator, rotary: recording.axis == Axis::Rotary }
}

fn refused(refusal: &Refusal, recording: &Recording) -> Error {
    let code = match refusal {
        Refusal::TooLittleMotion { .. } => &codes::SEGMENTS_TOO_SHORT,
        Refusal::Undetermined => &codes::NO_MOTION,
    };
    Error::new(code, refusal.to_string()).in_file(recording.file())
}

fn exit_status(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Consistent => 0,
        Verdict::MissingPhysics | Verdict::Unexplained => 1,
        Verdict::BadData => 3,
    }
}

fn text_of(story: &Story) -> String {
    let bullets = story.health.iter().chain(&story.findings).map(|sentence| format!("  * {sentence}\n"));
    let rest =
        [&story.proof, &story.minor, &story.withdrawn, &story.limits].into_iter().flatten().map(|s| format!("{s}\n"));
    std::iter::once(format!("{}\n", story.headline)).chain(bullets).chain(rest).collect()
}

fn summary(diagnosis: &Diagnosis, story: &Story, seconds: f64, seed: u64) -> Value {
    let held_out = diagnosis.proof.as_ref().map(|proof| {
        json!({
            "baseline_rmse": proof.baseline_rmse,
            "improved_rmse": proof.improved_rmse,
            "ratio": proof.improved_rmse / proof.baseline_rmse.max(f64::MIN_POSITIVE),
            "ci95": proof.ratio_ci95,
            "gain_nats": proof.gain_nats,
            "n": proof.rows,
        })
    });
    let (excess, excess_when) = diagnosis.traces.excess();
    json!({
        "schema": "frikan.diagnose/1",
        "verdict": diagnosis.verdict,
        "headline": story.headline,
        "health": diagnosis.health,
        "findings": diagnosis.findings.iter().zip(&story.findings).map(finding_json).collect::<Vec<_>>(),
        "minor": diagnosis.minor.iter().map(|(effect, share)| json!({ "effect": effect, "share": share })).collect::<Vec<_>>(),
        "withdrawn": diagnosis.withdrawn,
        "localisation": { "where": excess.iter().map(region_json).collect::<Vec<_>>(), "when_s": excess_when },
        "detection_limits": diagnosis.limits,
        "rivals": diagnosis.rivals.iter().map(rival_json).collect::<Vec<_>>(),
        "base": match diagnosis.base {
            BaseKind::CoulombViscous => "coulomb_viscous",
            BaseKind::Spline => "spline",
            BaseKind::Reference => "reference",
        },
        "base_parameters": diagnosis.base_parameters,
        "fit": {
            "noise_rmse": diagnosis.noise_rmse,
            "baseline": diagnosis.baseline,
            "improved": diagnosis.improved,
            "held_out": held_out,
            "cut_off_Hz": diagnosis.cut_off_hz,
            "n": diagnosis.rows,
        },
        "seconds": seconds,
        "seed": seed,
    })
}

fn finding_json((found, sentence): (&Finding, &String)) -> Value {
    json!({
        "effect": found.effect,
        "probability": found.probability,
        "alternatives": found.alternatives.iter()
            .map(|(effect, probability)| json!({"effect": effect, "probability": probability}))
            .collect::<Vec<_>>(),
        "action": found.action,
        "equation": found.equation,
        "parameters": found.parameters,
        "where": found.location.regions.iter().map(region_json).collect::<Vec<_>>(),
        "when_s": found.location.when_s,
        "evidence": found.evidence,
        "separate_by": found.separate_by.sentence,
        "sentence": sentence,
        "score_nats": found.score,
        "margin_nats": found.margin,
        "locked_gain_nats": found.locked_gain_nats,
    })
}

fn region_json(region: &crate::diagnose::Region) -> Value {
    json!({
        "channel": region.channel,
        "from": region.from,
        "to": region.to,
        "share_of_excess": region.share_of_excess,
        "share_of_samples": region.share_of_samples,
    })
}

fn rival_json(rival: &crate::diagnose::Scored) -> Value {
    json!({ "name": rival.label.to_string(), "score_nats": rival.score, "family_wise_p": rival.family_wise })
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
