//! `trainer simulate`: a recording of a joint that does not exist, for rehearsal.

use crate::error::{Error, Result, codes};
use crate::files::write_whole;
use crate::joint;
use crate::plant::{self, Hidden, NoiseKind, SimulatedRecording};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Simulate a recording of a joint in closed loop, with any combination of effects hidden in it.
#[derive(Args, Clone, Debug)]
pub struct Simulate {
    /// Description of the joint; its `[plant]` section and every key in it are optional
    #[arg(value_name = "JOINT.toml")]
    pub joint: PathBuf,
    /// Recording to write
    #[arg(short, long, value_name = "RECORDING.csv")]
    pub output: PathBuf,
    /// Seed of motions, noise and shapes of effects: one seed, one recording
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Seed of motions and noise, for another recording of the joint that `--seed` describes
    #[arg(long, value_name = "SEED")]
    pub motion_seed: Option<u64>,
    /// Hide an effect at an amplitude (1 is a plausible strength); may be given several times
    #[arg(long = "effect", value_name = "NAME=AMPLITUDE", value_parser = parse_effect)]
    pub effects: Vec<Hidden>,
    /// Length of the recording, s
    #[arg(long, value_name = "SECONDS")]
    pub duration: Option<f64>,
    /// Kind of noise: white, coloured, state_dependent, coarse_encoder or flexible_base
    #[arg(long, value_name = "KIND", value_parser = parse_noise)]
    pub noise: Option<NoiseKind>,
    /// Write one file a trajectory, RECORDING-00.csv and so on
    #[arg(long)]
    pub separate: bool,
    /// Also write the truth: motion, effect torque and noise without sensors between
    #[arg(long, value_name = "TRUTH.csv")]
    pub truth: Option<PathBuf>,
    /// Write what was hidden, with every drawn parameter, as JSON; `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// `FRK-D015` for a joint that cannot be simulated, `FRK-U001` for an effect or a length that does not exist, and
/// whatever reading or writing reports. Nothing is written unless the simulation succeeded.
pub fn run(arguments: &Simulate) -> Result<()> {
    let label = arguments.joint.display().to_string();
    let mut joint = with_effects(&arguments.joint, &arguments.effects)?;
    if let Some(kind) = arguments.noise {
        joint.noise.kind = kind;
    }
    if let Some(duration) = arguments.duration {
        if !(duration.is_finite() && duration > 0.0) {
            let message = "`--duration` has to be a finite number of seconds above zero";
            return Err(Error::new(&codes::USAGE, message).with_value(duration.to_string()));
        }
        plant::refuse_length(duration, joint.drive.rate_hz)
            .map_err(|error| Error::new(&codes::USAGE, error.to_string()).with_value(duration.to_string()))?;
        joint.campaign = joint.campaign.with_duration(duration);
    }
    let motion_seed = arguments.motion_seed.unwrap_or(arguments.seed);
    let recording = plant::simulate_again(&joint, arguments.seed, motion_seed)
        .map_err(|error| Error::from(error).in_file(&label))?;
    write_recording(arguments, &recording)?;
    if let Some(path) = &arguments.truth {
        write_whole(path, recording.truth_to_csv().as_bytes())?;
    }
    if let Some(path) = &arguments.json {
        let text = summary(&joint, &recording, arguments.seed);
        if path == Path::new("-") {
            println!("{text}");
        } else {
            write_whole(path, text.as_bytes())?;
        }
    }
    if !arguments.quiet {
        eprintln!("{}: {} samples, {} hidden", arguments.output.display(), recording.len(), joint.effects.len());
    }
    Ok(())
}

/// The joint that a `joint.toml` describes, with more effects hidden in it.
pub(super) fn with_effects(path: &Path, effects: &[Hidden]) -> Result<plant::Joint> {
    let file = joint::Joint::load(path)?;
    let mut joint = plant::Joint::described_by(&file).map_err(|error| error.in_file(path.display().to_string()))?;
    joint.effects.extend(effects.iter().cloned());
    Ok(joint)
}

fn write_recording(arguments: &Simulate, recording: &SimulatedRecording) -> Result<()> {
    if !arguments.separate {
        return write_whole(&arguments.output, recording.to_csv().as_bytes());
    }
    let stem = arguments.output.file_stem().unwrap_or_default().to_string_lossy();
    for (index, part) in recording.split().iter().enumerate() {
        let path = arguments.output.with_file_name(format!("{stem}-{index:02}.csv"));
        write_whole(&path, part.to_csv().as_bytes())?;
    }
    Ok(())
}

fn summary(joint: &plant::Joint, recording: &SimulatedRecording, seed: u64) -> String {
    let truth = &recording.truth;
    let parameters: Vec<_> =
        truth.parameters.iter().map(|(name, value)| json!({"name": name, "value": value})).collect();
    json!({
        "schema": "frikan.simulate/1",
        "seed": seed,
        "n": recording.len(),
        "noise_rms_Nm": truth.noise_rms,
        "effect_rms_Nm": truth.effect_rms(),
        "effects": joint.effects,
        "parameters": parameters,
    })
    .to_string()
}

pub(super) fn parse_effect(text: &str) -> std::result::Result<Hidden, String> {
    let (name, amplitude) = text.split_once('=').unwrap_or((text, "1"));
    if plant::find(name).is_none() {
        let known: Vec<&str> = plant::CATALOGUE.iter().chain(plant::OUTSIDE).map(|entry| entry.name).collect();
        return Err(format!("no effect is called `{name}`; there are {}", known.join(", ")));
    }
    match amplitude.parse::<f64>() {
        Ok(amplitude) if amplitude.is_finite() => Ok(Hidden { name: name.to_owned(), amplitude }),
        _ => Err(format!("`{amplitude}` is not a finite amplitude")),
    }
}

fn parse_noise(text: &str) -> std::result::Result<NoiseKind, String> {
    NoiseKind::ALL
        .into_iter()
        .find(|kind| kind.name() == text)
        .ok_or_else(|| format!("one of {} is expected", NoiseKind::ALL.map(NoiseKind::name).join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        simulate: Simulate,
    }

    fn run_line(folder: &Path, extra: &[&str]) -> Result<()> {
        let toml = folder.join("joint.toml");
        std::fs::write(&toml, "[plant.campaign]\ntrajectory_s = 1.0\n").unwrap();
        let (toml, output) = (toml.display().to_string(), folder.join("out.csv").display().to_string());
        let words = ["simulate", &toml, "-o", &output, "--duration", "2", "--quiet"];
        run(&Line::try_parse_from(words.iter().chain(extra))
            .map_err(|e| Error::new(&codes::USAGE, e.to_string()))?
            .simulate)
    }

    #[test]
    fn one_seed_writes_one_file() {
        let folder = tempfile::tempdir().unwrap();
        run_line(folder.path(), &["--effect", "stribeck=0.5", "--noise", "white"]).unwrap();
        let first = std::fs::read(folder.path().join("out.csv")).unwrap();
        run_line(folder.path(), &["--effect", "stribeck=0.5", "--noise", "white"]).unwrap();
        assert_eq!(first, std::fs::read(folder.path().join("out.csv")).unwrap());
        run_line(folder.path(), &["--effect", "stribeck=0.5", "--noise", "white", "--seed", "2"]).unwrap();
        assert_ne!(first, std::fs::read(folder.path().join("out.csv")).unwrap());
        let header = String::from_utf8(first).unwrap();
        assert!(header.starts_with("time_s,position_rad,torque_Nm,load_torque_Nm,temperature_C,"), "{header:.80}");
    }

    #[test]
    fn separate_files_and_truth_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let truth = folder.path().join("truth.csv").display().to_string();
        run_line(folder.path(), &["--separate", "--truth", &truth]).unwrap();
        let mut names: Vec<_> =
            std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["joint.toml", "out-00.csv", "out-01.csv", "truth.csv"]);
    }

    #[test]
    fn a_wrong_name_or_length_is_a_usage_error_and_writes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        for extra in [&["--effect", "magnetism=1"], &["--duration", "-1"], &["--duration", "1e9"], &["--noise", "pink"]]
        {
            assert_eq!(run_line(folder.path(), extra).unwrap_err().code(), &codes::USAGE);
        }
        assert!(!folder.path().join("out.csv").exists());
    }
}
