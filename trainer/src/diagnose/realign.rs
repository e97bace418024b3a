//! A torque that was recorded at another time than the motion is put back before physics is looked for: which delay to try
//! next, and what the trials say together. Knows how a diagnosis reads, not how it is made.

use crate::diagnose::answer::outcome::{Diagnosis, Finding};
use crate::diagnose::checks::health::late_torque;
use crate::diagnose::search::thresholds::EQUAL_ERROR_RATIO;
use crate::physics::EffectId;
use crate::samples::delay::LONGEST_SAMPLING_DELAY;

/// Realignments after the first: the linear regressor of a delay falls short of a long one. A limit of the computing
/// time.
const MOST_REALIGNMENTS: usize = 2;
/// Delay in samples above which the torque is shifted before the search. Chosen by judgement: less is carried by the
/// nuisance of a delay, to first order; a larger value leaves its second order to the hypotheses.
const LEAST_SAMPLING_DELAY: f64 = 0.3;
/// Samples of a longer shift that are left to the linear regressor of a delay, which names it. Chosen by judgement:
/// fewer are the sampling's own and name nothing, more are beyond its first order.
const SAMPLES_LEFT_TO_REGRESSOR: f64 = 2.0;
/// The same below which the first leaves so much less that it is preferred with as many findings. Chosen by judgement:
/// nearer to one a chance optimum names a delay, smaller misses one.
const LESSER_ERROR_RATIO: f64 = 0.8;

/// A diagnosis of signals whose torque was put back by a delay.
pub(crate) struct Trial {
    /// The delay in s; positive where the torque was recorded late.
    pub delay_s: f64,
    /// What came of it.
    pub diagnosis: Diagnosis,
}

/// Where the trials begin, by the shift of the torque (s) with which the base explains most of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Realignment {
    shift_s: f64,
    period_s: f64,
}

impl Realignment {
    pub(crate) fn new(shift_s: f64, period_s: f64) -> Self {
        Self { shift_s, period_s }
    }

    fn samples(self) -> f64 {
        self.shift_s / self.period_s
    }

    /// The delay to begin with, s: the sampling's own where it is felt, and none of a longer shift, which may be physics.
    pub(crate) fn first_delay_s(self) -> f64 {
        let samples = self.samples().abs();
        if samples > LEAST_SAMPLING_DELAY && samples <= LONGEST_SAMPLING_DELAY { self.shift_s } else { 0.0 }
    }

    /// The delay to begin with again where the first beginning found no misalignment, s: what is left of a longer shift is short
    /// enough for the linear regressor of a delay.
    pub(crate) fn second_delay_s(self, first: &Diagnosis) -> Option<f64> {
        let is_long = self.samples().abs() > LONGEST_SAMPLING_DELAY;
        let left = SAMPLES_LEFT_TO_REGRESSOR * self.period_s * self.samples().signum();
        (is_long && misalignment(first).is_none()).then_some(self.shift_s - left)
    }
}

/// The delay to try after the given trials, s: the last one and what it left. `None` where the torque is in step, or was moved often
/// enough.
pub(crate) fn next_delay_s(trials: &[Trial]) -> Option<f64> {
    let last = trials.last().filter(|_| trials.len() < 2 + MOST_REALIGNMENTS)?;
    misalignment(&last.diagnosis).map(|finding| last.delay_s + finding.fitted.coefficients[0])
}

/// What trials from one beginning say together: the physics of the last, behind the misalignment that the first found.
pub(crate) fn joined(mut trials: Vec<Trial>, period_s: f64) -> Option<Diagnosis> {
    let last = trials.pop()?;
    let mut diagnosis = Diagnosis { realigned_by_s: last.delay_s, ..last.diagnosis };
    let Some(Trial { diagnosis: first, .. }) = trials.into_iter().next() else {
        if misalignment(&diagnosis).is_none() {
            diagnosis.sampling_delay_s += last.delay_s;
            diagnosis.health.extend((last.delay_s != 0.0).then(|| late_torque(last.delay_s, period_s)));
        }
        return Some(diagnosis);
    };
    let mut misaligned = misalignment(&first)?.clone();
    let moved = last.delay_s - misaligned.fitted.coefficients[0];
    misaligned.fitted.coefficients[0] = last.delay_s;
    if let Some(parameter) = misaligned.parameters.first_mut() {
        parameter.value += moved;
        parameter.ci95 = parameter.ci95.map(|end| end + moved);
    }
    let of_physics = |(finding, _): &(Finding, Vec<f64>)| finding.effect != EffectId::TimeMisalignment;
    let physics = diagnosis.findings.into_iter().zip(diagnosis.traces.effects).filter(of_physics);
    (diagnosis.findings, diagnosis.traces.effects) = physics.unzip();
    diagnosis.put_first(misaligned, Vec::new());
    diagnosis.baseline = first.baseline;
    if let (Some(proof), Some(before)) = (&mut diagnosis.proof, &first.proof) {
        let larger = before.baseline_rmse / proof.baseline_rmse;
        proof.ratio_ci95 = proof.ratio_ci95.map(|end| end / larger);
        proof.baseline_rmse = before.baseline_rmse;
    }
    Some(diagnosis)
}

/// Whether a second beginning says more than the first: a misalignment, with fewer findings that leave as much, or no more that leave
/// clearly less.
pub(crate) fn is_better(second: &Diagnosis, first: &Diagnosis) -> bool {
    let (fewer, left) = (second.findings.len().cmp(&first.findings.len()), second.improved.rmse / first.improved.rmse);
    let says_more = fewer.is_lt() && left < EQUAL_ERROR_RATIO || fewer.is_eq() && left < LESSER_ERROR_RATIO;
    misalignment(second).is_some() && says_more
}

/// The finding that the torque was recorded at another time than the motion, where it is the first beside the friction level of the
/// reference.
fn misalignment(diagnosis: &Diagnosis) -> Option<&Finding> {
    let first = diagnosis.findings.iter().find(|finding| finding.effect != EffectId::FrictionLevel);
    first.filter(|f| f.effect == EffectId::TimeMisalignment && !f.fitted.coefficients.is_empty())
}
