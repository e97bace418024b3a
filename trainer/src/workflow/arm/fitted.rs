//! An arm before and after it is fitted.

use crate::arm::fit::{JointOutcome, Outcome};
use crate::error::Error;
use crate::fit::outcome::{Outcome as JointLaw, Trace};
use crate::joint::ArmFile;
use crate::workflow::fit::doubt;
use crate::workflow::recordings::Warning;
use crate::workflow::source::Source;

/// What is known of an arm, and its recordings.
#[derive(Clone, Copy, Debug)]
pub struct Recorded<'a> {
    /// Recordings of all joints to learn from.
    pub recordings: &'a [Source<'a>],
    /// Recordings that are only scored.
    pub tests: &'a [Source<'a>],
    /// Text of the URDF or MJCF file.
    pub robot: &'a str,
    /// What else is known.
    pub file: &'a ArmFile,
}

/// An arm with what was noticed of its recordings.
#[derive(Clone, Debug)]
pub struct FittedArm {
    /// Bodies, friction and laws.
    pub outcome: Outcome,
    /// What the checks of the recordings put right or noticed.
    pub warnings: Vec<Warning>,
    /// Time that reading and fitting took, s.
    pub seconds: f64,
    /// One seed, one arm.
    pub seed: u64,
}

/// The name of a joint as that of a file, without an ending.
#[must_use]
pub fn file_name(joint: &str) -> String {
    joint.chars().map(|c| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' }).collect()
}

/// Why the law of a joint may not be relied upon, where it may not or there is none.
#[must_use]
pub fn joint_doubt(joint: &JointOutcome) -> Option<Error> {
    match &joint.law {
        Ok(law) => doubt(&law.sound),
        Err(error) => Some(error.clone()),
    }
}

/// Share of the rows of a recording in which the joint is faster than any from which its law was learnt: there the law stands still.
#[must_use]
pub(super) fn beyond_trained(law: &JointLaw, trace: &Trace) -> f64 {
    let Some(range) = law.inputs.iter().find(|input| input.name == "velocity") else { return 0.0 };
    let beyond = trace.velocity.iter().filter(|velocity| !(range.low..=range.high).contains(*velocity)).count();
    beyond as f64 / trace.velocity.len().max(1) as f64
}
