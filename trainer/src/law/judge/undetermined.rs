//! What the data do not determine: left out, fixed, or allowed for in the intervals, and said in a sentence.

use super::criterion::{EXACT_RESIDUAL_RATIO, Evidence};
use super::uncertainty::{Interval, NORMAL_95, Uncertainty, analyse};
use crate::law::fitting::problem::{Effort, Fit, Held, Problem};
use crate::law::model::admissible::admissible;
use crate::law::model::naming::name_all;
use crate::law::model::structure::{Nonlinear, Shape, SignForm, Term};
use crate::law::render::significant;

/// Half the rise of twice the negative log likelihood at which a constant is distinguished from zero with 95 %.
const DROP_THRESHOLD_NATS: f64 = 0.5 * NORMAL_95 * NORMAL_95;

/// Takes out, one by one, terms that may as well be zero once the correlation of the residuals is counted: by their standard
/// error, and by what leaving them out, all else refitted, does to the likelihood.
pub(in crate::law) fn drop_undetermined(
    problem: &Problem<'_>,
    mut fit: Fit,
    evidence: Evidence,
    remarks: &mut Vec<String>,
) -> Fit {
    let misfit = |fit: &Fit| evidence.misfit(fit.rss / problem.rows() as f64);
    loop {
        let uncertainty = analyse(problem, &fit, &[], Interval::Linearised);
        let first = fit.structure.nonlinear().len();
        let weight = |i: usize| fit.params[first + i].abs() / uncertainty.standard_errors[first + i];
        let weakest = (0..fit.structure.terms().len())
            .filter(|&i| weight(i) < NORMAL_95 && admissible(&fit.structure.without(fit.structure.terms()[i])))
            .min_by(|a, b| weight(*a).total_cmp(&weight(*b)));
        let Some(weakest) = weakest else { return fit };
        let simpler = fit.structure.without(fit.structure.terms()[weakest]);
        let rough = problem.fit_grid(&simpler, &fit.nonlinear(), Held::default(), 1, Effort::SEARCH);
        let without = problem.polish(&rough, &[]);
        if misfit(&without) - misfit(&fit) > DROP_THRESHOLD_NATS {
            return fit;
        }
        let naming =
            &name_all(&fit.structure, problem.data(), problem.extents().layout(), &fit.params)[first + weakest];
        remarks.push(format!(
            "{} = {} ± {} {} is not determined and left out.",
            naming.name,
            significant(fit.params[first + weakest], 3),
            significant(NORMAL_95 * uncertainty.standard_errors[first + weakest], 2),
            naming.unit
        ));
        fit = without;
    }
}

/// Twice the negative log likelihood that a wider smoothing may cost where the data cannot tell it from a step: it moves no other constant by
/// more than a third of its standard error.
const SMOOTHING_COST: f64 = 0.1;

/// Fixes the smoothing of the sign where the data cannot tell it from a step.
pub(in crate::law) fn fix_smoothing(
    problem: &Problem<'_>,
    fit: Fit,
    evidence: Evidence,
    remarks: &mut Vec<String>,
) -> (Fit, Vec<Nonlinear>) {
    let names = fit.structure.nonlinear();
    let Some(at) = names.iter().position(|n| *n == Nonlinear::Smoothing) else { return (fit, Vec::new()) };
    let sign = fit.structure.sign();
    let held = vec![Nonlinear::Smoothing];
    let rows = problem.rows() as f64;
    let with_width = |width: f64| -> (Fit, f64) {
        let mut psi = fit.constants().to_vec();
        psi[at] = sign.from_width(width);
        let fixed =
            problem.fit_from(&fit.structure, &psi, Held { nonlinear: &held, coefficient: None }, Effort::SEARCH);
        let worse = 2.0 * (evidence.misfit(fixed.rss / rows) - evidence.misfit(fit.rss / rows));
        (fixed, worse)
    };
    let steepest = sign.width(problem.extents().steepest(sign));
    if with_width(steepest).1 > 3.84 {
        // Steeper than can be told is a step, however steep.
        let is_step = sign.width(fit.params[at]) <= steepest;
        return if is_step { (problem.polish(&fit, &held), held) } else { (fit, Vec::new()) };
    }
    // The widest that is as good, by bisection in the logarithm.
    let (mut good, mut bad) = (steepest, problem.extents().fastest());
    for _ in 0..12 {
        let middle = (good * bad).sqrt();
        if with_width(middle).1 < SMOOTHING_COST { good = middle } else { bad = middle }
    }
    let fixed = problem.polish(&with_width(good).0, &held);
    let bound = sign.from_width(good);
    let constant = match sign {
        SignForm::Tanh | SignForm::Arctan => "slope",
        SignForm::Algebraic | SignForm::Parabolic | SignForm::Cubic => "width",
    };
    remarks.push(format!(
        "The smoothing of the sign is not determined: too few samples near zero velocity. Its {constant} is fixed at {}, the smoothest \
         that fits as well as a step.",
        significant(bound, 4)
    ));
    (fixed, held)
}

/// Every joint has some viscous friction. Where it cannot be seen, the intervals of the other constants allow for it.
pub(in crate::law) fn allow_for_viscous(
    problem: &Problem<'_>,
    fit: &Fit,
    held: &[Nonlinear],
    uncertainty: &mut Uncertainty,
    remarks: &mut Vec<String>,
) {
    let sees_speed = |t: &Term| {
        matches!(t.shape, Shape::Viscous | Shape::Quadratic | Shape::OddPower | Shape::OddRoot | Shape::SignPower)
    };
    let exact = uncertainty.noise <= EXACT_RESIDUAL_RATIO * (problem.total() / problem.rows() as f64).sqrt();
    if exact || fit.structure.terms().is_empty() || fit.structure.terms().iter().any(sees_speed) {
        return;
    }
    let viscous = Term::plain(Shape::Viscous);
    let wider = fit.structure.with(viscous);
    let refit = problem.fit_from(&wider, fit.constants(), Held { nonlinear: held, coefficient: None }, Effort::FINAL);
    let more = analyse(problem, &refit, held, Interval::Profile);
    let added = wider.nonlinear().len() + wider.terms().iter().position(|t| *t == viscous).unwrap_or(0);
    let names = name_all(&wider, problem.data(), problem.extents().layout(), &refit.params);
    let [low, high] = more.intervals[added];
    remarks.push(format!(
        "A viscous term cannot be determined: {:.3} {} with a 95 % interval from {low:.3} to {high:.3}. It is left out; the intervals \
         of the other constants allow for it.",
        refit.params[added], names[added].unit
    ));
    let others = (0..refit.params.len()).filter(|k| *k != added);
    for (k, other) in others.enumerate() {
        let [low, high] = more.intervals[other];
        uncertainty.intervals[k] = [low.min(fit.params[k]), high.max(fit.params[k])];
        uncertainty.standard_errors[k] = more.standard_errors[other];
    }
}
