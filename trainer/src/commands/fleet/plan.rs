//! `trainer plan`: the recordings of a fleet as a list of tasks.

use std::path::{Path, PathBuf};

use clap::Args;

use super::stamp::without_date;
use super::task::{FLEET_FILE, Task, folder_of};
use crate::commands::output::{Outputs, refuse_unwritable, say};
use crate::error::{Error, Result, codes};
use crate::joint::Joint;

/// Endings of the files of a folder that are taken for recordings; a pattern may name any others.
const ENDINGS: [&str; 7] = [".csv", ".csv.gz", ".tsv", ".npy", ".npz", ".mat", ".parquet"];

/// The same of bags.
const BAG: &str = ".mcap";

/// Name of the file that tells what is known of the joints of a folder and of those beneath it.
const JOINT_FILE: &str = "joint.toml";

/// List the recordings of a fleet as tasks, one fit each, for any engine that counts: HyperQueue, a Slurm array, GNU parallel.
///
/// A joint is called by its path without date and ending: `arm7/elbow/2025-03-01.csv` and `arm7/elbow_20250301.csv` are recordings of
/// `arm7/elbow` on one day. What is known of a joint stands in `NAME.toml` beside NAME.csv, or else in the nearest `joint.toml` above it.
/// Joints whose files give the same `name` are siblings, and so are all that have none.
#[derive(Args, Clone, Debug)]
pub struct Plan {
    /// Folders with recordings, or patterns such as `'arms/*/elbow-*.csv'`
    #[arg(required = true, value_name = "DIR|GLOB")]
    pub recordings: Vec<PathBuf>,
    /// joint.toml of all joints
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Take all joints for siblings of this kind
    #[arg(long, value_name = "NAME")]
    pub kind: Option<String>,
    /// Seed of the training
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// List to write, one line of JSON a task; their results go to the folder of the same name with the ending `.results`
    #[arg(short, long, value_name = "TASKS.jsonl")]
    pub output: PathBuf,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// `FRK-I002` where a folder or pattern has no recording, `FRK-U001` for a pattern that is none, `FRK-D015` for a `joint.toml` that
/// cannot be used.
pub fn run(arguments: &Plan) -> Result<()> {
    refuse_unwritable([&arguments.output], &[])?;
    let mut found: Vec<(PathBuf, PathBuf)> = Vec::new();
    for place in &arguments.recordings {
        let root = if place.is_dir() { place.clone() } else { fixed_part(place) };
        let files = if place.is_dir() { in_folder(place)? } else { by_pattern(place)? };
        if files.is_empty() {
            let error = Error::new(&codes::FILE_NOT_FOUND, "there is no recording here");
            return Err(error.in_file(place.display().to_string()));
        }
        found.extend(files.into_iter().map(|file| (root.clone(), file)));
    }
    found.sort_by(|a, b| a.1.cmp(&b.1));
    found.dedup_by(|a, b| a.1 == b.1);
    refuse_unwritable([&arguments.output], &found.iter().map(|(_, file)| file.as_path()).collect::<Vec<_>>())?;
    let base = absolute(folder_of(&arguments.output))?;
    let tasks = found.iter().enumerate().map(|(index, (root, file))| task(arguments, index, root, file, &base));
    let tasks = tasks.collect::<Result<Vec<Task>>>()?;
    let lines = tasks.iter().map(|task| serde_json::json!(task).to_string() + "\n");
    let mut outputs = Outputs::default();
    outputs.add(&arguments.output, lines.collect::<String>());
    outputs.write()?;
    if !arguments.quiet {
        say(how_to_run(&arguments.output, &tasks).trim_end());
    }
    Ok(())
}

fn task(arguments: &Plan, index: usize, root: &Path, file: &Path, base: &Path) -> Result<Task> {
    let relative = file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/");
    let (joint, date) = without_date(stem(&relative));
    let joint_file = arguments.joint.clone().or_else(|| joint_file(root, file));
    let described = joint_file.as_deref().map(Joint::load).transpose()?;
    let kind = arguments.kind.clone().or_else(|| described.and_then(|joint| joint.name)).unwrap_or_default();
    let from_base = |path: &Path| -> Result<String> {
        let path = absolute(path)?;
        Ok(path.strip_prefix(base).unwrap_or(&path).to_string_lossy().into_owned())
    };
    // A recording that is called by its date alone is of the joint that its folder is.
    let joint = if joint.is_empty() { folder_name(root) } else { joint };
    let joint_file = joint_file.as_deref().map(from_base).transpose()?;
    Ok(Task { index, joint, kind, date, recording: from_base(file)?, joint_file, seed: arguments.seed })
}

/// A path without the endings of a recording.
fn stem(path: &str) -> &str {
    let name = path.rfind('/').map_or(0, |slash| slash + 1);
    let uncompressed = path.strip_suffix(".gz").unwrap_or(path);
    uncompressed[name..].rfind('.').filter(|dot| *dot > 0).map_or(uncompressed, |dot| &uncompressed[..name + dot])
}

fn folder_name(folder: &Path) -> String {
    let name =
        folder.canonicalize().ok().and_then(|path| path.file_name().map(|name| name.to_string_lossy().into_owned()));
    name.unwrap_or_default()
}

/// The file beside a recording that has its name, or the nearest joint.toml from its folder up to the root.
fn joint_file(root: &Path, file: &Path) -> Option<PathBuf> {
    let name = file.file_name()?.to_string_lossy().into_owned();
    let beside = file.with_file_name(format!("{}.toml", stem(&name)));
    let above =
        file.ancestors().skip(1).take_while(|folder| folder.starts_with(root)).map(|folder| folder.join(JOINT_FILE));
    std::iter::once(beside).chain(above).find(|path| path.is_file())
}

/// The recordings of a folder and of those beneath it; hidden ones and the tables of a fleet left out.
fn in_folder(folder: &Path) -> Result<Vec<PathBuf>> {
    let failed = |error: std::io::Error| Error::from_io(folder, &error);
    let mut files = Vec::new();
    if folder.join(FLEET_FILE).is_file() {
        return Ok(files);
    }
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        let kind = entry.file_type().map_err(failed)?;
        if name.starts_with('.') {
            continue;
        }
        // A link to a folder may lead in a circle; one to a file is a file.
        if kind.is_dir() {
            files.extend(in_folder(&path)?);
        } else if path.is_file() && ENDINGS.iter().chain([&BAG]).any(|ending| name.to_lowercase().ends_with(ending)) {
            files.push(path);
        }
    }
    Ok(files)
}

