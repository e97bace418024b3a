//! Gears that are not rigid: kinematic error, elasticity, backlash, hysteretic wind-up.

use super::mechanism::{Mechanism, Setting};
use crate::plant::mechanics::transmission::{Compliant, KinematicError, Transmission};
use crate::plant::random::Draws;
use std::f64::consts::TAU;

/// Two waves a turn of the wave generator and a slow one of the output (Tuttle & Seering 1996).
pub(super) fn kinematic_error(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let order = 2.0 * setting.joint.drive.gear_ratio;
    let size = setting.amplitude * draws.log_uniform("error_rad", 1.0e-4, 3.0e-4);
    let phase = draws.uniform("phase_rad", 0.0, TAU);
    let half = draws.uniform("first_order_share", 0.1, 0.4);
    let waves = vec![(size, order, phase), (half * size, 0.5 * order, draws.between(0.0, TAU))];
    draws.note("order", order);
    Mechanism::Transmission(Transmission::Kinematic(KinematicError { waves }))
}

/// A gear of this stiffness, damped at a ratio of the two masses swinging against each other.
fn compliant(stiffness: f64, damping_ratio: f64, setting: &Setting) -> Compliant {
    let (motor, link) = (setting.joint.motor_inertia_share, 1.0 - setting.joint.motor_inertia_share);
    let reduced = setting.joint.inertia_kgm2 * motor * link;
    let damping = 2.0 * damping_ratio * (stiffness * reduced).sqrt();
    Compliant { stiffness, damping, half_gap: 0.0, hysteresis: (0.0, 1.0), link: None, hysteresis_state: 0.0 }
}

/// A spring between motor and link (Spong 1987); the amplitude multiplies its compliance.
pub(super) fn elasticity(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let stiffness = draws.log_uniform("stiffness_Nm_rad", 1500.0, 4000.0) / setting.amplitude.max(1e-3);
    Mechanism::Transmission(Transmission::Compliant(compliant(stiffness, 0.1, setting)))
}

/// A gap between motor and link; the amplitude multiplies its width. The flanks are stiff, so that what is left of a
/// narrow gap is next to nothing.
pub(super) fn backlash(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let stiffness = draws.log_uniform("stiffness_Nm_rad", 150_000.0, 400_000.0);
    let half_gap = setting.amplitude * draws.log_uniform("half_gap_rad", 5e-4, 2e-3);
    let gear = Compliant { half_gap, ..compliant(stiffness, 0.3, setting) };
    Mechanism::Transmission(Transmission::Compliant(gear))
}

/// A gear whose wind-up has a loop that stiffens it at each reversal; the amplitude multiplies its compliance.
pub(super) fn windup_hysteresis(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let stiffness = draws.log_uniform("stiffness_Nm_rad", 2_000.0, 6_000.0) / setting.amplitude.max(1e-3);
    let level = draws.uniform("loop_torque_Nm", 0.8, 2.0);
    let twist = level / (stiffness * draws.uniform("loop_stiffness_share", 1.0, 2.5));
    draws.note("loop_twist_rad", twist);
    let gear = Compliant { hysteresis: (level, twist), ..compliant(stiffness, 0.1, setting) };
    Mechanism::Transmission(Transmission::Compliant(gear))
}
