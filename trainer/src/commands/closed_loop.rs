//! `trainer loop`: a joint in closed loop with the drive's own code, with and without compensation, on the host or an emulated drive.

mod account;
mod follow;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use frikan_runtime::drive::DriveSettings;
use frikan_runtime::shared::image::Image;
use frikan_runtime::shared::units::Unit;
use frikan_runtime::supervised::{DEFAULT_GAIN, SupervisionError, VelocitySource};

use super::output::{Outputs, command_line, print, refuse_unwritable};
use super::progress::Reporter;
use super::simulate::{parse_effect, with_effects};
use crate::actuator::FeedForward;
use crate::emulator::Lockstep;
use crate::error::{Error, Result, codes};
use crate::fit::model::{self, CELLS, HostModel};
use crate::plant::{self, Hidden};
use crate::report;
use crate::rig::{
    Bench, Row, Scores, adaptation_settings, drive_settings, host_drive, nominal_model, run as run_bench, usual_form,
    with_contact,
};
use account::{Account, FedBy};

/// Follow a motion in closed loop with a simulated joint, with and without friction compensation: what an image is worth before it meets a
/// machine.
///
/// The drive is the firmware's code: position loop, encoder filter and supervised compensator, on the host or on an emulated
/// microcontroller, bit for bit the same. The joint is that of `trainer simulate`, effects included. Where it reports no torque (`[actuator]`),
/// the actuator is told in its own form: a `pd` or `position_servo` joint follows the reference by its own law and limits and is told of the
/// compensation alone, as a torque to add or an offset of its position reference; `current` and `dc_motor` joints are told of all of the
/// drive's torque, as current, duty or voltage.
#[derive(Args, Clone, Debug)]
pub struct Loop {
    /// Description of the joint; its `[plant]` section and every key in it are optional
    #[arg(value_name = "JOINT.toml")]
    pub joint: PathBuf,
    /// Image that compensates; without one the very law of the simulated joint
    #[arg(long, value_name = "MODEL.frk")]
    pub image: Option<PathBuf>,
    /// Where the drive runs: host, or emulated: cortex-m0plus, cortex-m33, cortex-m4f, cortex-m7, riscv32imac, riscv32imc
    #[arg(long, default_value = "host")]
    pub target: String,
    /// hold, creep, reversals, dwells, sine, nudge, load-step, cold-start, or a recording whose reference (or position) is followed
    #[arg(long, value_name = "MOTION|FILE.csv", default_value = "reversals")]
    pub motion: String,
    /// Coulomb, Stribeck and viscous friction of the joint over that of its description
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub friction_scale: f64,
    /// Share of the friction that is compensated
    #[arg(long, default_value_t = DEFAULT_GAIN)]
    pub gain: f32,
    /// How an actuator that reports no torque is told: torque or position_offset (pd), position_offset (position_servo), current, duty or
    /// voltage (dc_motor); without it the first that its kind takes
    #[arg(long, value_name = "FORM", value_parser = parse_form)]
    pub feed_forward: Option<FeedForward>,
    /// Velocity at which friction is compensated
    #[arg(long, value_enum, default_value_t = Velocity::Blended)]
    pub velocity: Velocity,
    /// Leave the gain as it is where compensation feeds the joint
    #[arg(long)]
    pub no_monitor: bool,
    /// Let the drive learn how the friction differs from the model: level 0.5 to 1.5, and a viscous part and an offset of up to a fifth
    /// of the Coulomb torque
    #[arg(long)]
    pub adapt: bool,
    /// Hide an effect in the joint at an amplitude, as `trainer simulate` does; may be given several times
    #[arg(long = "effect", value_name = "NAME=AMPLITUDE", value_parser = parse_effect)]
    pub effects: Vec<Hidden>,
    /// Seed of the shapes of effects: that of the recording in which they are hidden
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Length of the run, s
    #[arg(long, value_name = "SECONDS")]
    pub duration: Option<f64>,
    /// Flash another image into the running drive
    #[arg(long, value_name = "MODEL.frk", requires = "swap_at")]
    pub swap_image: Option<PathBuf>,
    /// When, s
    #[arg(long, value_name = "SECONDS", requires = "swap_image")]
    pub swap_at: Option<f64>,
    /// Write the run with compensation, a row a sample
    #[arg(short, long, value_name = "TRACE.csv")]
    pub output: Option<PathBuf>,
    /// Also write the result as JSON; `-` for standard output
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    pub json: Option<PathBuf>,
    /// Also write a page with plots
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Velocity at which friction is compensated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Velocity {
    /// The joint's, behind the encoder's filter: hunts at rest
    Measured,
    /// The reference's: blind to what the joint does
    Reference,
    /// The reference's through zero and at rest, the joint's in sliding
    Blended,
}

impl From<Velocity> for VelocitySource {
    fn from(velocity: Velocity) -> Self {
        match velocity {
            Velocity::Measured => Self::Measured,
            Velocity::Reference => Self::Reference,
            Velocity::Blended => Self::Blended,
        }
    }
}

/// Runs the command.
///
/// # Errors
/// `FRK-D015` for a joint that cannot be simulated, `FRK-D014` for an actuator of which a constant is open, `FRK-D019` and `FRK-D020` for what is no image, `FRK-U001` for numbers out of range, a
/// motion that does not exist or a model that is not in N m, `FRK-U004` and `FRK-I004` to `FRK-I008` for targets that do not
/// exist or cannot be emulated. Nothing is written unless both runs ended.
pub fn run(arguments: &Loop) -> Result<()> {
    let written = [&arguments.output, &arguments.json, &arguments.report];
    let read = [Some(arguments.joint.as_path()), arguments.image.as_deref(), arguments.swap_image.as_deref()];
    let read = read.into_iter().flatten().chain(Some(Path::new(&arguments.motion)).filter(|motion| motion.is_file()));
    refuse_unwritable(written.into_iter().flatten(), &read.collect::<Vec<_>>())?;
    let label = arguments.joint.display().to_string();
    let joint = with_contact(&with_effects(&arguments.joint, &arguments.effects)?);
    let (image, model) = image_of(arguments, &joint)?;
    let settings = settings_of(arguments, &joint, model.output_limit)?;
    let bench = bench_of(arguments, joint)?;
    let of_joint = |error: Error| error.in_file(&label);

    let reporter = Reporter::new(arguments.quiet);
    let off = drive_settings(&bench.joint, 0.0, model.output_limit).unwrap_or(settings);
    let alone = Bench { swap: None, ..bench.clone() };
    let on_host = |model, settings: &DriveSettings| {
        let out_of_range = |error: SupervisionError| Error::new(&codes::BAD_JOINT_FILE, error.to_string());
        host_drive(model, settings).map_err(out_of_range).map_err(of_joint)
    };
    let uncompensated = run_bench(&alone, &mut on_host(model.clone(), &off)?).map_err(of_joint)?;
    let (compensated, instructions) = if arguments.target == "host" {
        (run_bench(&bench, &mut on_host(model, &settings)?).map_err(of_joint)?, None)
    } else {
        reporter.say("building the firmware and running it in lockstep");
        let mut drive = Lockstep::start(&arguments.target, &image, &settings.to_words(), true)?;
        (run_bench(&bench, &mut drive)?, drive.instructions())
    };
    drop(reporter);
    let nudge_end = bench.course.motion().and_then(|motion| motion.nudge_end());
    let scores = |rows: &[Row]| Scores::of(rows, nudge_end);
    let account = Account {
        target: &arguments.target,
        motion: bench.course.name(),
        friction_scale: arguments.friction_scale,
        gain: arguments.gain,
        fed: bench.joint.actuator.map(|actuator| FedBy::of(&actuator, bench.feed_forward)),
        uncompensated: scores(&uncompensated),
        compensated: scores(&compensated),
        instructions,
        rows: &compensated,
    };
    write(arguments, &account, &uncompensated, bench.feed_forward)
}

fn write(arguments: &Loop, account: &Account<'_>, uncompensated: &[Row], form: FeedForward) -> Result<()> {
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.output {
        outputs.add(path, account::trace(account.rows, form));
    }
    if let Some(path) = &arguments.json {
        outputs.add_json(path, account.to_json());
    }
    if let Some(path) = &arguments.report {
        let origin = report::Origin { command: &command_line(), recordings: &[], settings: "" };
        outputs.add(path, report::closed_loop(account.motion, &account.lines(), uncompensated, account.rows, &origin));
    }
    outputs.write()?;
    if arguments.json.as_ref().is_none_or(|path| path.as_os_str() != "-") {
        print(&(account.lines().join("\n") + "\n"))?;
    }
    Ok(())
}

/// The bytes and the model of the image that compensates.
fn image_of(arguments: &Loop, joint: &plant::Joint) -> Result<(Vec<u8>, HostModel)> {
    let (bytes, image) = if let Some(path) = &arguments.image {
        model::load(path)?
    } else {
        let nominal = nominal_model::<CELLS>(&joint.friction)
            .ok_or_else(|| {
            let message = "this friction follows from more than the velocity, or has numbers that no image holds: give an image, `--image`";
            Error::new(&codes::BAD_JOINT_FILE, message)
        })?;
        let image = Box::new(Image { model: nominal, provenance: model::provenance("", &[], arguments.seed) });
        (model::to_bytes(&image)?, image)
    };
    if image.model.output_unit != Unit::NewtonMetre {
        let message = "the loop puts out torques: it needs a model in N m";
        let path = arguments.image.as_deref().unwrap_or(Path::new("")).display().to_string();
        return Err(Error::new(&codes::USAGE, message).in_file(path).with_value(image.model.output_unit.symbol()));
    }
    Ok((bytes, image.model))
}

fn settings_of(arguments: &Loop, joint: &plant::Joint, largest: f32) -> Result<DriveSettings> {
    let mut settings = drive_settings(joint, arguments.gain, largest).ok_or_else(|| {
        let message = "the gain has to be finite and not negative";
        Error::new(&codes::USAGE, message).with_value(arguments.gain.to_string())
    })?;
    settings.supervision.source = arguments.velocity.into();
    settings.supervision.monitored = !arguments.no_monitor;
    if arguments.adapt {
        let adaptation = adaptation_settings(joint).ok_or_else(|| {
            let message = "an adaptation needs a Coulomb torque between 1e-4 and 1e6 N m";
            Error::new(&codes::USAGE, message).with_value(joint.friction.coulomb_torque_nm.to_string())
        })?;
        settings.supervision.adaptation = Some(adaptation);
    }
    Ok(settings)
}

fn parse_form(text: &str) -> std::result::Result<FeedForward, String> {
    let names = || FeedForward::ALL.map(FeedForward::name).join(", ");
    FeedForward::ALL
        .into_iter()
        .find(|form| form.name() == text)
        .ok_or_else(|| format!("one of {} is expected", names()))
}

/// In what form the actuator of `joint` is fed.
fn form_of(arguments: &Loop, joint: &plant::Joint) -> Result<FeedForward> {
    let form = arguments.feed_forward.unwrap_or_else(|| usual_form(joint));
    let kind = joint.actuator.map(|actuator| actuator.kind).unwrap_or_default();
    let taken = FeedForward::of(kind);
    if !taken.contains(&form) {
        let names: Vec<&str> = taken.iter().map(|form| form.name()).collect();
        let message = format!("an actuator of kind `{}` is told of a torque as {}", kind.name(), names.join(" or "));
        return Err(Error::new(&codes::USAGE, message).with_value(form.name()));
    }
    if joint.actuator.is_some_and(|actuator| !actuator.per_torque(form).is_finite()) {
        let message = "an offset of the reference makes no torque where the gain of the position error is zero";
        return Err(Error::new(&codes::USAGE, message).in_column("actuator.kp_Nm_rad"));
    }
    Ok(form)
}

fn bench_of(arguments: &Loop, joint: plant::Joint) -> Result<Bench> {
    let course = follow::course(&arguments.motion, joint.drive.rate_hz)?;
    let feed_forward = form_of(arguments, &joint)?;
    let holds = joint.actuator.filter(|actuator| actuator.kind.follows_position());
    if let Some(actuator) = holds.filter(|_| course.target(0, joint.drive.rate_hz).is_none()) {
        let message = format!("an actuator of kind `{}` holds its position and cannot be let go", actuator.kind.name());
        return Err(Error::new(&codes::USAGE, message).with_value(course.name()));
    }
    let duration = arguments.duration.unwrap_or_else(|| course.duration(joint.drive.rate_hz));
    let positive = [("--friction-scale", arguments.friction_scale), ("--duration", duration)];
    for (name, value) in positive {
        if !(value.is_finite() && value > 0.0) {
            let message = format!("`{name}` has to be a finite number above zero");
            return Err(Error::new(&codes::USAGE, message).with_value(value.to_string()));
        }
    }
    if duration * joint.drive.rate_hz > plant::MOST_SAMPLES {
        let message = format!("a run has at most {} samples", plant::MOST_SAMPLES);
        return Err(Error::new(&codes::USAGE, message).with_value((duration * joint.drive.rate_hz).to_string()));
    }
    let swap = match (&arguments.swap_image, arguments.swap_at) {
        (Some(path), Some(at)) => Some((at, model::load(path)?.0)),
        _ => None,
    };
    Ok(Bench {
        joint,
        seed: arguments.seed,
        friction_scale: arguments.friction_scale,
        course,
        feed_forward,
        duration,
        swap,
    })
}
