//! `trainer init`: a `joint.toml` that reads a recording, from the recording itself, or one of a servo whose parameters BAM knows.

mod bam;

use std::path::{Path, PathBuf};

use clap::Args;

use super::output::{Outputs, refuse_unwritable, say};
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::recording::{self, Proposal, Recording};
pub use bam::OfBam;

/// Propose a joint.toml for recordings: columns, units, joint and rate, each with the reason.
///
/// Columns that nothing is taken for are listed in it with what they could be; what was not found is said. A joint that reports no torque but what it was
/// told gets `[actuator]` and `[payload]` to fill in.
///
/// A parameter file of Rhoban's BAM (`m1.json` to `m6.json` of an actuator) in place of recordings becomes the joint.toml of that servo, and with
/// `--image` its friction an image for `rollout`, `loop`, `predict` and `diagnose --model`.
#[derive(Args, Clone, Debug)]
pub struct Init {
    /// Recordings of one joint, all with the same columns; `-` is standard input; or one parameter file of BAM
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// File to write; `-` for standard output
    #[arg(short, long, value_name = "JOINT.toml")]
    pub output: PathBuf,
    /// What goes with a parameter file of BAM
    #[command(flatten)]
    pub bam: OfBam,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// As [`recording::propose`] for the first recording and [`recording::load`] with the proposal, where it reads the first, for the others; of parameters of BAM `FRK-D046` for
/// what they cannot be and `FRK-D014` for what an image needs beside them. Nothing is written then.
pub fn run(arguments: &Init) -> Result<()> {
    let read: Vec<_> = arguments.recordings.iter().map(PathBuf::as_path).collect();
    refuse_unwritable([Some(&arguments.output), arguments.bam.image.as_ref()].into_iter().flatten(), &read)?;
    let Some((first, others)) = arguments.recordings.split_first() else { return Ok(()) };
    if let Some(text) = bam::text(first)? {
        if !others.is_empty() {
            return Err(Error::new(&codes::USAGE, "a parameter file of BAM stands by itself"));
        }
        return bam::run(&arguments.bam, (first, &text), &arguments.output, arguments.quiet);
    }
    if arguments.bam != OfBam::default() {
        let message = "`--image`, `--supply`, `--firmware-kp` and `--payload-kg` go with a parameter file of BAM";
        return Err(Error::new(&codes::USAGE, message));
    }
    let (proposal, recording) = recording::propose(first)?;
    if recording.is_ok() {
        let joint = Joint::parse(&proposal.toml)?;
        others.iter().try_for_each(|path| recording::load(path, &joint).map(drop))?;
    }
    let mut outputs = Outputs::default();
    outputs.add(&arguments.output, proposal.toml.as_bytes());
    outputs.write()?;
    if !arguments.quiet {
        say(told(first, &recording, &proposal).trim_end());
    }
    Ok(())
}

/// What was taken for what, a line a column.
fn told(path: &Path, recording: &Result<Recording>, proposal: &Proposal) -> String {
    let rate = proposal.rate_hz.map_or_else(String::new, |rate| format!(", {rate:.1} Hz"));
    let mut text = match recording {
        Ok(recording) => format!("{}: {} rows{rate}\n", recording.file(), recording.len()),
        Err(_) => format!("{}{rate}\n", path.display()),
    };
    let width = proposal.taken.iter().map(|taken| taken.column.chars().count()).max().unwrap_or(0);
    for taken in &proposal.taken {
        let (quantity, unit) = (taken.quantity.name(), &taken.unit);
        text += &format!("  {:<width$}  {quantity:<18} {unit:<7} {}\n", taken.column, taken.why);
    }
    if !proposal.channels.is_empty() {
        text += &format!("  kept as channels by their names: {}\n", proposal.channels.join(", "));
    }
    if !proposal.other_joints.is_empty() {
        text += &format!("  other joints: {}\n", proposal.other_joints.join(" "));
    }
    proposal.missing.iter().for_each(|sentence| text += &format!("  {sentence}\n"));
    match recording {
        Ok(_) => {}
        Err(error) if error.code() == &codes::NO_KNOWN_COLUMN => {
            text += "  nothing is read by it yet: every column stands in it, say there what each is\n";
        }
        Err(error) => text += &format!("  nothing is read by it yet: {} {}\n", error.code().id, error.message()),
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    #[test]
    fn a_proposal_reads_what_it_was_made_for() {
        let folder = tempfile::tempdir().unwrap();
        let (path, output) = (folder.path().join("log.csv"), folder.path().join("joint.toml"));
        let mut text = String::from("t,q1,dq1,tau1,mode\n");
        for row in 0..200 {
            let time = 0.004 * f64::from(row);
            writeln!(text, "{},{},{},{},80", 1000.0 * time, time.sin(), time.cos().to_degrees(), 0.5 * time.cos())
                .unwrap();
        }
        std::fs::write(&path, text).unwrap();
        let init = Init {
            recordings: vec![path.clone(), path.clone()],
            output: output.clone(),
            bam: OfBam::default(),
            quiet: true,
        };
        run(&init).unwrap();
        let recording = recording::load(&path, &Joint::load(&output).unwrap()).unwrap();
        let velocity = recording.values(recording::Quantity::Velocity).unwrap();
        assert!((velocity[0] - 1.0).abs() < 1e-12 && recording.actuator().is_some());
        assert!((recording.health.period_s.unwrap() - 0.004).abs() < 1e-12);
        let (proposal, recording) = recording::propose(&path).unwrap();
        let lines = told(&path, &recording, &proposal);
        assert!(
            lines.contains("the derivative of the position in deg_s")
                && lines.contains("channels by their names: mode"),
            "{lines}"
        );
        let over = run(&Init { output: path.clone(), ..init }).unwrap_err();
        assert_eq!(over.exit_status(), 2);
    }
}
