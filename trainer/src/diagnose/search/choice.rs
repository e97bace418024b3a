//! The end of a round: the best passing hypothesis with those that cannot be told apart from it, or nothing.

use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::round::Round;
use crate::diagnose::search::scored::Scored;
use crate::numerics::least_squares::{dot, orthonormal, project_out};
use crate::numerics::statistics::t_statistic;
use crate::physics::EffectId;

/// Energy that a name explains over that of a free function which leads it, above which the name is kept. Chosen by
/// judgement: lowered from 0.9; smaller names unknown structures, larger gives up names for the errors of their
/// formulas.
const NAMED_ENERGY_SHARE: f64 = 0.88;
/// The same of the whitened energy, in which the slow errors of a formula count for less. Chosen by judgement: with the
/// one before.
const NAMED_WHITENED_SHARE: f64 = 0.94;

/// Score of a free function above which the errors of a formula show and chance is no explanation, nats. Chosen by
/// judgement: below it a name needs [`NAMED_SCORE_SHARE`] of the score too.
const FORMULA_ERROR_NATS: f64 = 60.0;
/// Score of a name over that of a weaker free function that leads it, above which the name is kept. Chosen by
/// judgement: much of the energy that a weak function explains may be chance; smaller names unknown structures.
const NAMED_SCORE_SHARE: f64 = 0.8;

/// Energy of a name outside of a free function over its energy beside the base, below which the function is of its
/// kind. Chosen by judgement: a series errs by as much at the edges of a channel.
const SAME_KIND_ENERGY_SHARE: f64 = 0.1;
/// The same below which a rival is the best hypothesis with more coefficients, and no rival. Chosen by judgement:
/// larger hides rivals that differ, smaller lists every extension as a rival.
const SAME_FORMULA_ENERGY_SHARE: f64 = 0.01;
/// The same below which a hypothesis is a part of another, exact but for roundoff and filtering.
const PART_ENERGY_SHARE: f64 = 1e-6;

/// Lead up to which a structure without a name does not rule a name out, nats: it is the best of many, of which one may
/// fit by chance what the name's formula misses. Chosen by judgement: smaller leaves unnamed what a near name explains.
const UNKNOWN_LEAD_NATS: f64 = 12.0;

/// Lead up to which an effect and the one that it yields to do not rule each other out, nats: the further shape of the
/// one may fit what the other's formula misses. Chosen by judgement: smaller rules out the recorded channel for an
/// inferred one.
const YIELDING_LEAD_NATS: f64 = 8.0;

/// Torque of an event behind the filter over its largest, below which a row is beyond the event: what a filter leaves of an edge.
const EVENT_EDGE_SHARE: f64 = 0.01;
/// Energy of an effect during an event over all of it, above which the event may be its occasion. Chosen by judgement: most of it; a stop
/// that is hit hard once may be touched lightly at other times.
const OCCASION_ENERGY_SHARE: f64 = 0.5;

