//! What the diagnosis works on: one joint's signals on an even clock, before any filter.

use std::ops::Range;

/// Signals of one joint on an even clock; all series of one length; SI, joint side.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    /// Sample period in s.
    pub period: f64,
    /// Time in s.
    pub time: Vec<f64>,
    /// Position in rad or m.
    pub position: Vec<f64>,
    /// Recorded velocity, where the recording has no position.
    pub velocity: Option<Vec<f64>>,
    /// Actuator torque (N m, N or A).
    pub torque: Vec<f64>,
    /// Torque of the nominal rigid body, where one is given.
    pub rigid_body: Option<Vec<f64>>,
    /// Transmitted load torque.
    pub load: Option<Vec<f64>>,
    /// Temperature in degrees Celsius.
    pub temperature: Option<Vec<f64>>,
    /// Link-side position.
    pub link_position: Option<Vec<f64>>,
    /// Positions of other joints on the same clock.
    pub other_positions: Vec<Vec<f64>>,
    /// Torque that a fitted model or a simulation predicts at the recorded state, rigid body included.
    pub reference_torque: Option<Vec<f64>>,
    /// Change of the reference torque with each parameter that may move.
    pub reference_jacobian: Vec<Vec<f64>>,
    /// Friction of the reference as pairs (velocity, torque) in ascending velocity.
    pub reference_friction: Vec<(f64, f64)>,
    /// Stretches of uninterrupted motion (trajectories, or pieces between gaps).
    pub segments: Vec<Range<usize>>,
    /// Motor turns per joint turn, where known.
    pub gear_ratio: Option<f64>,
    /// Whether the axis turns (else it slides).
    pub rotary: bool,
    /// Smallest step of the position in its unit; 0 when unknown.
    pub position_resolution: f64,
}
