//! A torque that was recorded at another time than the motion is put back before physics is looked for.

use crate::diagnose::answer::outcome::{Diagnosis, Finding};
use crate::diagnose::checks::health::late_torque;
use crate::diagnose::comparison::base::{LONGEST_SAMPLING_DELAY, delay_by_shifting};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::prepare::Prepared;
use crate::diagnose::run::{Options, Refusal};
use crate::physics::EffectId;
use std::borrow::Cow;

/// Realignments after the first: the linear regressor of a delay falls short of a long one.
const MOST_REALIGNMENTS: usize = 2;
/// Samples of the sampling's own delay from which it is felt.
const LEAST_SAMPLING_DELAY: f64 = 0.3;
/// Samples of a longer shift that are left to the regressor of a delay.
const LEFT_OF_A_SHIFT: f64 = 2.0;
/// Error over that of another diagnosis up to which it is as much.
const AS_MUCH: f64 = 1.02;
/// The same from which it is clearly less.
const CLEARLY_LESS: f64 = 0.8;

/// Diagnoses signals whose torque and motion belong together.
type Diagnose<'d> = &'d dyn Fn(&Signals) -> Result<Diagnosis, Refusal>;

/// Diagnoses signals with their torque put back to the time of the motion.
pub(crate) fn diagnose_in_step(signals: &Signals, options: &Options, diagnose: Diagnose) -> Result<Diagnosis, Refusal> {
    let shift = delay_by_shifting(Prepared::new(signals, options.lock), signals, options.base);
    let samples = shift / signals.period;
    if samples.abs() <= LONGEST_SAMPLING_DELAY {
        let is_felt = samples.abs() > LEAST_SAMPLING_DELAY;
        return diagnose_put_back(signals, if is_felt { shift } else { 0.0 }, diagnose);
    }
    let as_recorded = diagnose_put_back(signals, 0.0, diagnose)?;
    if misalignment(&as_recorded).is_some() {
        return Ok(as_recorded);
    }
    // What is left of the shift is short enough for the linear regressor of a delay.
    let left = LEFT_OF_A_SHIFT * signals.period * samples.signum();
    match diagnose_put_back(signals, shift - left, diagnose) {
        Ok(shifted) if misalignment(&shifted).is_some() && says_more_with_less(&shifted, &as_recorded) => Ok(shifted),
        _ => Ok(as_recorded),
    }
}

/// Whether a diagnosis leaves as much as another with fewer findings, or clearly less with no more.
fn says_more_with_less(one: &Diagnosis, other: &Diagnosis) -> bool {
    let (fewer, left) = (one.findings.len().cmp(&other.findings.len()), one.improved.rmse / other.improved.rmse);
    fewer.is_lt() && left < AS_MUCH || fewer.is_eq() && left < CLEARLY_LESS
}

/// Diagnoses a recording with its torque put back by `delay` (s), and by what the diagnosis then finds of it.
fn diagnose_put_back(signals: &Signals, delay: f64, diagnose: Diagnose) -> Result<Diagnosis, Refusal> {
    let put_back = |delay: f64| {
        let signals = if delay == 0.0 { Cow::Borrowed(signals) } else { Cow::Owned(signals.realigned(delay)) };
        diagnose(&signals).map(|diagnosis| Diagnosis { put_back_s: delay, ..diagnosis })
    };
    let mut first = put_back(delay)?;
    let Some(mut misaligned) = misalignment(&first).cloned() else {
        first.sampling_delay_s += delay;
        first.health.extend((delay != 0.0).then(|| late_torque(delay, signals.period)));
        return Ok(first);
    };
    let mut total = delay + misaligned.fitted.coefficients[0];
    let Ok(mut aligned) = put_back(total) else { return Ok(first) };
    for _ in 0..MOST_REALIGNMENTS {
        let Some(rest) = misalignment(&aligned) else { break };
        let longer = total + rest.fitted.coefficients[0];
        let Ok(again) = put_back(longer) else { break };
        (total, aligned) = (longer, again);
    }
    let moved = total - misaligned.fitted.coefficients[0];
    misaligned.fitted.coefficients[0] = total;
    if let Some(parameter) = misaligned.parameters.first_mut() {
        parameter.value += moved;
        parameter.ci95 = parameter.ci95.map(|end| end + moved);
    }
    let of_physics = |(finding, _): &(Finding, Vec<f64>)| finding.effect != EffectId::TimeMisalignment;
    let physics = aligned.findings.into_iter().zip(aligned.traces.effects).filter(of_physics);
    (aligned.findings, aligned.traces.effects) = physics.unzip();
    aligned.put_first(misaligned);
    aligned.baseline = first.baseline;
    if let (Some(proof), Some(before)) = (&mut aligned.proof, &first.proof) {
        let larger = before.baseline_rmse / proof.baseline_rmse;
        proof.ratio_ci95 = proof.ratio_ci95.map(|end| end / larger);
        proof.baseline_rmse = before.baseline_rmse;
    }
    Ok(aligned)
}

/// The finding that the torque was recorded at another time than the motion, where it is the first.
fn misalignment(diagnosis: &Diagnosis) -> Option<&Finding> {
    diagnosis.findings.first().filter(|f| f.effect == EffectId::TimeMisalignment && !f.fitted.coefficients.is_empty())
}
