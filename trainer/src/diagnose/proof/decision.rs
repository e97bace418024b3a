//! Whether open and locked rows together carry an accepted effect.

use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::proof::locked_rows::Proof;
use crate::diagnose::search::thresholds::Settings;
use statrs::function::erf::erfc_inv;

/// Weight of the locked rows over their share of the evidence. Chosen by judgement: two, as of what the open rows could
/// tell much is spent on the choice of effect and shape; `what_the_locked_rows_tell_counts_double` holds it.
const LOCKED_WEIGHT: f64 = 2.0;
/// Largest weight of the locked rows (0..1). Chosen by judgement: the open rows keep a tenth where nearly all evidence
/// is locked; at one they would count for nothing.
const LARGEST_LOCKED_WEIGHT: f64 = 0.9;

/// Deviations of the locked rows above which they show an effect by themselves: 5 % of what is not there (one-sided). Of an effect that
/// they are not expected to show so clearly the open rows have to be as sure as of what no locked rows can confirm.
pub(super) const SHOWN_DEVIATIONS: f64 = 1.645;

/// Error of the locked rows with a one-off event over that without, above which the event is refused. Chosen by
/// judgement: they may hold the rest of the event, so that a tenth is no sign against it; larger lets an event distort
/// the base.
const EVENT_ERROR_RATIO: f64 = 1.1;
/// The same of a named effect whose loss is certain from block to block. Chosen by judgement: what is to be compensated
/// may not cost more than the scatter of such a ratio, some per cent.
const NAMED_ERROR_RATIO: f64 = 1.03;
/// The same of a structure without a name, which is not compensated. Chosen by judgement: it may err by half where the locked rows
/// suit its form less; larger keeps structures that only the open rows show.
const UNNAMED_ERROR_RATIO: f64 = 1.5;

/// Whether open and locked rows together carry an effect. Locked rows that can show it have to: alone, and together with the open
/// ones, as their deviations, weighted by what each can tell, make one p-value (Liptak 1958); there the locked rows count double, as
/// of what the open ones could tell much is spent on the choice. Of what is clear on the open ones they only have to ask for more than
/// half. Nothing carries what makes the locked rows clearly worse, whitened
/// and not: beside larger effects, whose formulas err slowly, whitening may see a loss where the error falls. A structure without a
/// name is not compensated: of it the locked rows may ask for less.
pub(crate) fn is_carried(settings: &Settings, label: &Label, family_wise: f64, locked: &Proof) -> bool {
    let is_clear = family_wise < settings.unconfirmed_level;
    let is_shown = if locked.expected_deviations < SHOWN_DEVIATIONS {
        is_clear
    } else {
        let weight = (LOCKED_WEIGHT * locked.locked_share).min(LARGEST_LOCKED_WEIGHT);
        let together = (1.0 - weight).sqrt() * deviations_of(family_wise) + weight.sqrt() * locked.locked_deviations;
        let is_asked_for = locked.locked_deviations > SHOWN_DEVIATIONS;
        is_asked_for && together > deviations_of(settings.family_wise_level)
            || is_clear && locked.gain_nats > 0.0
            || locked.shows_gain()
    };
    let is_to_be_compensated = matches!(label, Label::Named(_));
    let may_be_worse = !is_to_be_compensated && locked.improved_rmse <= UNNAMED_ERROR_RATIO * locked.baseline_rmse;
    let errs_more = locked.ratio_ci95[0] > 1.0 && locked.improved_rmse > NAMED_ERROR_RATIO * locked.baseline_rmse;
    is_shown && (may_be_worse || !is_worse(settings, locked)) && !(is_to_be_compensated && errs_more)
}

/// Whether an effect makes the locked rows clearly worse.
fn is_worse(settings: &Settings, locked: &Proof) -> bool {
    locked.gain_nats < -settings.largest_locked_loss && locked.improved_rmse >= locked.baseline_rmse
}

/// Whether an event makes the locked rows clearly worse: they may hold the rest of it, so that a little more of it in the base
/// costs many nats.
pub(crate) fn is_worse_by_an_event(settings: &Settings, locked: &Proof) -> bool {
    is_worse(settings, locked) && locked.improved_rmse > EVENT_ERROR_RATIO * locked.baseline_rmse
}

