//! An image in the forms in which robot simulators know a joint: friction, inertia, and the torque error that each form adds.
//!
//! A user's own model file is patched as text: what is not told to the simulator stays as it is, byte for byte.

mod body;
mod content;
mod edits;
mod form;
mod law;
mod mjcf;
mod model_file;
mod python;
mod sdf;
#[cfg(test)]
mod tests;
mod urdf;
mod usd;

use frikan_shared::image::Image;

use self::content::Content;
use self::mjcf::Elements;
pub use self::model_file::ModelFile;
use crate::error::{Error, Result, codes};
use crate::fit::CELLS;

/// A simulator's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulator {
    /// MJCF with a passive motor where it helps (MuJoCo 4.0).
    Mujoco,
    /// MJCF with attributes of the joint only (any MuJoCo).
    MjcfPatch,
    /// URDF `dynamics`.
    Urdf,
    /// SDFormat `dynamics`.
    Sdf,
    /// A USD layer over a joint, with the attributes of PhysX.
    Usd,
    /// Isaac Lab, as Python.
    Isaac,
    /// Drake, as Python.
    Drake,
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// What the image is, in half a line.
    pub title: &'a str,
    /// File to patch, if any.
    pub into: Option<ModelFile<'a>>,
    /// N m (or N) at the joint for each ampere, for a law of the current.
    pub torque_per_ampere: Option<f64>,
}

/// The image as text for a simulator.
///
/// # Errors
/// `FRK-U001` for a law that does not depend on the velocity or is of a current without its constants, and for a file where the
/// format takes none; `FRK-D030` with its row where the file lacks the joint or cannot be read.
pub fn write(image: &Image<CELLS>, simulator: Simulator, request: &Request) -> Result<String> {
    let content = Content::of(image, request.title, request.torque_per_ampere)?;
    match (simulator, &request.into) {
        (Simulator::Mujoco, Some(file)) => mjcf::patched(&content, file, Elements::PassiveMotor),
        (Simulator::MjcfPatch, Some(file)) => mjcf::patched(&content, file, Elements::Joint),
        (Simulator::Mujoco | Simulator::MjcfPatch, None) => Ok(mjcf::default_class(&content)),
        (Simulator::Urdf, Some(file)) => urdf::patched(&content, file),
        (Simulator::Urdf, None) => Ok(urdf::joint(&content)),
        (Simulator::Sdf, Some(file)) => sdf::patched(&content, file),
        (Simulator::Sdf, None) => Ok(sdf::joint(&content)),
        (Simulator::Usd, file) => Ok(usd::layer(&content, file.as_ref())),
        (Simulator::Isaac, None) => Ok(python::isaac(&content)),
        (Simulator::Drake, None) => Ok(python::drake(&content)),
        (Simulator::Isaac | Simulator::Drake, Some(_)) => {
            Err(Error::new(&codes::USAGE, "this form is Python code, which goes into no model file"))
        }
    }
}
