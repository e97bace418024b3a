//! `trainer fit`: recordings in, a friction image out.

pub mod watch;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::measurement::{self, Source, actuator_file, profile, rehearse};
use super::output::{Outputs, command_line, print, refuse_unwritable, say};
use super::progress::Reporter;
use crate::actuator::Kind;
use crate::compile::profile::Profile;
use crate::did_you_mean::hint;
use crate::error::{Error, Result, codes};
use crate::fit::outcome::Representation;
use crate::fit::{Budget, Options, Progress, Training};
use crate::kan::{Architecture, Sparsity};
use crate::law::KnownForm;
use crate::workflow::fit::{Fitted, fit};

/// Fit a friction law to recordings of one joint and export it as an image.
#[derive(Args, Clone, Debug)]
pub struct Fit {
    /// Recordings to learn from, CSV with columns `<quantity>_<unit>`
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// Recordings that are only scored
    #[arg(long = "test", num_args = 1.., value_name = "RECORDING")]
    pub tests: Vec<PathBuf>,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Inputs of the law by name; chosen by relevance when absent
    #[arg(long, value_delimiter = ',', value_name = "NAME,...")]
    pub inputs: Option<Vec<String>>,
    /// Form of the law in the image; the better one on held-out blocks when absent
    #[arg(long, value_enum)]
    pub representation: Option<Form>,
    /// Law of the literature to fit, over velocity, in place of the one that the samples ask for: coulomb, coulomb-static, coulomb-viscous, stribeck-dry,
    /// bengisu-akay, awrejcewicz, stribeck, stribeck-gaussian, stribeck-exponent, asymmetric, power-law or arctangent
    #[arg(long, value_name = "NAME", value_parser = known_form)]
    pub form: Option<KnownForm>,
    /// Rate at which samples are fitted, Hz; follows the filter when absent
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Bytes that the image may have, provenance not counted
    #[arg(long, value_name = "BYTES")]
    pub max_bytes: Option<usize>,
    /// Instructions that one evaluation may take on a Cortex-M4F
    #[arg(long, value_name = "N")]
    pub max_instructions: Option<u32>,
    /// Drive that has to have room for the image, by its name as `verify` takes it; the smallest documented one when absent. One without floating-point unit
    /// gets a table of integers
    #[arg(long, value_name = "NAME", value_parser = profile)]
    pub target: Option<Profile>,
    /// Image to write
    #[arg(short, long, value_name = "MODEL.frk")]
    pub output: PathBuf,
    /// Also write the result as JSON; `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Also write a report as a page
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Seed of the training: one seed, one image
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Threads to use; all when absent. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Memory to stay within, MB: of recordings that need more, stretches spread over them are read [default: 1000]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u32).range(200..))]
    pub memory: Option<u32>,
    /// Write the image in spite of exit status 4: not identifiable, not physical or not converged
    #[arg(long)]
    pub force: bool,
    /// Read and check the recordings, say what would be written, and stop there
    #[arg(long)]
    pub dry_run: bool,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
    /// How the network is trained
    #[command(flatten)]
    pub training: TrainingArguments,
}

fn known_form(name: &str) -> std::result::Result<KnownForm, String> {
    let names = KnownForm::ALL.map(KnownForm::key);
    KnownForm::named(name)
        .ok_or_else(|| format!("there is no form of this name{}; there are {}", hint(name, names), names.join(", ")))
}

/// How the network is trained; rarely needed.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Training")]
pub struct TrainingArguments {
    /// Shape of the network, such as `[1,5,1]` or `[2,[5,2],1]` (five sums and two products)
    #[arg(long, value_name = "SHAPE")]
    pub network: Option<Architecture>,
    /// Independent starts; the best on held-out blocks is kept
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub restarts: Option<u16>,
    /// Most steps of one start
    #[arg(long, value_name = "N")]
    pub steps: Option<usize>,
    /// How often the cells of the grids are halved, as long as held-out blocks gain
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(..=6))]
    pub refinements: Option<u16>,
    /// Pull of superfluous edges towards nothing: weight of the sum of their sizes
    #[arg(long, value_name = "WEIGHT", default_value_t = 0.0)]
    pub l1: f64,
    /// The same: weight of the entropy of their sizes
    #[arg(long, value_name = "WEIGHT", default_value_t = 0.0)]
    pub entropy: f64,
}