/// Standard deviations that a normal variable exceeds with a probability.
fn deviations_of(probability: f64) -> f64 {
    std::f64::consts::SQRT_2 * erfc_inv(2.0 * probability.max(f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypotheses::channel::Channel;
    use crate::diagnose::hypotheses::function_form::Form;
    use crate::diagnose::hypotheses::unnamed::{Factor, Generic};
    use crate::physics::EffectId;

    const NAMED: Label = Label::Named(EffectId::Stribeck);

    fn named_is_carried(family_wise: f64, locked_deviations: f64, gain_nats: f64) -> bool {
        let locked = Proof {
            gain_nats,
            locked_deviations,
            expected_deviations: 2.0,
            locked_share: 0.2,
            ratio_ci95: [0.9, 1.1],
            ..Proof::default()
        };
        is_carried(&Settings::default(), &NAMED, family_wise, &locked)
    }

    #[test]
    fn locked_rows_decide_about_a_candidate() {
        assert!(named_is_carried(0.03, 2.8, 3.0));
        assert!(!named_is_carried(0.03, 0.5, 0.0), "the locked rows hardly ask for it");
        assert!(!named_is_carried(1e-3, 1.6, 1.2) && named_is_carried(1e-3, 1.7, 1.4));
        assert!(named_is_carried(1e-8, 1.1, 0.2), "what is clear on the open rows stands");
        assert!(!named_is_carried(1e-8, 0.9, -0.2), "unless the locked ones ask for less than half of it");
        assert!(!named_is_carried(1e-30, -2.0, -20.0), "nothing survives locked rows that clearly speak against it");
    }

    #[test]
    fn what_the_locked_rows_tell_counts_double() {
        // Weighted by their shares alone the deviations would make 2.41, and 2.51 are needed.
        assert!(named_is_carried(0.05, 2.1, 2.5));
        assert!(!named_is_carried(0.1, 1.9, 2.5));
    }

    #[test]
    fn what_the_locked_rows_can_hardly_show_needs_open_ones_that_are_sure() {
        let carried = |family_wise: f64, expected_deviations: f64| {
            let blind =
                Proof { expected_deviations, locked_deviations: -0.2, ratio_ci95: [0.9, 1.1], ..Proof::default() };
            is_carried(&Settings::default(), &NAMED, family_wise, &blind)
        };
        let level = Settings::default().unconfirmed_level;
        assert!(carried(0.9 * level, 1.6) && !carried(1.1 * level, 1.6) && !carried(0.9 * level, 1.7));
    }

    #[test]
    fn deviations_belong_to_their_probability() {
        assert!((deviations_of(0.025) - 1.959_964).abs() < 1e-5);
        assert!((deviations_of(0.5)).abs() < 1e-12);
        assert!(deviations_of(0.0) > 37.0 && deviations_of(0.0).is_finite());
    }

    #[test]
    fn a_loss_behind_whitening_is_none_where_the_error_falls() {
        let locked = Proof {
            baseline_rmse: 242.0,
            improved_rmse: 142.0,
            ratio_ci95: [0.5, 0.7],
            expected_deviations: 8.0,
            gain_nats: -20.0,
            locked_deviations: -2.0,
            locked_share: 0.2,
            ..Proof::default()
        };
        assert!(is_carried(&Settings::default(), &NAMED, 1e-30, &locked));
    }

    #[test]
    fn of_a_structure_without_a_name_the_locked_rows_may_ask_for_less() {
        let unnamed = Label::Generic(Generic { factor: Factor::Sign, channel: Channel::Position, form: Form::Free });
        let less = Proof {
            gain_nats: -6.0,
            locked_deviations: 1.9,
            expected_deviations: 5.8,
            locked_share: 0.2,
            ratio_ci95: [0.9, 1.1],
            ..Proof::default()
        };
        assert!(
            is_carried(&Settings::default(), &unnamed, 1e-20, &less)
                && !is_carried(&Settings::default(), &NAMED, 1e-20, &less)
        );
        let far_worse = Proof { baseline_rmse: 1.0, improved_rmse: 2.0, ..less.clone() };
        assert!(!is_carried(&Settings::default(), &unnamed, 1e-20, &far_worse));
        let opposite = Proof { locked_deviations: -0.5, ..less };
        assert!(!is_carried(&Settings::default(), &unnamed, 1e-20, &opposite));
    }
}
