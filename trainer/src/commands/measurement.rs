//! Recordings, joint files and drives as a command line names them.

use std::path::{Path, PathBuf};

use frikan_runtime::integer::{IntegerTableInPlace, Units};

use super::output::say;
use crate::actuator::Kind;
use crate::compile::integers::steps::units;
use crate::compile::profile::{PROFILES, Profile};
use crate::did_you_mean::hint;
use crate::error::{Error, Result, codes};
use crate::fit::HostModel;
use crate::joint::{Drive, Joint};

pub(super) use crate::workflow::recordings::motion;
use crate::workflow::recordings::{folded_warnings, load_all, load_with_faults};
use crate::workflow::source::Reading;
pub(super) use crate::workflow::source::Source;

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

/// What a command would read and write, in place of its work: recordings are read and checked, nothing is written.
///
/// # Errors
/// Whatever reading a recording reports.
pub(super) fn rehearse(recordings: &[Source<'_>], joint: &Joint, written: &[&PathBuf]) -> Result<String> {
    let (recordings, warnings) = load_all(recordings.iter().copied(), |source| {
        load_with_faults(source, joint, Reading::of(&[], None, recordings.len()))
    })?;
    let mut lines: Vec<String> = recordings
        .iter()
        .map(|recording| format!("would read   {}, {} rows", recording.label, recording.len()))
        .collect();
    lines.extend(folded_warnings(&warnings).iter().map(|warning| format!("             {warning}")));
    lines.extend(written.iter().map(|path| format!("would write  {}", path.display())));
    Ok(lines.join("\n") + "\n")
}

/// The integer table of an image in the counts of a drive; none where its law is another.
///
/// # Errors
/// `FRK-U001` where the image is for other counts than those of the joint file.
pub(super) fn table_in_counts<'a>(
    image: &'a [u8],
    model: &HostModel,
    drive: &Drive,
) -> Result<Option<(Units, IntegerTableInPlace<'a>)>> {
    let Some(units) = units(model, [drive.velocity_count_rad_s, drive.torque_count_nm]) else { return Ok(None) };
    let table = IntegerTableInPlace::new(image, units).map_err(|error| {
        let message = format!("the table of integers is not for these counts: {error}");
        Error::new(&codes::USAGE, message).with_value(format!("{:?} and {:?}", units.velocity, units.torque))
    })?;
    Ok(Some((units, table)))
}

/// The file in which `fit` writes what it identified of the actuator, beside its image.
pub(super) fn actuator_file(image: &Path) -> PathBuf {
    image.with_extension("actuator.toml")
}

/// The joint with the constants of the actuator that `fit` identified with an image, as far as its own file leaves them open.
///
/// # Errors
/// As [`Joint::load`].
pub(super) fn with_identified(mut joint: Joint, image: &Path) -> Result<Joint> {
    let path = actuator_file(image);
    if joint.actuator.kind == Kind::Torque || !path.exists() {
        return Ok(joint);
    }
    let identified = Joint::load(&path)?.actuator.constants;
    let own = &mut joint.actuator.constants;
    for (constant, known) in identified {
        if own.get(&constant).and_then(|known| known.given()).is_none() {
            own.insert(constant, known);
        }
    }
    Ok(joint)
}

/// A documented drive by its name.
pub(super) fn profile(name: &str) -> std::result::Result<Profile, String> {
    let names = PROFILES.map(|profile| profile.name);
    Profile::named(name)
        .ok_or_else(|| format!("there is no drive of this name{}; there are {}", hint(name, names), names.join(", ")))
}
