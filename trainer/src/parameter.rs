//! A named physical parameter with its unit and interval, as results and reports carry it.

use serde::Serialize;

/// What is said of a value that the samples leave open.
pub(crate) const NOT_DETERMINED: &str = "not determined";

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// The field's name, e.g. `coulomb_torque`.
    pub name: String,
    /// Symbol in the equation.
    pub symbol: String,
    /// Estimate in `unit`.
    pub value: f64,
    /// SI unit as text, e.g. `N m s/rad`.
    pub unit: String,
    /// 95 % confidence interval.
    pub ci95: [f64; 2],
}

impl Parameter {
    /// Why there is no interval to state, in words; `None` where there is one.
    #[must_use]
    pub fn without_interval(&self) -> Option<&'static str> {
        match self.ci95 {
            [f64::NEG_INFINITY, f64::INFINITY] => Some("not told apart from others"),
            [low, high] if low < high => None,
            _ => Some(NOT_DETERMINED),
        }
    }
}
