//! The distance of a sample by the measured position.

use super::{Memory, STARTED};
use crate::usable::Usable;

/// The distance since the sample before, rad, by the position as measured. The memory is the position before, rad, and whether there was one;
/// the first sample has no distance.
#[must_use]
#[inline(always)]
pub fn step([before, started, ..]: &mut Memory, position: f32, usable: Usable) -> f32 {
    let distance = position - if *started == STARTED { *before } else { position };
    *before = usable.or(position, *before);
    *started = usable.or(STARTED, *started);
    distance
}
