//! From both sides of a comparison to the probabilities of all sets of effects.

use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::predicted_blocks::temper_of;
use crate::diagnose::infer::refined::refined;
use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::size::{Size, Sizing};
use crate::diagnose::infer::weighing::{FIRST_PRICE, Weighing, friction_of};
use crate::diagnose::noise::autoregression::Noise;
use crate::inference::evidence::{Candidate, Model};
use crate::inference::posterior::Posterior;
use crate::inference::sets::{Field, Member};
use crate::numerics::least_squares::weighted;
use crate::physics::{EffectId, Hypothesis};

/// Rounds of noise, sets and refined shapes: the second has the noise of what the first found. A limit of the computing time.
const ROUNDS: usize = 2;
/// Leading sets beside which a shape may be of use. A limit of the computing time.
const LEADING_SETS: usize = 6;
/// Nats behind the best shape of its candidate from which a shape is no longer followed: a weight of one in three million.
const USEFUL_NATS: f64 = 15.0;
/// Probability of a candidate from which its shape is refined.
const REFINED_FROM: f64 = 0.01;
/// Probability of a set from which members that tell no cause are compared with refined effects.
const INSTEAD_FROM: f64 = 0.2;
/// Effects below the least torque beside which the others are weighed, from which on no more are taken. A limit of the computing time: as many as two sets.
const MOST_BELOW: usize = 8;
/// Effects that are refined in the place of one of them. A limit of the computing time.
const INSTEAD: usize = 4;

/// What was inferred.
pub(crate) struct Inferred {
    pub candidates: Candidates,
    pub posterior: Posterior,
    /// Shapes that the simulation shows by itself.
    pub shown: Vec<Member>,
    /// Torque of each member of the likeliest set beyond what base and common columns could take.
    pub sizes: Vec<Size>,
    /// Effects that are there and below what is named, with their torque, root mean square: the others are weighed beside them.
    pub below: Vec<(EffectId, f64)>,
    /// Torque, root mean square, that an effect has to exceed to be named.
    pub least: f64,
    /// Log evidence (nats, tempered) of each candidate alone.
    pub alone: Vec<f64>,
    pub noise: Noise,
    /// Exponent of the evidence.
    pub temper: f64,
    /// Tempered nats that a member has to bring.
    pub price: f64,
}

/// Weighs all candidates on the torque of `real`, beginning with the products for a noise; `seed` is that of the replays, `least` the torque,
/// root mean square, that an effect has to exceed.
pub(crate) fn infer(
    hypotheses: &[Box<dyn Hypothesis + Send>],
    mut candidates: Candidates,
    (real, simulated): (&Side, Option<&Side>),
    (mut weighing, mut noise): (Weighing, Noise),
    (seed, least): (u64, f64),
) -> Inferred {
    let friction = friction_of(real);
    let mut null = None;
    for _ in 0..ROUNDS {
        let weighed = candidates.weighed(friction, weighing.random());
        let field = Field { reduced: &weighing.reduced, candidates: &weighed, price: FIRST_PRICE, temper: 1.0 };
        let sets = field.search();
        let useful = field.useful(&sets[..LEADING_SETS.min(sets.len())], USEFUL_NATS);
        let posterior = Posterior::of(&field, sets);
        let likeliest = posterior.likeliest().map(|set| set.members.clone()).unwrap_or_default();
        if null.is_none() {
            // All shapes count for what noise alone reaches.
            null = Some(weighing.null(&weighed, &likeliest, seed));
        }
        let left = weighing.left(&candidates, real, &weighed, &likeliest);
        let of_members = weighted(&candidates.real, &weighing.own(&weighed, &likeliest));
        refine_shapes(hypotheses, &mut candidates, (real, simulated), &weighing, &field, &posterior, &noise);
        let alone = gains_alone(&weighing, &weighed);
        let is_best = |member: Member| {
            let gains = &alone[member.candidate];
            (0..gains.len()).max_by(|a, b| gains[*a].total_cmp(&gains[*b])) == Some(member.variant)
        };
        candidates = candidates.only(|member| {
            weighed[member.candidate].variants.len() <= member.variant
                || is_best(member)
                || useful.binary_search(&member).is_ok()
                || weighing.shown.contains(&member)
        });
        noise = Noise::fit(&left, &real.runs, &real.features_beside(&of_members, &left));
        weighing = Weighing::new(&candidates, real, simulated, &noise, friction);
    }
    let price_at = |temper: f64| null.as_ref().map_or(FIRST_PRICE, |null| null.price(temper));
    let (mut real, mut below) = (real.clone(), Vec::new());
    loop {
        let weighed = candidates.weighed(friction, weighing.random());
        let field = Field { reduced: &weighing.reduced, candidates: &weighed, price: price_at(1.0), temper: 1.0 };
        let sets = field.search();
        let temper = temper_of(&weighing, &real, &field, &sets);
        let price = price_at(temper);
        let field = Field { price, temper, ..field };
        let posterior = Posterior::of(&field, field.search());
        let members = posterior.likeliest().map(|set| set.members.clone()).unwrap_or_default();
        let sizing = Sizing { candidates: &candidates, real: &real, temper };
        let sizes = sizing.of_set(&weighing, &weighed, &members, least);
        let is_below = |(member, size): &(&Member, &Size)| {
            size.least < least && !candidates.entries[member.candidate].is_function()
        };
        let small: Vec<(Member, f64)> = if below.len() < MOST_BELOW {
            members.iter().zip(&sizes).filter(is_below).map(|(member, size)| (*member, size.torque)).collect()
        } else {
            Vec::new()
        };
        if small.is_empty() {
            let best = |gains: Vec<f64>| temper * gains.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let alone = gains_alone(&weighing, &weighed).into_iter().map(best).collect();
            let shown = weighing.shown;
            return Inferred { candidates, posterior, shown, sizes, below, least, alone, noise, temper, price };
        }
        for (member, torque) in small {
            below.push((candidates.entries[member.candidate].label.effect(), torque));
            let columns = candidates.entries[member.candidate].shapes[member.variant].columns.clone();
            real.columns.extend(columns.map(|place| candidates.real[place].clone()));
        }
        weighing = Weighing::new(&candidates, &real, simulated, &noise, friction);
    }
}

