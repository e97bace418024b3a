//! From both sides of a comparison to the probabilities of all sets of effects.

use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::predicted_blocks::temper_of;
use crate::diagnose::infer::refined::refined;
use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::weighing::{FIRST_PRICE, Weighing, friction_of};
use crate::diagnose::noise::autoregression::Noise;
use crate::inference::evidence::{Candidate, Model};
use crate::inference::posterior::Posterior;
use crate::inference::sets::{Field, Member};
use crate::physics::Hypothesis;

/// Rounds of noise, sets and refined shapes: the second has the noise of what the first found. A limit of the computing time.
const ROUNDS: usize = 2;
/// Leading sets beside which a shape may be of use. A limit of the computing time.
const LEADING_SETS: usize = 6;
/// Nats behind the best shape of its candidate from which a shape is no longer followed: a weight of one in three million.
const USEFUL_NATS: f64 = 15.0;
/// Probability of a candidate from which its shape is refined.
const REFINED_FROM: f64 = 0.01;

/// What was inferred.
pub(crate) struct Inferred {
    pub candidates: Candidates,
    pub posterior: Posterior,
    /// Log evidence (nats, tempered) of each candidate alone.
    pub alone: Vec<f64>,
    pub noise: Noise,
    /// Exponent of the evidence.
    pub temper: f64,
    /// Tempered nats that a member has to bring.
    pub price: f64,
}

/// Weighs all candidates on the torque of `real`, beginning with a noise; `seed` is that of the replays.
pub(crate) fn infer(
    hypotheses: &[Box<dyn Hypothesis + Send>],
    mut candidates: Candidates,
    (real, simulated): (&Side, Option<&Side>),
    mut noise: Noise,
    seed: u64,
) -> Inferred {
    let friction = friction_of(real);
    let mut null = None;
    for _ in 0..ROUNDS {
        let weighing = Weighing::new(&candidates, real, simulated, &noise, friction);
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
        refine_shapes(hypotheses, &mut candidates, (real, simulated), &weighing, &weighed, &posterior, &noise);
        candidates = candidates.only(|member| {
            weighed[member.candidate].variants.len() <= member.variant
                || useful.binary_search(&member).is_ok()
                || weighing.shown.contains(&member)
        });
        noise = Noise::fit(&left, &real.runs, &real.features);
    }
    let weighing = Weighing::new(&candidates, real, simulated, &noise, friction);
    let weighed = candidates.weighed(friction, weighing.random());
    let price_at = |temper: f64| null.as_ref().map_or(FIRST_PRICE, |null| null.price(temper));
    let field = Field { reduced: &weighing.reduced, candidates: &weighed, price: price_at(1.0), temper: 1.0 };
    let sets = field.search();
    let temper = temper_of(&weighing, real, &field, &sets);
    let price = price_at(temper);
    let field = Field { price, temper, ..field };
    let posterior = Posterior::of(&field, field.search());
    let nothing = Model::new(&weighing.reduced, &[]);
    let alone = weighed
        .iter()
        .map(|candidate| {
            let gains = candidate.variants.iter().map(|v| nothing.as_ref().map_or(0.0, |m| m.gain(v)));
            temper * gains.fold(f64::NEG_INFINITY, f64::max)
        })
        .collect();
    Inferred { candidates, posterior, alone, noise, temper, price }
}

/// Adds refined shapes of the candidates that are probable.
fn refine_shapes(
    hypotheses: &[Box<dyn Hypothesis + Send>],
    candidates: &mut Candidates,
    (real, simulated): (&Side, Option<&Side>),
    weighing: &Weighing,
    weighed: &[Candidate],
    posterior: &Posterior,
    noise: &Noise,
) {
    let mut done: Vec<usize> = Vec::new();
    for (set, probability) in posterior.sets.clone() {
        if probability < REFINED_FROM {
            break;
        }
        for member in &set.members {
            if done.contains(&member.candidate) && !candidates.entries[member.candidate].repeats {
                continue;
            }
            done.push(member.candidate);
            let others: Vec<Member> = set.members.iter().copied().filter(|other| other != member).collect();
            // The common part and the others are taken off; what is left is for the shape.
            let mut coefficients = weighing.coefficients(weighed, &set.members);
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
}
