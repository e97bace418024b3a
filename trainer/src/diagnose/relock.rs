//! Other rows are locked where a one-off event lay in those that were: nothing that fits it was open. Knows how a diagnosis reads,
//! not how it is made.

use crate::diagnose::answer::finding::{unexplained_event, unexplained_finding};
use crate::diagnose::answer::outcome::{Diagnosis, Verdict};
use crate::diagnose::answer::traces::WorstLocked;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::search::thresholds::OTHER_ROWS_ERROR_RATIO;
use crate::physics::EffectId;

/// Error of the worst locked stretch over that of the worst open one (root mean squares), above which it is a finding whatever it is. Chosen by judgement: four times the ratio that asks for another
/// lock; lower reports noise as an event.
const EVENT_FINDING_ERROR_RATIO: f64 = 6.0;

/// The locked stretch that the open rows do not explain.
pub(crate) fn locked_event(diagnosis: &Diagnosis) -> Option<WorstLocked> {
    let worst = diagnosis.traces.worst_locked().filter(|worst| worst.over_open > OTHER_ROWS_ERROR_RATIO);
    worst.filter(|_| diagnosis.lock == Lock::Spread)
}

/// Adds what happened once in the locked rows to a diagnosis that cannot name it.
pub(crate) fn add_locked_event(diagnosis: &mut Diagnosis, event: WorstLocked) {
    if event.over_open <= EVENT_FINDING_ERROR_RATIO {
        return;
    }
    match diagnosis.verdict {
        Verdict::BadData => {}
        Verdict::Consistent => {
            diagnosis.verdict = Verdict::Unexplained;
            diagnosis.findings.push(unexplained_finding(event, &diagnosis.traces));
            diagnosis.traces.effects.push(diagnosis.traces.left_within(event.when_s));
        }
        Verdict::MissingPhysics | Verdict::Unexplained => diagnosis.health.push(unexplained_event(event)),
    }
}

/// Whether a diagnosis with other rows locked names more of the event.
pub(crate) fn names_more(second: &Diagnosis, first: &Diagnosis, event: WorstLocked) -> bool {
    let events = |diagnosis: &Diagnosis| {
        diagnosis.findings.iter().filter(|finding| finding.effect == EffectId::TransientEvent).count()
    };
    let leaves_less = || second.traces.worst_locked().is_some_and(|left| left.over_open < event.over_open);
    events(second) > events(first) || events(second) == events(first) && events(first) > 0 && leaves_less()
}
