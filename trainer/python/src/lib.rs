//! The trainer as a module of Python, `frikan._frikan`: what the package `frikan` is written on. Calls the functions that the command
//! line calls, so that results are the same to the byte.

mod failure;
mod image;
mod results;
mod source;
mod work;

use frikan_trainer::compile::profile::Profile;
use frikan_trainer::error::Error;
use frikan_trainer::fit::outcome::Representation;
use frikan_trainer::fit::{Budget, Options, model};
use frikan_trainer::law::KnownForm;
use frikan_trainer::plant;
use frikan_trainer::recording::silence_readers_panics;
use frikan_trainer::workflow::arm::{self as fitting_arms, Recorded};
use frikan_trainer::workflow::diagnose::{Against, BaseKind, Request};
use frikan_trainer::workflow::{Source, Warning, check as checking, predict as predicting, rollout as rolling_out};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use failure::raise;
use image::Image;
use results::{ArmObject, DiagnosedObject, FittedObject};
use source::{Recording, joint};
use work::{Progress, watched};

/// Fits recordings; `progress` is called with a stage, steps and an error.
#[pyfunction]
#[pyo3(signature = (recordings, tests, joint_file, inputs, representation, form, rate, max_bytes, max_instructions, target, seed, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python package names them all")]
fn fit(
    py: Python<'_>,
    recordings: Vec<Recording>,
    tests: Vec<Recording>,
    joint_file: Option<(bool, String)>,
    inputs: Option<Vec<String>>,
    representation: Option<&str>,
    form: Option<&str>,
    rate: Option<f64>,
    max_bytes: Option<usize>,
    max_instructions: Option<u32>,
    target: Option<&str>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<FittedObject> {
    let joint = joint(joint_file).map_err(|error| raise(py, &error))?;
    let representation = match representation {
        None => None,
        Some("table") => Some(Representation::Table),
        Some("expression") => Some(Representation::Expression),
        Some(other) => return Err(unknown("representation", other)),
    };
    let form = form.map(|name| KnownForm::named(name).ok_or_else(|| unknown("form", name))).transpose()?;
    let target = profile(target)?;
    let budget = Budget { bytes: max_bytes, instructions: max_instructions, target: target.unwrap_or_default() };
    let integers = target.is_some_and(|target| !target.has_floats);
    let options = Options { seed, inputs, representation, form, rate_hz: rate, budget, integers, ..Options::default() };
    let done = watched(py, progress, move |progress: &Progress| {
        let [recordings, tests] =
            [&recordings, &tests].map(|all| all.iter().map(Recording::source).collect::<Vec<_>>());
        let tell = |now: &frikan_trainer::fit::Progress| progress.tell(now.stage.name(), now.steps, now.rmse);
        frikan_trainer::fit(&recordings, &tests, &joint, &options, &tell)
    })?;
    Ok(FittedObject(done))
}

/// Diagnoses recordings.
#[pyfunction]
#[pyo3(signature = (recordings, simulation, model, spline, joint_file, target, least_effect, seed, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python package names them all")]
fn diagnose(
    py: Python<'_>,
    recordings: Vec<Recording>,
    simulation: Option<Recording>,
    model: Option<Vec<u8>>,
    spline: bool,
    joint_file: Option<(bool, String)>,
    target: Option<&str>,
    least_effect: Option<f64>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<DiagnosedObject> {
    let joint = joint(joint_file).map_err(|error| raise(py, &error))?;
    let image = model.map(|bytes| model::from_bytes(&bytes)).transpose().map_err(|error| raise(py, &error))?;
    let target = profile(target)?;
    let done = watched(py, progress, move |progress: &Progress| {
        let against = match (&simulation, image) {
            (Some(simulation), _) => Against::Simulation(simulation.source()),
            (None, Some(image)) => Against::Model(image),
            (None, None) if spline => Against::Itself(BaseKind::Spline),
            (None, None) => Against::Itself(BaseKind::CoulombViscous),
        };
        let recordings: Vec<Source<'_>> = recordings.iter().map(Recording::source).collect();
        let request = Request { target, least_effect, seed, ..Request::of(&recordings, against) };
        let tell = |stage: &str| progress.tell(stage, 0, None);
        frikan_trainer::diagnose(&request, &joint, &tell)
    })?;
    Ok(DiagnosedObject(done))
}

/// A recording with a model's prediction beside it, as CSV, and what was noticed of it.
#[pyfunction]
fn predict<'py>(
    py: Python<'py>,
    image: &Image,
    recording: Recording,
    joint_file: Option<(bool, String)>,
) -> PyResult<(Bound<'py, PyBytes>, Vec<String>)> {
    let joint = joint(joint_file).map_err(|error| raise(py, &error))?;
    let done = py.detach(|| predicting::predict(image.model(), recording.source(), &joint));
    let done = done.map_err(|error| raise(py, &error))?;
    Ok((PyBytes::new(py, &done.csv), done.warnings.iter().map(Warning::to_string).collect()))
}

/// What recordings are worth before anything is fitted: JSON of schema `frikan.check/1`, and text.
#[pyfunction]
fn check(py: Python<'_>, recordings: Vec<Recording>, joint_file: Option<(bool, String)>) -> PyResult<(String, String)> {
    let joint = joint(joint_file).map_err(|error| raise(py, &error))?;
    let done = py.detach(|| checking::check(&recordings.iter().map(Recording::source).collect::<Vec<_>>(), &joint));
    let done = done.map_err(|error| raise(py, &error))?;
    Ok((done.json().to_string(), done.text()))
}

/// A joint simulated with an image under the commands of a recording: CSV, JSON of schema `frikan.rollout/1`, text, what was noticed.
#[pyfunction]
fn rollout<'py>(
    py: Python<'py>,
    image: &Image,
    recording: Recording,
    joint_file: Option<(bool, String)>,
    window: Option<f64>,
) -> PyResult<(Bound<'py, PyBytes>, String, String, Vec<String>)> {
    let joint = joint(joint_file).map_err(|error| raise(py, &error))?;
    let done = py.detach(|| {
        let done = rolling_out::rollout(image.model(), recording.source(), &joint, window)?;
        Ok::<_, Error>((done.csv()?, done))
    });
    let (csv, done) = done.map_err(|error| raise(py, &error))?;
    let warnings = done.warnings.iter().map(Warning::to_string).collect();
    Ok((PyBytes::new(py, &csv), done.json().to_string(), done.text(), warnings))
}

