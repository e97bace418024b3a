//! From the description of a joint to the settings of its drive.

use std::f64::consts::TAU;

use frikan_runtime::compensator::Limits;
use frikan_runtime::controller::Settings;
use frikan_runtime::drive::DriveSettings;
use frikan_runtime::supervised::Supervision;

use crate::plant::{Joint, encoder_step};

/// Way over which the contact of a joint breaks away unless its stiffness is given, rad: harmonic drives and greased bearings take about one
/// milliradian (Armstrong-Helouvry et al. 1994, table 2).
const BREAKAWAY_RAD: f64 = 1e-3;

/// How long the compensation may take from nothing to its limit, s.
const SLEW_TIME_S: f32 = 2e-3;

/// The joint with a contact that yields before it slips, over a milliradian where its description gives no stiffness.
#[must_use]
pub fn with_contact(joint: &Joint) -> Joint {
    let mut joint = joint.clone();
    let friction = &mut joint.friction;
    if friction.contact_stiffness_nm_rad == 0.0 {
        friction.contact_stiffness_nm_rad = friction.dry_level(0.0) / BREAKAWAY_RAD;
    }
    joint
}

/// Settings of the drive of `joint`: the position loop of its description (bandwidth, damping, filter, encoder, torque limit), a
/// compensation of `gain` times at most `largest` N m, and the defaults of the supervision. None where these limits cannot be kept.
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
    Some(DriveSettings {
        controller,
        limits: Limits::new(gain, largest, largest / SLEW_TIME_S).ok()?,
        supervision: Supervision::new(joint.inertia_kgm2 as f32, joint.friction.coulomb_torque_nm as f32),
        dt: (1.0 / joint.drive.rate_hz) as f32,
    })
}
