//! A fitted law with names, units and intervals.

use super::uncertainty::{NORMAL_95, Uncertainty};
use crate::law::fitting::problem::{Fit, Problem};
use crate::law::model::canonical::canonical;
use crate::law::model::expression::Expr;
use crate::law::model::naming::name_all;
use crate::law::model::structure::{Nonlinear, Structure};

/// A named constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// `coulomb_torque`.
    pub name: String,
    /// `F_c`.
    pub symbol: String,
    /// In the unit.
    pub value: f64,
    /// `N m`.
    pub unit: String,
    /// 95 % interval; infinite where the data set no bound.
    pub ci95: [f64; 2],
    /// Whether the data determine it; a constant that is not determined was fixed, or may as well be zero.
    pub determined: bool,
}

/// A law with numbers and names.
#[derive(Clone, Debug)]
pub struct Law {
    /// Which law.
    pub structure: Structure,
    /// With numbers, in canonical form.
    pub expression: Expr,
    /// With `Param(i)` for parameter `i`.
    pub template: Expr,
    /// Named constants, in the order of the template.
    pub parameters: Vec<Parameter>,
}

/// Coefficient of a nuisance column.
#[derive(Clone, Debug, PartialEq)]
pub struct NuisanceCoefficient {
    /// Name of the coefficient.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// Coefficients of the nuisance columns with their intervals.
pub(in crate::law) fn nuisance_coefficients(
    problem: &Problem<'_>,
    fit: &Fit,
    uncertainty: &Uncertainty,
) -> Vec<NuisanceCoefficient> {
    let coefficients = problem.nuisance_coefficients(fit);
    let columns = problem.data().nuisance.iter().zip(coefficients).zip(&uncertainty.nuisance);
    columns
        .map(|((column, value), (_, se))| NuisanceCoefficient {
            name: column.name.clone(),
            value,
            unit: column.unit.clone(),
            ci95: [value - NORMAL_95 * se, value + NORMAL_95 * se],
        })
        .collect()
}

/// Names, units and intervals for a fitted law.
pub(in crate::law) fn describe(problem: &Problem<'_>, fit: &Fit, uncertainty: &Uncertainty, held: &[Nonlinear]) -> Law {
    let layout = problem.extents().layout();
    let names = fit.structure.nonlinear();
    let template = fit.structure.template(layout);
    let parameters = name_all(&fit.structure, problem.data(), layout, &fit.params)
        .into_iter()
        .enumerate()
        .map(|(k, naming)| {
            let ci95 = uncertainty.intervals[k];
            let fixed = names.get(k).is_some_and(|n| held.contains(n));
            let bounded = ci95.iter().all(|x| x.is_finite());
            let not_zero = ci95[0] > 0.0 || ci95[1] < 0.0;
            Parameter {
                name: naming.name,
                symbol: naming.symbol,
                value: fit.params[k],
                unit: naming.unit,
                ci95,
                determined: !fixed && bounded && not_zero,
            }
        })
        .collect();
    Law { structure: fit.structure.clone(), expression: canonical(&template.bind(&fit.params)), template, parameters }
}
