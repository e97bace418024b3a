//! Measurement before physics: what is wrong with the recording itself.

use super::prepare::Prepared;
use super::reference::Outside;
use super::signals::Signals;
use super::traces::WorstLocked;
use super::unit_or_sign::{contradicting_velocity, wrong_sign_or_unit};
use crate::figures::{digits, quantity};
use crate::physics::EffectId;
use crate::samples::spikes::Spikes;
use crate::statistics::quantile;
use serde::Serialize;

/// A note on the measurement chain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HealthNote {
    /// The effect of the catalogue it stands for.
    pub effect: EffectId,
    /// Whether a diagnosis of physics makes no sense before it is repaired.
    pub blocking: bool,
    /// One sentence with figures.
    pub sentence: String,
}

/// Share of samples at one extreme torque from which it counts as clipped.
const CLIPPED_SHARE: f64 = 0.02;
/// A torque step of this share of the usual torque hides friction.
const COARSE_TORQUE_SHARE: f64 = 0.05;
/// Band in Hz that a coarse encoder has to leave for friction to be seen, and its step over the travel from which it is coarse.
const LEAST_BAND_HZ: f64 = 17.0;
const COARSE_STEP: f64 = 1e-4;

/// Looks at the signals alone.
pub fn examine(signals: &Signals) -> Vec<HealthNote> {
    let mut notes = Vec::new();
    notes.extend(signals.spikes.iter().map(replaced));
    notes.extend(clipped_torque(signals));
    notes.extend(contradicting_velocity(signals));
    notes.extend(wrong_sign_or_unit(signals));
    notes.extend(coarse_torque(signals));
    notes.extend(signals.reference.as_ref().and_then(|reference| beyond_the_model(&reference.outside)));
    notes
}

/// Rows at which the model is asked for more than it was fitted on.
fn beyond_the_model(outside: &Outside) -> Option<HealthNote> {
    let beyond = outside.samples.iter().filter(|beyond| **beyond).count();
    let [first, ..] = &outside.channels[..] else { return None };
    let range = |(channel, [low, high], unit): &(String, [f64; 2], String)| {
        format!("{channel} from {} to {} {unit}", digits(*low), digits(*high))
    };
    let ranges = outside.channels.iter().skip(1).fold(range(first), |all, next| all + ", " + &range(next));
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

/// Torque steps of more than the noise hide what happens between them.
fn coarse_torque(signals: &Signals) -> Option<HealthNote> {
    let steps: Vec<f64> =
        signals.torque.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0).collect();
    let typical = quantile(steps.iter().copied(), 0.5);
    let smallest = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = quantile(signals.torque.iter().map(|t| t.abs()), 0.9);
    // Most changes are a single step, and the step is a sizeable share of the torque.
    let coarse = typical < 1.5 * smallest && smallest > COARSE_TORQUE_SHARE * spread && steps.len() > 20;
    coarse.then(|| HealthNote {
        effect: EffectId::Quantisation,
        blocking: true,
        sentence: format!("the torque is recorded in steps of {smallest:.4}, coarser than its own noise"),
    })
}

/// Something that happened once, in rows that were locked away.
pub(crate) fn unexplained_event(worst: WorstLocked, actuator: &str) -> HealthNote {
    let ([from, to], rms) = (worst.when_s.map(digits), quantity(worst.rms, actuator));
    HealthNote {
        effect: EffectId::TransientEvent,
        blocking: false,
        sentence: format!(
            "between {from} and {to} s the model is wrong by {rms} (root mean square), which nothing in the other rows is like"
        ),
    }
}

/// An encoder so coarse that its grain alone left only a few hertz of the motion.
pub(crate) fn coarse_position(signals: &Signals, prepared: &Prepared) -> Option<HealthNote> {
    let cut_off = prepared.filter.cut_off_hz;
    let (low, high) = prepared.state.travel();
    let is_coarse = signals.position_resolution > COARSE_STEP * (high - low);
    let coarse = is_coarse && prepared.grain_limited && cut_off < LEAST_BAND_HZ;
    coarse.then(|| HealthNote {
        effect: EffectId::Quantisation,
        blocking: true,
        sentence: format!(
            "the position is recorded in steps of {:.2e}: its grain drowns everything above {cut_off} Hz",
            signals.position_resolution
        ),
    })
}

fn clipped_torque(signals: &Signals) -> Option<HealthNote> {
    let top = signals.torque.iter().fold(0.0f64, |m, t| m.max(t.abs()));
    let at_top = signals.torque.iter().filter(|t| t.abs() >= top * (1.0 - 1e-6)).count();
    let share = at_top as f64 / signals.torque.len().max(1) as f64;
    (top > 0.0 && share > CLIPPED_SHARE).then(|| HealthNote {
        effect: EffectId::Saturation,
        blocking: false,
        sentence: format!("the torque stands at its limit of {top:.4} in {:.1} % of the samples", 100.0 * share),
    })
}
