//! The effects with what a case fixes of them; torques are shares of Coulomb friction, speeds shares of the top speed.

use super::coupling::Partner;
use super::load::Load;
use super::memory::Presliding;
use super::position::Shape;
use super::state::Profile;
use super::{Bench, body, coupling, load, memory, position, state, velocity};

/// One effect.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the fields are those of the functions that hide them")]
pub enum Effect {
    Nothing,
    Stribeck { torque: f64, speed: f64, exponent: f64 },
    ViscousNonlinearity { torque: f64, power: f64 },
    DirectionAsymmetry { torque: f64, viscous: f64 },
    Temperature { profile: Profile, coulomb_per_k: f64, viscous_per_k: f64, step_k: f64 },
    WarmUp { time_constant_s: f64, coulomb: f64, viscous: f64 },
    LoadFriction { load: Load, share: f64 },
    DriveBackdrive { load: Load, driving: f64, driven: f64 },
    SlowDrift { torque: f64 },
    Presliding { kind: Presliding, distance: f64 },
    FrictionalLag { time_constant_s: f64, pure_delay: bool },
    DwellBreakaway { torque: f64, distance: f64 },
    PositionRipple { torque: f64, orders: &'static [[f64; 2]], of_friction: bool },
    KinematicError { order: f64, amplitude_rad: f64, link_column: bool },
    PositionFriction { torque: f64, shape: Shape },
    GravityError { share: f64, phase_rad: f64 },
    InertiaError { share: f64 },
    TorqueScale { share: f64 },
    TorqueOffset { torque: f64 },
    Spring { torque: f64 },
    Coupling { torque: f64, partner: Partner },
}

impl Effect {
    /// Its name in findings; `None` of nothing.
    #[must_use]
    pub const fn name(&self) -> Option<&'static str> {
        Some(match self {
            Self::Nothing => return None,
            Self::Stribeck { .. } => "stribeck",
            Self::ViscousNonlinearity { .. } => "viscous_nonlinearity",
            Self::DirectionAsymmetry { .. } => "direction_asymmetry",
            Self::Temperature { .. } => "temperature",
            Self::WarmUp { .. } => "warm_up",
            Self::LoadFriction { .. } => "load_friction",
            Self::DriveBackdrive { .. } => "drive_backdrive",
            Self::SlowDrift { .. } => "slow_drift",
            Self::Presliding { .. } => "presliding",
            Self::FrictionalLag { .. } => "frictional_lag",
            Self::DwellBreakaway { .. } => "dwell_breakaway",
            Self::PositionRipple { .. } => "position_ripple",
            Self::KinematicError { .. } => "kinematic_error",
            Self::PositionFriction { .. } => "position_friction",
            Self::GravityError { .. } => "gravity_error",
            Self::InertiaError { .. } => "inertia_error",
            Self::TorqueScale { .. } => "torque_scale",
            Self::TorqueOffset { .. } => "torque_offset",
            Self::Spring { .. } => "spring",
            Self::Coupling { .. } => "coupling",
        })
    }

    /// Puts it into the torques.
    pub fn hide(&self, bench: &mut Bench) {
        match *self {
            Self::Nothing => {}
            Self::Stribeck { torque, speed, exponent } => velocity::stribeck(bench, torque, speed, exponent),
            Self::ViscousNonlinearity { torque, power } => velocity::nonlinearity(bench, torque, power),
            Self::DirectionAsymmetry { torque, viscous } => velocity::asymmetry(bench, torque, viscous),
            Self::Temperature { profile, coulomb_per_k, viscous_per_k, step_k } => {
                state::temperature(bench, profile, coulomb_per_k, viscous_per_k, step_k);
            }
            Self::WarmUp { time_constant_s, coulomb, viscous } => {
                state::warm_up(bench, time_constant_s, coulomb, viscous);
            }
            Self::LoadFriction { load, share } => load::friction(bench, load, share, share),
            Self::DriveBackdrive { load, driving, driven } => load::friction(bench, load, driving, driven),
            Self::SlowDrift { torque } => state::slow_drift(bench, torque),
            Self::Presliding { kind, distance } => memory::presliding(bench, kind, distance),
            Self::FrictionalLag { time_constant_s, pure_delay } => memory::lag(bench, time_constant_s, pure_delay),
            Self::DwellBreakaway { torque, distance } => memory::dwell_breakaway(bench, torque, distance),
            Self::PositionRipple { torque, orders, of_friction } => {
                position::ripple(bench, torque, orders, of_friction);
            }
            Self::KinematicError { order, amplitude_rad, link_column } => {
                position::kinematic_error(bench, order, amplitude_rad, link_column);
            }
            Self::PositionFriction { torque, shape } => position::friction(bench, torque, shape),
            Self::GravityError { share, phase_rad } => body::gravity_error(bench, share, phase_rad),
            Self::InertiaError { share } => body::inertia_error(bench, share),
            Self::TorqueScale { share } => body::torque_scale(bench, share),
            Self::TorqueOffset { torque } => body::torque_offset(bench, torque),
            Self::Spring { torque } => body::spring(bench, torque),
            Self::Coupling { torque, partner } => coupling::coupling(bench, torque, partner),
        }
    }
}
