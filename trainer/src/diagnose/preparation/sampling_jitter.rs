//! The scatter of the instants at which the position was sampled, where the clock does not show it: an error in proportion to the
//! speed.

use crate::diagnose::measurement::signals::Signals;
use crate::numerics::statistics::{DEVIATION_PER_MEDIAN, quantile};
use crate::physics::JointState;

/// Sum of the squared weights of a fourth difference: 1 + 16 + 36 + 16 + 1.
const FOURTH_DIFFERENCE_GAIN: f64 = 1.0 + 16.0 + 36.0 + 16.0 + 1.0;
/// Speed over the top speed above which a sample is fast. Chosen by judgement: jitter shows in proportion to the speed,
/// and half of the top speed leaves enough samples.
const FAST_SPEED_SHARE: f64 = 0.5;
/// Speed over the top speed below which a sample shows the quantisation alone: jitter has a hundredth of its power
/// there.
const SLOW_SPEED_SHARE: f64 = 0.1;
/// Jitter in sample periods, up to which it may be the motion's own fourth difference and counts as none. Chosen by
/// judgement: `scattered_instants_are_told_from_the_grain_of_an_encoder` holds it from below; larger overlooks jitter.
const LEAST_JITTER_PERIODS: f64 = 0.05;
/// Samples of a kind above which their median is used: the deviation estimated from it then errs by about an eighth
/// (1.17 over the root of the samples).
const LEAST_SAMPLES: usize = 100;

/// Standard deviation of the instants of sampling, s: what the fourth differences of the position have at high speed beyond those
/// at low speed and the encoder's grain. 0 where that is little, and where the clock tells the instants.
pub(crate) fn sampling_jitter(signals: &Signals, state: &JointState) -> f64 {
    if signals.resampled {
        return 0.0;
    }
    let top_speed = state.top_speed();
    let (mut fast, mut slow) = (Vec::new(), Vec::new());
    for segment in &signals.segments {
        for i in segment.start + 2..segment.end.saturating_sub(2) {
            let [a, b, c, d, e] = [i - 2, i - 1, i, i + 1, i + 2].map(|j| signals.position[j]);
            let difference = a - 4.0 * b + 6.0 * c - 4.0 * d + e;
            let speed = state.velocity[i].abs();
            if speed > FAST_SPEED_SHARE * top_speed {
                fast.push((difference.abs(), speed));
            } else if speed < SLOW_SPEED_SHARE * top_speed {
                slow.push(difference.abs());
            }
        }
    }
    if fast.len() < LEAST_SAMPLES {
        return 0.0;
    }
    let power = |differences: &mut dyn Iterator<Item = f64>| {
        (DEVIATION_PER_MEDIAN * quantile(differences, 0.5)).powi(2) / FOURTH_DIFFERENCE_GAIN
    };
    let at_low_speed = if slow.len() < LEAST_SAMPLES { 0.0 } else { power(&mut slow.into_iter()) };
    let of_grain = signals.position_resolution.powi(2) / 12.0;
    let beyond = power(&mut fast.iter().map(|(difference, _)| *difference)) - at_low_speed.max(of_grain);
    let speed = quantile(fast.iter().map(|(_, speed)| *speed), 0.5);
    let jitter = beyond.max(0.0).sqrt() / speed.max(f64::MIN_POSITIVE);
    if jitter < LEAST_JITTER_PERIODS * signals.period { 0.0 } else { jitter }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::preparation::rows::Lock;
    use crate::diagnose::preparation::states::{Known, Prepared};
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    /// A swing sampled every millisecond, each time some periods early or late, by an encoder of some steps a radian.
    fn swing(jitter_periods: f64, steps: f64) -> Signals {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let time: Vec<f64> = (0..10_000).map(|i| 1e-3 * f64::from(i)).collect();
        let position = |t: &f64| {
            let at = t + 1e-3 * jitter_periods * normal(&mut random);
            (steps * ((3.0 * at).sin() + 0.3 * (11.0 * at).sin())).round() / steps
        };
        let position = time.iter().map(position).collect();
        let torque = time.iter().map(|t| (3.0 * t).cos()).collect();
        Signals { position_resolution: 1.0 / steps, ..Signals::without_gap(1e-3, time, position, torque) }
    }

    #[test]
    fn scattered_instants_are_told_from_the_grain_of_an_encoder() {
        let periods = |signals: &Signals| {
            Prepared::new(signals, Known::of(signals), Lock::Nothing).sampling_jitter / signals.period
        };
        let scattered = periods(&swing(0.2, 1e5));
        assert!((scattered - 0.2).abs() < 0.03, "{scattered}");
        for steps in [1e3, 1e4, 1e6] {
            let even = periods(&swing(0.0, steps));
            assert_eq!(even, 0.0, "{steps} steps a radian");
        }
    }
}
