//! What was accepted and is not told: what the locked rows do not bear out, and what may be the error of a formula.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::preparation::states::Prepared;
use crate::diagnose::proof::decision::{SHOWN_DEVIATIONS, is_carried, is_worse_by_an_event};
use crate::diagnose::proof::locked_rows::{Proof, prove, prove_alone, rest};
use crate::diagnose::proof::refit::{Refit, refit};
use crate::diagnose::request::LEAST_EFFECT_SHARE;
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::thresholds::{OTHER_ROWS_ERROR_RATIO, Settings};
use crate::numerics::least_squares::{dot, rows_in};
use crate::numerics::statistics::{NORMAL_95, root_mean_square};
use crate::physics::{Action, EffectId};

/// Share (0..1) of the removable error below which a named effect beside others is minor, where it is also small
/// against the torque. Chosen by judgement: lowered from 0.1 with the pages regenerated; larger hides a small second
/// effect, smaller names the error of the larger one's formula.
pub(super) const MINOR_SHARE: f64 = 0.06;
/// The same of a structure without a name. Chosen by judgement: larger, as a free function takes up more of the error
/// of a formula.
const UNNAMED_MINOR_SHARE: f64 = 0.1;
/// Torque over that beside a known rigid body (root mean squares) below which it is small. Chosen by judgement: with it
/// a strong effect beside a stronger one is no minor one; larger hides effects of a fortieth of the friction.
pub(super) const MINOR_TORQUE_SHARE: f64 = 0.025;

/// Torque of an effect over the recorded torque (root mean squares) below which it is listed and not acted on: no
/// filter, encoder or clock is exact to it, and what they leave has a shape. Chosen by judgement: smaller names such
/// errors in recordings without noise.
const NEGLIGIBLE_TORQUE_SHARE: f64 = 7e-4;
/// Effect over the noise behind the filter (root mean squares after whitening) below which an effect of less than
/// [`LEAST_EFFECT_SHARE`] of the torque is listed and not acted on, where its energy is small too. Quantisation and
/// interpolation near reversals of simulated recordings with faults of the measurement and without missing physics
/// reach a sixth.
const LEAST_NOISE_SHARE: f64 = 1.0 / 6.0;
/// Energy of such an effect in variances of the noise, below which it is small. The same recordings reach 34.
const LEAST_EFFECT_ENERGY: f64 = 36.0;

/// Effects that were found and are no findings: they are not in the improved model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Discarded {
    /// Found beside larger ones and of little of the torque, with their share (0..1) of the removable error.
    pub minor: Vec<(EffectId, f64)>,
    /// No larger than what the formulas of the reference get wrong, with the torque that they explain (root mean square).
    pub doubtful: Vec<(EffectId, f64)>,
    /// Below the least effect, with the torque that they explain (root mean square).
    pub negligible: Vec<(EffectId, f64)>,
    /// Withdrawn, because locked rows did not confirm them.
    pub withdrawn: Vec<EffectId>,
    /// Of a size whose 95 % interval includes zero.
    pub undetermined: Vec<EffectId>,
}

impl Discarded {
    /// Whether nothing was discarded.
    pub(crate) fn is_empty(&self) -> bool {
        let Self { minor, doubtful, negligible, withdrawn, undetermined } = self;
        [minor, doubtful, negligible].into_iter().all(Vec::is_empty) && withdrawn.is_empty() && undetermined.is_empty()
    }
}

/// Torque (root mean square) that no filter, encoder and clock is exact to.
pub(crate) fn negligible_torque(workbench: &Workbench) -> f64 {
    NEGLIGIBLE_TORQUE_SHARE * root_mean_square(&workbench.prepared.filtered(&workbench.prepared.torque))
}

/// Torque (root mean square) beside a known rigid body: weight and inertia can be many times what friction is.
pub(crate) fn torque_beside_rigid_body(workbench: &Workbench) -> f64 {
    let Prepared { torque, state, .. } = workbench.prepared;
    match &state.rigid_body {
        Some(body) => root_mean_square(&workbench.prepared.filtered(&state.map(|i| torque[i] - body[i]))),
        None => root_mean_square(&workbench.prepared.filtered(torque)),
    }
}

