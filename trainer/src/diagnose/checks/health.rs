//! Measurement before physics: what is wrong with the recording itself.

use crate::diagnose::checks::note::HealthNote;
use crate::diagnose::checks::unit_or_sign::{contradicting_velocity, wrong_sign_or_unit};
use crate::diagnose::comparison::reference::{Comparison, Outside};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::states::Prepared;
use crate::figures::{digits, quantity};
use crate::numerics::statistics::quantile;
use crate::physics::EffectId;
use crate::samples::spikes::{PRINTED, Spikes};

/// Share of samples at one extreme torque from which it counts as clipped.
const CLIPPED_SHARE: f64 = 0.02;
/// A torque step of this share of the usual torque is worth a note, and of this hides friction.
const TELLING_TORQUE_SHARE: f64 = 0.01;
const COARSE_TORQUE_SHARE: f64 = 0.05;
/// Band in Hz that a coarse encoder has to leave for friction to be seen, and its step over the travel from which it is coarse.
const LEAST_BAND_HZ: f64 = 17.0;
const COARSE_STEP: f64 = 1e-4;

/// What is wrong with a torque as it was recorded.
#[derive(Clone, Debug)]
pub(crate) struct AsRecorded {
    notes: Vec<HealthNote>,
    step: Option<TorqueStep>,
}

impl AsRecorded {
    /// Looks at the torque of a recording, in the unit of its actuator.
    pub fn of(signals: &Signals, actuator: &str) -> Self {
        let step = torque_step(signals);
        let replaced = signals.spikes.iter().map(replaced);
        Self { notes: replaced.chain(clipped_torque(signals, step, actuator)).collect(), step }
    }

