//! Sets of candidates by their evidence: a beam over sets that grow by one, and swaps of one for another.

use crate::inference::evidence::{Candidate, Model, Variant, log_sum_exp};
use crate::inference::reduced::Reduced;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most candidates of a set.
pub(crate) const MOST_MEMBERS: usize = 4;
/// Sets of one size that are followed. A limit of the computing time.
const BEAM: usize = 12;
/// Candidates by which a set is extended, and for which a member is exchanged. A limit of the computing time.
const EXTENSIONS: usize = 16;
/// Sweeps over the shapes of a set's members at most; most settle in one.
const SWEEPS: usize = 3;

/// A candidate in a set with one of its shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Member {
    /// Place of the candidate.
    pub candidate: usize,
    /// Place of its shape.
    pub variant: usize,
}

/// A set of candidates.
#[derive(Clone, Debug)]
pub(crate) struct Set {
    /// Its members with their likeliest shapes, in ascending order.
    pub members: Vec<Member>,
    /// Log evidence against nothing, averaged over the shapes, nats.
    pub log_evidence: f64,
}

impl Set {
    /// Places of the candidates, in ascending order.
    pub fn key(&self) -> Vec<usize> {
        self.members.iter().map(|member| member.candidate).collect()
    }

    /// Whether a candidate is in it.
    pub fn holds(&self, candidate: usize) -> bool {
        self.members.iter().any(|member| member.candidate == candidate)
    }
}

/// What the sets are made of.
pub(crate) struct Field<'a> {
    /// Products beside base and random effects.
    pub reduced: &'a Reduced,
    /// All candidates.
    pub candidates: &'a [Candidate],
    /// Nats that a member has to bring; sets of which a member brings less are not extended.
    pub price: f64,
    /// Exponent of the evidence.
    pub temper: f64,
}