/// Drops effects, weakest first, that the locked rows do not bear out. A one-off event has none to speak for it, but may make them
/// worse.
pub(crate) fn withdraw_unproven(
    workbench: &Workbench,
    settings: &Settings,
    baseline: &Refit,
    accepted: &mut Vec<Accepted>,
) -> Vec<EffectId> {
    let mut withdrawn = Vec::new();
    while let Some(all) = refit(workbench, accepted) {
        let unproven = (0..accepted.len()).filter_map(|i| {
            let proof = prove_alone(workbench, accepted, i, &all)?;
            let Accepted { label, family_wise, .. } = &accepted[i];
            let is_carried = if accepted[i].effect() == EffectId::TransientEvent {
                !is_worse_by_an_event(settings, &proof)
            } else {
                is_carried(settings, label, *family_wise, &proof)
            };
            (!is_carried).then_some((i, proof.gain_nats))
        });
        let Some((weakest, _)) = unproven.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        withdrawn.push(accepted.remove(weakest).effect());
    }
    // Rows that could not show it do not speak against it.
    let lowers_the_error =
        |proof: Proof| proof.expected_deviations < SHOWN_DEVIATIONS || proof.improved_rmse < proof.baseline_rmse;
    if !proof_of_all(workbench, baseline, accepted).is_none_or(lowers_the_error) {
        withdrawn.extend(take_what_repeats(accepted));
    }
    withdrawn
}

/// Drops all effects where the locked rows do not show by the interval of their ratio that the error falls with them: a model that was
/// fitted to another recording is wrong in ways that its image does not tell.
pub(crate) fn withdraw_without_shown_gain(
    workbench: &Workbench,
    baseline: &Refit,
    accepted: &mut Vec<Accepted>,
) -> Vec<EffectId> {
    if proof_of_all(workbench, baseline, accepted).is_none_or(|proof| proof.shows_gain()) {
        return Vec::new();
    }
    take_what_repeats(accepted).collect()
}

/// Takes away what other rows of the recording would show again: all but a one-off event, which lies in rows that no others can speak for,
/// and a fault of the measurement, which adds no torque.
fn take_what_repeats(accepted: &mut Vec<Accepted>) -> impl Iterator<Item = EffectId> {
    let stays =
        |found: &Accepted| found.effect() == EffectId::TransientEvent || found.effect().action() == Action::Measurement;
    accepted.extract_if(.., move |found| !stays(found)).map(|found| found.effect())
}

/// The proof of all that was accepted. `None` where nothing is locked.
fn proof_of_all(workbench: &Workbench, baseline: &Refit, accepted: &[Accepted]) -> Option<Proof> {
    prove(workbench, baseline, &refit(workbench, accepted)?)
}

/// What one effect explains beside all the others.
struct Explained<'a> {
    effect: EffectId,
    /// Root mean square of its torque that the others cannot explain.
    torque: f64,
    with: &'a [Accepted],
    without: &'a [Accepted],
}

impl Explained<'_> {
    /// Whether what it explains on the open rows, whitened, is little beside the noise.
    fn is_hidden(&self, workbench: &Workbench) -> Option<bool> {
        let [with, without] = [refit(workbench, self.with)?, refit(workbench, self.without)?];
        let runs = workbench.prepared.open_runs();
        let energy = |refit: &Refit| {
            let white = with.noise.whitened(&rest(workbench, refit), &runs);
            dot(&white, &white, &runs)
        };
        let (left, left_without) = (energy(&with), energy(&without));
        let share = (left_without - left).max(0.0) / left;
        Some(share < LEAST_NOISE_SHARE * LEAST_NOISE_SHARE && share * (rows_in(&runs) as f64) < LEAST_EFFECT_ENERGY)
    }
}