    /// The notes on it, beside a base that leaves some of it (root mean square).
    pub fn notes(&self, left_by_base: f64, actuator: &str) -> impl Iterator<Item = HealthNote> {
        self.notes.iter().cloned().chain(self.step.and_then(|step| coarse_torque(step, left_by_base, actuator)))
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
    let range = |(channel, [low, high], unit): &(String, [f64; 2], String)| {
        format!("{channel} from {} to {} {unit}", digits(*low), digits(*high))
    };
    let ranges = outside.channels.iter().map(range).collect::<Vec<_>>().join(", ");
    let share = 100.0 * beyond as f64 / outside.samples.len() as f64;
    Some(HealthNote {
        // Where a law ends nothing of the joint is missing.
        effect: EffectId::Unknown,
        blocking: false,
        sentence: format!(
            "the model was fitted on {ranges}: the {share:.1} % of the recording beyond that are not compared with it"
        ),
    })
}

/// Rows that no motion of the joint can explain and that were replaced.
fn replaced(spikes: &Spikes) -> HealthNote {
    let Spikes { channel, rows, time_s, height, unit } = spikes;
    let (height, time) = (quantity(*height, &unit.replace("Nm", "N m")), digits(*time_s));
    let sentence = if *rows == 1 {
        format!("one sample of the {channel} stands out alone, by {height} at {time} s: taken as a glitch and replaced")
    } else {
        format!(
            "{rows} samples of the {channel} stand out alone, the largest by {height} at {time} s: taken as glitches and replaced"
        )
    };
    HealthNote { effect: EffectId::TransientEvent, blocking: false, sentence }
}

/// Torque steps of more than the noise hide what happens between them, where they are a sizeable share of the torque or their own
/// error is as large as all that the base leaves.
fn coarse_torque(TorqueStep { step, share }: TorqueStep, left_by_base: f64, actuator: &str) -> Option<HealthNote> {
    (share > TELLING_TORQUE_SHARE).then(|| HealthNote {
        effect: EffectId::Quantisation,
        blocking: share > COARSE_TORQUE_SHARE || step / 12f64.sqrt() >= left_by_base,
        sentence: format!(
            "the torque is recorded in steps of {}, coarser than its own noise",
            quantity(step, actuator)
        ),
    })
}

/// The step in which a torque is recorded, and its share of the usual torque.
#[derive(Clone, Copy, Debug)]
struct TorqueStep {
    step: f64,
    share: f64,
}

/// The step in which the torque is recorded, where most of its changes are a single one.
fn torque_step(signals: &Signals) -> Option<TorqueStep> {
    const FEWEST_CHANGES: usize = 20;
    let usual = quantile(signals.torque.iter().map(|torque| torque.abs()), 0.9);
    let changes = signals.torque.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    // An even clock may fall a little beside the recorded samples, and so between two steps.
    let steps: Vec<f64> = changes.filter(|step| *step > 0.1 * TELLING_TORQUE_SHARE * usual).collect();
    let smallest = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let is_single = quantile(steps.iter().copied(), 0.5) < 1.5 * smallest;
    (steps.len() > FEWEST_CHANGES && is_single).then_some(TorqueStep { step: smallest, share: smallest / usual })
}

/// A torque that was put back to the time of the motion by `delay` (s) before anything was fitted.
pub(crate) fn late_torque(delay: f64, period: f64) -> HealthNote {
    let way = if delay > 0.0 { "later" } else { "earlier" };
    let samples = digits((delay / period).abs());
    HealthNote {
        effect: EffectId::TimeMisalignment,
        blocking: false,
        sentence: format!(
            "the torque was recorded {} ({samples} samples) {way} than the position, as drives do: it was put back",
            quantity(delay.abs(), "s")
        ),
    }
}

/// An encoder so coarse that its grain alone left only a few hertz of the motion.
pub(crate) fn coarse_position(signals: &Signals, prepared: &Prepared) -> Option<HealthNote> {
    let cut_off = prepared.filter.cut_off_hz;
    let is_coarse = signals.position_resolution > COARSE_STEP * prepared.state.span();
    let coarse = is_coarse && prepared.grain_limited && cut_off < LEAST_BAND_HZ;
    coarse.then(|| HealthNote {
        effect: EffectId::Quantisation,
        blocking: true,
        sentence: format!(
            "the position is recorded in steps of {}: its grain drowns everything above {cut_off} Hz",
            quantity(signals.position_resolution, if signals.rotary { "rad" } else { "m" })
        ),
    })
}

/// A position that was sampled at other instants than the clock says.
pub(crate) fn scattered_sampling(signals: &Signals, prepared: &Prepared) -> Option<HealthNote> {
    let periods = prepared.sampling_jitter / signals.period;
    (periods > 0.0).then(|| HealthNote {
        effect: EffectId::TimeMisalignment,
        blocking: false,
        sentence: format!(
            "the position is rough in proportion to the speed, as if the instants of its samples scattered by {} ({} samples), which \
             the clock does not show: what is derived from it is as wrong",
            quantity(prepared.sampling_jitter, "s"),
            digits(periods)
        ),
    })
}

fn clipped_torque(signals: &Signals, step: Option<TorqueStep>, actuator: &str) -> Option<HealthNote> {
    let top = signals.torque.iter().fold(0.0f64, |m, t| m.max(t.abs()));
    let share_from = |level: f64| {
        let at_least = signals.torque.iter().filter(|torque| torque.abs() >= level).count();
        at_least as f64 / signals.torque.len().max(1) as f64
    };
    let share = share_from(top * (1.0 - PRINTED));
    // Of a torque in coarse steps some samples are the highest anyway: at a limit there are twice as many as a step below it.
    let is_coarse_peak = step.is_some_and(|TorqueStep { step, .. }| share_from(top - 1.5 * step) > 1.5 * share);
    (top > 0.0 && share > CLIPPED_SHARE && !is_coarse_peak).then(|| HealthNote {
        effect: EffectId::Saturation,
        blocking: false,
        sentence: format!(
            "the torque stands at its limit of {} in {:.1} % of the samples",
            quantity(top, actuator),
            100.0 * share
        ),
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
        let blocking = |largest: f64| {
            torque_step(&in_steps(largest, largest))
                .and_then(|step| coarse_torque(step, f64::INFINITY, "N m"))
                .map(|note| note.blocking)
        };
        assert_eq!([blocking(5.0), blocking(40.0), blocking(400.0)], [Some(true), Some(false), None]);
    }

    #[test]
    fn fine_steps_block_where_they_are_all_that_is_left() {
        let as_recorded = AsRecorded::of(&in_steps(40.0, 40.0), "N m");
        let blocks = |left_by_base: f64| as_recorded.notes(left_by_base, "N m").any(|note| note.blocking);
        assert!(blocks(0.25) && !blocks(0.35));
    }

    #[test]
    fn the_highest_step_of_a_coarse_torque_is_no_limit() {
        let clipped = |signals: Signals| clipped_torque(&signals, torque_step(&signals), "N m");
        assert!(clipped(in_steps(5.0, 9.0)).is_none());
        assert!(clipped(in_steps(5.0, 3.0)).is_some());
        assert!(clipped(in_steps(400.0, 250.0)).is_some());
    }
}
