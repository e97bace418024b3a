//! `trainer watch`: a recording that is being written, fitted again as it grows.

use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

use clap::Args;

use super::in_pool;
use crate::commands::measurement::{self, Source};
use crate::commands::output::{command_line, is_read, refuse_unwritable};
use crate::error::Result;
use crate::figures::{digits, quantity};
use crate::files::{read_whole, write_together};
use crate::fit::Options;
use crate::joint::Joint;
use crate::workflow::fit::{Fitted, fit};

/// Time between two looks at the file, that a user takes for at once and a disk does not feel.
const LOOK_EVERY: Duration = Duration::from_millis(200);
/// Largest recording that is watched, bytes: a day at 1 kHz, a hundred bytes a row.
const RECORDING_LIMIT_BYTES: u64 = 10 << 30;
/// Endings of recordings that loggers write row by row, so that the last row may be half there.
const ROW_BY_ROW: [&str; 5] = ["csv", "tsv", "txt", "dat", "log"];

/// Fit a recording again whenever it has grown, a line for each fit, until Ctrl-C.
///
/// The law is that of `fit` for the rows that are there; a row that is half written waits for the next fit. Rows that cannot be fitted yet
/// are told with the code of `fit`, and the image is written where the fit may be relied upon.
#[derive(Args, Clone, Debug)]
pub struct Watch {
    /// Recording that is being written; may be missing yet
    #[arg(value_name = "RECORDING")]
    pub recording: PathBuf,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Image to write after each fit
    #[arg(short, long, value_name = "MODEL.frk")]
    pub output: Option<PathBuf>,
    /// Page to write after each fit
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Least time from the start of one fit to that of the next, s
    #[arg(long, value_name = "S", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pub every: u32,
    /// Seed of the training
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Threads to use; all when absent. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command, which ends when it is interrupted or nobody reads it any more.
///
/// # Errors
/// `FRK-U001` and `FRK-I...` for files that cannot be read or written. That rows cannot be fitted is no error.
pub fn run(arguments: &Watch) -> Result<()> {
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let read = [Some(&arguments.recording), arguments.joint.as_ref()].into_iter().flatten().map(PathBuf::as_path);
    refuse_unwritable(arguments.output.iter().chain(&arguments.report), &read.collect::<Vec<_>>())?;
    let beginning = Instant::now();
    let mut fitted = None;
    loop {
        // A file that is not there yet, or is being put in the place of another, is there at the next look.
        let state = std::fs::metadata(&arguments.recording).ok().as_ref().map(state);
        if state.is_none() || state == fitted {
            sleep(LOOK_EVERY);
            continue;
        }
        let start = Instant::now();
        let told = in_pool(arguments.threads, || refit(arguments, &joint))??;
        fitted = state;
        if !is_read(&format!("{:6.1} s  {told}\n", beginning.elapsed().as_secs_f64()))? {
            return Ok(());
        }
        sleep(Duration::from_secs(arguments.every.into()).saturating_sub(start.elapsed()));
    }
}

/// By what a file that was written to is known.
fn state(file: &Metadata) -> (u64, Option<SystemTime>) {
    (file.len(), file.modified().ok())
}

/// Fits what is there, writes what is asked for, and tells it in a line.
fn refit(arguments: &Watch, joint: &Joint) -> Result<String> {
    let label = arguments.recording.display().to_string();
    let bytes = read_whole(&arguments.recording, RECORDING_LIMIT_BYTES)?;
    let source = Source::Bytes { label: &label, bytes: whole_rows(&arguments.recording, &bytes) };
    let options = Options { seed: arguments.seed, ..Options::default() };
    let fitted = match fit(&[source], &[], joint, &options, &|_| {}) {
        Ok(fitted) => fitted,
        Err(error) => return Ok(error.to_string()),
    };
    let page = arguments.report.as_ref().map(|path| (path.as_path(), fitted.report(&command_line())));
    let mut files: Vec<(&Path, &[u8])> = page.iter().map(|(path, page)| (*path, page.as_bytes())).collect();
    if let Some(path) = arguments.output.as_ref().filter(|_| !fitted.is_withheld()) {
        files.push((path, &fitted.outcome.image));
    }
    write_together(&files)?;
    Ok(line(&fitted))
}

fn line(fitted: &Fitted) -> String {
    let outcome = &fitted.outcome;
    let rows: usize = fitted.recordings.iter().map(crate::recording::Recording::len).sum();
    let told = match fitted.doubt() {
        Some(doubt) => doubt.to_string(),
        None => format!("friction = {}", outcome.law.expression),
    };
    let score = outcome.train_score;
    format!("{rows:7} rows  error {} (R² {})  {told}", quantity(score.rmse, outcome.unit), digits(score.r2))
}

/// The content without a row that is half written, where rows are written one by one.
fn whole_rows<'a>(path: &Path, content: &'a [u8]) -> &'a [u8] {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let last = content.iter().rposition(|byte| *byte == b'\n');
    match last {
        Some(last) if ROW_BY_ROW.contains(&ending.as_str()) => &content[..=last],
        _ => content,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_is_half_written_is_left_out_of_text_alone() {
        let rows = |name: &str, content: &'static [u8]| whole_rows(Path::new(name), content);
        assert_eq!(rows("log.csv", b"t,v\n0,1\n0.1,"), b"t,v\n0,1\n");
        assert_eq!(rows("log.CSV", b"t,v\n0,1\n"), b"t,v\n0,1\n");
        assert_eq!(rows("log.csv", b"t,"), b"t,");
        assert_eq!(rows("log.npy", b"\n\x93NUM"), b"\n\x93NUM");
    }
}
