//! What is asked for of a simulator's file.

use super::actuator::SimulatedActuator;
use super::model_file::ModelFile;

/// A simulator of the MuJoCo family, for MJCF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Release {
    /// Any MuJoCo 3.
    Mujoco3,
    /// MuJoCo 4.0.
    Mujoco4,
    /// MJX, MuJoCo in JAX.
    Mjx,
    /// Newton.
    Newton,
}

/// What is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Request<'a> {
    /// What the image is, in half a line.
    pub title: &'a str,
    /// File to patch, if any.
    pub into: Option<ModelFile<'a>>,
    /// N m (or N) at the joint for each ampere, for a law of the current.
    pub torque_per_ampere: Option<f64>,
    /// Name of the joint in the simulator, where it is not that in the image.
    pub joint: Option<&'a str>,
    /// Which simulator MJCF is written for; MuJoCo 4.0 where nothing is said.
    pub release: Option<Release>,
    /// The actuator of the joint, for MJCF and Isaac Lab.
    pub actuator: Option<SimulatedActuator>,
}
