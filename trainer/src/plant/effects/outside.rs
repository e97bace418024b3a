//! Structures outside the catalogue: real enough to move the joint, with no name to find.

use super::mechanism::{Entry, Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;
use std::f64::consts::TAU;

/// Structures that no hypothesis describes, each with the channels it depends on.
pub const OUTSIDE: &[Entry] = &[
    Entry { name: "unknown_local_bump", channels: &["position", "velocity"], draw: local_bump },
    Entry { name: "unknown_viscous_cosine", channels: &["position", "velocity"], draw: viscous_cosine },
    Entry { name: "unknown_viscous_other_cosine", channels: &["other", "velocity"], draw: viscous_other_cosine },
    Entry { name: "unknown_acceleration_sign", channels: &["acceleration", "velocity"], draw: acceleration_sign },
    Entry { name: "unknown_load_temperature", channels: &["load", "temperature", "velocity"], draw: load_temperature },
    Entry { name: "unknown_speed_band", channels: &["velocity"], draw: speed_band },
    Entry { name: "unknown_load_squared_viscous", channels: &["load", "velocity"], draw: load_squared_viscous },
    Entry { name: "unknown_temperature_bump", channels: &["temperature", "velocity"], draw: temperature_bump },
    Entry { name: "unknown_other_drag", channels: &["other", "velocity"], draw: other_drag },
    Entry { name: "unknown_other_position", channels: &["other"], draw: other_position },
    Entry { name: "unknown_position_step_viscous", channels: &["position", "velocity"], draw: position_step_viscous },
    Entry { name: "unknown_slow_wave", channels: &["time", "velocity"], draw: slow_wave },
    Entry { name: "unknown_acceleration_square", channels: &["acceleration"], draw: acceleration_square },
    Entry { name: "unknown_centrifugal_position", channels: &["position", "velocity"], draw: centrifugal_position },
    Entry { name: "unknown_load_position", channels: &["load", "position", "velocity"], draw: load_position },
];

/// A narrow tight place: friction within a few hundredths of a radian.
fn local_bump(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let (low, high) = setting.range;
    let place = draws.uniform("place_rad", 0.5 * low, 0.5 * high);
    let width = draws.uniform("width_rad", 0.04, 0.1);
    let level = draws.uniform("level_Nm", 1.0, 2.0);
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(level * (-((m.position - place) / width).powi(2)).exp()))
}

/// Viscosity that waves along the own position.
fn viscous_cosine(draws: &mut Draws, _: &Setting) -> Mechanism {
    let size = draws.uniform("viscous_Nm_s_rad", 0.4, 0.8);
    let order = draws.uniform("order", 1.7, 3.4);
    let phase = draws.uniform("phase_rad", 0.0, TAU);
    Mechanism::torque(move |m: &Moment, _| Resistance::smooth(size * m.velocity * (order * m.position + phase).cos()))
}

/// `v cos 2 q2`: viscosity that depends on where the neighbour stands.
fn viscous_other_cosine(draws: &mut Draws, _: &Setting) -> Mechanism {
    let size = draws.uniform("viscous_Nm_s_rad", 0.4, 0.8);
    Mechanism::torque(move |m: &Moment, _| Resistance::smooth(size * m.velocity * (2.0 * m.other.position).cos()))
}

/// More friction while speeding up than while slowing down.
fn acceleration_sign(draws: &mut Draws, _: &Setting) -> Mechanism {
    let level = draws.uniform("level_Nm", 0.4, 0.8);
    let width = draws.uniform("width_rad_s2", 0.5, 2.0);
    Mechanism::torque(move |m: &Moment, _| {
        let rising = (m.acceleration / width).tanh();
        Resistance::sided(level * rising, -level * rising)
    })
}

/// Load-dependent friction that only a warm gear has.
fn load_temperature(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let share = draws.uniform("coefficient_1_K", 0.008, 0.02);
    let reference = setting.joint.thermal.ambient_c + draws.uniform("reference_K", 2.0, 5.0);
    Mechanism::torque(move |m: &Moment, _| {
        let warm = m.temperature - reference;
        Resistance::dry(share * m.load.abs() * warm)
    })
}