fn by_pattern(pattern: &Path) -> Result<Vec<PathBuf>> {
    let text = pattern.to_string_lossy();
    let refused = |why: String| Error::new(&codes::USAGE, why).with_value(&text);
    let matches = glob::glob(&text).map_err(|error| refused(format!("this is no pattern: {error}")))?;
    let files = matches.collect::<std::result::Result<Vec<PathBuf>, _>>();
    let files = files.map_err(|error| Error::from_io(error.path(), error.error()))?;
    Ok(files.into_iter().filter(|path| path.is_file()).collect())
}

/// The folders of a pattern before its first wildcard.
fn fixed_part(pattern: &Path) -> PathBuf {
    let is_fixed = |part: &std::path::Component<'_>| !part.as_os_str().to_string_lossy().contains(['*', '?', '[']);
    let fixed: PathBuf = pattern.components().take_while(is_fixed).collect();
    if fixed == pattern { folder_of(pattern).to_owned() } else { fixed }
}

fn absolute(path: &Path) -> Result<PathBuf> {
    path.canonicalize().map_err(|error| Error::from_io(path, &error))
}

/// How engines that count are told.
fn how_to_run(list: &Path, tasks: &[Task]) -> String {
    let (list, last) = (list.display(), tasks.len().saturating_sub(1));
    let joints = tasks.iter().map(|task| &task.joint).collect::<std::collections::BTreeSet<_>>().len();
    let run = |index: &str| format!("trainer run --tasks {list} --threads 1 --index {index}");
    format!(
        "{} recordings of {joints} joints. To run them:\n  \
         HyperQueue  hq submit --array 0-{last} bash -c '{}'\n  \
         Slurm       sbatch --array=0-{last} --wrap '{}'\n  \
         one by one  for i in $(seq 0 {last}); do {}; done\n\
         and then    trainer gather --tasks {list} -o FOLDER\n",
        tasks.len(),
        run("$HQ_TASK_ID"),
        run("$SLURM_ARRAY_TASK_ID"),
        run("$i"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_gives_the_same_list_every_time_and_its_own_results_are_no_recordings() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in [
            "b/elbow/2025-03-01.csv",
            "a/elbow/2025-03-01.csv",
            "a/elbow/20250201.csv.gz",
            "a/notes.txt",
            "table/fleet.json",
            "table/joints.csv",
        ] {
            std::fs::create_dir_all(at(name).parent().unwrap()).unwrap();
            std::fs::write(at(name), "").unwrap();
        }
        std::fs::write(at("joint.toml"), "name = \"elbow\"\n").unwrap();
        std::fs::write(at("b/elbow/joint.toml"), "").unwrap();
        let list = at("tasks.jsonl");
        let plan = |place: PathBuf| {
            let plan =
                Plan { recordings: vec![place], joint: None, kind: None, seed: 1, output: list.clone(), quiet: true };
            run(&plan).map(|()| std::fs::read_to_string(&list).unwrap())
        };
        let lines = plan(folder.path().to_owned()).unwrap();
        assert_eq!(plan(folder.path().to_owned()).unwrap(), lines);
        let tasks: Vec<Task> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let told: Vec<_> =
            tasks.iter().map(|t| (t.index, &*t.joint, &*t.kind, t.date.as_deref().unwrap(), &*t.recording)).collect();
        assert_eq!(
            told,
            [
                (0, "a/elbow", "elbow", "2025-03-01", "a/elbow/2025-03-01.csv"),
                (1, "a/elbow", "elbow", "2025-02-01", "a/elbow/20250201.csv.gz"),
                (2, "b/elbow", "", "2025-03-01", "b/elbow/2025-03-01.csv"),
            ]
        );
        assert_eq!(tasks[1].joint_file.as_deref(), Some("joint.toml"));
        let by_pattern = plan(folder.path().join("*/elbow/*.csv")).unwrap();
        assert_eq!(by_pattern.lines().count(), 2);
        assert_eq!(plan(at("nowhere/*.csv")).unwrap_err().code(), &codes::FILE_NOT_FOUND);
        assert_eq!(plan(at("a***")).unwrap_err().code(), &codes::USAGE);
    }
}
