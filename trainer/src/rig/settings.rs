//! From a simulated joint to the bench on which it is run.

use std::f64::consts::TAU;

use frikan_runtime::compensator::Limits;
use frikan_runtime::controller::Settings;
use frikan_runtime::supervised::Supervision;

use super::joint::LuGreJoint;
use crate::plant::Joint;

/// Way over which the contact of a joint breaks away unless its stiffness is given, rad: harmonic drives and greased bearings take about one
/// milliradian (Armstrong-Helouvry et al. 1994, table 2).
const BREAKAWAY_RAD: f64 = 1e-3;

/// How long the compensation may take from nothing to its limit, s.
const SLEW_TIME_S: f32 = 2e-3;

/// The joint under test, its friction `friction_scale` times that of the description, with a contact of `stiffness` N m/rad.
#[must_use]
pub fn joint_of(joint: &Joint, friction_scale: f64, stiffness: Option<f64>) -> LuGreJoint {
    LuGreJoint {
        inertia: joint.inertia_kgm2,
        friction: joint.friction.clone(),
        friction_scale,
        stiffness: stiffness.unwrap_or(joint.friction.dry_level(0.0) / BREAKAWAY_RAD),
        gravity: (joint.gravity_torque_nm.first().copied().unwrap_or(0.0), joint.gravity_phase_rad),
        counts_per_turn: joint.drive.counts_per_turn,
    }
}

/// The position loop of the description: bandwidth, damping, filter, encoder, torque limit.
#[must_use]
pub fn settings_of(joint: &Joint) -> Settings {
    let omega = TAU * joint.control.bandwidth_hz;
    let limit = joint.drive.torque_limit_nm;
    Settings {
        stiffness: (joint.inertia_kgm2 * omega * omega) as f32,
        damping: (2.0 * joint.control.damping_ratio * omega * joint.inertia_kgm2) as f32,
        inertia: joint.inertia_kgm2 as f32,
        count: (TAU / joint.drive.counts_per_turn) as f32,
        velocity_corner: (TAU * joint.control.velocity_corner_hz) as f32,
        torque_limit: if limit > 0.0 { limit as f32 } else { f32::MAX },
    }
}

/// The supervision of a compensator on this joint.
#[must_use]
pub fn supervision_of(joint: &Joint) -> Supervision {
    Supervision::new(joint.inertia_kgm2 as f32, joint.friction.coulomb_torque_nm as f32)
}

/// Limits for a model that gives at most `largest` N m; none where they cannot be kept.
#[must_use]
pub fn limits_of(gain: f32, largest: f32) -> Option<Limits> {
    Limits::new(gain, largest, largest / SLEW_TIME_S).ok()
}
