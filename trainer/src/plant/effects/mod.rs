//! Everything that can be hidden in a joint: the catalogue, structures outside it, and how each is drawn from a seed.
//!
//! An effect is drawn once, off any grid, and multiplied by an amplitude. `mechanism` says where it acts. Knows no
//! recording and no way in which an effect is looked for.

mod dependence;
mod events;
mod measurement;
pub(crate) mod mechanism;
mod memory;
mod outside;
mod position;
mod rigid_body;
mod transmission;
mod velocity;

pub use mechanism::Entry;
pub use outside::OUTSIDE;

/// The catalogue of `CONTRACT.md`, and `clock_gaps`.
pub const CATALOGUE: &[Entry] = &[
    Entry { name: "stribeck", channels: &["velocity"], draw: velocity::stribeck },
    Entry { name: "viscous_nonlinearity", channels: &["velocity"], draw: velocity::viscous_nonlinearity },
    Entry { name: "direction_asymmetry", channels: &["velocity"], draw: velocity::direction_asymmetry },
    Entry { name: "temperature", channels: &["temperature", "velocity"], draw: dependence::temperature },
    Entry { name: "warm_up", channels: &["time", "velocity"], draw: dependence::warm_up },
    Entry { name: "load_friction", channels: &["load", "velocity"], draw: dependence::load_friction },
    Entry { name: "drive_backdrive", channels: &["load", "velocity"], draw: dependence::drive_backdrive },
    Entry { name: "slow_drift", channels: &["time", "velocity"], draw: dependence::slow_drift },
    Entry { name: "presliding", channels: &["distance", "velocity"], draw: memory::presliding },
    Entry { name: "frictional_lag", channels: &["velocity", "acceleration"], draw: memory::frictional_lag },
    Entry { name: "dwell_breakaway", channels: &["dwell", "distance"], draw: memory::dwell_breakaway },
    Entry { name: "position_ripple", channels: &["position"], draw: position::ripple },
    Entry { name: "kinematic_error", channels: &["position", "velocity"], draw: transmission::kinematic_error },
    Entry { name: "position_friction", channels: &["position", "velocity"], draw: position::friction },
    Entry { name: "gravity_error", channels: &["position"], draw: rigid_body::gravity_error },
    Entry { name: "inertia_error", channels: &["acceleration"], draw: rigid_body::inertia_error },
    Entry { name: "torque_scale", channels: &["torque", "load"], draw: rigid_body::torque_scale },
    Entry { name: "torque_offset", channels: &[], draw: measurement::torque_offset },
    Entry { name: "spring", channels: &["position"], draw: rigid_body::spring },
    Entry { name: "coupling", channels: &["other"], draw: rigid_body::coupling },
    Entry { name: "saturation", channels: &["torque"], draw: events::saturation },
    Entry { name: "contact", channels: &["position"], draw: events::contact },
    Entry { name: "transient_event", channels: &["time"], draw: events::transient_event },
    Entry { name: "recurrent_fault", channels: &["position"], draw: events::recurrent_fault },
    Entry { name: "backlash", channels: &["load"], draw: transmission::backlash },
    Entry { name: "elasticity", channels: &["load", "acceleration"], draw: transmission::elasticity },
    Entry { name: "windup_hysteresis", channels: &["load"], draw: transmission::windup_hysteresis },
    Entry { name: "time_misalignment", channels: &["torque"], draw: measurement::time_misalignment },
    Entry { name: "quantisation", channels: &["position"], draw: measurement::quantisation },
    Entry { name: "unit_or_sign", channels: &["torque"], draw: measurement::unit_or_sign },
    Entry { name: "clock_gaps", channels: &["time"], draw: measurement::clock_gaps },
];

/// Finds an entry of the catalogue or outside it by name.
pub fn find(name: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().chain(OUTSIDE).find(|entry| entry.name == name)
}

#[cfg(test)]
mod tests;
