//! Breakaway that rises with the dwell before it (Rabinowicz 1958; Dieterich 1979).

use frikan_shared::effect::Effect;
use frikan_shared::elementary::{exp, log};

use super::{Contribution, Motion};

/// Distances over which the latched torque has decayed to nothing.
const TRAVEL_LIMIT: f32 = 20.0;

/// Rest and travel since then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dwell {
    /// Time at rest, s, at most the dwell limit.
    time: f32,
    /// Distance since rest, in breakaway distances, at most [`TRAVEL_LIMIT`].
    travelled: f32,
    /// Torque latched at the end of the rest, N m.
    torque: f32,
}

/// While at rest the dwell grows and with it the torque; in motion the torque decays over the distance.
#[must_use]
pub fn step(effect: &Effect, dwell: &mut Dwell, motion: &Motion) -> Contribution {
    let Effect::DwellBreakaway { gain, time, distance, rest_velocity, dwell_limit, smoothing_velocity } = *effect
    else {
        return Contribution::default();
    };
    let speed = motion.velocity.abs();
    let resting = speed < rest_velocity;
    let longer = dwell.time + motion.dt;
    let longer = if longer < dwell_limit { longer } else { dwell_limit };
    let farther = dwell.travelled + speed * motion.dt / distance;
    let farther = if farther < TRAVEL_LIMIT { farther } else { TRAVEL_LIMIT };
    let risen = gain * log(1.0 + longer / time);
    *dwell = Dwell {
        time: if resting { longer } else { 0.0 },
        travelled: if resting { 0.0 } else { farther },
        torque: if resting { risen } else { dwell.torque },
    };
    Contribution::torque(dwell.torque * exp(-dwell.travelled) * motion.smooth_sign(smoothing_velocity))
}
