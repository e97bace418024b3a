//! A candidate with its fitted shape and coefficients.

use crate::diagnose::hypotheses::label::Label;
use crate::physics::Shape;

/// A finding after the joint refit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// What it is.
    pub label: Label,
    /// Shape parameters.
    pub shape: Shape,
    /// Deviation of each shape parameter; `None` for discrete ones.
    pub shape_deviation: Vec<Option<f64>>,
    /// Linear coefficients.
    pub coefficients: Vec<f64>,
    /// Their standard deviations.
    pub deviation: Vec<f64>,
}
