//! Which velocity the friction is compensated at (Olsson et al. 1998, section 6): that of the reference is free of noise and delay and makes
//! no feedback, that of the joint is true.

use super::settings::Supervision;

/// The velocity of the reference up to `rest_velocity`, through zero and at rest; the measured one from twice that on; between them in
/// proportion to the speed of the reference. A joint that does not go the way of its reference, or hardly, is compensated as if it went at
/// twice `rest_velocity`: the friction to overcome is that at which it breaks away, whatever the speed that is asked for.
#[must_use]
pub fn blended(supervision: &Supervision, measured: f32, reference: f32) -> f32 {
    let rest = supervision.rest_velocity;
    let share = share(rest, reference.abs());
    let along = if reference < 0.0 { -measured } else { measured };
    let along = if along > 2.0 * rest { along } else { 2.0 * rest };
    let speed = reference.abs() + share * (along - reference.abs());
    if reference < 0.0 { -speed } else { speed }
}

/// The share of compensation at a measured speed without a reference: none at rest, where nobody says which way the joint is to go and the
/// sign of a noisy velocity would switch the torque; all of it from twice `rest_velocity` on.
#[must_use]
pub fn share_without_reference(supervision: &Supervision, measured: f32) -> f32 {
    share(supervision.rest_velocity, measured.abs())
}

/// 0 up to `rest`, 1 from twice that on, linear between.
fn share(rest: f32, speed: f32) -> f32 {
    let share = (speed - rest) / rest;
    let positive = if share > 0.0 { share } else { 0.0 };
    if positive < 1.0 { positive } else { 1.0 }
}