impl Field<'_> {
    pub(crate) fn variant(&self, member: Member) -> &Variant {
        &self.candidates[member.candidate].variants[member.variant]
    }

    fn model(&self, members: &[Member]) -> Option<Model<'_>> {
        Model::new(self.reduced, &members.iter().map(|member| self.variant(*member)).collect::<Vec<_>>())
    }

    /// Weight of a set in nats: tempered evidence, prior and price of its members.
    pub(crate) fn weight(&self, set: &Set) -> f64 {
        let prior: f64 = set.members.iter().map(|member| self.candidates[member.candidate].log_prior).sum();
        self.temper * set.log_evidence + prior - self.price * set.members.len() as f64
    }

    /// Weighted log evidence that each shape of a candidate adds to a model.
    fn gains(&self, model: &Model, candidate: usize) -> Vec<f64> {
        let variants = &self.candidates[candidate].variants;
        variants.iter().map(|variant| variant.log_weight + model.gain(variant)).collect()
    }

    /// The set with each member's shape where it is likeliest beside the others; `None` where a model is singular.
    pub(crate) fn settled(&self, mut members: Vec<Member>) -> Option<Set> {
        members.sort_unstable();
        let mut averaged = vec![0.0; members.len()];
        for _ in 0..SWEEPS {
            let before = members.clone();
            for place in 0..members.len() {
                let mut others = members.clone();
                let own = others.remove(place);
                let model = self.model(&others)?;
                let gains = self.gains(&model, own.candidate);
                members[place] = best_beside(&others, own.candidate, &gains)?;
                let best = members[place].variant;
                let unweighted = gains[best] - self.variant(members[place]).log_weight;
                averaged[place] = log_sum_exp(gains.iter().copied()) - unweighted;
            }
            if members == before {
                break;
            }
        }
        let log_evidence = self.model(&members)?.log_evidence + averaged.iter().sum::<f64>();
        Some(Set { members, log_evidence })
    }

    /// Members one after the other, each the shape that adds most beside those before, until none is worth its price.
    pub(crate) fn forward(&self, most: usize) -> Vec<Member> {
        let mut members: Vec<Member> = Vec::new();
        while members.len() < most {
            let Some(model) = self.model(&members) else { break };
            let shapes =
                self.candidates.iter().enumerate().flat_map(|(candidate, of)| {
                    (0..of.variants.len()).map(move |variant| Member { candidate, variant })
                });
            let free: Vec<Member> = shapes.filter(|member| !members.contains(member)).collect();
            let gain = |member: Member| {
                let of = self.candidates[member.candidate].log_prior + self.variant(member).log_weight;
                (model.gain(self.variant(member)) + of, member)
            };
            let best = free.into_par_iter().map(gain).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            match best {
                Some((gain, member)) if gain > self.price => members.push(member),
                _ => break,
            }
        }
        members
    }

    /// The candidates that add most to some members, best first.
    fn extensions(&self, model: &Model, members: &[Member]) -> Vec<(f64, usize)> {
        let may_join = |candidate: &usize| {
            self.candidates[*candidate].repeats || members.iter().all(|member| member.candidate != *candidate)
        };
        let weighed = (0..self.candidates.len()).into_par_iter().filter(may_join);
        let mut gains: Vec<(f64, usize)> = weighed
            .map(|candidate| {
                let gain = log_sum_exp(self.gains(model, candidate).iter().copied());
                (self.temper * gain + self.candidates[candidate].log_prior, candidate)
            })
            .collect();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        gains.truncate(EXTENSIONS);
        gains
    }

    /// Candidates of sets to be settled, each once.
    fn settle_new(&self, proposed: Vec<Vec<Member>>, known: &mut BTreeMap<Vec<usize>, Set>) {
        let mut fresh: BTreeMap<Vec<usize>, Vec<Member>> = BTreeMap::new();
        for mut members in proposed {
            members.sort_unstable();
            let key: Vec<usize> = members.iter().map(|member| member.candidate).collect();
            if !known.contains_key(&key) {
                fresh.entry(key).or_insert(members);
            }
        }
        let settled: Vec<Option<Set>> =
            fresh.into_values().collect::<Vec<_>>().into_par_iter().map(|members| self.settled(members)).collect();
        known.extend(settled.into_iter().flatten().map(|set| (set.key(), set)));
    }

    /// Shapes that may be of use: alone or beside the leading sets within some nats of their candidate's best.
    pub(crate) fn useful(&self, leading: &[Set], within: f64) -> Vec<Member> {
        let nothing = Set { members: Vec::new(), log_evidence: 0.0 };
        let models: Vec<Model> = leading.iter().chain([&nothing]).filter_map(|set| self.model(&set.members)).collect();
        let of_candidate = |candidate: usize| -> Vec<Member> {
            let mut useful = vec![false; self.candidates[candidate].variants.len()];
            for model in &models {
                let gains = self.gains(model, candidate);
                let best = gains.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                useful.iter_mut().zip(&gains).for_each(|(useful, gain)| *useful |= *gain > best - within);
            }
            (0..useful.len()).filter(|v| useful[*v]).map(|variant| Member { candidate, variant }).collect()
        };
        let mut members: Vec<Member> = (0..self.candidates.len()).into_par_iter().flat_map_iter(of_candidate).collect();
        members.extend(leading.iter().flat_map(|set| set.members.iter().copied()));
        members.sort_unstable();
        members.dedup();
        members
    }

    /// Sets that are worth a thought, likeliest first; nothing is one of them.
    pub(crate) fn search(&self) -> Vec<Set> {
        let mut known = BTreeMap::from([(Vec::new(), Set { members: Vec::new(), log_evidence: 0.0 })]);
        let mut followed = vec![Set { members: Vec::new(), log_evidence: 0.0 }];
        for size in 1..=MOST_MEMBERS {
            let proposed = followed.iter().flat_map(|set| self.extended(&set.members)).collect();
            self.settle_new(proposed, &mut known);
            let mut of_size: Vec<&Set> = known.values().filter(|set| set.members.len() == size).collect();
            of_size.sort_by(|a, b| self.weight(b).total_cmp(&self.weight(a)));
            let best =
                known.values().filter(|set| set.members.len() < size).map(|set| self.weight(set)).fold(0.0, f64::max);
            let grows = of_size.first().is_some_and(|set| self.weight(set) > best - self.price);
            followed = of_size.into_iter().take(BEAM).cloned().collect();
            if !grows {
                break;
            }
        }
        self.swap(&mut known);
        self.ranked(known)
    }

    /// Exchanges each member of the leading sets for every other candidate, until no exchange leads.
    fn swap(&self, known: &mut BTreeMap<Vec<usize>, Set>) {
        let mut exchanged: Vec<Vec<usize>> = Vec::new();
        for _ in 0..BEAM {
            let leader = known.values().max_by(|a, b| self.weight(a).total_cmp(&self.weight(b)));
            let Some(leader) = leader.filter(|leader| !exchanged.contains(&leader.key())).cloned() else { return };
            exchanged.push(leader.key());
            let mut proposed = Vec::new();
            for place in 0..leader.members.len() {
                let mut others = leader.members.clone();
                others.remove(place);
                proposed.extend(self.extended(&others));
                proposed.push(others);
            }
            self.settle_new(proposed, known);
        }
    }

    /// Members with each of the candidates that add most to them, at its likeliest shape.
    pub(crate) fn extended(&self, members: &[Member]) -> Vec<Vec<Member>> {
        let Some(model) = self.model(members) else { return Vec::new() };
        let with = |(_, candidate): (f64, usize)| {
            let new = best_beside(members, candidate, &self.gains(&model, candidate))?;
            Some([members, &[new]].concat())
        };
        self.extensions(&model, members).into_iter().filter_map(with).collect()
    }

    fn ranked(&self, known: BTreeMap<Vec<usize>, Set>) -> Vec<Set> {
        let mut sets: Vec<Set> = known.into_values().collect();
        sets.sort_by(|a, b| self.weight(b).total_cmp(&self.weight(a)).then_with(|| a.key().cmp(&b.key())));
        sets
    }
}

