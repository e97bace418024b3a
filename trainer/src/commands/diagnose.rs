//! `trainer diagnose`: what the model of a joint leaves out, in words, as JSON, as a page and as an improved image.

mod compare;
mod put_right;
mod sealed;
mod summary;
mod trajectory;

use crate::commands::measurement::profile;
use crate::commands::measurement::{self, Warning, load_all, units};
use crate::commands::output::Outputs;
use crate::commands::progress::{Reporter, peak_memory_mb};
use crate::compile::improved::{Origin, improve};
use crate::compile::profile::Profile;
use crate::diagnose::advice::{Limits, Plan, Question, plan};
use crate::diagnose::answer::finding::tell_first;
use crate::diagnose::answer::outcome::{Diagnosis, Verdict};
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::request::{Options, Refusal};
use crate::diagnose::run::diagnose;
use crate::diagnose::search::thresholds::Settings;
use crate::error::{Error, Result, codes};
use crate::fit;
use crate::joint::Joint;
use crate::physics::JointState;
use crate::physics::names::capital;
use crate::recording::{Quantity, Recording};
use crate::report::tell::evidence::planned_motion;
use crate::report::tell::{Story, tell};
use crate::report::{self, DiagnosisPage};
use clap::{Args, ValueEnum};
use compare::{Compared, comparison};
use frikan_shared::image::Image;
use frikan_shared::units::Unit;
use sealed::sealed_score;
use std::path::{Path, PathBuf};
use std::time::Instant;
use summary::{Told, summary};
use trajectory::to_csv;

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
    let reporter = Reporter::new(arguments.quiet);
    reporter.say("reading");
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let (recordings, warnings) = load_all(&arguments.recordings, |path| measurement::load_with_faults(path, &joint))?;
    let real = &recordings[0];
    let (comparison, compared) = comparison(arguments, &recordings, &joint)?;
    let units = units(real);
    let options = Options {
        base: base_kind(arguments),
        lock: arguments.lock,
        settings: Settings { seed: arguments.seed, ..Settings::default() },
        least_effect: arguments.least_effect,
        by_likelihood: arguments.by_likelihood,
    };
    reporter.say("weighing every effect against the noise");
    let mut diagnosis = diagnose(&comparison, &options).map_err(|refusal| refused(&refusal, real))?;
    tell_measurement(&mut diagnosis, &warnings);
    reporter.say("choosing what to record next");
    let advice = advice(&comparison, &diagnosis, &joint, (&compared, real));
    reporter.say("writing");
    let mut outputs = Outputs::default();
    let is_blocked = diagnosis.is_blocked();
    let improved = if is_blocked {
        None
    } else {
        let written = improved_image(arguments, (&recordings, &joint), &diagnosis, &comparison, &compared);
        // Without a file to write, what cannot be written costs no more than its figures.
        if arguments.output.is_some() { Some(written?) } else { written.ok() }
    };
    let sealed = improved.as_ref().and_then(|improved| improved.sealed.as_ref());
    let story = tell(&diagnosis, sealed, units);
    let seconds = begin.elapsed().as_secs_f64();
    if let Some(path) = &arguments.json {
        let summary = summary(
            &Told { diagnosis: &diagnosis, story: &story, plan: advice.as_ref(), sealed, units },
            seconds,
            arguments.seed,
        );
        outputs.add(path, summary.to_string() + "\n");
    }
    if arguments.json.as_deref() != Some(Path::new("-")) {
        outputs.add(Path::new("-"), text_of(&story, advice.as_ref()));
    }
    let mut remarks = Vec::new();
    if is_blocked && arguments.output.is_some() {
        remarks.push("no model is written: the measurement has to be put right first".to_string());
    }
    let is_worse = sealed.is_some_and(SealedScore::is_worse);
    if let (Some(path), Some(improved)) = (&arguments.output, &improved) {
        remarks.clone_from(&improved.remarks);
        if is_worse {
            remarks.push(
                "no model is written: it would leave more of the torque than the model compared with".to_string(),
            );
        } else {
            outputs.add(path, improved.image.clone());
        }
    }
    if arguments.simulation.is_some() && diagnosis.verdict == Verdict::MissingPhysics && !is_worse {
        remarks.push(put_right::command(arguments.output.as_deref(), joint.name.as_deref()));
    }
    if let Some(path) = &arguments.report {
        let page = DiagnosisPage {
            recording: &real.label,
            compared_with: &compared_with(arguments),
            diagnosis: &diagnosis,
            story: &story,
            units,
            plan: advice.as_ref(),
            export: &remarks,
        };
        outputs.add(path, report::diagnosis(&page));
    }
    match (&arguments.advise, &advice) {
        (Some(path), Some(plan)) => outputs.add(path, to_csv(plan, units.rotary)),
        (Some(_), None) => {
            let has_rivals = diagnosis.findings.iter().any(|finding| !finding.alternatives.is_empty());
            let reason = if has_rivals {
                "no trajectory is written: no motion within the limits tells the rivals apart"
            } else {
                "no trajectory is needed: nothing that was found has a rival"
            };
            remarks.push(reason.to_string());
        }
        (None, _) => {}
    }
    let inputs = [arguments.joint.as_ref(), arguments.simulation.as_ref(), arguments.model.as_ref()];
    let inputs = arguments.recordings.iter().chain(inputs.into_iter().flatten());
    outputs.refuse_overwriting(&inputs.map(PathBuf::as_path).collect::<Vec<_>>())?;
    outputs.write()?;
    drop(reporter);
    if !arguments.quiet {
        remarks.iter().for_each(|sentence| eprintln!("{sentence}"));
        let memory = peak_memory_mb().map_or_else(String::new, |mb| format!(", {mb:.0} MB of memory"));
        let (samples, rows, hz) = (comparison.signals.time.len(), diagnosis.rows, diagnosis.cut_off_hz);
        eprintln!("{}: {samples} samples, {rows} rows behind {hz:.0} Hz, {seconds:.1} s{memory}", real.label);
    }
    Ok(exit_status(diagnosis.verdict))
}

