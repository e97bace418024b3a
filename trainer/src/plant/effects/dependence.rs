//! Friction that depends on temperature, work done, load and time.

use super::mechanism::{Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;

/// Friction over housing temperature: dry part linear, viscous part exponential (Bittencourt & Gunnarsson 2012).
pub(super) fn temperature(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let dry = setting.joint.friction.coulomb_torque_nm * draws.uniform("coulomb_change_1_K", -0.02, 0.005);
    let viscous = setting.joint.friction.viscous_nm_s_rad;
    let decay = draws.uniform("viscous_decay_1_K", 0.02, 0.05);
    let reference = setting.joint.thermal.ambient_c;
    Mechanism::torque(move |m: &Moment, _| {
        let rise = m.temperature - reference;
        Resistance::dry(dry * rise).with_smooth(viscous * (-decay * rise).exp_m1() * m.velocity)
    })
}

/// Heat of the contact itself, fed by dissipated power, unseen by any sensor (Simoni et al. 2015).
pub(super) fn warm_up(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let time_constant = draws.log_uniform("time_constant_s", 12.0, 90.0);
    let dry = -setting.joint.friction.coulomb_torque_nm * draws.uniform("coulomb_fall_1_W", 0.03, 0.08);
    let viscous = -setting.joint.friction.viscous_nm_s_rad * draws.uniform("viscous_fall_1_W", 0.08, 0.15);
    let mut heat = 0.0;
    Mechanism::torque(move |m: &Moment, step_s: f64| {
        heat += (m.power - heat) * -(-step_s / time_constant).exp_m1();
        // The fall levels off: oil does not get thinner than it is.
        let thinned = heat / (1.0 + 0.05 * heat);
        Resistance::dry(dry * thinned).with_smooth(viscous * thinned * m.velocity)
    })
}

/// Friction in proportion to the transmitted torque, a little more at low speed (Hamon, Gautier & Garrec 2010).
pub(super) fn load_friction(draws: &mut Draws, _: &Setting) -> Mechanism {
    let share = draws.uniform("load_coefficient", 0.06, 0.14);
    let extra = draws.uniform("low_speed_share", 0.0, 0.4);
    let velocity = draws.log_uniform("low_speed_rad_s", 0.05, 0.3);
    Mechanism::torque(move |m: &Moment, _| {
        Resistance::dry(share * m.load.abs() * (1.0 + extra * (-(m.velocity / velocity).powi(2)).exp()))
    })
}

/// A gear that loses more when driven than when backdriven.
pub(super) fn drive_backdrive(draws: &mut Draws, _: &Setting) -> Mechanism {
    let driving = draws.uniform("driving_coefficient", 0.08, 0.18);
    let backdriving = draws.uniform("backdriving_coefficient", 0.0, 0.05);
    Mechanism::torque(move |m: &Moment, _| {
        let towards = |direction: f64| {
            let share = if m.load * direction > 0.0 { driving } else { backdriving };
            share * m.load.abs()
        };
        Resistance::sided(towards(1.0), towards(-1.0))
    })
}

/// Run-in or wear: dry friction that creeps with time and does not recover.
pub(super) fn slow_drift(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let total = draws.signed("change_over_recording_Nm", 0.4, 1.0);
    let bend = draws.uniform("bend", -0.25, 0.25);
    let duration = setting.duration;
    Mechanism::torque(move |m: &Moment, _| {
        let x = m.time / duration;
        Resistance::dry(total * (x + bend * x * (1.0 - x)))
    })
}
