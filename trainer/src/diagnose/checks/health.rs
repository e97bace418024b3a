//! Measurement before physics: what is wrong with the recording itself.

use crate::diagnose::checks::note::{HealthNote, Observation};
use crate::diagnose::checks::unit_or_sign::{contradicting_velocity, wrong_sign_or_unit};
use crate::diagnose::comparison::reference::{Comparison, Outside};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::statistics::quantile;
use crate::physics::EffectId;
use crate::samples::spikes::{PRINTED, Spikes};

/// Share (0..1) of the samples at one extreme torque, above which the torque is clipped. Chosen by judgement: a peak
/// that is only passed lies in few samples; lower takes peaks for limits, higher misses a limit that is seldom reached.
const CLIPPED_SHARE: f64 = 0.02;
/// Step of the recorded torque over its 90 % quantile, above which it is noted. Chosen by judgement: a hundredth of the
/// torque is a tenth of a friction that is a tenth of it.
const NOTED_STEP_SHARE: f64 = 0.01;
/// The same above which no effect is looked for: steps of a twentieth of the torque are half of a friction that is a
/// tenth of it. Chosen by judgement: the test `coarse_steps_are_told_and_block_where_they_hide_friction` holds both.
const BLOCKING_STEP_SHARE: f64 = 0.05;
/// Cut-off that a coarse encoder has to leave, Hz; below it no effect is looked for. Chosen by judgement: a reversal at half a hertz
/// still passes, with its harmonics; joints of MuJoCo behind encoders of 12 to 14 bits are answered rightly from 7 Hz on.
const LEAST_BAND_HZ: f64 = 6.0;
/// The same below which it is noted that the encoder hides what is faster. Chosen by judgement: the band of a motion and its reversals.
const NOTED_BAND_HZ: f64 = 17.0;
/// Step of the encoder over the travel above which it is coarse: fewer than ten thousand steps over the travel. Chosen
/// by judgement: lower blames an encoder for a noise that it does not make.
const COARSE_STEP_SHARE: f64 = 1e-4;

/// What is wrong with a torque as it was recorded.
#[derive(Clone, Debug)]
pub(crate) struct AsRecorded {
    notes: Vec<HealthNote>,
    step: Option<TorqueStep>,
}

impl AsRecorded {
    /// Looks at the torque of a recording.
    pub fn of(signals: &Signals) -> Self {
        let step = torque_step(signals);
        let replaced = signals.spikes.iter().map(replaced);
        Self { notes: replaced.chain(clipped_torque(signals, step)).collect(), step }
    }

    /// Whether the steps of the torque explain all that a base leaves of it (root mean square): rounding follows the motion as physics
    /// does, and beside it there is nothing to look for.
    pub fn explains(&self, left_by_base: f64) -> bool {
        self.step.is_some_and(|step| step.share > NOTED_STEP_SHARE && step.error() >= left_by_base)
    }

    /// The notes on it.
    pub fn notes(&self) -> impl Iterator<Item = HealthNote> {
        self.notes.iter().cloned().chain(self.step.and_then(coarse_torque))
    }
}

/// Looks at what the signals say of each other.
pub(crate) fn examine(comparison: &Comparison) -> Vec<HealthNote> {
    let mut notes = Vec::new();
    notes.extend(contradicting_velocity(&comparison.signals));
    notes.extend(wrong_sign_or_unit(comparison));
    notes.extend(comparison.reference.as_ref().and_then(|reference| beyond_the_model(&reference.outside)));
    notes
}

/// Rows at which the model is asked for more than it was fitted on.
fn beyond_the_model(outside: &Outside) -> Option<HealthNote> {
    let beyond = outside.samples.iter().filter(|beyond| **beyond).count();
    if outside.channels.is_empty() {
        return None;
    }
    Some(HealthNote {
        // Where a law ends nothing of the joint is missing.
        effect: EffectId::Unknown,
        blocking: false,
        observation: Observation::BeyondModelRange {
            channels: outside.channels.clone(),
            share: beyond as f64 / outside.samples.len() as f64,
        },
    })
}

/// Rows that no motion of the joint can explain and that were replaced.
fn replaced(spikes: &Spikes) -> HealthNote {
    let observation = Observation::Glitches(spikes.clone());
    HealthNote { effect: EffectId::TransientEvent, blocking: false, observation }
}

/// Torque steps of more than the noise hide what happens between them where they are a sizeable share of the torque.
fn coarse_torque(step: TorqueStep) -> Option<HealthNote> {
    (step.share > NOTED_STEP_SHARE).then_some(HealthNote {
        effect: EffectId::Quantisation,
        blocking: step.share > BLOCKING_STEP_SHARE,
        observation: Observation::CoarseTorque { step: step.step },
    })
}

/// The step in which a torque is recorded, and its share of the usual torque.
#[derive(Clone, Copy, Debug)]
struct TorqueStep {
    step: f64,
    share: f64,
}

impl TorqueStep {
    /// Standard deviation of a value that was rounded to it: uniform over the step.
    fn error(&self) -> f64 {
        self.step / 12f64.sqrt()
    }
}

