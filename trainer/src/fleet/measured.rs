//! What one recording of one joint says, as far as siblings are compared by it. Plain data.

use super::ripple::Ripple;
use crate::parameter::Parameter;

/// A recording of a joint, fitted.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name of the joint, unique within the fleet.
    pub joint: String,
    /// What its siblings are: joints of one kind are compared with each other.
    pub kind: String,
    /// Day of the recording, counted from any day that all share, and parts of a day; `None` where it is not known.
    pub day: Option<f64>,
    /// Unit of torque, force or current as printed.
    pub unit: String,
    /// Friction laws of the literature, all fitted to the same samples.
    pub laws: Vec<FittedLaw>,
    /// The law in the image over velocity: velocity, friction, its standard error (0 where that is not known); velocities increase.
    pub curve: Vec<[f64; 3]>,
    /// Root mean square of what the image leaves of the recorded actuator in motion, in `unit`.
    pub residual: f64,
    /// The strongest wave over position in that residual.
    pub ripple: Option<Ripple>,
}

/// A friction law of the literature, fitted.
#[derive(Clone, Debug)]
pub struct FittedLaw {
    /// Its name.
    pub name: String,
    /// Bayesian information criterion; lower is better.
    pub bic: f64,
    /// Its constants, then those of the rigid body.
    pub parameters: Vec<Parameter>,
}
