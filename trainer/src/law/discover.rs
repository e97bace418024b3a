//! From samples to a named law: search, choice on held-out blocks, polish, uncertainty, names.

use rayon::prelude::*;

use super::canonical::canonical;
use super::data::{LawData, LawError};
use super::expression::Expr;
use super::fit::{Effort, Fit, Held, Problem};
use super::known_forms::polish;
use super::naming::name_all;
use super::price::{EXACT, Evidence, correlation_length};
use super::ranges::Extents;
use super::search::{Beam, best, explore};
use super::structure::{Nonlinear, Shape, SignForm, Structure, Term};
use super::uncertainty::{Interval, Uncertainty, analyse};

/// How to search.
#[derive(Clone, Debug)]
pub struct SearchOptions {
    /// Structures kept from round to round, at least 1.
    pub beam_width: usize,
    /// Most rounds.
    pub rounds: usize,
    /// Most samples used while structures are ranked; the chosen law is fitted to all.
    pub search_samples: usize,
    /// Parts into which the blocks are grouped for holding out, at least 2.
    pub folds: usize,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self { beam_width: 6, rounds: 8, search_samples: 4000, folds: 5 }
    }
}

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

/// A law on the front of error against complexity.
#[derive(Clone, Debug)]
pub struct FrontEntry {
    /// Which law.
    pub structure: Structure,
    /// With numbers.
    pub expression: Expr,
    /// Nodes of the expression.
    pub nodes: usize,
    /// Root mean square of the residuals, unit of the target.
    pub rmse: f64,
    /// The same over blocks that were held out in turn.
    pub held_out_rmse: f64,
    /// What was minimised, nats.
    pub score: f64,
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

/// What was found.
#[derive(Clone, Debug)]
pub struct Discovery {
    /// The chosen law.
    pub law: Law,
    /// Laws that no simpler one equals, by complexity.
    pub front: Vec<FrontEntry>,
    /// What the data do not determine, in sentences.
    pub remarks: Vec<String>,
    /// Coefficients of the nuisance columns beside the chosen law.
    pub nuisance: Vec<NuisanceCoefficient>,
    /// Root mean square of the residuals of the chosen law, unit of the target.
    pub rmse: f64,
    /// Share of the target's variance (after the nuisance columns) that the law explains.
    pub r2: f64,
    /// Structures fitted.
    pub explored: usize,
}

/// Looks for the law.
///
/// # Errors
/// When no law can be looked for in the data, see [`LawError`].
pub fn discover(data: &LawData, options: &SearchOptions) -> Result<Discovery, LawError> {
    let extents = Extents::new(data)?;
    let problem = Problem::new(data, &extents);
    let stride = data.rows().div_ceil(options.search_samples.max(1));
    let thinned = (stride > 1).then(|| data.select(&(0..data.rows()).step_by(stride).collect::<Vec<_>>()));
    let small = thinned.as_ref().map(|d| Problem::new(d, &extents));
    let beam = Beam { width: options.beam_width.max(1), rounds: options.rounds, refits: 5 };
    let searched = small.as_ref().unwrap_or(&problem);
    let explored = explore(searched, beam, evidence_of(searched, None), &[]);

    let rough = evidence_of(searched, best(&explored, evidence_of(searched, None), 1).first().copied());
    let finalists: Vec<Fit> = best(&explored, rough, 12).par_iter().map(|f| polish(&problem, f, &[])).collect();
    let evidence = evidence_of(&problem, finalists.first());
    let mut ranked: Vec<(f64, f64, Fit)> = finalists
        .into_par_iter()
        .map(|fit| {
            let held_out = held_out_mean_square(data, &extents, &fit, options.folds.max(2));
            (evidence.held_out(&fit, held_out), held_out, fit)
        })
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.2.structure.cmp(&b.2.structure)));
    let front = front(&problem, &ranked);
    let chosen = ranked.remove(0).2;
    let mut remarks = Vec::new();
    let (fit, held) = settle_smoothing(&problem, chosen, evidence, &mut remarks);
    let mut uncertainty = analyse(&problem, &fit, &held, Interval::Profile);
    allow_for_viscous(&problem, &fit, &held, &mut uncertainty, &mut remarks);
    let law = describe(&problem, &fit, &uncertainty, &held);
    let nuisance = data
        .nuisance
        .iter()
        .zip(problem.nuisance_coefficients(&fit))
        .zip(&uncertainty.nuisance)
        .map(|((n, value), (_, se))| NuisanceCoefficient {
            name: n.name.clone(),
            value,
            unit: n.unit.clone(),
            ci95: [value - 1.96 * se, value + 1.96 * se],
        })
        .collect();
    let mean = data.target.len() as f64;
    Ok(Discovery {
        law,
        front,
        remarks,
        nuisance,
        rmse: (fit.rss / mean).sqrt(),
        r2: 1.0 - fit.rss / problem.total().max(f64::MIN_POSITIVE),
        explored: explored.len(),
    })
}

fn evidence_of(problem: &Problem<'_>, fit: Option<&Fit>) -> Evidence {
    let rows = problem.rows();
    let length = fit.map_or(1.0, |f| correlation_length(&problem.residuals(f)));
    Evidence { rows, effective: (rows as f64 / length).max(10.0), exact: EXACT * EXACT * problem.total() / rows as f64 }
}

