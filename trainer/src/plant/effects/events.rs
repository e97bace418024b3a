//! Limits and events: saturation, contact, a bump in time, a fault at an angle.

use super::mechanism::{Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;
use std::f64::consts::TAU;

/// An actuator that delivers less than commanded beyond a threshold; at amplitude 1 about half of the excess is lost.
pub(super) fn saturation(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let peak = setting.joint.gravity_torque_nm.iter().fold(0.0_f64, |peak, g| peak.max(g.abs()))
        + setting.joint.friction.coulomb_torque_nm;
    let threshold = peak * draws.uniform("threshold_share", 0.55, 0.75);
    draws.note("threshold_Nm", threshold);
    let lost = (setting.amplitude * draws.uniform("lost_share", 0.4, 0.6)).min(0.75);
    Mechanism::Actuator(Box::new(move |torque: f64| {
        torque - lost * (torque.abs() - threshold).max(0.0).copysign(torque)
    }))
}

/// A soft stop near one end of the range (Hunt & Crossley 1975).
pub(super) fn contact(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let (low, high) = setting.range;
    let side = draws.sign();
    let reach = if side > 0.0 { high } else { -low };
    let stop = reach * draws.uniform("stop_share", 0.55, 0.8);
    draws.note("stop_rad", side * stop);
    let stiffness = draws.uniform("stiffness_Nm_rad", 5.0, 10.0);
    let exponent = draws.uniform("exponent", 1.0, 1.5);
    let damping = draws.uniform("damping_s_rad", 0.02, 0.08);
    Mechanism::torque(move |m: &Moment, _| {
        let depth = side * m.position - stop;
        if depth <= 0.0 {
            return Resistance::default();
        }
        let torque = stiffness * depth.powf(exponent) * (1.0 + damping * side * m.velocity);
        Resistance::smooth(side * torque.max(0.0))
    })
}

/// One bump in time, with finite flanks.
pub(super) fn transient_event(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let start = setting.duration * draws.uniform("start_share", 0.05, 0.9);
    draws.note("start_s", start);
    let length = draws.log_uniform("length_s", 0.15, 0.9);
    let size = draws.signed("torque_Nm", 1.0, 2.0);
    let flank = 0.2 * length;
    Mechanism::torque(move |m: &Moment, _| {
        let inside = (m.time - start).min(start + length - m.time);
        Resistance::smooth(size * (inside / flank).clamp(0.0, 1.0))
    })
}

/// A chipped tooth or a pitted bearing: a short pulse at one angle of each turn of an element.
pub(super) fn recurrent_fault(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let ratio = setting.joint.drive.gear_ratio;
    let order = if draws.choice("rotor", 3) == 0 { 1.0 } else { ratio };
    draws.note("order", order);
    let centre =
        if order > 1.0 { draws.between(0.0, TAU) } else { draws.between(0.5 * setting.range.0, 0.5 * setting.range.1) };
    draws.note("angle_rad", centre);
    let width =
        if order > 1.0 { draws.uniform("width_rad", 0.15, 0.5) } else { draws.uniform("width_rad", 0.02, 0.06) };
    let size = draws.signed("torque_Nm", 0.8, 1.6);
    Mechanism::torque(move |m: &Moment, _| {
        let away = (order * m.position - centre + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        Resistance::smooth(size * (-0.5 * (away / width).powi(2)).exp())
    })
}
