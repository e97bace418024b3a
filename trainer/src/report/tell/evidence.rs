//! What speaks for a finding, what would separate it from its rivals, and its parameters with their units.

use crate::diagnose::AMBIGUITY_MARGIN_NATS;
use crate::diagnose::advice::Plan;
use crate::diagnose::answer::outcome::{Estimate, Evidence, Finding};
use crate::diagnose::answer::sealed::SealedScore;
use crate::figures::{digits, pair};
use crate::parameter::Parameter;
use crate::physics::EffectId;
use crate::physics::names::plain_name;
use crate::physics::separation::separation;
use crate::physics::units::{Units, unit_text};
use crate::report::tell::measurement::observation;

/// What speaks for a finding, in small letters and without a full stop.
#[must_use]
pub fn evidence(found: &Finding, units: Units) -> String {
    match &found.evidence {
        Evidence::Measurement(seen) => observation(seen, units),
        Evidence::Rows { held_out_gain_nats, family_wise, rivals } => {
            let of_locked =
                found.locked_gain_nats.map(|gain| format!("; locked rows {gain:+.1} more")).unwrap_or_default();
            format!(
                "log-likelihood ratio {:.1} nats in favour (held-out folds {held_out_gain_nats:+.1}{of_locked}), family-wise p {}, {rivals} rival{} \
                 within reach",
                found.score,
                probability(*family_wise),
                if *rivals == 1 { "" } else { "s" },
            )
        }
    }
}

/// How much better the improved model is on rows that decided nothing, in one sentence; one that is worse is not written.
#[must_use]
pub fn sealed_sentence(score: &SealedScore, units: Units) -> String {
    let interval = if score.ratio_ci95[1].is_finite() {
        format!(", 95 % interval {} to {}", digits(score.ratio_ci95[0]), digits(score.ratio_ci95[1]))
    } else {
        String::new()
    };
    let leaves = if score.is_worse() { "No model is written: it would leave" } else { "The improved model leaves" };
    format!(
        "{leaves} {} of the torque as recorded, on {} sealed rows that decided nothing (ratio {}{interval}).",
        pair(score.before_rmse, "->", score.after_rmse, units.actuator),
        score.n,
        digits(score.ratio),
    )
}

/// A small probability; what a double cannot hold is bounded.
fn probability(probability: f64) -> String {
    if probability < 1e-99 { "below 1e-99".to_string() } else { format!("{probability:.1e}") }
}

/// What would separate a finding from its rivals: the planned motion where there is one, then what does so in general.
#[must_use]
pub fn separate_by(found: &Finding, plan: Option<&Plan>) -> String {
    let names = std::iter::once(found.effect).chain(found.alternatives.iter().map(|(rival, _)| *rival));
    let general = names.map(separation).collect::<Vec<_>>().join("; ");
    match plan.filter(|_| !found.alternatives.is_empty()) {
        Some(plan) => format!("{}; in general: {general}", planned_motion(plan)),
        None => general,
    }
}

/// A planned motion in one sentence, in small letters and without a full stop.
#[must_use]
pub fn planned_motion(plan: &Plan) -> String {
    let text = |pairs: &[(EffectId, EffectId)]| {
        let pairs: Vec<String> =
            pairs.iter().map(|(a, b)| format!("{} from {}", plain_name(*a), plain_name(*b))).collect();
        pairs.join(", and ")
    };
    let (seconds, words, pairs) = (plan.duration_s(), &plan.words, text(&plan.pairs));
    let (expected, present) = (plan.expected_nats, plan.present_nats);
    if !plan.suffices() {
        return format!(
            "no motion within the limits distinguishes {pairs}: the best of them, {seconds:.0} s of {words}, has an expected \
             margin of {expected:.1} nats, {AMBIGUITY_MARGIN_NATS} are required"
        );
    }
    let sentence = format!(
        "{seconds:.0} s of {words}, recorded next, would distinguish {pairs}: expected margin {expected:.1} nats, \
         {AMBIGUITY_MARGIN_NATS} are required and this recording has {present:.1}"
    );
    if plan.left_open.is_empty() {
        sentence
    } else {
        format!("{sentence}; it does not distinguish {}", text(&plan.left_open))
    }
}

/// A parameter with its unit.
#[must_use]
pub fn parameter(estimate: &Estimate, units: Units) -> Parameter {
    let Estimate { name, symbol, dimension, value, ci95 } = *estimate;
    let unit = unit_text(dimension, units.rotary, units.actuator);
    Parameter { name: name.to_string(), symbol: symbol.to_string(), value, unit, ci95 }
}

/// Several parameters with their units.
#[must_use]
pub fn parameters(estimates: &[Estimate], units: Units) -> Vec<Parameter> {
    estimates.iter().map(|estimate| parameter(estimate, units)).collect()
}
