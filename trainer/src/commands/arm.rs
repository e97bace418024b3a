//! `trainer arm`: recordings of all joints of an arm in, an image for each joint out.

use std::path::{Path, PathBuf};

use clap::Args;

use super::fit::{in_pool, line};
use super::measurement::{Source, profile};
use super::output::{Outputs, print, refuse_unwritable, say};
use super::progress::Reporter;
use crate::compile::profile::Profile;
use crate::error::{Error, Result, codes};
use crate::files::{create_folder, read_text, refuse_folder};
use crate::fit::{Budget, Options};
use crate::joint::ArmFile;
use crate::workflow::arm::{FittedArm, Recorded, advise, arm, joint_doubt};

/// Largest `arm.toml` and URDF that are read, in bytes.
const FILE_LIMIT_BYTES: u64 = 64 << 20;

/// Fit bodies and friction of a whole arm and export an image for each joint.
#[derive(Args, Clone, Debug)]
pub struct Arm {
    /// Recordings of all joints to learn from
    #[arg(required_unless_present = "advise", value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// Recordings that are only scored
    #[arg(long = "test", num_args = 1.., value_name = "RECORDING")]
    pub tests: Vec<PathBuf>,
    /// The robot as URDF or MJCF: joints, and the masses that are known of its links
    #[arg(long, visible_alias = "mjcf", value_name = "ARM.urdf")]
    pub urdf: PathBuf,
    /// arm.toml: column names, drives, gravity, joints that are held; limits and obstacles of `--advise`
    #[arg(long, value_name = "ARM.toml")]
    pub joint: Option<PathBuf>,
    /// Folder for an image of each joint, arm.json and the robot's file with their friction; made where it does not exist
    #[arg(short, long, required_unless_present = "advise", value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Plan a motion that tells everything apart, within `[limits]` of arm.toml and clear of its `[[obstacles]]` and of the arm itself, instead of fitting; as CSV, `-` for standard output
    #[arg(long, conflicts_with_all = ["recordings", "tests", "output", "split", "json"], value_name = "FILE")]
    pub advise: Option<PathBuf>,
    /// Also write the recordings of each joint with the torque of the bodies, and a joint.toml for `fit` and `diagnose`
    #[arg(long)]
    pub split: bool,
    /// Drive that has to have room for the images, by its name as `verify` takes it; the smallest documented one when absent
    #[arg(long, value_name = "NAME", value_parser = profile)]
    pub target: Option<Profile>,
    /// Also write the result as JSON elsewhere; `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Seed of the training: one seed, one set of images
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Threads to use; all when absent. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Write the images in spite of exit status 4: not identifiable, not physical or not converged
    #[arg(long)]
    pub force: bool,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

impl Arm {
    /// Files that are read.
    fn inputs(&self) -> Vec<&Path> {
        let recordings = self.recordings.iter().chain(&self.tests);
        recordings.chain([&self.urdf]).chain(&self.joint).map(PathBuf::as_path).collect()
    }
}

/// Runs the command; the exit status is 0 or, where the law of a joint may not be relied upon, 4.
///
/// # Errors
/// As [`arm`], and whatever reading or writing reports. Nothing is written unless the fit succeeded.
pub fn run(arguments: &Arm) -> Result<u8> {
    refuse_unwritable(&arguments.json, &arguments.inputs())?;
    refuse_unwritable(&arguments.advise, &arguments.inputs())?;
    if arguments.advise.is_none() {
        refuse_folder(&folder(arguments))?;
    }
    let text = |path: &Path| read_text(path, FILE_LIMIT_BYTES);
    let in_file = |path: &Path| {
        let path = path.display().to_string();
        move |error: Error| error.in_file(path)
    };
    let robot = text(&arguments.urdf)?;
    let file = match &arguments.joint {
        None => ArmFile::default(),
        Some(path) => ArmFile::parse(&text(path)?).map_err(in_file(path))?,
    };
    if !arguments.quiet {
        file.unknown_keys().iter().for_each(|sentence| say(&format!("{} {sentence}", codes::UNKNOWN_KEY.id)));
    }
    if let Some(path) = &arguments.advise {
        return plan(arguments, path, &robot, &file);
    }
    let budget = Budget { target: arguments.target.unwrap_or_default(), ..Budget::default() };
    let options = Options { seed: arguments.seed, budget, ..Options::default() };
    let [recordings, tests] =
        [&arguments.recordings, &arguments.tests].map(|paths| paths.iter().map(Source::from).collect::<Vec<_>>());
    let recorded = Recorded { recordings: &recordings, tests: &tests, robot: &robot, file: &file };
    let reporter = Reporter::new(arguments.quiet);
    let fitted = in_pool(arguments.threads, || {
        arm(&recorded, &options, &|joint, progress| {
            reporter.say(&joint.map_or_else(|| line(progress), |joint| format!("{joint}: {}", line(progress))));
        })
    })?;
    drop(reporter);
    let fitted = fitted.map_err(|error| match error.code() {
        code if *code == codes::BAD_URDF => error.in_file(arguments.urdf.display().to_string()),
        code if *code == codes::BAD_JOINT_FILE => {
            arguments.joint.as_ref().map_or(error.clone(), |path| error.in_file(path.display().to_string()))
        }
        _ => error,
    })?;
    write(arguments, &fitted, &robot)?;
    let doubtful = fitted.outcome.joints.iter().filter_map(|joint| Some((&joint.name, joint_doubt(joint)?)));
    let doubts: Vec<String> = doubtful.map(|(name, doubt)| format!("{name}: {doubt}")).collect();
    if !arguments.quiet {
        doubts.iter().for_each(|doubt| say(doubt));
    }
    Ok(if doubts.is_empty() { 0 } else { codes::NOT_IDENTIFIABLE.class.exit_status() })
}

/// Where the images go; clap asks for it unless a motion is planned.
fn folder(arguments: &Arm) -> PathBuf {
    arguments.output.clone().unwrap_or_default()
}

/// Writes a planned motion.
fn plan(arguments: &Arm, path: &Path, robot: &str, file: &ArmFile) -> Result<u8> {
    let advised = in_pool(arguments.threads, || advise(robot, file, arguments.seed))??;
    let mut outputs = Outputs::default();
    outputs.add(path, advised.trajectory);
    outputs.refuse_overwriting(&arguments.inputs())?;
    outputs.write()?;
    if path != Path::new("-") {
        print(&advised.text)?;
    } else if !arguments.quiet {
        say(advised.text.trim_end());
    }
    Ok(0)
}

fn write(arguments: &Arm, fitted: &FittedArm, robot: &str) -> Result<()> {
    let folder = folder(arguments);
    create_folder(&folder)?;
    let mut outputs = Outputs::default();
    let place = |name: &str| folder.join(name);
    let images = fitted.images(arguments.force);
    for (name, bytes) in images.iter().flatten() {
        outputs.add(&place(name), *bytes);
    }
    let images: Vec<Option<String>> = images.into_iter().map(|image| image.map(|(name, _)| name)).collect();
    let json = fitted.json(&images);
    outputs.add_json(&place("arm.json"), json.clone());
    let ending = arguments.urdf.extension().map_or_else(|| "urdf".into(), |ending| ending.to_string_lossy());
    outputs.add(&place(&format!("arm.{ending}")), fitted.patched(robot, arguments.force)?);
    if arguments.split {
        fitted.recordings().into_iter().for_each(|(name, content)| outputs.add(&place(&name), content));
    }
    if let Some(path) = &arguments.json {
        outputs.add_json(path, json);
    }
    outputs.refuse_overwriting(&arguments.inputs())?;
    outputs.write()?;
    if arguments.json.as_deref() == Some(Path::new("-")) {
        return Ok(());
    }
    print(&fitted.text(&images))
}