impl Round<'_, '_> {
    /// Decides the round: the best passing hypothesis with its ambiguity set, or nothing; nothing too where that set holds nearly
    /// everything.
    pub(crate) fn choose(&self, table: &[Scored]) -> Option<Accepted> {
        let settings = &self.search.settings;
        // Locked rows have nothing to say of a one-off event.
        let any_locked = self.search.workbench.prepared.blocks.iter().any(|block| block.locked);
        let passes = |s: &&Scored| {
            let (level, score) = settings.on_open_rows(any_locked && s.label != Label::Named(EffectId::TransientEvent));
            s.family_wise < level && s.own_score > score
        };
        let is_named = |s: &&Scored| matches!(s.label, Label::Named(_));
        let passing_names = || table.iter().filter(is_named).filter(passes);
        let named = passing_names().next();
        let generic = table.iter().filter(|s| !is_named(s)).find(passes);
        let held_out = table.iter().filter(is_named).map(|s| s.evidence.held_out).fold(f64::NEG_INFINITY, f64::max);
        let best = match (named, generic) {
            (Some(named), Some(generic))
                if generic.score > named.score + settings.ambiguity_margin && generic.evidence.held_out > held_out =>
            {
                passing_names().find(|name| self.is_kept_beside(name, generic, table)).unwrap_or(generic)
            }
            (Some(named), _) if named.label == Label::Named(EffectId::TransientEvent) => {
                // No other block can confirm an event, so any cause that may come back goes before it on equal terms.
                let lasting = |s: &&Scored| {
                    s.label != named.label && s.evidence.criterion > named.score - settings.ambiguity_margin
                };
                passing_names().find(lasting).unwrap_or(named)
            }
            (Some(named), _) => named,
            (None, Some(generic)) => generic,
            (None, None) => return None,
        };
        let best = self.simplest(self.most_significant(best, passing_names()), passing_names());
        let mut rivals = Vec::new();
        let mut standings = Vec::new();
        let mut margin = f64::INFINITY;
        for rival in table.iter().filter(|s| s.label != best.label) {
            let Label::Named(effect) = rival.label else { continue };
            let distance = best.score - rival.score;
            standings.push((effect, distance));
            let is_ruled_out = match best.label {
                Label::Named(_) if self.yields(best, rival).is_some() || self.yields(rival, best).is_some() => {
                    distance >= YIELDING_LEAD_NATS
                }
                Label::Named(_) => !within_reach(best, rival, settings.ambiguity_margin),
                Label::Generic(_) => distance >= UNKNOWN_LEAD_NATS || !passes(&rival),
            };
            if passes(&rival) && self.is_the_occasion(best, rival) {
                rivals.push((effect, distance.min(settings.ambiguity_margin)));
            } else if is_ruled_out {
                margin = margin.min(distance);
            } else if distance < 0.0 || !self.contains(rival, best, SAME_FORMULA_ENERGY_SHARE) {
                rivals.push((effect, distance));
            }
        }
        if rivals.len() > settings.most_rivals {
            return None;
        }
        Some(Accepted {
            label: best.label.clone(),
            shape: best.shape.clone(),
            score: best.score,
            family_wise: best.family_wise,
            fold_gain: best.evidence.fold_gain.clone(),
            margin,
            rivals,
            standings,
            channels: channels(best, table.iter().filter(passes), settings.ambiguity_margin),
            stated: None,
        })
    }

    /// Whether a name is kept beside a free function that leads it. A free function holds more than any name does, and every formula
    /// is a little wrong: what explains nearly as much, whitened or not, is good enough, unless the function leads what holds the
    /// name among those of its channel as well. Then it is no error of the formula that the name lacks.
    fn is_kept_beside(&self, name: &Scored, generic: &Scored, table: &[Scored]) -> bool {
        let is_strong = generic.score >= FORMULA_ERROR_NATS;
        let explains_as_much = name.explained >= NAMED_ENERGY_SHARE * generic.explained
            && (is_strong || name.score >= NAMED_SCORE_SHARE * generic.score)
            || name.evidence.beyond_noise() >= NAMED_WHITENED_SHARE * generic.evidence.beyond_noise();
        let errs_by_its_formula = || {
            let mut of_the_channel = table.iter().filter(|s| s.label.channel() == generic.label.channel());
            let own = of_the_channel.find(|own| self.contains(own, name, SAME_KIND_ENERGY_SHARE));
            own.is_none_or(|own| own.score > generic.score - self.search.settings.ambiguity_margin)
        };
        explains_as_much && errs_by_its_formula()
    }

    /// Whether a one-off event is most of what a recording would show of another effect: a stop that is reached, or a limit that is
    /// exceeded once.
    fn is_the_occasion(&self, event: &Scored, other: &Scored) -> bool {
        if event.label != Label::Named(EffectId::TransientEvent) {
            return false;
        }
        let column = |scored: &Scored| {
            self.search.workbench.filtered_columns(&scored.label, &scored.shape).first().cloned().unwrap_or_default()
        };
        let (of_event, of_other) = (column(event), column(other));
        let least = EVENT_EDGE_SHARE * of_event.iter().fold(0.0, |most: f64, torque| most.max(torque.abs()));
        let energy = |rows: &dyn Fn(f64) -> bool| -> f64 {
            let pairs = of_event.iter().zip(&of_other).filter(|(event, _)| rows(event.abs()));
            pairs.map(|(_, other)| other * other).sum()
        };
        energy(&|event| event > least) > OCCASION_ENERGY_SHARE * energy(&|_| true)
    }

    /// Whether the open rows prove a hypothesis by themselves.
    fn is_significant(&self, scored: &Scored) -> bool {
        scored.family_wise < self.search.settings.family_wise_level
    }

