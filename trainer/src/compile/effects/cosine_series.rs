//! Friction over the position of a joint, as the diagnosis finds it.

use crate::compile::formula::Curve;
use crate::compile::interval::Interval;
use crate::compile::series::{ORDERS, Series};

/// `sum c_j cos(j pi x)` with `x` from 0 to 1 over the travel.
pub(super) struct CosineSeries {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) coefficients: Vec<f64>,
}

impl Curve for CosineSeries {
    fn value(&self, x: f64) -> f64 {
        let angle = std::f64::consts::PI * ((x - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.coefficients.iter().zip(1..).map(|(c, j)| c * (f64::from(j) * angle).cos()).sum()
    }

    fn series(&self, _over: Interval) -> Series {
        // No enclosure is claimed: the table of an effect is checked against the recording.
        Series([Interval::ENTIRE; ORDERS])
    }
}
