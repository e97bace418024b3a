//! Breakaway that rises with the dwell before it (Rabinowicz 1958; Dieterich 1979).

use frikan_shared::effect::Effect;
use frikan_shared::elementary::{decay, log};

use super::{Contribution, Memory, Motion};

/// Distances over which the latched torque has decayed to nothing.
const TRAVEL_LIMIT: f32 = 20.0;

/// While at rest the dwell grows and with it the torque; in motion the torque decays over the distance. The memory is the time at rest, s,
/// at most the dwell limit, the way since rest in breakaway distances, at most `TRAVEL_LIMIT`, and the torque latched at the end of the
/// rest, N m.
#[must_use]
#[inline(never)]
pub fn step(effect: &Effect, [dwell, travelled, latched, _]: &mut Memory, motion: &Motion) -> Contribution {
    let Effect::DwellBreakaway { gain, time, distance, rest_velocity, dwell_limit, smoothing_velocity } = *effect
    else {
        return Contribution::default();
    };
    let resting = motion.velocity.abs() < rest_velocity;
    let longer = *dwell + motion.dt;
    let longer = if longer < dwell_limit { longer } else { dwell_limit };
    let farther = *travelled + motion.travel.abs() / distance;
    let farther = if farther < TRAVEL_LIMIT { farther } else { TRAVEL_LIMIT };
    let risen = gain * log(1.0 + longer / time);
    let rested = if resting { longer } else { 0.0 };
    let way = if resting { 0.0 } else { farther };
    let torque = if resting { risen } else { *latched };
    *dwell = motion.usable.or(rested, *dwell);
    *travelled = motion.usable.or(way, *travelled);
    *latched = motion.usable.or(torque, *latched);
    Contribution::torque(torque * decay(way) * motion.smooth_sign(smoothing_velocity))
}
