//! From the description of a joint to the settings of its drive.

use std::f64::consts::TAU;

use frikan_runtime::compensator::Limits;
use frikan_runtime::controller::Settings;
use frikan_runtime::drive::DriveSettings;
use frikan_runtime::supervised::Supervision;
use frikan_runtime::supervised::adaptation_settings::AdaptationSettings;

use crate::plant::{Joint, encoder_step};

/// Way over which the contact of a joint breaks away unless its stiffness is given, rad: harmonic drives and greased bearings take about one
/// milliradian (Armstrong-Helouvry et al. 1994, table 2).
const BREAKAWAY_RAD: f64 = 1e-3;

/// What an adaptation may make of the friction of the model: lowest and highest ratio. From a joint that is warm through to one that is cold
/// (Bittencourt & Gunnarsson 2012, figure 4: friction falls by 40 % from 33 to 80 degC).
const ADAPTED_LEVEL: [f32; 2] = [0.5, 1.5];
/// Largest offset and, at 1 rad/s, largest viscous torque of an adaptation, shares of the Coulomb torque. Chosen by judgement: above the
/// error of a gravity model, below what would move the joint.
const ADAPTED_SHARE: f32 = 0.2;
/// Its memory, s of sliding: a tenth of the time in which the motion `cold-start` warms up.
const ADAPTATION_MEMORY_S: f32 = 1.5;
/// Torque that it takes for noise, share of the Coulomb torque.
const ADAPTATION_NOISE: f32 = 0.03;

/// How long the compensation may take from nothing to its limit, s.
const SLEW_TIME_S: f32 = 2e-3;

/// The joint with a contact that yields before it slips, over a milliradian where its description gives no stiffness.
#[must_use]
pub fn with_contact(joint: &Joint) -> Joint {
    let mut joint = joint.clone();
    if joint.friction.contact_stiffness_nm_rad == 0.0 {
        joint.friction.contact_stiffness_nm_rad = joint.friction.holding_level(0.0, gravity(&joint)) / BREAKAWAY_RAD;
    }
    joint
}

/// Settings of the drive of `joint`: the position loop of its description (bandwidth, damping, filter, encoder, torque limit), a
/// compensation of `gain` times at most `largest` N m, and the defaults of the supervision. None where limits or supervision cannot be kept.
#[must_use]
pub fn drive_settings(joint: &Joint, gain: f32, largest: f32) -> Option<DriveSettings> {
    let omega = TAU * joint.control.bandwidth_hz;
    let limit = joint.drive.torque_limit_nm;
    let controller = Settings {
        stiffness: (joint.inertia_kgm2 * omega * omega) as f32,
        damping: (2.0 * joint.control.damping_ratio * omega * joint.inertia_kgm2) as f32,
        inertia: joint.inertia_kgm2 as f32,
        count: encoder_step(joint) as f32,
        velocity_corner: (TAU * joint.control.velocity_corner_hz) as f32,
        torque_limit: if limit > 0.0 { limit as f32 } else { f32::MAX },
    };
    let supervision = Supervision::new(joint.inertia_kgm2 as f32, coulomb_torque(joint), controller.count);
    supervision.validate().ok()?;
    Some(DriveSettings {
        controller,
        limits: Limits::new(gain, largest, largest / SLEW_TIME_S).ok()?,
        supervision,
        dt: (1.0 / joint.drive.rate_hz) as f32,
    })
}

/// Bounds and memory of an adaptation to the friction of `joint`; none where its Coulomb torque is out of range.
#[must_use]
pub fn adaptation_settings(joint: &Joint) -> Option<AdaptationSettings> {
    let coulomb = coulomb_torque(joint);
    let bounds = [ADAPTED_SHARE * coulomb; 2];
    AdaptationSettings::new(ADAPTED_LEVEL, bounds, ADAPTATION_MEMORY_S, ADAPTATION_NOISE * coulomb).ok()
}

/// Dry friction of a joint that slides fast while it holds its payload, N m.
fn coulomb_torque(joint: &Joint) -> f32 {
    joint.friction.holding_level(f64::INFINITY, gravity(joint)) as f32
}

/// Largest torque of gravity in a run, N m.
fn gravity(joint: &Joint) -> f64 {
    joint.gravity_torque_nm.first().copied().unwrap_or(0.0)
}