/// The likeliest shape of a candidate that is not among the members yet, by the gains of its shapes.
fn best_beside(members: &[Member], candidate: usize, gains: &[f64]) -> Option<Member> {
    let shapes = (0..gains.len()).map(|variant| Member { candidate, variant });
    let free = shapes.filter(|member| !members.contains(member));
    free.max_by(|a, b| gains[a.variant].total_cmp(&gains[b.variant]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::posterior::Posterior;
    use crate::inference::products::products;
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    const ROWS: usize = 400;

    fn random_columns(count: usize, seed: u64) -> Vec<Vec<f64>> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        (0..count).map(|_| (0..ROWS).map(|_| normal(&mut random)).collect()).collect()
    }

    fn candidate(shapes: &[usize]) -> Candidate {
        let variant = |&column: &usize| Variant {
            columns: column..column + 1,
            shared: 0..0,
            mean: vec![0.0],
            variance: vec![1.0],
            log_weight: -(shapes.len() as f64).ln(),
            only_positive: false,
        };
        Candidate { log_prior: 0.0, variants: shapes.iter().map(variant).collect(), repeats: false }
    }

    /// Products of columns with the sum of some of them and unit noise.
    fn with_target(columns: &[Vec<f64>], of: &[(usize, f64)]) -> Reduced {
        let mut all = columns.to_vec();
        let mut target = random_columns(1, 99).swap_remove(0);
        for (column, coefficient) in of {
            target.iter_mut().zip(&columns[*column]).for_each(|(t, c)| *t += coefficient * c);
        }
        all.push(target);
        Reduced::without_base(&products(&all), 0)
    }

    #[test]
    fn the_right_set_is_found_with_its_shapes_and_nothing_where_there_is_nothing() {
        let columns = random_columns(12, 4);
        let candidates: Vec<Candidate> = (0..4).map(|k| candidate(&[3 * k, 3 * k + 1, 3 * k + 2])).collect();
        let search = |of: &[(usize, f64)]| {
            let reduced = with_target(&columns, of);
            let field = Field { reduced: &reduced, candidates: &candidates, price: 5.0, temper: 1.0 };
            Posterior::of(&field, field.search())
        };
        let two = search(&[(1, 0.5), (9, -0.4)]);
        let expected = [Member { candidate: 0, variant: 1 }, Member { candidate: 3, variant: 0 }];
        assert_eq!(two.likeliest().unwrap().members, expected);
        assert!(two.inclusion(0) > 0.99 && two.inclusion(3) > 0.99 && two.inclusion(1) < 0.05);
        assert!(search(&[]).nothing() > 0.9);
        let total: f64 = two.sets.iter().map(|(_, probability)| probability).sum();
        assert!((total - 1.0).abs() < 1e-9);
    }

    #[test]
    fn two_that_are_one_stand_in_for_each_other() {
        let mut columns = random_columns(4, 8);
        let (first, noise) = (columns[0].clone(), random_columns(1, 5).swap_remove(0));
        columns[1] = first.iter().zip(&noise).map(|(first, noise)| first + 0.02 * noise).collect();
        let reduced = with_target(&columns, &[(0, 0.4)]);
        let candidates: Vec<Candidate> = (0..4).map(|k| candidate(&[k])).collect();
        let field = Field { reduced: &reduced, candidates: &candidates, price: 5.0, temper: 1.0 };
        let posterior = Posterior::of(&field, field.search());
        let likeliest = posterior.likeliest().unwrap().members[0].candidate;
        let stand_ins = posterior.stand_ins(likeliest);
        assert_eq!(stand_ins.len(), 1, "{stand_ins:?}");
        assert_eq!(stand_ins[0].0, 1 - likeliest);
        assert!((posterior.inclusion(0) + posterior.inclusion(1) - 1.0).abs() < 0.05);
    }
}