/// Nats of every shape of each candidate by itself.
fn gains_alone(weighing: &Weighing, weighed: &[Candidate]) -> Vec<Vec<f64>> {
    let nothing = Model::new(&weighing.reduced, &[]);
    let gain = |variant| nothing.as_ref().map_or(0.0, |model| model.gain(variant));
    weighed.iter().map(|candidate| candidate.variants.iter().map(gain).collect()).collect()
}

/// Sets with the member of each whose shape is refined: members of probable sets, and effects with a cause in the place of a function or an
/// event without one. A function has no shape to refine.
fn to_refine(candidates: &Candidates, field: &Field, posterior: &Posterior) -> Vec<(Vec<Member>, Member)> {
    let tells_no_cause = |member: &Member| candidates.entries[member.candidate].tells_no_cause();
    let mut sets: Vec<(Vec<Member>, Member)> = Vec::new();
    let mut add = |set: &[Member], member: Member| {
        let is_done = sets.iter().any(|(_, done)| done.candidate == member.candidate);
        let entry = &candidates.entries[member.candidate];
        if !entry.is_function() && (!is_done || entry.repeats) {
            sets.push((set.to_vec(), member));
        }
    };
    for (set, probability) in posterior.sets.iter().take_while(|(_, probability)| *probability >= REFINED_FROM) {
        set.members.iter().for_each(|member| add(&set.members, *member));
        if *probability < INSTEAD_FROM {
            continue;
        }
        for without_cause in set.members.iter().filter(|member| tells_no_cause(member)) {
            let others: Vec<Member> = set.members.iter().copied().filter(|other| other != without_cause).collect();
            let instead =
                field.extended(&others).into_iter().filter(|set| set.last().is_some_and(|m| !tells_no_cause(m)));
            instead.take(INSTEAD).for_each(|set| set.last().into_iter().for_each(|m| add(&set, *m)));
        }
    }
    sets
}

/// Adds refined shapes of the candidates that are probable.
fn refine_shapes(
    hypotheses: &[Box<dyn Hypothesis + Send>],
    candidates: &mut Candidates,
    (real, simulated): (&Side, Option<&Side>),
    weighing: &Weighing,
    field: &Field,
    posterior: &Posterior,
    noise: &Noise,
) {
    let weighed = field.candidates;
    for (set, member) in to_refine(candidates, field, posterior) {
        let others: Vec<Member> = set.iter().copied().filter(|other| *other != member).collect();
        // The common part and the others are taken off; what is left is for the shape.
        let mut coefficients = weighing.coefficients(weighed, &set);
        let beside_others = weighing.coefficients(weighed, &others);
        let own = candidates.entries[member.candidate].shapes[member.variant].columns.clone();
        own.for_each(|place| coefficients[place] = beside_others[place]);
        let target = weighing.less(&coefficients);
        let beside = weighing.beside(candidates, &others);
        let entry = &candidates.entries[member.candidate];
        let start = &entry.shapes[member.variant];
        let weight = start.log_weight.min(-(entry.shapes.len() as f64).ln());
        let term = (&entry.label.clone(), &start.shape.clone()[..]);
        if let Some(better) = refined(hypotheses, real, term, (&beside, &target), noise) {
            let log_weight = weight + better.log_width;
            candidates.extend(hypotheses, real, simulated, member.candidate, vec![better.shape], log_weight);
        }
    }
}