/// The least certain of the effects of one coefficient, beside the first, whose 95 % interval includes zero: what it is cannot be told where it
/// may be no torque at all. The first stands by its evidence: its coefficient may trade with a parameter of the base, as that of a power of the
/// velocity near one does with viscous friction. Of several coefficients each may be anything while together they are not, and a structure
/// without a name is shrunk towards zero.
pub(crate) fn least_determined(effects: &[Fitted]) -> Option<usize> {
    let deviations = |fitted: &Fitted| match (&fitted.label, &fitted.coefficients[..], &fitted.deviation[..]) {
        (Label::Named(_), [coefficient], [deviation]) => (coefficient / deviation).abs(),
        _ => f64::INFINITY,
    };
    let beside = effects.iter().map(deviations).enumerate().skip(1);
    Some(beside.filter(|(_, deviations)| *deviations < NORMAL_95).min_by(|a, b| a.1.total_cmp(&b.1))?.0)
}

/// Sets aside what explains no more than the formulas of the reference get wrong.
pub(crate) fn set_aside_doubtful(workbench: &Workbench, accepted: &mut Vec<Accepted>) -> Vec<(EffectId, f64)> {
    let error = OTHER_ROWS_ERROR_RATIO * workbench.base.formula_error;
    set_aside(&|explained| explained.torque < error, workbench, accepted)
}

/// Sets aside what is too small to matter: below the share `least_effect` of the torque beside the rigid body where that is asked for,
/// else below [`LEAST_EFFECT_SHARE`] of it and hidden by the noise. What a person has to look at may last for a moment only, and is
/// not held against the noise of the whole recording.
pub(crate) fn set_aside_negligible(
    workbench: &Workbench,
    accepted: &mut Vec<Accepted>,
    least_effect: Option<f64>,
) -> Vec<(EffectId, f64)> {
    let negligible = negligible_torque(workbench);
    let least = least_effect.unwrap_or(LEAST_EFFECT_SHARE) * torque_beside_rigid_body(workbench);
    let is_hidden = |explained: &Explained| {
        explained.effect.action() != Action::Maintenance && explained.is_hidden(workbench) == Some(true)
    };
    let is_small = |explained: &Explained| {
        explained.torque < negligible || explained.torque < least && (least_effect.is_some() || is_hidden(explained))
    };
    set_aside(&is_small, workbench, accepted)
}

/// Sets aside, one after the other, what is small, with what it explains. Effects that repeat count together.
fn set_aside(
    is_small: &dyn Fn(&Explained) -> bool,
    workbench: &Workbench,
    accepted: &mut Vec<Accepted>,
) -> Vec<(EffectId, f64)> {
    let mut set_aside = Vec::new();
    while let Some(all) = energy_left(workbench, accepted) {
        let explained = |effect: EffectId| {
            let without: Vec<Accepted> = accepted.iter().filter(|other| other.effect() != effect).cloned().collect();
            let torque = (energy_left(workbench, &without)? - all).max(0.0).sqrt();
            is_small(&Explained { effect, torque, with: accepted, without: &without }).then_some((effect, torque))
        };
        let small: Vec<_> = accepted.iter().map(Accepted::effect).filter_map(explained).collect();
        let Some(taken) = take_least_in_favour(accepted, &small) else { break };
        set_aside.push(taken);
    }
    set_aside
}

/// Takes one away of the effects that each explain little beside the others: two that can stand for each other both do, and of
/// those the one stays that had more in its favour when it came, and a name before none.
fn take_least_in_favour(accepted: &mut Vec<Accepted>, small: &[(EffectId, f64)]) -> Option<(EffectId, f64)> {
    let in_favour = |effect: EffectId| {
        let scores = accepted.iter().filter(|found| found.effect() == effect).map(|found| found.score);
        (effect != EffectId::Unknown, scores.fold(f64::NEG_INFINITY, f64::max))
    };
    let least = small.iter().map(|(effect, _)| in_favour(*effect)).enumerate();
    let (index, _) = least.min_by(|(_, a), (_, b)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)))?;
    accepted.retain(|other| other.effect() != small[index].0);
    Some(small[index])
}

/// Mean square of what base and effects leave.
pub(super) fn energy_left(workbench: &Workbench, accepted: &[Accepted]) -> Option<f64> {
    refit(workbench, accepted).map(|refit| refit.noise.rms.powi(2))
}

