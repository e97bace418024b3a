//! The options of an export to a simulator: the user's model file, its joint, and the constants of a current.

use std::path::{Path, PathBuf};

use clap::Args;
use frikan_shared::image::Image;

use crate::error::{Result, codes};
use crate::export::simulator::{ModelFile, Request, Simulator, write};
use crate::files;
use crate::fit::CELLS;
use crate::joint::Joint;

/// Largest model file that is read, in bytes.
const SIZE_LIMIT_BYTES: u64 = 64 << 20;

/// A simulator's model file and what is known beside it.
#[derive(Args, Clone, Debug)]
pub struct ModelFileArguments {
    /// Model file of a simulator, for `mujoco`, `mjcf-patch`, `urdf`, `sdf`, `usd`: written with the joint as identified, all else as it is
    #[arg(long, value_name = "MODEL_FILE", requires = "joint_name")]
    pub into: Option<PathBuf>,
    /// Joint of the model file
    #[arg(long, value_name = "NAME", requires = "into")]
    pub joint_name: Option<String>,
    /// Inertia of the model file's bodies about the joint without its armature, kg m2 (kg); for MJCF read from the file where it says it
    #[arg(long, value_name = "VALUE", requires = "into", value_parser = inertia)]
    pub inertia_of_model: Option<f64>,
    /// joint.toml: torque constant and gear ratio, for a law of the current
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
}

impl ModelFileArguments {
    /// The image as text for a simulator.
    ///
    /// # Errors
    /// As [`write`], and `FRK-I...` or `FRK-D004` where the file cannot be read.
    pub(super) fn write(&self, image: &Image<CELLS>, simulator: Simulator, title: &str) -> Result<String> {
        let joint = self.joint.as_deref().map(Joint::load).transpose()?;
        let path = self.into.as_ref().map(|path| path.display().to_string());
        let text = match &self.into {
            // A stage may be binary; the layer only refers to it.
            Some(path) if simulator == Simulator::Usd => files::open(path).map(|_| String::new())?,
            Some(path) => files::read_text(path, SIZE_LIMIT_BYTES)?,
            None => String::new(),
        };
        let into = path.as_deref().zip(self.joint_name.as_deref()).map(|(path, joint)| ModelFile {
            text: &text,
            path,
            joint,
            inertia_of_model: self.inertia_of_model,
        });
        let torque_per_ampere = joint.and_then(|joint| joint.drive.joint_torque_per_ampere());
        let request = Request { title, into, torque_per_ampere };
        write(image, simulator, &request).map_err(|error| match &path {
            Some(path) if error.code() == &codes::BAD_MODEL_FILE => error.in_file(path),
            _ => error,
        })
    }

    /// Files that are read.
    pub(super) fn inputs(&self) -> impl Iterator<Item = &Path> {
        [&self.into, &self.joint].into_iter().flatten().map(PathBuf::as_path)
    }
}

fn inertia(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("a finite number, at least 0, is expected".to_owned()),
    }
}
