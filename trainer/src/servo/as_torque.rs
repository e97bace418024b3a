//! Recordings of commands as a law is looked for in them: under the torque of the actuator, and of the joint what is its own.

use super::identified::Identified;
use super::known_torque::{Load, known_torque, reference_inertia};
use crate::error::Result;
use crate::joint::{Joint, RigidBody};
use crate::recording::Recording;

/// The joint without payload, and how recordings of its commands become ones of a torque.
pub(crate) struct AsTorque<'a> {
    joint: &'a Joint,
    identified: &'a Identified,
    /// Inertia of a payload that stays in the recordings, kg m2.
    pub(super) reference: f64,
    /// The joint that the torque moves.
    pub(crate) bare: Joint,
}

impl<'a> AsTorque<'a> {
    /// What `recordings` are to be fitted as.
    pub(crate) fn of(recordings: &[Recording], joint: &'a Joint, identified: &'a Identified) -> Self {
        // A given inertia is that of the joint itself, so that all of the payload's is taken off beforehand.
        let is_given = joint.rigid_body.inertia_kgm2.is_some();
        let reference = if is_given { 0.0 } else { reference_inertia(recordings, joint) };
        let mut bare = joint.clone();
        if !identified.has_own_gravity {
            bare.rigid_body = RigidBody { gravity_torque_nm: Some(0.0), ..bare.rigid_body };
        }
        Self { joint, identified, reference, bare }
    }

    /// The recordings under the torque of the actuator.
    ///
    /// # Errors
    /// As [`known_torque`].
    pub(crate) fn known(&self, recordings: &[Recording]) -> Result<Vec<Recording>> {
        let known = |recording| known_torque(recording, self.joint, self.identified, self.reference, Load::None);
        recordings.iter().map(known).collect()
    }
}
