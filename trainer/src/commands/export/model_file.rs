//! The options of an export to a simulator: the user's model file, its joint, and the constants of a current.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use frikan_shared::image::Image;

use crate::commands::measurement::with_identified;
use crate::error::{Error, Result, codes};
use crate::export::simulator::{self, ModelFile, Release, Request, SimulatedActuator, Simulator, write};
use crate::files;
use crate::fit::CELLS;
use crate::joint::Joint;

/// Largest model file that is read, in bytes.
const SIZE_LIMIT_BYTES: u64 = 64 << 20;

/// A simulator's model file and what is known beside it.
#[derive(Args, Clone, Debug)]
pub struct ModelFileArguments {
    /// Model file of a simulator, for `mujoco`, `mjcf-patch`, `urdf`, `sdf`, `usd`: written with the joint as identified, all else as it is
    #[arg(long, value_name = "MODEL_FILE")]
    pub into: Option<PathBuf>,
    /// Joint of the model file, which may be left out where the file has just one, or the name that the joint has in the simulator, for `isaac` and
    /// `drake`
    #[arg(long, value_name = "NAME")]
    pub joint_name: Option<String>,
    /// Inertia of the model file's bodies about the joint without its armature, kg m2 (kg); for MJCF read from the file where it says it
    #[arg(long, value_name = "VALUE", requires = "into", value_parser = inertia)]
    pub inertia_of_model: Option<f64>,
    /// Which simulator MJCF is written for: only what it reads [default: mujoco4]
    #[arg(long, value_enum, value_name = "NAME")]
    pub simulator: Option<ForSimulator>,
    /// Stiffness and damping of the controller that moves the joint, N m/rad and N m s/rad (N/m, N s/m), as `KP,KV`, with which forms of MuJoCo are
    /// tried; where nothing is said, a `position` actuator of the file, or a soft and a stiff controller
    #[arg(long, value_name = "KP,KV", requires = "into", value_parser = gains)]
    pub gains: Option<[f64; 2]>,
    /// joint.toml: the counts of `[drive]`, for `c` of an integer table; torque constant and gear ratio, for a law of the current; `[actuator]`, of which simulators of the MuJoCo family and Isaac Lab
    /// get gains and limit, with what `fit` identified of it beside the image
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
}

/// A simulator of the MuJoCo family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ForSimulator {
    /// Any MuJoCo 3
    Mujoco3,
    /// MuJoCo 4.0
    Mujoco4,
    /// MJX
    Mjx,
    /// Newton
    Newton,
}

impl ModelFileArguments {
    /// The image as text for a simulator.
    ///
    /// # Errors
    /// As [`write`], and `FRK-I...` or `FRK-D004` where the file cannot be read.
    pub(super) fn write(
        &self,
        (model, image): (&Path, &Image<CELLS>),
        simulator: Simulator,
        title: &str,
    ) -> Result<String> {
        let joint = self.joint.as_deref().map(Joint::load).transpose()?;
        let joint = joint.map(|joint| with_identified(joint, model)).transpose()?;
        let path = self.into.as_ref().map(|path| path.display().to_string());
        let text = match &self.into {
            // A stage may be binary; the layer only refers to it.
            Some(path) if simulator == Simulator::Usd => match files::read_text(path, SIZE_LIMIT_BYTES) {
                Err(error) if error.code() == &codes::NOT_UTF8 => String::new(),
                text => text?,
            },
            Some(path) => files::read_text(path, SIZE_LIMIT_BYTES)?,
            None => String::new(),
        };
        let in_file = |error: Error| match &path {
            Some(path) if error.code() == &codes::BAD_MODEL_FILE => error.in_file(path),
            _ => error,
        };
        let only = match (&self.joint_name, &self.into) {
            (None, Some(_)) => Some(only_joint(simulator, &text).map_err(in_file)?),
            _ => None,
        };
        let into = path.as_deref().zip(self.joint_name.as_deref().or(only.as_deref())).map(|(path, joint)| ModelFile {
            text: &text,
            path,
            joint,
            inertia_of_model: self.inertia_of_model,
            gains: self.gains,
        });
        let takes_actuator =
            matches!(simulator, Simulator::Mujoco | Simulator::MjcfPatch | Simulator::Isaac | Simulator::Bam);
        let with_actuator = joint.as_ref().filter(|_| takes_actuator);
        let actuator = with_actuator.map(SimulatedActuator::of).transpose()?.flatten();
        let torque_per_ampere = joint.and_then(|joint| joint.drive.joint_torque_per_ampere());
        let release = self.simulator.map(|simulator| match simulator {
            ForSimulator::Mujoco3 => Release::Mujoco3,
            ForSimulator::Mujoco4 => Release::Mujoco4,
            ForSimulator::Mjx => Release::Mjx,
            ForSimulator::Newton => Release::Newton,
        });
        let name = self.joint_name.as_deref().filter(|_| into.is_none());
        let request = Request { title, into, torque_per_ampere, joint: name, release, actuator };
        write(image, simulator, &request).map_err(in_file)
    }

    /// Files that are read.
    pub(super) fn inputs(&self) -> impl Iterator<Item = &Path> {
        [&self.into, &self.joint].into_iter().flatten().map(PathBuf::as_path)
    }
}

/// The joint of a model file that has one only, empty for a form that goes into no file. The prims of a stage do not tell which of them is meant.
fn only_joint(simulator: Simulator, text: &str) -> Result<String> {
    match simulator {
        Simulator::Usd => {
            Err(Error::new(&codes::USAGE, "`--joint-name` has to be the path of the joint's prim in the stage"))
        }
        Simulator::Isaac | Simulator::Drake | Simulator::Bam => Ok(String::new()),
        Simulator::Mujoco | Simulator::MjcfPatch | Simulator::Urdf | Simulator::Sdf => simulator::only_joint(text),
    }
}

fn inertia(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("a finite number, at least 0, is expected".to_owned()),
    }
}

fn gains(text: &str) -> std::result::Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|word| word.trim().parse().ok()).collect();
    match numbers[..] {
        [kp, kv] if kp > 0.0 && kv >= 0.0 && kp.is_finite() && kv.is_finite() => Ok([kp, kv]),
        _ => {
            Err("two numbers are expected, such as 200,15: a stiffness above 0 and a damping of at least 0".to_owned())
        }
    }
}