    /// The best hypothesis, or one within the margin that the open rows prove by themselves where they do not prove the best one:
    /// that was sought among more shapes, of which one fits by chance.
    fn most_significant<'t>(&self, best: &'t Scored, mut passing: impl Iterator<Item = &'t Scored>) -> &'t Scored {
        if self.is_significant(best) || !matches!(best.label, Label::Named(_)) {
            return best;
        }
        let margin = self.search.settings.ambiguity_margin;
        passing.find(|rival| best.score - rival.score < margin && self.is_significant(rival)).unwrap_or(best)
    }

    /// The best hypothesis, or one within reach that explains the same with less: without its further coefficients, or by the
    /// effect that the best one yields to.
    fn simplest<'t>(&self, best: &'t Scored, mut passing: impl Iterator<Item = &'t Scored>) -> &'t Scored {
        if !matches!(best.label, Label::Named(_)) {
            return best;
        }
        let plainer = |rival: &&Scored| {
            let as_good = |no_better_by: f64| best.score - rival.score < no_better_by;
            let is_as_sure = self.is_significant(rival) || !self.is_significant(best);
            let is_a_part = || {
                within_reach(best, rival, self.search.settings.ambiguity_margin)
                    && self.contains(best, rival, PART_ENERGY_SHARE)
            };
            is_as_sure && (self.yields(best, rival).is_some_and(as_good) || is_a_part())
        };
        passing.find(plainer).unwrap_or(best)
    }

    /// Lead in nats up to which a hypothesis yields to another; `None` if it does not.
    fn yields(&self, one: &Scored, other: &Scored) -> Option<f64> {
        let Label::Named(effect) = one.label else { return None };
        let (first, no_better_by) = self.search.workbench.hypothesis(effect)?.yields_to()?;
        (other.label == Label::Named(first)).then_some(no_better_by)
    }

    /// Whether a hypothesis is another one with more coefficients, but for a share of the other's energy.
    fn contains(&self, wider: &Scored, narrower: &Scored, but_for: f64) -> bool {
        if wider.evidence.degrees <= narrower.evidence.degrees {
            return false;
        }
        let runs = self.bench.runs();
        let white = |scored: &Scored| {
            self.search
                .workbench
                .whitened(&self.search.workbench.filtered_columns(&scored.label, &scored.shape), &self.noise)
        };
        let span = orthonormal(&self.bench.base().iter().cloned().chain(white(wider)).collect::<Vec<_>>(), &runs);
        let base = orthonormal(self.bench.base(), &runs);
        white(narrower).iter().all(|column| {
            let outside = |basis: &[Vec<f64>]| {
                let mut rest = column.clone();
                project_out(&mut rest, basis, &runs);
                dot(&rest, &rest, &runs)
            };
            outside(&span) < but_for * outside(&base)
        })
    }
}

/// The channel of a structure without a name, then those of the passing structures within reach, likeliest first.
fn channels<'t>(best: &Scored, passing: impl Iterator<Item = &'t Scored>, reach: f64) -> Vec<Channel> {
    let Some(own) = best.label.channel() else { return Vec::new() };
    let mut channels = vec![own];
    for rival in passing.filter(|rival| within_reach(best, rival, reach)) {
        channels.extend(rival.label.channel().filter(|channel| !channels.contains(channel)));
    }
    channels
}

/// Whether a rival cannot be told apart from the best: by its distance in nats, or because a small lead is not certain from
/// block to block (Hansen, Lunde and Nason 2011).
fn within_reach(best: &Scored, rival: &Scored, reach: f64) -> bool {
    /// Lead up to which its scatter from block to block is asked, nats. Chosen by judgement: a larger one is certain at
    /// once (likelihood ratio of 150; Kass and Raftery 1995 call it very strong).
    const CLOSE_LEAD_NATS: f64 = 5.0;
    /// Mean lead over its standard error, above which it is certain: 95 % one-sided (1.645).
    const LEAD_T_STATISTIC: f64 = 1.65;
    let distance = best.score - rival.score;
    let leads: Vec<f64> = best.evidence.fold_gain.iter().zip(&rival.evidence.fold_gain).map(|(b, r)| b - r).collect();
    distance < reach || distance < CLOSE_LEAD_NATS && t_statistic(&leads) < LEAD_T_STATISTIC
}
