//! What a diagnosis page is made of.

use frikan_shared::model::RigidBody;

use crate::diagnose::advice::Plan;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::physics::units::Units;
use crate::report::page::Origin;
use crate::report::tell::Story;

/// Link of all charts over the time of the recording.
pub(super) const TIME: &str = "time";

/// What goes onto the page.
#[derive(Clone, Copy, Debug)]
pub struct DiagnosisPage<'a> {
    /// Name of the recording.
    pub recording: &'a str,
    /// What it was compared with, a few words.
    pub compared_with: &'a str,
    /// The diagnosis.
    pub diagnosis: &'a Diagnosis,
    /// Its sentences.
    pub story: &'a Story,
    /// Units of the recording.
    pub units: Units,
    /// What to record next, where something cannot be told apart.
    pub plan: Option<&'a Plan>,
    /// Rigid body of the model compared with, where it is known.
    pub rigid_body: Option<RigidBody>,
    /// The command that puts a simulator right with the improved image, where one is written.
    pub put_right: Option<&'a str>,
    /// What was written into an improved image, and what not; empty where none was asked for.
    pub export: &'a [String],
    /// Command and recordings.
    pub origin: Origin<'a>,
}

/// Label of an axis over a channel, with its unit.
pub(super) fn axis_label(channel: &str, units: Units) -> String {
    format!("{} ({})", channel.replace('_', " "), units.of_channel(channel))
}
