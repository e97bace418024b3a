//! What lies between motor and link.

use crate::second_opinion::protocol::{Protocol, VELOCITY_NOISE};
use crate::second_opinion::random::{Random, factor};
use crate::second_opinion::recording::Material;
use crate::second_opinion::two_mass::{MOTOR_SHARE, Transmission};
use std::f64::consts::TAU;

/// Rate of the integration, Hz.
const FINE_HZ: f64 = 20_000.0;
/// Ways in which the position of the link is recorded.
const WITH_LINK: usize = 3;

/// Half of the play, rad or m.
const HALF_PLAY: [f64; 6] = [0.01, 0.006, 0.004, 0.003, 0.008, 0.015];
/// Square of this frequency times the inertia is the stiffness beside a play but for a factor, Hz.
const STIFF_HZ: f64 = 18.0;

/// Play between motor and link.
pub(super) fn backlash(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let times = if way == 0 { 3.0 } else { 2.5 };
    let stiffness = times * protocol.joint.inertia * (TAU * STIFF_HZ).powi(2);
    let half_play = HALF_PLAY[way] * factor(random);
    let transmission = Transmission { stiffness, half_play, slipping: None, bandwidth_rad_s: 40.0 };
    record(way, protocol, &transmission, &format!("play of twice {half_play:.4}, stiffness {stiffness:.3}"), random)
}

/// Frequencies at which the link swings when the motor is held, Hz.
const SWINGING_HZ: [f64; 6] = [10.0, 8.0, 9.0, 8.0, 9.0, 7.0];

/// Stiffness at which the link swings at its frequency, N m/rad or N/m.
fn stiffness(way: usize, protocol: &Protocol, random: &mut Random) -> f64 {
    let hz = SWINGING_HZ[way] * random.uniform(0.9, 1.1);
    (1.0 - MOTOR_SHARE) * protocol.joint.inertia * (TAU * hz).powi(2)
}

/// An elastic transmission.
pub(super) fn elasticity(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let stiffness = stiffness(way, protocol, random);
    let transmission = Transmission { stiffness, half_play: 0.0, slipping: None, bandwidth_rad_s: 25.0 };
    record(way, protocol, &transmission, &format!("stiffness {stiffness:.3}"), random)
}

/// An elastic transmission with a part that slips.
pub(super) fn windup(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let stiffness = stiffness(way, protocol, random);
    let level = 0.6 * protocol.joint.coulomb * factor(random);
    let slipping = Some([3.0 * stiffness, level]);
    let transmission = Transmission { stiffness: 2.0 * stiffness, half_play: 0.0, slipping, bandwidth_rad_s: 25.0 };
    let note =
        format!("stiffness {:.3}, beside it {:.3} that slips at {level:.3}", transmission.stiffness, 3.0 * stiffness);
    record(way, protocol, &transmission, &note, random)
}

fn record(way: usize, protocol: &Protocol, transmission: &Transmission, note: &str, random: &mut Random) -> Material {
    let fine = protocol.finer_than(FINE_HZ, random);
    let joint = &fine.joint;
    let driven = transmission.follow(joint, &fine.path, fine.period_s);
    let path = driven.motor.every(fine.step);
    let mut torque = fine.samples_of(&driven.command);
    protocol.disturb(&mut torque, random);
    let mut real = Protocol::columns(joint, &path, torque, VELOCITY_NOISE, random);
    let with_link = way < WITH_LINK;
    if with_link {
        let link = fine.samples_of(&driven.link).iter().map(|q| joint.read(*q)).collect();
        real.put(format!("link_position_{}", joint.unit()), link);
    }
    let seen = if with_link { "with" } else { "without" };
    protocol.of(joint, real, &format!("{note}, {seen} the position of the link"))
}