impl TrainingArguments {
    fn training(&self) -> Result<Training> {
        let weight = |option: &str, weight: f64| {
            let message = format!("`{option}` has to be a finite number, zero or above");
            let sound = weight.is_finite() && weight >= 0.0;
            if sound { Ok(weight) } else { Err(Error::new(&codes::USAGE, message).with_value(weight.to_string())) }
        };
        Ok(Training {
            network: self.network.clone(),
            restarts: self.restarts.map(usize::from),
            steps: self.steps,
            refinements: self.refinements.map(usize::from),
            sparsity: Some(Sparsity { l1: weight("--l1", self.l1)?, entropy: weight("--entropy", self.entropy)? }),
        })
    }
}

/// Form of a law, as the command line spells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// Tables of cubic pieces made from the network
    Table,
    /// A formula
    Expression,
}

/// Runs the command; the exit status is 0 or, for a fit that may not be relied upon, 4.
///
/// # Errors
/// As [`fit()`], and whatever reading or writing reports. Nothing is written unless the fit succeeded.
pub fn run(arguments: &Fit) -> Result<u8> {
    if let Some(rate) = arguments.rate.filter(|rate| !(rate.is_finite() && *rate > 0.0)) {
        let message = "`--rate` has to be a finite number above zero";
        return Err(Error::new(&codes::USAGE, message).with_value(rate.to_string()));
    }
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let read = arguments.recordings.iter().chain(&arguments.tests).chain(&arguments.joint).map(PathBuf::as_path);
    let actuator = (joint.actuator.kind != Kind::Torque).then(|| actuator_file(&arguments.output));
    let written = [Some(&arguments.output), actuator.as_ref(), arguments.json.as_ref(), arguments.report.as_ref()];
    refuse_unwritable(written.into_iter().flatten(), &read.collect::<Vec<_>>())?;
    if arguments.dry_run {
        let recordings: Vec<Source<'_>> =
            arguments.recordings.iter().chain(&arguments.tests).map(Source::from).collect();
        return print(&rehearse(&recordings, &joint, &written.into_iter().flatten().collect::<Vec<_>>())?).map(|()| 0);
    }
    let options = Options {
        seed: arguments.seed,
        inputs: arguments.inputs.clone(),
        representation: arguments.representation.map(|form| match form {
            Form::Table => Representation::Table,
            Form::Expression => Representation::Expression,
        }),
        form: arguments.form,
        rate_hz: arguments.rate,
        budget: Budget {
            bytes: arguments.max_bytes,
            instructions: arguments.max_instructions,
            target: arguments.target.unwrap_or_default(),
        },
        integers: arguments.target.is_some_and(|target| !target.has_floats),
        training: arguments.training.training()?,
        memory_mb: arguments.memory,
    };
    let reporter = Reporter::new(arguments.quiet);
    let [recordings, tests] =
        [&arguments.recordings, &arguments.tests].map(|paths| paths.iter().map(Source::from).collect::<Vec<_>>());
    let fitted = in_pool(arguments.threads, || {
        fit(&recordings, &tests, &joint, &options, &|progress| reporter.say(&line(progress)))
    })??;
    drop(reporter);
    let withheld = fitted.is_withheld() && !arguments.force;
    write(arguments, &fitted, withheld)?;
    let Some(doubt) = fitted.doubt() else { return Ok(0) };
    // That there is no image is no message but the result.
    if withheld || !arguments.quiet {
        say(&doubt.to_string());
    }
    Ok(doubt.exit_status())
}

/// Does the work on so many threads; on all where no number is given.
///
/// # Errors
/// `FRK-I001` where the threads cannot be started.
pub(super) fn in_pool<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> Result<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).build();
    let pool = pool.map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))?;
    Ok(pool.install(work))
}

/// What a fit is doing, as a line of progress.
pub(super) fn line(progress: &Progress) -> String {
    let stage = progress.stage.name();
    match progress.rmse {
        Some(rmse) => format!("{stage}: step {}, rmse {rmse:.4}", progress.steps),
        None => stage.to_owned(),
    }
}

fn write(arguments: &Fit, fitted: &Fitted, withheld: bool) -> Result<()> {
    let mut outputs = Outputs::default();
    if !withheld {
        outputs.add(&arguments.output, fitted.outcome.image.clone());
        if let Some(table) = fitted.actuator_toml() {
            outputs.add(&actuator_file(&arguments.output), table);
        }
    }
    if let Some(path) = &arguments.json {
        outputs.add_json(path, fitted.json());
    }
    if let Some(path) = &arguments.report {
        outputs.add(path, fitted.report(&command_line()));
    }
    outputs.write()?;
    // With JSON on standard output the text would get in its way.
    if arguments.json.as_deref() == Some(Path::new("-")) {
        return Ok(());
    }
    print(&fitted.text((!withheld).then_some(arguments.output.as_path())))
}
