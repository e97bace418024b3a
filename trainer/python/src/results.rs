//! What fits, diagnoses and checks bring back.

use frikan_trainer::workflow::Warning;
use frikan_trainer::workflow::arm::FittedArm;
use frikan_trainer::workflow::diagnose::{Diagnosed, Told};
use frikan_trainer::workflow::fit::Fitted;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::failure::raise;

/// A fit.
#[pyclass(frozen, name = "Fitted")]
pub struct FittedObject(pub Fitted);

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
    #[pyo3(signature = (image))]
    fn text(&self, image: Option<&str>) -> String {
        self.0.text(image.map(AsRef::as_ref))
    }

    /// The image, as it is written to a file.
    fn image<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.outcome.image)
    }

    /// Code and sentence of why the fit may not be relied upon, where it may not.
    fn doubt(&self) -> Option<(&'static str, String)> {
        self.0.doubt().map(|doubt| (doubt.code().id, doubt.message().to_owned()))
    }

    /// Raises why the fit may not be relied upon, where it may not.
    fn refuse_doubtful(&self, py: Python<'_>) -> PyResult<()> {
        self.0.doubt().map_or(Ok(()), |doubt| Err(raise(py, &doubt)))
    }

    /// The friction law over velocity, and the band in which the friction lies with 95 %.
    fn curves(&self) -> (Vec<[f64; 2]>, Vec<[f64; 3]>) {
        (self.0.outcome.law_curve.clone(), self.0.outcome.band.clone())
    }
}

/// A diagnosis.
#[pyclass(frozen, name = "Diagnosed")]
pub struct DiagnosedObject(pub Diagnosed);

#[pymethods]
impl DiagnosedObject {
    /// The result as JSON, schema `frikan.diagnose/1`.
    fn json(&self) -> String {
        self.0.json().to_string()
    }

    /// The result as one HTML page.
    fn report(&self, compared_with: &str, command: &str) -> String {
        self.0.report(compared_with, Told { command, ..Told::default() })
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

/// An arm.
#[pyclass(frozen, name = "FittedArm")]
pub struct ArmObject {
    arm: FittedArm,
    urdf: String,
}

impl ArmObject {
    /// An arm with the text of its URDF.
    pub fn new(arm: FittedArm, urdf: String) -> Self {
        Self { arm, urdf }
    }

    fn names(&self, force: bool) -> Vec<Option<String>> {
        self.arm.images(force).into_iter().map(|image| image.map(|(name, _)| name)).collect()
    }
}

#[pymethods]
impl ArmObject {
    /// The result as JSON, schema `frikan.arm/1`.
    fn json(&self) -> String {
        self.arm.json(&self.names(false)).to_string()
    }

    /// The result as `trainer arm` prints it.
    fn text(&self) -> String {
        self.arm.text(&self.names(false))
    }

    /// Name of the file and content of the image of each joint, where its law may be relied upon or `force` says so.
    fn images<'py>(&self, py: Python<'py>, force: bool) -> Vec<Option<(String, Bound<'py, PyBytes>)>> {
        let images = self.arm.images(force).into_iter();
        images.map(|image| image.map(|(name, bytes)| (name, PyBytes::new(py, bytes)))).collect()
    }

    /// The URDF with the friction of the joints.
    fn patched(&self, py: Python<'_>, force: bool) -> PyResult<String> {
        self.arm.patched(&self.urdf, force).map_err(|error| raise(py, &error))
    }

    /// What the checks of the recordings noticed.
    fn warnings(&self) -> Vec<String> {
        self.arm.warnings.iter().map(Warning::to_string).collect()
    }
}
