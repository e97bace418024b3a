//! Which of the explored laws is taken: scored on held-out blocks, and no richer than it is worth.

use std::collections::BTreeMap;

use super::criterion::Evidence;
use crate::law::fitting::problem::{Effort, Fit, Held, Problem};
use crate::law::model::canonical::canonical;
use crate::law::model::expression::Expr;
use crate::law::model::structure::{Modulation, Nonlinear, Shape, Structure, Term};

/// Candidates of best score that are examined on held-out blocks.
const FINALISTS_BY_SCORE: usize = 10;
/// Candidates that are the best of their complexity.
const FINALISTS_BY_COMPLEXITY: usize = 6;

/// A law beyond the budget of nodes must be better by this factor of the held-out mean square.
const HELD_OUT_RATIO_THRESHOLD: f64 = 1.15;

/// Every structure that was fitted, by structure.
pub type Explored = BTreeMap<Structure, Fit>;

/// A law on the front of error against complexity.
#[derive(Clone, Debug)]
pub struct FrontEntry {
    /// Which law.
    pub structure: Structure,
    /// Its non-linear constants, in the order of [`Structure::nonlinear`].
    pub constants: Vec<f64>,
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

/// A polished law with its held-out error.
pub(in crate::law) struct Candidate {
    pub(in crate::law) fit: Fit,
    expression: Expr,
    nodes: usize,
    rmse: f64,
    held_out: f64,
    score: f64,
}

impl Candidate {
    pub(in crate::law) fn new(problem: &Problem<'_>, fit: Fit, evidence: Evidence, folds: usize) -> Self {
        let held_out = held_out_mean_square(problem, &fit, Held::default(), folds);
        let expression = canonical(&fit.structure.template(problem.extents().layout()).bind(&fit.params));
        Self {
            nodes: expression.node_count(),
            expression,
            rmse: (fit.rss / problem.rows() as f64).sqrt(),
            score: evidence.held_out(&fit, held_out),
            held_out,
            fit,
        }
    }
}

/// The structures of best score, best first.
pub fn best<'a>(problem: &Problem<'_>, explored: &'a Explored, evidence: Evidence, count: usize) -> Vec<&'a Fit> {
    let mut ranked: Vec<(f64, &Fit)> =
        explored.values().filter(|f| usable(problem, f)).map(|f| (evidence.score(f), f)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.structure.cmp(&b.1.structure)));
    ranked.into_iter().take(count).map(|(_, f)| f).collect()
}

/// Whether no constant has run to the end of its range, where a law is no longer itself (the smoothing of the sign may:
/// then it is a step).
fn is_inside(problem: &Problem<'_>, fit: &Fit) -> bool {
    let ranges = problem.ranges(&fit.structure);
    fit.nonlinear().iter().zip(&ranges).all(|((n, x), r)| *n == Nonlinear::Smoothing || !r.is_end(*x))
}

/// Whether a law of the literature is itself: no constant at the end of its range, and no negative Coulomb torque, which no motion has and which
/// stands for speeds beyond those recorded. Within its bounds such a law is best where it is a simpler one.
pub(in crate::law) fn is_itself(problem: &Problem<'_>, fit: &Fit) -> bool {
    let is_coulomb = |term: &Term| term.shape == Shape::Sign && term.modulation == Modulation::Plain;
    let mut of_coulomb = fit.structure.terms().iter().zip(fit.coefficients()).filter(|(term, _)| is_coulomb(term));
    is_inside(problem, fit) && of_coulomb.all(|(_, torque)| *torque >= 0.0)
}

/// Whether every term adds something, every number is finite and no constant has run to the end of its range.
fn usable(problem: &Problem<'_>, fit: &Fit) -> bool {
    is_inside(problem, fit)
        && fit.rss.is_finite()
        && fit.params.iter().all(|p| p.is_finite())
        && !fit.dependent.contains(&true)
}

/// The laws of best score, and the best of each smaller complexity.
pub(in crate::law) fn finalists(problem: &Problem<'_>, explored: &Explored, evidence: Evidence) -> Vec<Fit> {
    let layout = problem.extents().layout();
    let ranked = best(problem, explored, evidence, explored.len());
    let mut chosen: Vec<Fit> = ranked.iter().take(FINALISTS_BY_SCORE).map(|f| (*f).clone()).collect();
    let nodes = |f: &Fit| f.structure.template(layout).node_count();
    let mut least = chosen.iter().map(&nodes).min().unwrap_or(0);
    for fit in ranked.into_iter().skip(FINALISTS_BY_SCORE) {
        if chosen.len() == FINALISTS_BY_SCORE + FINALISTS_BY_COMPLEXITY {
            break;
        }
        if nodes(fit) < least {
            least = nodes(fit);
            chosen.push(fit.clone());
        }
    }
    chosen
}

/// The best score within the budget of nodes; beyond it only where that reduces the held-out mean square materially.
pub(in crate::law) fn choose<'a>(candidates: &'a [Candidate], max_nodes: usize) -> &'a Candidate {
    let leading = |within: &dyn Fn(&Candidate) -> bool| -> Option<&'a Candidate> {
        candidates
            .iter()
            .filter(|c| within(c))
            .min_by(|a, b| a.score.total_cmp(&b.score).then_with(|| a.fit.structure.cmp(&b.fit.structure)))
    };
    let free = leading(&|_| true).expect("the empty law is always a candidate");
    let within = leading(&|c| c.nodes <= max_nodes);
    within.filter(|c| c.held_out <= HELD_OUT_RATIO_THRESHOLD * free.held_out).unwrap_or(free)
}

/// Those that are better than every simpler one.
pub(in crate::law) fn front(candidates: &[Candidate]) -> Vec<FrontEntry> {
    let mut sorted: Vec<&Candidate> = candidates.iter().collect();
    sorted.sort_by(|a, b| a.nodes.cmp(&b.nodes).then(a.held_out.total_cmp(&b.held_out)));
    let mut least = f64::INFINITY;
    sorted.retain(|c| {
        let better = c.held_out < least;
        least = least.min(c.held_out);
        better
    });
    let entry = |c: &Candidate| FrontEntry {
        structure: c.fit.structure.clone(),
        constants: c.fit.constants().to_vec(),
        expression: c.expression.clone(),
        nodes: c.nodes,
        rmse: c.rmse,
        held_out_rmse: c.held_out.sqrt(),
        score: c.score,
    };
    sorted.into_iter().map(entry).collect()
}

/// Mean square over all samples, each predicted from constants fitted without its block; the mean square of the fit itself
/// where there is but one block. Constants in `held` stay where they are.
pub(in crate::law) fn held_out_mean_square(problem: &Problem<'_>, fit: &Fit, held: Held<'_>, folds: usize) -> f64 {
    let (data, extents) = (problem.data(), problem.extents());
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
        let refit = problem.fit_from(&fit.structure, fit.constants(), held, Effort::COMPARISON);
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