/// Fits a whole arm; `progress` is called with the joint and stage, steps and an error.
#[pyfunction]
#[pyo3(signature = (recordings, tests, urdf, arm_file, target, seed, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python package names them all")]
fn arm(
    py: Python<'_>,
    recordings: Vec<Recording>,
    tests: Vec<Recording>,
    urdf: String,
    arm_file: Option<(bool, String)>,
    target: Option<&str>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<ArmObject> {
    let prepared = source::arm_file(arm_file).and_then(|file| Ok((file, source::text(&urdf)?)));
    let (file, urdf) = prepared.map_err(|error| raise(py, &error))?;
    let budget = Budget { target: profile(target)?.unwrap_or_default(), ..Budget::default() };
    let options = Options { seed, budget, ..Options::default() };
    let done = watched(py, progress, move |progress: &Progress| {
        let [recordings, tests] =
            [&recordings, &tests].map(|all| all.iter().map(Recording::source).collect::<Vec<_>>());
        let recorded = Recorded { recordings: &recordings, tests: &tests, robot: &urdf, file: &file };
        let tell = |joint: Option<&str>, now: &frikan_trainer::fit::Progress| {
            let stage = now.stage.name();
            progress.tell(&joint.map_or(stage.to_owned(), |joint| format!("{joint}: {stage}")), now.steps, now.rmse);
        };
        let fitted = fitting_arms::arm(&recorded, &options, &tell)?;
        Ok((fitted, urdf))
    })?;
    Ok(ArmObject::new(done.0, done.1))
}

/// A simulated recording of a joint in closed loop, as CSV.
#[pyfunction]
fn simulate(
    py: Python<'_>,
    joint_file: Option<(bool, String)>,
    effects: Vec<(String, f64)>,
    duration: Option<f64>,
    noise: Option<&str>,
    seed: u64,
    motion_seed: u64,
) -> PyResult<String> {
    let file = joint(joint_file).map_err(|error| raise(py, &error))?;
    let mut joint = plant::Joint::described_by(&file).map_err(|error| raise(py, &error))?;
    for (name, amplitude) in effects {
        if plant::find(&name).is_none() {
            return Err(unknown("effect", &name));
        }
        joint.effects.push(plant::Hidden { name, amplitude });
    }
    if let Some(noise) = noise {
        let kind = plant::NoiseKind::ALL.into_iter().find(|kind| kind.name() == noise);
        joint.noise.kind = kind.ok_or_else(|| unknown("noise", noise))?;
    }
    if let Some(duration) = duration {
        plant::refuse_length(duration, joint.drive.rate_hz)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        joint.campaign = joint.campaign.with_duration(duration);
    }
    let done = py.detach(|| plant::simulate_again(&joint, seed, motion_seed).map(|recording| recording.to_csv()));
    done.map_err(|error| raise(py, &error.into()))
}

fn profile(name: Option<&str>) -> PyResult<Option<Profile>> {
    name.map(|name| Profile::named(name).ok_or_else(|| unknown("target", name))).transpose()
}

fn unknown(what: &str, name: &str) -> PyErr {
    PyValueError::new_err(format!("there is no {what} of the name {name:?}"))
}

/// What the package `frikan` is written on.
#[pymodule]
fn _frikan(module: &Bound<'_, PyModule>) -> PyResult<()> {
    silence_readers_panics();
    module.add("Error", module.py().get_type::<failure::FrikanError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<FittedObject>()?;
    module.add_class::<DiagnosedObject>()?;
    module.add_class::<ArmObject>()?;
    module.add_class::<Image>()?;
    module.add_function(wrap_pyfunction!(fit, module)?)?;
    module.add_function(wrap_pyfunction!(diagnose, module)?)?;
    module.add_function(wrap_pyfunction!(predict, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(rollout, module)?)?;
    module.add_function(wrap_pyfunction!(arm, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)
}
