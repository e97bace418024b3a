//! What is named of the sets that were weighed, and how sure each name is.

use crate::diagnose::comparison::simulation::SimulatedEffect;
use crate::diagnose::evidence::score::GroupEvidence;
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::infer::inferred::Inferred;
use crate::diagnose::search::accepted::{Accepted, Stated};
use crate::diagnose::search::scored::Scored;
use crate::inference::sets::{Member, Set};
use crate::physics::EffectId;
use serde::Serialize;

/// Probability above which an effect is named: more likely than not.
const TOLD_FROM: f64 = 0.5;

/// Torque of an effect beyond what base and common columns could take, over the friction (root mean squares), below which it is listed
/// and not named. Errors of preparation reach it in recordings without any effect; true effects of 1.8 % come with thousands of nats
/// (study of 318 concealed effects and healthy recordings).
pub(crate) const LEAST_NAMED_SHARE: f64 = 0.005;
/// Probability from which a set is told.
const LEAST_SET_PROBABILITY: f64 = 0.01;

/// Effects that may be missing together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbableSet {
    /// Effects of the catalogue, `unknown` among them; none where nothing is missing.
    pub effects: Vec<EffectId>,
    /// Their probability.
    pub probability: f64,
}

impl Inferred {
    /// Sets of effects with their probabilities, whatever shape or channel each effect has.
    pub fn sets(&self) -> Vec<ProbableSet> {
        let mut sets: Vec<ProbableSet> = Vec::new();
        for (set, probability) in &self.posterior.sets {
            let effect = |candidate: usize| self.candidates.entries[candidate].label.effect();
            let mut effects: Vec<EffectId> = set.key().into_iter().map(effect).collect();
            effects.sort_unstable();
            effects.dedup();
            match sets.iter_mut().find(|known| known.effects == effects) {
                Some(known) => known.probability += probability,
                None => sets.push(ProbableSet { effects, probability: *probability }),
            }
        }
        sets.retain(|set| set.probability >= LEAST_SET_PROBABILITY);
        sets.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        sets
    }

    /// Effects of the catalogue that the simulation shows by itself.
    pub fn shown_by_simulation(&self) -> impl Iterator<Item = SimulatedEffect> {
        self.shown.iter().filter_map(|member| {
            let entry = &self.candidates.entries[member.candidate];
            let shaped = &entry.shapes[member.variant];
            let Label::Named(effect) = entry.label else { return None };
            Some(SimulatedEffect { effect, shape: shaped.shape.clone(), width: shaped.columns.len() })
        })
    }

    /// The members of the likeliest set that are more likely than not to be missing, the largest torque first; and effects that do not exceed
    /// the least torque with 95 %, with their torque (root mean square).
    pub fn accepted(&self) -> (Vec<Accepted>, Vec<(EffectId, f64)>) {
        let Some(set) = self.posterior.likeliest() else { return (Vec::new(), Vec::new()) };
        let told =
            set.members.iter().zip(&self.sizes).filter_map(|(m, size)| self.told(*m, set).map(|told| (told, *size)));
        let (mut large, small): (Vec<_>, Vec<_>) = told.partition(|(_, size)| size.least >= self.least);
        large.sort_by(|(_, a), (_, b)| b.torque.total_cmp(&a.torque));
        let small = small.into_iter().map(|(accepted, size)| (accepted.effect(), size.torque));
        let mut below: Vec<(EffectId, f64)> = Vec::new();
        for (effect, torque) in self.below.iter().copied().chain(small) {
            if !below.iter().any(|(known, _)| *known == effect) {
                below.push((effect, torque));
            }
        }
        (large.into_iter().map(|(accepted, _)| accepted).collect(), below)
    }

    /// A member with what may stand in for it; `None` where nothing is as likely.
    fn told(&self, member: Member, set: &Set) -> Option<Accepted> {
        let entry = &self.candidates.entries[member.candidate];
        let effect_of = |candidate: usize| self.candidates.entries[candidate].label.effect();
        let stand_ins = self.posterior.stand_ins(member.candidate);
        let mut probability = self.posterior.inclusion(member.candidate);
        let mut alternatives: Vec<(EffectId, f64)> = Vec::new();
        let mut channels: Vec<Channel> = entry.label.channel().into_iter().collect();
        for (candidate, of_rival) in &stand_ins {
            let effect = effect_of(*candidate);
            if effect == entry.label.effect() {
                // Another function of the same kind: an unnamed structure of another channel, a ripple of another order.
                probability += of_rival;
                let channel = self.candidates.entries[*candidate].label.channel();
                channels.extend(channel.filter(|channel| !channels.contains(channel)));
                continue;
            }
            match alternatives.iter_mut().find(|(known, _)| *known == effect) {
                Some((_, sum)) => *sum += of_rival,
                None => alternatives.push((effect, *of_rival)),
            }
        }
        if probability < TOLD_FROM {
            return None;
        }
        let without: Vec<usize> = set.key().into_iter().filter(|other| *other != member.candidate).collect();
        let evidence = |key: &[usize]| {
            self.posterior.sets.iter().find(|(set, _)| set.key() == key).map_or(0.0, |(set, _)| set.log_evidence)
        };
        let score = self.temper * (set.log_evidence - evidence(&without));
        let distance = |rival: f64| (probability / rival.max(f64::MIN_POSITIVE)).ln();
        let standings: Vec<(EffectId, f64)> =
            alternatives.iter().map(|(effect, rival)| (*effect, distance(*rival))).collect();
        Some(Accepted {
            label: entry.label.clone(),
            shape: entry.shapes[member.variant].shape.clone(),
            score,
            family_wise: self.posterior.nothing(),
            fold_gain: vec![score],
            margin: standings.first().map_or(score, |(_, distance)| *distance),
            rivals: standings.clone(),
            standings,
            channels,
            stated: Some(Stated { probability: probability.min(1.0), alternatives }),
        })
    }

    /// Every candidate by what it would bring alone, best first.
    pub fn table(&self) -> Vec<Scored> {
        let mut table: Vec<Scored> = Vec::new();
        for (index, entry) in self.candidates.entries.iter().enumerate() {
            let Some(shaped) = entry.shapes.first() else { continue };
            let score = self.alone[index] + entry.log_prior - self.price;
            table.push(Scored {
                label: entry.label.clone(),
                shape: shaped.shape.clone(),
                score,
                own_score: score,
                family_wise: 1.0 / (1.0 + score.exp()),
                evidence: GroupEvidence {
                    best: 0,
                    statistic: 0.0,
                    degrees: shaped.columns.len(),
                    held_out: score,
                    fold_gain: Vec::new(),
                    criterion: score,
                },
                group: index,
                surprise: 0.0,
                explained: 0.0,
            });
        }
        table.sort_by(|a, b| b.score.total_cmp(&a.score));
        table
    }
}
