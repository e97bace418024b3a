//! A named physical parameter with its unit and interval, as results and reports carry it.

use serde::Serialize;

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
