//! A law from elsewhere (a simulation, a fitted model) evaluated at the recorded states, as the base of a comparison.

use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::prepare::Prepared;
use crate::diagnose::preparation::rows::Lock;
use crate::physics::{EffectId, JointState};

/// A law at the states of a recording.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    /// Whole torque, one value a sample.
    pub torque: Vec<f64>,
    /// Its rigid-body part.
    pub rigid_body: Vec<f64>,
    /// Change of the torque with each parameter that may move, with its name.
    pub jacobian: Vec<(&'static str, Vec<f64>)>,
    /// Effects of the catalogue that it holds itself.
    pub effects: Vec<EffectId>,
    /// What the law leaves of the simulation from which it was learned, where that is of the same motion.
    pub left: Option<Vec<f64>>,
    /// Root mean square, behind the filter, of what its formulas get wrong beside that.
    pub formula_error: f64,
    /// Torque of each direction in which the law is not sure of itself, at one standard deviation.
    pub doubt: Vec<Vec<f64>>,
    /// Samples at which a channel lies beyond what the law was fitted on, and by which channels; empty where none does.
    pub outside: Outside,
    /// Its friction as pairs (velocity, torque) in ascending velocity.
    pub friction: Vec<(f64, f64)>,
}

/// Where a law is asked for more than it was fitted on: there it holds its last value, and the difference is its own.
#[derive(Clone, Debug, Default)]
pub struct Outside {
    /// One a sample; empty where all are within.
    pub samples: Vec<bool>,
    /// Each channel that is beyond, with the range that the law was fitted on and its unit.
    pub channels: Vec<(String, [f64; 2], String)>,
}

impl Signals {
    /// The states at which a reference is evaluated: those behind the filter that the recording asks for.
    #[must_use]
    pub fn states(&self) -> JointState {
        Prepared::new(self, Lock::Nothing).state
    }

    /// Takes a reference for the model that the recording is compared with.
    pub fn compare_with(&mut self, reference: Reference) {
        if self.rigid_body.is_none() && reference.rigid_body.iter().any(|torque| *torque != 0.0) {
            self.rigid_body = Some(reference.rigid_body.clone());
        }
        self.reference = Some(reference);
    }
}

/// Coulomb and viscous friction that may move beside a law, with the names of their changes.
pub(crate) fn coulomb_and_viscous(state: &JointState) -> Vec<(&'static str, Vec<f64>)> {
    vec![("coulomb_torque_change", state.sign.clone()), ("viscous_coefficient_change", state.velocity.clone())]
}

/// Velocities at which a reference's friction is tabulated, denser towards zero.
pub(crate) fn tabulated_velocities(reach: f64) -> impl Iterator<Item = f64> {
    (-120..=120).map(move |k| {
        let x = f64::from(k) / 120.0;
        reach * x * x * x
    })
}
