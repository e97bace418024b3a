//! What the loop is asked to do, and what disturbs the joint meanwhile.

use std::f64::consts::TAU;

use frikan_runtime::controller::Target;

/// A motion of the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Standing still, on a floor that vibrates.
    Hold,
    /// Constant slow velocity.
    Creep,
    /// Slow reversals.
    Reversals,
    /// Point to point, with dwells.
    Dwells,
    /// A sine at working speed.
    Sine,
    /// No position loop: the joint is nudged and let go.
    Nudge,
    /// A sine while the load steps.
    LoadStep,
    /// A sine of a joint that starts cold and warms up.
    ColdStart,
}

impl Motion {
    /// All motions, in an order that is kept.
    pub const ALL: [Self; 8] = [
        Self::Hold,
        Self::Creep,
        Self::Reversals,
        Self::Dwells,
        Self::Sine,
        Self::Nudge,
        Self::LoadStep,
        Self::ColdStart,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hold => "hold",
            Self::Creep => "creep",
            Self::Reversals => "reversals",
            Self::Dwells => "dwells",
            Self::Sine => "sine",
            Self::Nudge => "nudge",
            Self::LoadStep => "load-step",
            Self::ColdStart => "cold-start",
        }
    }

    /// How long it is run unless told otherwise, s.
    #[must_use]
    pub fn duration(self) -> f64 {
        match self {
            Self::Nudge => 5.0,
            Self::Reversals => 40.0,
            Self::ColdStart => 60.0,
            _ => 20.0,
        }
    }

    /// The target at a time, s; none where there is no position loop.
    #[must_use]
    pub fn target(self, time: f64) -> Option<Target> {
        match self {
            Self::Hold => Some(place(HOLD_POSITION, time)),
            Self::Creep => Some(ramp(CREEP_VELOCITY, time)),
            Self::Reversals => Some(sine(0.05, 0.1, time)),
            Self::Dwells => Some(dwells(time)),
            Self::Sine | Self::ColdStart => Some(sine(0.5, 0.5, time)),
            Self::LoadStep => Some(sine(0.2, 0.25, time)),
            Self::Nudge => None,
        }
    }

    /// The outside torque at a time, N m, for a joint of `inertia` kg m^2 and a friction of `friction` N m.
    #[must_use]
    pub fn disturbance(self, time: f64, inertia: f64, friction: f64) -> f64 {
        match self {
            // Pushed beyond its friction, so that it would reach NUDGE_VELOCITY without compensation.
            Self::Nudge if (NUDGE_START..NUDGE_END).contains(&time) => {
                friction + inertia * NUDGE_VELOCITY / (NUDGE_END - NUDGE_START)
            }
            Self::Hold => VIBRATION * friction * (TAU * VIBRATION_HZ * time).sin(),
            Self::LoadStep if !((time / 5.0) as u64).is_multiple_of(2) => friction,
            _ => 0.0,
        }
    }

    /// Friction at a time, s, over that of the warm joint.
    #[must_use]
    pub fn friction_factor(self, time: f64) -> f64 {
        match self {
            Self::ColdStart => 1.0 + COLD_EXCESS * (-time / WARMING_S).exp(),
            _ => 1.0,
        }
    }

    /// When the joint is let go, s.
    #[must_use]
    pub fn nudge_end(self) -> Option<f64> {
        (self == Self::Nudge).then_some(NUDGE_END)
    }
}

/// Friction of the cold joint beyond that of the warm one, and the time constant of its fall, s. Chosen by judgement: a large excess, gone
/// within a run of a minute, where the housing of a real joint takes an hour.
const COLD_EXCESS: f64 = 0.4;
const WARMING_S: f64 = 15.0;
const NUDGE_START: f64 = 0.5;
const NUDGE_END: f64 = 0.7;
/// rad/s
const NUDGE_VELOCITY: f64 = 0.3;
/// Where the joint stands still, rad: no multiple of an encoder's step.
const HOLD_POSITION: f64 = 0.012_345;
/// Vibration of the floor as a share of the friction, and its frequency, Hz.
const VIBRATION: f64 = 0.02;
const VIBRATION_HZ: f64 = 7.3;
/// rad/s
const CREEP_VELOCITY: f64 = 0.01;

fn target(position: f64, velocity: f64, acceleration: f64) -> Target {
    Target { position: position as f32, velocity: velocity as f32, acceleration: acceleration as f32 }
}

/// A sine that starts at its lowest point, at rest.
fn sine(amplitude: f64, frequency: f64, time: f64) -> Target {
    let omega = TAU * frequency;
    let (sine, cosine) = (omega * time).sin_cos();
    target(amplitude * (1.0 - cosine), amplitude * omega * sine, amplitude * omega * omega * cosine)
}

/// Constant velocity, reached in half a second.
fn ramp(velocity: f64, time: f64) -> Target {
    let start = 0.5;
    if time < start {
        return target(0.5 * velocity / start * time * time, velocity / start * time, velocity / start);
    }
    target(velocity * (time - 0.5 * start), velocity, 0.0)
}

/// There in a second, and there it stays.
fn place(position: f64, time: f64) -> Target {
    minimum_jerk(0.0, position, time)
}

/// There and back in a second each with a second of rest.
fn dwells(time: f64) -> Target {
    let (distance, period) = (0.2, 2.0);
    let (index, phase) = ((time / period).floor(), time % period);
    if (index as u64).is_multiple_of(2) {
        minimum_jerk(0.0, distance, phase)
    } else {
        minimum_jerk(distance, -distance, phase)
    }
}

/// A way in a second, minimum jerk (Flash & Hogan 1985), and rest after it.
fn minimum_jerk(from: f64, way: f64, time: f64) -> Target {
    let s = time.min(1.0);
    let (s2, s3) = (s * s, s * s * s);
    target(
        from + way * s3 * (10.0 - 15.0 * s + 6.0 * s2),
        way * 30.0 * s2 * (1.0 - 2.0 * s + s2),
        way * 60.0 * s * (1.0 - 3.0 * s + 2.0 * s2),
    )
}