/// Extra friction in one band of speed (a resonant seal).
fn speed_band(draws: &mut Draws, _: &Setting) -> Mechanism {
    let centre = draws.uniform("speed_rad_s", 0.7, 1.4);
    let width = draws.uniform("width_rad_s", 0.1, 0.25);
    let level = draws.uniform("level_Nm", 0.6, 1.0);
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(level * (-((m.speed() - centre) / width).powi(2)).exp()))
}

/// Viscous torque that grows with the square of the load.
fn load_squared_viscous(draws: &mut Draws, _: &Setting) -> Mechanism {
    let size = draws.uniform("viscous_Nm_s_rad", 0.02, 0.04);
    Mechanism::torque(move |m: &Moment, _| Resistance::smooth(size * m.load * m.load * m.velocity))
}

/// Friction that peaks at one temperature (a grease in transition).
fn temperature_bump(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let thermal = &setting.joint.thermal;
    let peak = thermal.ambient_c + draws.uniform("peak_above_ambient_K", 3.0, 6.0);
    let width = draws.uniform("width_K", 0.8, 1.8);
    let level = draws.uniform("level_Nm", 0.5, 1.0);
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(level * (-((m.temperature - peak) / width).powi(2)).exp()))
}

/// Friction that rises with the neighbour's speed (a shared seal).
fn other_drag(draws: &mut Draws, _: &Setting) -> Mechanism {
    let share = draws.uniform("level_Nm_s_rad", 0.4, 0.9);
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(share * m.other.velocity.abs()))
}

/// A hose pulled by the neighbour.
fn other_position(draws: &mut Draws, _: &Setting) -> Mechanism {
    let size = draws.uniform("torque_Nm", 0.3, 0.7);
    let order = draws.uniform("order", 1.3, 2.2);
    Mechanism::torque(move |m: &Moment, _| Resistance::smooth(size * (order * m.other.position).sin()))
}

/// Viscosity that changes at one position.
fn position_step_viscous(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let place = draws.uniform("place_rad", 0.4 * setting.range.0, 0.4 * setting.range.1);
    let size = draws.uniform("viscous_Nm_s_rad", 0.3, 0.6);
    let width = draws.uniform("width_rad", 0.03, 0.1);
    Mechanism::torque(move |m: &Moment, _| {
        Resistance::smooth(size * m.velocity * ((m.position - place) / width).tanh())
    })
}

/// Dry friction that swells and ebbs with time.
fn slow_wave(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let level = draws.uniform("level_Nm", 0.4, 0.8);
    let cycles = draws.uniform("cycles", 1.6, 2.8);
    let phase = draws.uniform("phase_rad", 0.0, TAU);
    let omega = TAU * cycles / setting.duration;
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(level * (omega * m.time + phase).sin()))
}

/// A torque even in acceleration.
fn acceleration_square(draws: &mut Draws, _: &Setting) -> Mechanism {
    let size = draws.uniform("torque_Nm", 0.4, 0.8);
    let scale = draws.uniform("scale_rad_s2", 4.0, 8.0);
    Mechanism::torque(move |m: &Moment, _| {
        let x = (m.acceleration / scale).powi(2);
        Resistance::smooth(size * x / (1.0 + x))
    })
}

/// `v^2 sin q`: a torque even in velocity that changes along the way.
fn centrifugal_position(draws: &mut Draws, _: &Setting) -> Mechanism {
    let size = draws.signed("torque_Nm_s2", 0.2, 0.45);
    let order = draws.uniform("order", 1.4, 2.4);
    Mechanism::torque(move |m: &Moment, _| {
        Resistance::smooth(size * m.velocity * m.velocity * (order * m.position).sin())
    })
}

/// Load-dependent friction with a tight half of the way.
fn load_position(draws: &mut Draws, _: &Setting) -> Mechanism {
    let share = draws.uniform("coefficient", 0.08, 0.15);
    let order = draws.uniform("order", 1.5, 3.0);
    let phase = draws.uniform("phase_rad", 0.0, TAU);
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(share * m.load.abs() * (order * m.position + phase).sin()))
}