/// Sets aside what accounts for little of the torque and of the mismatch beside a larger finding: there the
/// error of the larger one's formula may pass for an effect, which that of a parameter alone has not. Effects that repeat count together.
pub(crate) fn set_aside_minor(
    workbench: &Workbench,
    accepted: &mut Vec<Accepted>,
    baseline: &Refit,
) -> Vec<(EffectId, f64)> {
    let small_energy = (MINOR_TORQUE_SHARE * torque_beside_rigid_body(workbench)).powi(2);
    let mut minor = Vec::new();
    while let (Some(refitted), true) = (refit(workbench, accepted), accepted.len() > 1) {
        let removable = (baseline.noise.rms.powi(2) - refitted.noise.rms.powi(2)).max(f64::MIN_POSITIVE);
        let share = |effect: EffectId| {
            // A structure without a name can take over what any effect explains: a name is weighed beside names.
            let beside = |other: EffectId| effect == EffectId::Unknown || other != EffectId::Unknown;
            let with: Vec<Accepted> = accepted.iter().filter(|other| beside(other.effect())).cloned().collect();
            let without: Vec<Accepted> = with.iter().filter(|other| other.effect() != effect).cloned().collect();
            energy_left(workbench, &without)
                .zip(energy_left(workbench, &with))
                .map(|(without, with)| (effect, (without - with) / removable))
        };
        let is_beside_a_formula = |effect: EffectId| {
            let mut others = accepted.iter().map(Accepted::effect).filter(|other| *other != effect);
            others.any(|other| other.action() != Action::Parameter)
        };
        let is_minor = |(effect, share): &(EffectId, f64)| {
            let is_little = |least: f64| *share < least && share * removable < small_energy;
            match effect {
                // A one-off event is short: its share of all says nothing of its size.
                EffectId::TransientEvent => share_at_the_time_of_events(workbench, &refitted) < MINOR_SHARE,
                EffectId::Unknown => is_little(UNNAMED_MINOR_SHARE),
                _ => is_little(MINOR_SHARE) && is_beside_a_formula(*effect),
            }
        };
        let small: Vec<_> = accepted.iter().map(Accepted::effect).filter_map(share).filter(is_minor).collect();
        let Some(taken) = take_least_in_favour(accepted, &small) else { break };
        minor.push(taken);
    }
    minor
}

/// Energy of the one-off events over that of the other effects at their time; infinite where these do nothing then.
fn share_at_the_time_of_events(workbench: &Workbench, refitted: &Refit) -> f64 {
    let rows = workbench.prepared.rows.len();
    let torque = |is_event: bool| {
        let of_kind =
            refitted.effects.iter().filter(|fitted| is_event == (fitted.label.effect() == EffectId::TransientEvent));
        of_kind.fold(vec![0.0; rows], |mut sum, fitted| {
            sum.iter_mut().zip(workbench.torque_of(fitted)).for_each(|(sum, torque)| *sum += torque);
            sum
        })
    };
    let (events, others) = (torque(true), torque(false));
    let half = 0.5 * events.iter().fold(0.0, |most: f64, torque| most.max(torque.abs()));
    let during = events.iter().zip(&others).filter(|(event, _)| event.abs() > half);
    let [event, other] = during.fold([0.0; 2], |[e, o], (event, other)| [e + event * event, o + other * other]);
    event / other
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_no_torque_at_all_is_not_named() {
        let fitted = |coefficients: &[f64], deviation: &[f64]| Fitted {
            label: Label::Named(EffectId::Elasticity),
            shape: Vec::new(),
            shape_deviation: Vec::new(),
            coefficients: coefficients.to_vec(),
            deviation: deviation.to_vec(),
        };
        let (sure, unsure, least) = (fitted(&[-2.0], &[1.0]), fitted(&[1.5], &[1.2]), fitted(&[-0.1], &[1.0]));
        let of_two = fitted(&[0.1, -0.1], &[1.0, 1.0]);
        assert_eq!(least_determined(&[sure.clone(), unsure.clone(), least, of_two.clone()]), Some(2));
        assert_eq!(least_determined(&[sure.clone(), unsure.clone()]), Some(1));
        assert_eq!(least_determined(&[unsure, sure.clone()]), None, "the first stands by its evidence");
        assert_eq!(least_determined(&[sure, of_two]), None);
    }
}
