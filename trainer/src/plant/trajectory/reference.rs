//! A commanded motion, sample by sample.

/// A reference at the sample instants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Position, rad.
    pub position: Vec<f64>,
    /// Velocity, rad/s.
    pub velocity: Vec<f64>,
    /// Acceleration, rad/s2.
    pub acceleration: Vec<f64>,
}

/// Rest at both ends of a trajectory, s.
pub(super) const REST_S: f64 = 0.1;
