//! From samples to a named law: search, choice on held-out blocks, polish, uncertainty, names.

use rayon::prelude::*;
use std::collections::BTreeMap;

use super::beam::{Beam, explore};
use super::proposals::Start;
use crate::law::fitting::problem::{Fit, Problem};
use crate::law::judge::choice::{Candidate, FrontEntry, best, choose, finalists, front};
use crate::law::judge::criterion::{Evidence, correlation_length};
use crate::law::judge::description::{Law, NuisanceCoefficient, describe, nuisance_coefficients};
use crate::law::judge::rounding::rounded;
use crate::law::judge::uncertainty::{Interval, analyse};
use crate::law::judge::undetermined::{allow_for_viscous, drop_undetermined, fix_smoothing};
use crate::law::model::data::{LawData, LawError};
use crate::law::model::ranges::Extents;
use crate::law::model::structure::Structure;

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
    /// Which intervals the chosen law is given.
    pub intervals: Interval,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            beam_width: 6,
            rounds: 8,
            search_samples: 2000,
            folds: 5,
            max_nodes: 20,
            starts: Vec::new(),
            intervals: Interval::Profile,
        }
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Discovery {
    /// The chosen law.
    pub law: Law,
    /// Laws that no simpler one equals, by complexity.
    pub front: Vec<FrontEntry>,
    /// What else the data do not determine, in sentences.
    pub remarks: Vec<String>,
    /// Coefficients of the nuisance columns beside the chosen law.
    pub nuisance: Vec<NuisanceCoefficient>,
    /// Root mean square of the residuals of the chosen law, unit of the target.
    pub rmse: f64,
    /// Share of the target's variance (after the nuisance columns) that the law explains.
    pub r2: f64,
    /// Structures fitted, each with its non-linear constants on the samples that structures were ranked on.
    pub explored: BTreeMap<Structure, Vec<f64>>,
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
        finalists(searched, &explored, rough).par_iter().map(|f| problem.polish(f, &[])).collect();
    let evidence = evidence_of(&problem, finalists.first());
    let candidates: Vec<Candidate> =
        finalists.into_par_iter().map(|fit| Candidate::new(&problem, fit, evidence, options.folds.max(2))).collect();
    let front = front(&candidates);
    let chosen = choose(&candidates, options.max_nodes).fit.clone();
    let mut remarks = Vec::new();
    let chosen = drop_undetermined(&problem, chosen, evidence, &mut remarks);
    let (fit, held) = fix_smoothing(&problem, chosen, evidence, &mut Vec::new());
    let mut uncertainty = analyse(&problem, &fit, &held, options.intervals);
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
        explored: explored.into_iter().map(|(structure, fit)| (structure, fit.constants().to_vec())).collect(),
    })
}

fn evidence_of(problem: &Problem<'_>, fit: Option<&Fit>) -> Evidence {
    Evidence::of(problem, fit.map_or(1.0, |f| correlation_length(&problem.residuals(f))))
}
