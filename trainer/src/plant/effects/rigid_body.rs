//! Rigid-body parameters, the torque constant, springs and the neighbouring joint.

use super::mechanism::{Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;

/// A payload whose mass or centre is not what the model says.
pub(super) fn gravity_error(draws: &mut Draws, _: &Setting) -> Mechanism {
    let along = draws.signed("sine_Nm", 0.3, 0.8);
    let across = draws.signed("cosine_Nm", 0.1, 0.5);
    Mechanism::torque(move |m: &Moment, _| {
        let (sine, cosine) = m.position.sin_cos();
        Resistance::smooth(along * sine + across * cosine)
    })
}

/// Inertia that the model lacks or has too much of.
pub(super) fn inertia_error(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let inertia = setting.joint.inertia_kgm2 * draws.signed("inertia_share", 0.05, 0.15);
    // At no amplitude may the joint lose its inertia.
    Mechanism::Inertia((setting.amplitude * inertia).max(-0.8 * setting.joint.inertia_kgm2))
}

/// A torque constant that is not what the drive believes: the command is recorded, less or more arrives.
pub(super) fn torque_scale(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let error = setting.amplitude * draws.signed("relative_error", 0.05, 0.15);
    let gain = (1.0 + error).max(0.1);
    Mechanism::Actuator(Box::new(move |torque| torque / gain))
}

/// A cable or a balancer, with a little hysteresis of its own.
pub(super) fn spring(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let stiffness = draws.uniform("stiffness_Nm_rad", 0.4, 1.0);
    let (low, high) = setting.range;
    let rest = draws.uniform("rest_position_rad", 0.6 * low, 0.6 * high);
    Mechanism::torque(move |m: &Moment, _| Resistance::smooth(stiffness * (m.position - rest)))
}

/// Inertial, centrifugal and Coriolis torque of the neighbouring joint (two-link arm).
pub(super) fn coupling(draws: &mut Draws, _: &Setting) -> Mechanism {
    let own = draws.uniform("own_inertia_kgm2", 0.03, 0.06);
    let joint = draws.uniform("mutual_inertia_kgm2", 0.02, 0.05);
    Mechanism::torque(move |m: &Moment, _| {
        let (sine, cosine) = m.other.position.sin_cos();
        let inertial = (own + joint * cosine) * m.other.acceleration;
        let centrifugal = -joint * sine * m.other.velocity * (m.other.velocity + 2.0 * m.velocity);
        Resistance::smooth(inertial + centrifugal)
    })
}