/// Puts what the checks of the recordings found before what was found behind them.
fn tell_measurement(diagnosis: &mut Diagnosis, warnings: &[Warning]) {
    for warning in warnings.iter().rev() {
        tell_first(diagnosis, warning.to_health(), warning.is_finding());
    }
}

/// The motion that would tell apart what cannot be told, within the limits of the joint.
fn advice(
    comparison: &Comparison,
    diagnosis: &Diagnosis,
    joint: &Joint,
    (compared, real): (&Compared, &Recording),
) -> Option<Plan> {
    let limits = Limits {
        lowest_position: joint.limits.lowest_position_rad,
        highest_position: joint.limits.highest_position_rad,
        speed: joint.limits.velocity_rad_s,
        acceleration: joint.limits.acceleration_rad_s2,
    };
    let recorded_body = real.channel(Quantity::RigidBodyTorque).is_some();
    let at = |state: &JointState| compared.at(state, recorded_body);
    plan(&Question { comparison, diagnosis, limits, reference: Some(&at) })
}

/// An improved image, what it holds in sentences, and how much better it is on rows that decided nothing.
struct Written {
    image: Vec<u8>,
    remarks: Vec<String>,
    sealed: Option<SealedScore>,
}

fn improved_image(
    arguments: &Diagnose,
    (recordings, joint): (&[Recording], &Joint),
    diagnosis: &Diagnosis,
    comparison: &Comparison,
    compared: &Compared,
) -> Result<Written> {
    let mut provenance = fit::model::provenance(joint.name.as_deref().unwrap_or_default(), recordings, arguments.seed);
    let origin = match compared {
        Compared::Itself(body) => Origin::Recording(**body),
        Compared::Simulation(law, given) => Origin::Simulation(law, *given),
        Compared::Model(image) => {
            provenance.law_error = image.provenance.law_error;
            provenance.rigid_body_error = image.provenance.rigid_body_error;
            Origin::Model(&image.model)
        }
    };
    let unit = match units(&recordings[0]).actuator {
        "N" => Unit::Newton,
        "A" => Unit::Ampere,
        _ => Unit::NewtonMetre,
    };
    let improved = improve(diagnosis, comparison, origin, unit, arguments.target.unwrap_or_default())
        .map_err(|why| Error::new(&codes::BAD_IMAGE, why.to_string()))?;
    let image = fit::model::to_bytes(&Image { provenance, model: *improved.model })?;
    // What is scored is what a drive would decode.
    let after = fit::model::from_bytes(&image)?.model;
    let sealed = improved
        .compared_with
        .and_then(|before| sealed_score(&diagnosis.sealed_s, recordings, comparison.signals.period, [&before, &after]));
    Ok(Written { image, remarks: improved.remarks, sealed })
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

fn refused(refusal: &Refusal, recording: &Recording) -> Error {
    let code = match refusal {
        Refusal::TooLittleMotion { .. } => &codes::SEGMENTS_TOO_SHORT,
        Refusal::NotMeasured { .. } => &codes::NOT_MEASURED,
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

fn text_of(story: &Story, advice: Option<&Plan>) -> String {
    let health = story.health.iter().map(|sentence| format!("  - Measurement: {sentence}\n"));
    let bullets = health.chain(story.findings.iter().map(|sentence| format!("  * {sentence}\n")));
    let rest = story.rest().map(|sentence| format!("{sentence}\n"));
    let advice = advice.map(|plan| format!("{}.\n", capital(&planned_motion(plan))));
    let given = story.given.iter().map(|sentence| format!("{sentence}\n"));
    std::iter::once(format!("{}\n", story.headline)).chain(given).chain(bullets).chain(rest).chain(advice).collect()
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
