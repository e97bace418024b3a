//! The trainer as a module of Python, `frikan._frikan`: what the package `frikan` is written on. Calls the functions that the command
//! line calls, so that results are the same to the byte.

mod failure;
mod image;
mod source;
mod work;

use frikan_trainer::compile::profile::Profile;
use frikan_trainer::fit::outcome::Representation;
use frikan_trainer::fit::{Budget, Options, model};
use frikan_trainer::plant;
use frikan_trainer::workflow::diagnose::{Against, BaseKind, Diagnosed, Request};
use frikan_trainer::workflow::fit::Fitted;
use frikan_trainer::workflow::{Source, Warning, predict as predicting};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use failure::raise;
use image::Image;
use source::{Recording, joint};
use work::{Progress, watched};

/// A fit.
#[pyclass(frozen, name = "Fitted")]
struct FittedObject(Fitted);

#[pymethods]
impl FittedObject {
    /// The result as JSON, schema `frikan.fit/1`.
    fn json(&self) -> String {
        self.0.json().to_string()
    }

    /// The result as one HTML page.
    fn report(&self, command: &str) -> String {
        self.0.report(command)
    }

    /// The result as `trainer fit` prints it.
    fn text(&self, image: &str) -> String {
        self.0.text(Some(image.as_ref()))
    }

    /// The image, as it is written to a file.
    fn image<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.outcome.image)
    }

    /// Code and sentence of why the fit may not be relied upon, where it may not.
    fn doubt(&self) -> Option<(&'static str, String)> {
        self.0.doubt().map(|doubt| (doubt.code().id, doubt.message().to_owned()))
    }

    /// The friction law over velocity, and the band in which the friction lies with 95 %.
    fn curves(&self) -> (Vec<[f64; 2]>, Vec<[f64; 3]>) {
        (self.0.outcome.law_curve.clone(), self.0.outcome.band.clone())
    }
}

/// A diagnosis.
#[pyclass(frozen, name = "Diagnosed")]
struct DiagnosedObject(Diagnosed);

#[pymethods]
impl DiagnosedObject {
    /// The result as JSON, schema `frikan.diagnose/1`.
    fn json(&self) -> String {
        self.0.json().to_string()
    }

    /// The result as one HTML page.
    fn report(&self, compared_with: &str, command: &str) -> String {
        self.0.report(compared_with, &[], command)
    }

    /// The result as `trainer diagnose` prints it.
    fn text(&self) -> String {
        self.0.text()
    }

    /// The improved image, where there is one.
    fn image<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        self.0.image().map(|image| PyBytes::new(py, image))
    }

    /// The motion that would tell apart what cannot be told, as CSV.
    fn trajectory(&self) -> Option<String> {
        self.0.trajectory()
    }
}

/// Fits recordings; `progress` is called with a stage, steps and an error.
#[pyfunction]
#[pyo3(signature = (recordings, tests, joint_file, inputs, representation, rate, max_bytes, max_instructions, target, seed, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python package names them all")]
fn fit(
    py: Python<'_>,
    recordings: Vec<Recording>,
    tests: Vec<Recording>,
    joint_file: Option<(bool, String)>,
    inputs: Option<Vec<String>>,
    representation: Option<&str>,
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
    let budget = Budget { bytes: max_bytes, instructions: max_instructions, target: profile(target)? };
    let options = Options { seed, inputs, representation, rate_hz: rate, budget, ..Options::default() };
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

fn profile(name: Option<&str>) -> PyResult<Profile> {
    name.map_or(Ok(Profile::default()), |name| Profile::named(name).ok_or_else(|| unknown("target", name)))
}

fn unknown(what: &str, name: &str) -> PyErr {
    PyValueError::new_err(format!("there is no {what} of the name {name:?}"))
}

/// What the package `frikan` is written on.
#[pymodule]
fn _frikan(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("Error", module.py().get_type::<failure::FrikanError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<FittedObject>()?;
    module.add_class::<DiagnosedObject>()?;
    module.add_class::<Image>()?;
    module.add_function(wrap_pyfunction!(fit, module)?)?;
    module.add_function(wrap_pyfunction!(diagnose, module)?)?;
    module.add_function(wrap_pyfunction!(predict, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)
}