/// The step in which the torque is recorded, where most of its changes are a single one.
fn torque_step(signals: &Signals) -> Option<TorqueStep> {
    /// Changes of the torque above which their median tells its step. Chosen by judgement: of fewer one step may be
    /// most by chance.
    const LEAST_TORQUE_CHANGES: usize = 20;
    let usual = quantile(signals.torque.iter().map(|torque| torque.abs()), 0.9);
    let changes = signals.torque.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    // An even clock may fall a little beside the recorded samples, and so between two steps.
    let steps: Vec<f64> = changes.filter(|step| *step > 0.1 * NOTED_STEP_SHARE * usual).collect();
    let smallest = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let is_single = quantile(steps.iter().copied(), 0.5) < 1.5 * smallest;
    (steps.len() > LEAST_TORQUE_CHANGES && is_single).then_some(TorqueStep { step: smallest, share: smallest / usual })
}

/// A torque that was put back to the time of the motion by `delay` (s) before anything was fitted.
pub(crate) fn late_torque(delay: f64, period: f64) -> HealthNote {
    HealthNote {
        effect: EffectId::TimeMisalignment,
        blocking: false,
        observation: Observation::RealignedTorque { delay_s: delay, period_s: period },
    }
}

/// An encoder so coarse that its grain alone left only a few hertz of the motion.
pub(crate) fn coarse_position(signals: &Signals, prepared: &Prepared) -> Option<HealthNote> {
    let cut_off = prepared.filter.cut_off_hz;
    let is_coarse = signals.position_resolution > COARSE_STEP_SHARE * prepared.state.span();
    let coarse = is_coarse && prepared.quantisation_limited && cut_off < NOTED_BAND_HZ;
    coarse.then_some(HealthNote {
        effect: EffectId::Quantisation,
        blocking: cut_off < LEAST_BAND_HZ,
        observation: Observation::CoarsePosition { step: signals.position_resolution, cut_off_hz: cut_off },
    })
}

/// A position that was sampled at other instants than the clock says.
pub(crate) fn scattered_sampling(signals: &Signals, prepared: &Prepared) -> Option<HealthNote> {
    let deviation_s = prepared.sampling_jitter;
    (deviation_s > 0.0).then_some(HealthNote {
        effect: EffectId::TimeMisalignment,
        blocking: false,
        observation: Observation::SamplingJitter { deviation_s, period_s: signals.period },
    })
}

fn clipped_torque(signals: &Signals, step: Option<TorqueStep>) -> Option<HealthNote> {
    let top = signals.torque.iter().fold(0.0f64, |m, t| m.max(t.abs()));
    let share_from = |level: f64| {
        let at_least = signals.torque.iter().filter(|torque| torque.abs() >= level).count();
        at_least as f64 / signals.torque.len().max(1) as f64
    };
    let share = share_from(top * (1.0 - PRINTED));
    // Of a torque in coarse steps some samples are the highest anyway: at a limit there are twice as many as a step below it.
    let is_coarse_peak = step.is_some_and(|TorqueStep { step, .. }| share_from(top - 1.5 * step) > 1.5 * share);
    (top > 0.0 && share > CLIPPED_SHARE && !is_coarse_peak).then_some(HealthNote {
        effect: EffectId::Saturation,
        blocking: false,
        observation: Observation::ClippedTorque { limit: top, share },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A torque of up to `largest` that swings, in steps of one.
    fn in_steps(largest: f64, limit: f64) -> Signals {
        let torque = (0..4000).map(|i| (largest * (0.01 * f64::from(i)).sin()).round().clamp(-limit, limit)).collect();
        Signals { torque, ..Signals::default() }
    }

    #[test]
    fn coarse_steps_are_told_and_block_where_they_hide_friction() {
        let blocking =
            |largest: f64| torque_step(&in_steps(largest, largest)).and_then(coarse_torque).map(|note| note.blocking);
        assert_eq!([blocking(5.0), blocking(40.0), blocking(400.0)], [Some(true), Some(false), None]);
    }

    #[test]
    fn a_base_that_leaves_no_more_than_the_steps_lacks_nothing() {
        for (largest, is_coarse) in [(5.0, true), (40.0, false)] {
            let as_recorded = AsRecorded::of(&in_steps(largest, largest));
            assert!(as_recorded.explains(0.25) && !as_recorded.explains(0.35));
            let notes: Vec<HealthNote> = as_recorded.notes().collect();
            assert!(notes.len() == 1 && notes[0].blocking == is_coarse, "{notes:?}");
        }
        assert!(!AsRecorded::of(&in_steps(400.0, 400.0)).explains(0.1), "fine steps are no fault");
    }

    #[test]
    fn the_highest_step_of_a_coarse_torque_is_no_limit() {
        let clipped = |signals: Signals| clipped_torque(&signals, torque_step(&signals));
        assert!(clipped(in_steps(5.0, 9.0)).is_none());
        assert!(clipped(in_steps(5.0, 3.0)).is_some());
        assert!(clipped(in_steps(400.0, 250.0)).is_some());
    }
}
