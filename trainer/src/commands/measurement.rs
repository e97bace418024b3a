//! Recordings, joint files and drives as a command line names them.

use std::path::Path;

use super::output::say;
use crate::compile::profile::{PROFILES, Profile};
use crate::did_you_mean::hint;
use crate::error::{Result, codes};
use crate::joint::Joint;

pub(super) use crate::workflow::recordings::{Source, motion};

/// What is known of the joint, from its file where one is given; what nothing reads of that file is told on standard error.
///
/// # Errors
/// As [`Joint::load`].
pub(super) fn joint(path: Option<&Path>, quiet: bool) -> Result<Joint> {
    let Some(path) = path else { return Ok(Joint::default()) };
    let joint = Joint::load(path)?;
    if !quiet {
        joint.unknown_keys().iter().for_each(|sentence| say(&format!("{} {sentence}", codes::UNKNOWN_KEY.id)));
    }
    Ok(joint)
}

/// A documented drive by its name.
pub(super) fn profile(name: &str) -> std::result::Result<Profile, String> {
    let names = PROFILES.map(|profile| profile.name);
    Profile::named(name)
        .ok_or_else(|| format!("there is no drive of this name{}; there are {}", hint(name, names), names.join(", ")))
}
