//! The motion that a run follows, by its name or from a file.

use std::path::Path;

use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::plant::MOST_SAMPLES;
use crate::recording::{self, Quantity};
use crate::rig::{Course, Motion};
use crate::samples::interpolate;

/// The course called `motion`: one of the set, or the reference of a recording at `rate` samples a second.
pub(super) fn course(motion: &str, rate: f64) -> Result<Course> {
    if let Some(known) = Motion::ALL.into_iter().find(|known| known.name() == motion) {
        return Ok(Course::Standard(known));
    }
    let path = Path::new(motion);
    if !path.exists() {
        let names = Motion::ALL.map(Motion::name).join(", ");
        let message = format!("there is no motion or file of this name; there are {names}");
        return Err(Error::new(&codes::USAGE, message).with_value(motion));
    }
    let recording = recording::load(path, &Joint::default())?;
    let quantity = [Quantity::ReferencePosition, Quantity::Position]
        .into_iter()
        .find(|quantity| recording.values(*quantity).is_some())
        .unwrap_or(Quantity::ReferencePosition);
    recording.require(&[quantity], "a motion to follow")?;
    let time = recording.require(&[Quantity::Time], "a motion to follow")?.values.clone();
    let positions = recording.values(quantity).unwrap_or_default();
    let (Some(start), Some(end)) = (time.first(), time.last()) else {
        return Err(Error::new(&codes::USAGE, "there are no rows to follow").in_file(motion));
    };
    let samples = ((end - start) * rate).floor();
    if samples > MOST_SAMPLES {
        let message = format!("a run has at most {MOST_SAMPLES} samples");
        return Err(Error::new(&codes::USAGE, message).in_file(motion).with_value(samples.to_string()));
    }
    let times: Vec<f64> = (0..=samples as usize).map(|index| start + index as f64 / rate).collect();
    Ok(Course::through(&interpolate(&time, positions, &times), rate))
}
