//! From recordings of a whole arm to a law for each joint, that tell themselves.

mod advise;
mod clearance;
mod fitted;
mod json;
mod recordings;
mod text;

use std::time::Instant;

use nalgebra::Vector3;
use serde_json::Value;

use super::recordings::{Warning, motion_of};
use super::source::Source;
use crate::arm::chain::Chain;
use crate::arm::fit::{Arm, ArmProgress, JointOutcome};
use crate::arm::motion::Run;
use crate::error::Result;
use crate::export::simulator::{ModelFile, Request, Simulator, write};
use crate::fit::Options;
use crate::fit::model::from_bytes;
use crate::joint::{ArmFile, Joint};
use crate::robot::{Robot, is_mjcf, parse};
pub use advise::{Advised, advise};
pub use fitted::{FittedArm, Recorded, file_name, joint_doubt};

/// Fits an arm.
///
/// # Errors
/// As [`crate::arm::fit::fit`], [`Chain::parse`] and [`crate::joint::ArmFile::joints`], and whatever reading a recording reports.
pub fn arm(of: &Recorded<'_>, options: &Options, progress: ArmProgress<'_>) -> Result<FittedArm> {
    let start = Instant::now();
    let (chain, joints) = described(&parse(of.robot)?, of.file)?;
    let mut warnings = Vec::new();
    let mut load = |sources: &[Source<'_>]| {
        sources.iter().map(|source| run(*source, &joints, &mut warnings)).collect::<Result<Vec<_>>>()
    };
    let (runs, tests) = (load(of.recordings)?, load(of.tests)?);
    let outcome = crate::arm::fit::fit(&Arm { chain, joints, runs, tests }, options, progress)?;
    Ok(FittedArm { outcome, warnings, seconds: start.elapsed().as_secs_f64(), seed: options.seed })
}

/// The chain of a robot, under the gravity of arm.toml where that gives one, and what arm.toml says of its joints.
fn described(robot: &Robot, file: &ArmFile) -> Result<(Chain, Vec<Joint>)> {
    let mut chain = Chain::of(robot, &file.held)?;
    if let Some(gravity) = file.gravity_m_s2 {
        chain.gravity = Vector3::from(gravity);
    }
    let names: Vec<String> = chain.joints.iter().map(|joint| joint.name.clone()).collect();
    let joints = file.joints(&names)?;
    Ok((chain, joints))
}

/// The joints of one recording, as their motion is safe to use.
fn run(source: Source<'_>, joints: &[Joint], warnings: &mut Vec<Warning>) -> Result<Run> {
    let recordings = source.read_joints(joints)?;
    let label = recordings.first().map_or_else(String::new, |recording| recording.label.clone());
    let mut reviewed = Vec::with_capacity(recordings.len());
    for (recording, joint) in recordings.into_iter().zip(joints) {
        let name = format!("{label}, joint {}", joint.name.as_deref().unwrap_or_default());
        let (recording, noticed) = motion_of(&name, recording, joint)?;
        warnings.extend(noticed);
        reviewed.push(recording);
    }
    Run::of(&label, reviewed)
}

impl FittedArm {
    /// Name of a file and content of the image of each joint whose law may be relied upon, or of all where `force` says so.
    #[must_use]
    pub fn images(&self, force: bool) -> Vec<Option<(String, &[u8])>> {
        fn image(joint: &JointOutcome, force: bool) -> Option<(String, &[u8])> {
            let law = joint.law.as_ref().ok().filter(|_| force || joint_doubt(joint).is_none())?;
            Some((format!("{}.frk", file_name(&joint.name)), law.image.as_slice()))
        }
        self.outcome.joints.iter().map(|joint| image(joint, force)).collect()
    }

    /// The result as JSON, schema `frikan.arm/1`; `images` holds the name of the image of each joint, where one is written.
    #[must_use]
    pub fn json(&self, images: &[Option<String>]) -> Value {
        json::summary(self, images)
    }

    /// The result for a terminal.
    #[must_use]
    pub fn text(&self, images: &[Option<String>]) -> String {
        text::summary(self, images)
    }

    /// The URDF or MJCF file with Coulomb and viscous friction of the joints whose laws may be relied upon, or of all where `force` says so.
    ///
    /// # Errors
    /// As [`write()`].
    pub fn patched(&self, robot: &str, force: bool) -> Result<String> {
        let mut text = robot.to_owned();
        let simulator = if is_mjcf(robot) { Simulator::MjcfPatch } else { Simulator::Urdf };
        for joint in &self.outcome.joints {
            let Ok(law) = &joint.law else { continue };
            if joint_doubt(joint).is_some() && !force {
                continue;
            }
            let image = from_bytes(&law.image)?;
            let into = ModelFile { text: &text, joint: &joint.name, ..ModelFile::default() };
            let torque_per_ampere = joint.torque_constant.map(|constant| constant.value);
            let request = Request { title: &joint.name, into: Some(into), torque_per_ampere, ..Request::default() };
            text = write(&image, simulator, &request)?;
        }
        Ok(text)
    }

    /// Recordings of each joint with the torque of the bodies beside its own, and a `joint.toml` that reads them: name of a file and content.
    #[must_use]
    pub fn recordings(&self) -> Vec<(String, String)> {
        self.outcome.joints.iter().flat_map(recordings::of_joint).collect()
    }
}
