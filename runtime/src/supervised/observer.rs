//! What the motion tells of friction: the net friction of a joint without its acceleration being measured.
//!
//! `loop torque - J dv/dt`, where the loop torque is all that acts on the joint but friction, compensation and outside forces, both sides
//! of the difference behind the same low-pass (Hsu, Bodson, Sastry & Paden 1987). It is friction less compensation. The low-pass has two
//! stages, so that a count of the encoder is a bounded torque ([`Pace::of`]).

use super::pace::Pace;
use super::settings::Supervision;

/// The filters of the observer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observer {
    /// Loop torque behind both stages of the low-pass, N m.
    torque: [f32; 2],
    /// Velocity of the position behind both, rad/s.
    velocity: [f32; 2],
    /// Way since the velocity changed its sign or the joint stood still, rad.
    way: f32,
}

/// One sample of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Friction less compensation behind the low-pass, N m.
    pub net_friction: f32,
    /// Velocity behind the low-pass, rad/s.
    pub velocity: f32,
    /// Whether the joint slides: it moves, and has left the way behind over which a contact gives back what it had stored.
    pub slides: bool,
}

impl Observer {
    /// Takes the velocity of the position since the sample before and the loop torque that acted meanwhile on an inertia in kg m^2, all finite.
    pub fn observe(
        &mut self,
        supervision: &Supervision,
        pace: &Pace,
        velocity: f32,
        (loop_torque, inertia): (f32, f32),
    ) -> Observation {
        let share = pace.observer;
        follow(&mut self.torque, share, loop_torque);
        let above = follow(&mut self.velocity, share, velocity);
        let [early, late] = self.velocity;
        let goes_on = early * late > 0.0 && late.abs() > pace.standstill;
        self.way = if goes_on { self.way + early.abs() * pace.dt } else { 0.0 };
        Observation {
            // The low-pass of the differences of the velocity, whatever the sample period.
            net_friction: self.torque[1] - inertia * (share * pace.rate) * above,
            velocity: late,
            slides: self.way > supervision.presliding,
        }
    }
}

/// Moves both stages of a low-pass by a share of what lies before each, and returns how far the first was above the second.
pub(super) fn follow(stages: &mut [f32; 2], share: f32, value: f32) -> f32 {
    let [early, late] = stages;
    *early += share * (value - *early);
    let above = *early - *late;
    *late += share * above;
    above
}
