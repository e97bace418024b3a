//! Beam search over structures. Every constant is refitted jointly for every candidate; the score pays for constants.

use rayon::prelude::*;

use super::library::{self, Move};
use super::proposals::Start;
use crate::law::fitting::problem::grid::Ground;
use crate::law::fitting::problem::{Effort, Fit, Held, Problem};
use crate::law::judge::choice::{Explored, best};
use crate::law::judge::criterion::Evidence;
use crate::law::model::structure::{Nonlinear, Shape, SignForm, Structure, Term};

/// How far the search goes.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Structures kept from round to round.
    pub width: usize,
    /// Most rounds.
    pub rounds: usize,
    /// Additions and exchanges of a structure that are refitted, the most promising first.
    pub refits: usize,
}

fn seeds() -> Vec<Structure> {
    let of = |shapes: &[Shape]| Structure::new(SignForm::Tanh, shapes.iter().copied().map(Term::plain));
    vec![
        of(&[]),
        of(&[Shape::Offset]),
        of(&[Shape::Viscous]),
        of(&[Shape::Sign]),
        of(&[Shape::Sign, Shape::Viscous]),
        of(&[Shape::Sign, Shape::StribeckExponential]),
        of(&[Shape::Sign, Shape::StribeckExponential, Shape::Viscous]),
        of(&[Shape::Sign, Shape::StribeckGaussian, Shape::Viscous]),
    ]
}

/// Explores structures on `problem`. `extra` are more structures to start from.
pub fn explore(problem: &Problem<'_>, beam: Beam, evidence: Evidence, extra: &[Start]) -> Explored {
    let library = library::terms(problem.data(), problem);
    let mut starts: Vec<Start> =
        seeds().into_iter().map(|structure| Start { structure, constants: Vec::new() }).collect();
    starts.extend(extra.iter().cloned());
    let fits: Vec<Fit> = starts
        .par_iter()
        .map(|s| problem.fit_grid(&s.structure, &s.constants, Held::default(), 2, Effort::SEARCH))
        .collect();
    let mut explored = Explored::new();
    for fit in fits {
        if explored.get(&fit.structure).is_none_or(|known| fit.rss < known.rss) {
            explored.insert(fit.structure.clone(), fit);
        }
    }
    let mut expanded: Vec<Structure> = Vec::new();
    for _ in 0..beam.rounds {
        let parents: Vec<&Fit> = best(problem, &explored, evidence, beam.width)
            .into_iter()
            .filter(|f| !expanded.contains(&f.structure))
            .collect();
        if parents.is_empty() {
            break;
        }
        expanded.extend(parents.iter().map(|f| f.structure.clone()));
        let mut children: Vec<Child> = parents
            .par_iter()
            .flat_map_iter(|parent| promising(problem, parent, &library, beam.refits, evidence))
            .collect();
        // A structure known from a worse start is worth another fit.
        children.retain(|c| explored.get(&c.structure).is_none_or(|known| c.rss < 0.999 * known.rss));
        children.sort_by(|a, b| a.structure.cmp(&b.structure).then(a.rss.total_cmp(&b.rss)));
        children.dedup_by(|a, b| a.structure == b.structure);
        let fits: Vec<Fit> = children
            .par_iter()
            .map(|c| problem.fit_grid(&c.structure, &c.start, Held::default(), 1, Effort::SEARCH))
            .collect();
        for fit in fits {
            let better = explored.get(&fit.structure).is_none_or(|known| fit.rss < known.rss);
            if better {
                expanded.retain(|s| *s != fit.structure);
                explored.insert(fit.structure.clone(), fit);
            }
        }
    }
    explored
}

struct Child {
    structure: Structure,
    start: Vec<(Nonlinear, f64)>,
    rss: f64,
}

/// Children of a fit: all simplifications and changes of smoothing, and the additions and exchanges that promise most
/// before the other constants are refitted.
fn promising(
    problem: &Problem<'_>,
    parent: &Fit,
    library: &[Vec<Term>],
    refits: usize,
    evidence: Evidence,
) -> Vec<Child> {
    let mut sure = Vec::new();
    let mut screened = Vec::new();
    // Many terms are put in the place of the same ones.
    let mut grounds: Vec<(Vec<Term>, Ground)> = Vec::new();
    for change in library::moves(&parent.structure, library) {
        let structure = change.apply(&parent.structure);
        let mut start = change.carry_over(parent);
        if change.added.is_empty() {
            let rss = complete(problem, &structure, &mut start);
            sure.push(Child { structure, start, rss });
            continue;
        }
        if !grounds.iter().any(|(removed, _)| *removed == change.removed) {
            grounds.push((change.removed.clone(), problem.ground(&reduced(parent, &change))));
        }
        let ground = grounds.iter().find(|(removed, _)| *removed == change.removed);
        let (found, rss) = problem.screen(&ground.expect("it was put there").1, &change.added);
        start.extend(found.into_iter().filter(|(n, _)| parent.nonlinear().iter().all(|(k, _)| k != n)));
        let cost = structure.constants() as f64;
        let score = evidence.misfit(rss / problem.rows() as f64) + 0.5 * libm::log(evidence.effective) * cost;
        screened.push((score, Child { structure, start, rss }));
    }
    screened.sort_by(|a, b| a.0.total_cmp(&b.0));
    sure.extend(screened.into_iter().take(refits).map(|(_, c)| c));
    sure
}

/// Adds to `start` the value of the one constant that it may lack, the best on its grid; the sum of squares then.
fn complete(problem: &Problem<'_>, structure: &Structure, start: &mut Vec<(Nonlinear, f64)>) -> f64 {
    let known = |n: &Nonlinear, start: &[(Nonlinear, f64)]| start.iter().find(|(k, _)| k == n).map(|(_, x)| *x);
    let names = structure.nonlinear();
    let sum = problem.sums(structure);
    let rss = |start: &[(Nonlinear, f64)]| sum(&names.iter().filter_map(|n| known(n, start)).collect::<Vec<_>>());
    let Some(open) = names.iter().position(|n| known(n, start).is_none()) else { return rss(start) };
    let tried = problem.ranges(structure)[open].starts.clone().into_iter().map(|value| {
        let mut trial = start.clone();
        trial.push((names[open], value));
        (rss(&trial), trial)
    });
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a grid has at least one point");
    *start = best.1;
    best.0
}

/// The parent without the removed terms, its non-linear constants where they were.
fn reduced(parent: &Fit, change: &Move) -> Fit {
    let kept: Vec<Term> = parent.structure.terms().iter().copied().filter(|t| !change.removed.contains(t)).collect();
    let structure = Structure::new(parent.structure.sign(), kept);
    let known = parent.nonlinear();
    let mut params: Vec<f64> =
        structure.nonlinear().iter().filter_map(|n| known.iter().find(|(k, _)| k == n).map(|(_, x)| *x)).collect();
    params.resize(params.len() + structure.terms().len(), 0.0);
    Fit { params, structure, rss: f64::INFINITY, converged: false, dependent: Vec::new() }
}
