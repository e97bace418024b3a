//! From samples to a named law: search, choice on held-out blocks, polish, uncertainty, names.

use rayon::prelude::*;

use super::canonical::canonical;
use super::choice::{Candidate, FrontEntry, choose, finalists, front};
use super::data::{LawData, LawError};
use super::expression::Expr;
use super::fit::{Fit, Problem};
use super::known_forms::polish;
use super::naming::name_all;
use super::price::{EXACT, Evidence, correlation_length};
use super::proposals::Start;
use super::ranges::Extents;
use super::rounding::rounded;
use super::search::{Beam, best, explore};
use super::settle::{allow_for_viscous, drop_undetermined, settle_smoothing};
use super::structure::{Nonlinear, Structure};
use super::uncertainty::{Interval, NORMAL_95, Uncertainty, analyse};

/// How to search, and which law is simple enough.
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
    /// Nodes that a law may have; one with more is taken only where it reduces the held-out mean square by 15 %.
    pub max_nodes: usize,
    /// Where to start besides the usual structures, for instance what the activations of a pruned network suggest.
    pub starts: Vec<Start>,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self { beam_width: 6, rounds: 8, search_samples: 2000, folds: 5, max_nodes: 20, starts: Vec::new() }
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
    let explored = explore(searched, beam, evidence_of(searched, None), &options.starts);

    let rough = evidence_of(searched, best(searched, &explored, evidence_of(searched, None), 1).first().copied());
    let finalists: Vec<Fit> =
        finalists(searched, &explored, rough).par_iter().map(|f| polish(&problem, f, &[])).collect();
    let evidence = evidence_of(&problem, finalists.first());
    let candidates: Vec<Candidate> =
        finalists.into_par_iter().map(|fit| Candidate::new(&problem, fit, evidence, options.folds.max(2))).collect();
    let front = front(&candidates);
    let chosen = choose(&candidates, options.max_nodes).fit.clone();
    let mut remarks = Vec::new();
    let chosen = drop_undetermined(&problem, chosen, evidence, &mut remarks);
    let (fit, held) = settle_smoothing(&problem, chosen, evidence, &mut remarks);
    let mut uncertainty = analyse(&problem, &fit, &held, Interval::Profile);
    allow_for_viscous(&problem, &fit, &held, &mut uncertainty, &mut remarks);
    let fit = rounded(&problem, &fit, &uncertainty);
    let law = describe(&problem, &fit, &uncertainty, &held);
    let nuisance = nuisance_coefficients(&problem, &fit, &uncertainty);
    Ok(Discovery {
        law,
        front,
        remarks,
        nuisance,
        rmse: (fit.rss / data.rows() as f64).sqrt(),
        r2: 1.0 - fit.rss / problem.total().max(f64::MIN_POSITIVE),
        explored: explored.len(),
    })
}

/// Held-out blocks guard against what correlated residuals pretend, so that no fewer samples than this are counted.
const LEAST_EFFECTIVE: f64 = 200.0;

fn evidence_of(problem: &Problem<'_>, fit: Option<&Fit>) -> Evidence {
    let rows = problem.rows();
    let length = fit.map_or(1.0, |f| correlation_length(&problem.residuals(f)));
    Evidence {
        rows,
        effective: (rows as f64 / length).max(LEAST_EFFECTIVE.min(rows as f64)),
        exact: EXACT * EXACT * problem.total() / rows as f64,
    }
}

/// Coefficients of the nuisance columns with their intervals.
pub(super) fn nuisance_coefficients(
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