/// Mean square over all samples, each predicted from constants fitted without its block.
fn held_out_mean_square(data: &LawData, extents: &Extents, fit: &Fit, folds: usize) -> f64 {
    let mut labels = data.blocks.clone();
    labels.sort_unstable();
    labels.dedup();
    let folds = folds.min(labels.len());
    if folds < 2 {
        return fit.rss / data.rows() as f64;
    }
    let fold_of = |block: usize| labels.partition_point(|l| *l < block) * folds / labels.len();
    let mut sum = 0.0;
    for fold in 0..folds {
        let (test, train): (Vec<usize>, Vec<usize>) = (0..data.rows()).partition(|&r| fold_of(data.blocks[r]) == fold);
        let (train, test) = (data.select(&train), data.select(&test));
        let problem = Problem::new(&train, extents);
        let psi = &fit.params[..fit.structure.nonlinear().len()];
        let refit = problem.fit_from(&fit.structure, psi, Held::default(), Effort::FINAL);
        let beta = problem.nuisance_coefficients(&refit);
        let law = Problem::new(&test, extents).law_values(&refit);
        for (row, f) in law.iter().enumerate() {
            let along: f64 = test.nuisance.iter().zip(&beta).map(|(n, b)| n.values[row] * b).sum();
            sum += (test.target[row] - f - along).powi(2);
        }
    }
    let mean_square = sum / data.rows() as f64;
    if mean_square.is_finite() { mean_square } else { f64::INFINITY }
}

/// Those of the ranked laws that are better than every simpler one.
fn front(problem: &Problem<'_>, ranked: &[(f64, f64, Fit)]) -> Vec<FrontEntry> {
    let layout = problem.extents().layout();
    let mut entries: Vec<FrontEntry> = ranked
        .iter()
        .map(|(score, held_out, fit)| {
            let expression = canonical(&fit.structure.template(layout).bind(&fit.params));
            FrontEntry {
                structure: fit.structure.clone(),
                nodes: expression.node_count(),
                expression,
                rmse: (fit.rss / problem.rows() as f64).sqrt(),
                held_out_rmse: held_out.sqrt(),
                score: *score,
            }
        })
        .collect();
    entries.sort_by(|a, b| a.nodes.cmp(&b.nodes).then(a.held_out_rmse.total_cmp(&b.held_out_rmse)));
    let mut least = f64::INFINITY;
    entries.retain(|e| {
        let better = e.held_out_rmse < least;
        least = least.min(e.held_out_rmse);
        better
    });
    entries
}

/// Fixes the smoothing of the sign where the data cannot tell it from a step.
fn settle_smoothing(
    problem: &Problem<'_>,
    fit: Fit,
    evidence: Evidence,
    remarks: &mut Vec<String>,
) -> (Fit, Vec<Nonlinear>) {
    let names = fit.structure.nonlinear();
    let Some(at) = names.iter().position(|n| *n == Nonlinear::Smoothing) else { return (fit, Vec::new()) };
    let sign = fit.structure.sign();
    let bound = problem.extents().steepest(sign);
    let mut psi = fit.params[..names.len()].to_vec();
    psi[at] = bound;
    let held = vec![Nonlinear::Smoothing];
    let fixed = problem.fit_from(&fit.structure, &psi, Held { nonlinear: &held, coefficient: None }, Effort::FINAL);
    let rows = problem.rows() as f64;
    let worse = 2.0 * (evidence.misfit(fixed.rss / rows) - evidence.misfit(fit.rss / rows));
    if worse > 3.84 {
        return (fit, Vec::new());
    }
    let constant = match sign {
        SignForm::Tanh | SignForm::Arctan => "slope",
        SignForm::Algebraic | SignForm::Parabolic | SignForm::Cubic => "width",
    };
    remarks.push(format!(
        "The smoothing of the sign is not determined: too few samples near zero velocity. Its {constant} is fixed at {bound:.3}, the \
         steepest that these data could tell from a step."
    ));
    (fixed, held)
}

/// Every joint has some viscous friction. Where it cannot be seen, the intervals of the other constants allow for it.
fn allow_for_viscous(
    problem: &Problem<'_>,
    fit: &Fit,
    held: &[Nonlinear],
    uncertainty: &mut Uncertainty,
    remarks: &mut Vec<String>,
) {
    let sees_speed = |t: &Term| {
        matches!(t.shape, Shape::Viscous | Shape::Quadratic | Shape::OddPower | Shape::OddRoot | Shape::SignPower)
    };
    let exact = uncertainty.noise <= EXACT * (problem.total() / problem.rows() as f64).sqrt();
    if exact || fit.structure.terms().is_empty() || fit.structure.terms().iter().any(sees_speed) {
        return;
    }
    let viscous = Term::plain(Shape::Viscous);
    let wider = fit.structure.with(viscous);
    let psi = &fit.params[..fit.structure.nonlinear().len()];
    let refit = problem.fit_from(&wider, psi, Held { nonlinear: held, coefficient: None }, Effort::FINAL);
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

/// Names, units and intervals for a fitted law.
pub(super) fn describe(problem: &Problem<'_>, fit: &Fit, uncertainty: &Uncertainty, held: &[Nonlinear]) -> Law {
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
