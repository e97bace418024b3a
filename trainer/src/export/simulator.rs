//! An image in the forms in which robot simulators know a joint: friction, inertia, and the torque error that each form adds.
//!
//! A user's own model file is patched as text: what is not told to the simulator stays as it is, byte for byte.

mod actuator;
mod bam;
mod body;
mod content;
mod edits;
mod form;
mod law;
mod mjcf;
mod model_file;
mod python;
mod request;
mod sdf;
#[cfg(test)]
mod tests;
mod trial;
mod urdf;
mod usd;

use frikan_shared::image::Image;

pub use self::actuator::SimulatedActuator;
use self::content::Content;
use self::mjcf::Reads;
pub use self::model_file::{ModelFile, only_joint};
pub use self::request::{Release, Request};
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
    /// Rhoban's BAM, as JSON.
    Bam,
}

/// The image as text for a simulator.
///
/// # Errors
/// `FRK-U001` for a law that does not depend on the velocity or is of a current without its constants, and for a file, a simulator or
/// an empty name where the format takes none; `FRK-D030` with its row where the file lacks the joint, has one that is no axis or bodies
/// that are too heavy, or cannot be read.
pub fn write(image: &Image<CELLS>, simulator: Simulator, request: &Request) -> Result<String> {
    let content = Content::of(image, request)?;
    let is_mjcf = matches!(simulator, Simulator::Mujoco | Simulator::MjcfPatch);
    if request.release.is_some() && !is_mjcf {
        return Err(Error::new(&codes::USAGE, "`--simulator` is for `mujoco` and `mjcf-patch`"));
    }
    let release = request.release.unwrap_or(Release::Mujoco4);
    match (simulator, &request.into) {
        (Simulator::Mujoco, Some(file)) => mjcf::patched(&content, file, reads(release), told(release)),
        (Simulator::MjcfPatch, Some(file)) => {
            mjcf::patched(&content, file, Reads { passive_motors: false, ..reads(release) }, told(release))
        }
        (Simulator::Mujoco | Simulator::MjcfPatch, None) => Ok(mjcf::default_class(&content)),
        (Simulator::Urdf, Some(file)) => urdf::patched(&content, file),
        (Simulator::Urdf, None) => Ok(urdf::joint(&content)),
        (Simulator::Sdf, Some(file)) => sdf::patched(&content, file),
        (Simulator::Sdf, None) => Ok(sdf::joint(&content)),
        (Simulator::Usd, file) => usd::layer(&content, file.as_ref()),
        (Simulator::Isaac, None) => python::isaac(&content),
        (Simulator::Drake, None) => python::drake(&content),
        (Simulator::Bam, None) => bam::parameters(image, request),
        (Simulator::Isaac | Simulator::Drake | Simulator::Bam, Some(_)) => {
            Err(Error::new(&codes::USAGE, "this form is a file of its own and goes into no model file"))
        }
    }
}

/// What a simulator of the MuJoCo family reads.
fn reads(release: Release) -> Reads {
    let is_mujoco_4 = release == Release::Mujoco4;
    Reads { powers: is_mujoco_4, passive_motors: is_mujoco_4 }
}

/// What a file that is written for it says of that.
fn told(release: Release) -> &'static str {
    match release {
        Release::Mujoco4 => "",
        Release::Mujoco3 => " Written for MuJoCo 3: attributes that all of its versions read.",
        Release::Mjx => " Written for MJX, which has no passive motors and leaves damping beyond the first number out.",
        Release::Newton => {
            " Written for Newton with the solver of MuJoCo: its other solvers step otherwise than was simulated."
        }
    }
}
