//! The time by which the torque of the actuator was recorded late or early: a drive holds its torque over a sample and logs it with a position
//! that it read at one edge of it. Left in, it reads as viscous friction: the jerk of a motion goes with its velocity.

use std::ops::Range;

use super::BendingLaw;
use super::prepare::{prepare, prepare_actuator};
use super::rigid_body::{given_torque, terms};
use super::{Preparation, SLIDING_SPEED_SHARE, Samples, top_speed};
use crate::error::Result;
use crate::joint::Joint;
use crate::numerics::jackknife::even_blocks;
use crate::numerics::products::dot;
use crate::numerics::regression::Columns;
use crate::numerics::statistics::t_statistic;
use crate::recording::Recording;

/// Delay in samples up to which it is the sampling's own: a torque held over a sample against a position read at either edge of it makes
/// up to one, and a quarter is left for the error of the estimate. A longer one is no matter of the sampling and stays: `diagnose` names it.
pub(crate) const LONGEST_SAMPLING_DELAY: f64 = 1.25;
/// Precision, per square of a sample, of the delay that sampling makes: it lies anywhere up to one sample to either side.
const SAMPLING_PRECISION: f64 = 3.0;
/// Parts of the samples whose gains are compared. Chosen by judgement: noise is independent between parts of a second and more.
const PARTS: usize = 20;
/// Gauss-Newton steps. The second corrects what a filter and a law that bends make of the first.
const STEPS: usize = 2;
/// Mean gain of the parts over its standard error above which a delay is put back: 99 % one-sided (2.33).
const LEAST_T_STATISTIC: f64 = 2.33;

/// By how much a torque was recorded late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SamplingDelay {
    /// What is put back, s; negative where early, 0 where the samples do not show one.
    pub put_back_s: f64,
    /// Root mean square of what may be left in where nothing is put back, s: by the samples and by what sampling makes.
    pub unknown_s: f64,
}

/// The delay with which rigid body and friction, identified anew, leave least of the torque where the joint slides; nothing is put back where the
/// samples do not show one, or one longer than the sampling's own. Friction that was separated before has no rigid body that tells it.
pub(crate) fn torque_delay(recordings: &[&Recording], joint: &Joint, preparation: &Preparation) -> SamplingDelay {
    let periods = recordings.iter().filter_map(|recording| recording.health.period_s);
    let period = periods.fold(f64::INFINITY, f64::min);
    let is_separated = recordings.iter().any(|recording| recording.separated_friction().is_some());
    if is_separated || preparation.sigma_s.is_none() || !period.is_finite() {
        return SamplingDelay::default();
    }
    let in_samples = |sliding: &Sliding| {
        let columns = Columns::of(&sliding.columns);
        let left = |samples: f64| {
            let torque =
                sliding.torque(recordings, &Preparation { torque_delay_s: samples * period, ..*preparation })?;
            Ok(columns.residuals(&torque))
        };
        estimated(&left)
    };
    let sliding = Sliding::of(recordings, joint, preparation).ok();
    match sliding.as_ref().and_then(in_samples) {
        Some(Estimated { samples, is_shown: true, .. }) => {
            SamplingDelay { put_back_s: samples * period, unknown_s: 0.0 }
        }
        Some(estimated) => SamplingDelay { put_back_s: 0.0, unknown_s: estimated.unknown() * period },
        None => SamplingDelay { put_back_s: 0.0, unknown_s: period / SAMPLING_PRECISION.sqrt() },
    }
}

/// A delay in samples.
struct Estimated {
    samples: f64,
    /// Its standard error.
    error: f64,
    /// Whether the parts of what is left show it.
    is_shown: bool,
}

impl Estimated {
    /// Root mean square of the delay, by the estimate and by what sampling makes.
    fn unknown(&self) -> f64 {
        let (data, sampling) = ((self.error * self.error).recip(), SAMPLING_PRECISION);
        let mean = data / (data + sampling) * self.samples;
        (mean * mean + (data + sampling).recip()).sqrt()
    }
}

/// The delay in samples, where it is one of the sampling.
fn estimated(left: &dyn Fn(f64) -> Result<Vec<f64>>) -> Option<Estimated> {
    let as_recorded = left(0.0).ok()?;
    let mut samples = 0.0;
    let mut error = f64::INFINITY;
    let mut least = as_recorded.clone();
    for _ in 0..STEPS {
        // What is left is nearly linear in the delay, so that its energy is a parabola.
        let [early, late] = [left(samples - 1.0).ok()?, left(samples + 1.0).ok()?];
        let slope: Vec<f64> = late.iter().zip(&early).map(|(late, early)| 0.5 * (late - early)).collect();
        let bend = dot(&slope, &slope).max(f64::MIN_POSITIVE);
        let of_part = |part: Range<usize>| dot(&slope[part.clone()], &least[part]);
        let scores: Vec<f64> = even_blocks(least.len(), PARTS).into_iter().map(of_part).collect();
        let mean = dot(&slope, &least) / scores.len().max(1) as f64;
        samples -= dot(&slope, &least) / bend;
        // What noise alone changes by from sample to sample tells no delay.
        let of_noise: f64 = least.windows(3).map(|noise| (0.5 * (noise[2] - noise[0])).powi(2)).sum();
        let told = (bend - of_noise).max(f64::MIN_POSITIVE);
        error = scores.iter().map(|score| (score - mean).powi(2)).sum::<f64>().sqrt() / told;
        if samples.abs() > LONGEST_SAMPLING_DELAY {
            return None;
        }
        least = left(samples).ok()?;
    }
    let gain = |part: Range<usize>| {
        let [before, after] = [&as_recorded, &least].map(|left| dot(&left[part.clone()], &left[part.clone()]));
        before - after
    };
    let gains: Vec<f64> = even_blocks(least.len(), PARTS).into_iter().map(gain).collect();
    Some(Estimated { samples, error, is_shown: t_statistic(&gains) > LEAST_T_STATISTIC })
}

/// The samples at which the joint slides, with what does not depend on the delay of the torque.
struct Sliding {
    rows: Vec<usize>,
    /// Columns of rigid body and friction.
    columns: Vec<Vec<f64>>,
    /// Torque of the rigid body that is given.
    given: Vec<f64>,
}

impl Sliding {
    fn of(recordings: &[&Recording], joint: &Joint, preparation: &Preparation) -> Result<Self> {
        let parts = recordings.iter().map(|recording| prepare(recording, preparation)).collect::<Result<Vec<_>>>()?;
        let samples = Samples::join(parts)?;
        let velocity = samples.require_velocity()?;
        let sliding = SLIDING_SPEED_SHARE * top_speed(velocity);
        let rows: Vec<usize> = (0..velocity.len()).filter(|&i| velocity[i].abs() > sliding).collect();
        let pick = |column: &[f64]| rows.iter().map(|&i| column[i]).collect::<Vec<f64>>();
        let velocity = pick(velocity);
        let mut columns: Vec<Vec<f64>> = terms(&samples, joint).iter().map(|term| pick(&term.column)).collect();
        columns.extend(BendingLaw::over(&velocity)?.columns(&velocity));
        let given = pick(&given_torque(&samples, joint)?);
        Ok(Self { columns, given, rows })
    }

    /// The torque that they have to explain, delayed as prepared.
    fn torque(&self, recordings: &[&Recording], preparation: &Preparation) -> Result<Vec<f64>> {
        let parts = recordings.iter().map(|recording| prepare_actuator(recording, preparation));
        let torque = parts.collect::<Result<Vec<_>>>()?.concat();
        Ok(self.rows.iter().zip(&self.given).map(|(&row, given)| torque[row] - given).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random::normal;
    use crate::recording::parse;
    use crate::samples::rigid_body::separate;
    use crate::samples::{Request, plan};
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    const PERIOD_S: f64 = 0.004;

    /// A body of 0.5 kg m2 with Coulomb friction of 2 N m and viscous friction of 1.2 N m s/rad under two tones, the faster one as large as
    /// given; its torque is recorded late.
    fn recorded(delay_s: f64, fast_rad: f64) -> Recording {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let tones = [(0.9, 2.3), (fast_rad, 7.9)];
        let sum = |t: f64, of: fn(f64, f64, f64) -> f64| tones.iter().map(|(a, w)| of(*a, *w, t)).sum::<f64>();
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for i in 0..10_000 {
            let t = PERIOD_S * f64::from(i);
            let then = t - delay_s;
            let velocity = sum(then, |a, w, t| a * w * (w * t).cos());
            let acceleration = sum(then, |a, w, t| -a * w * w * (w * t).sin());
            let torque =
                0.5 * acceleration + 2.0 * (velocity / 0.002).tanh() + 1.2 * velocity + 0.1 * normal(&mut random);
            text += &format!("{t},{},{torque}\n", sum(t, |a, w, t| a * (w * t).sin()));
        }
        parse("swing.csv", text.as_bytes(), &Joint::default()).unwrap()
    }

    fn planned(recording: &Recording) -> plan::Preparation {
        plan::Preparation::plan(&[recording], &Joint::default(), &Request::default()).unwrap()
    }

    #[test]
    fn a_torque_half_a_sample_early_is_found_and_put_back() {
        for delay_s in [-0.5 * PERIOD_S, 0.8 * PERIOD_S] {
            let recording = recorded(delay_s, 0.25);
            let planned = planned(&recording);
            let found = torque_delay(&[&recording], &Joint::default(), &planned).put_back_s;
            assert!((found - delay_s).abs() < 0.05 * PERIOD_S, "{found} s, and {delay_s} s is true");
            // Friction at 1 and 2 rad/s, from what the rigid body leaves.
            let viscous = |torque_delay_s: f64| {
                let samples = prepare(&recording, &Preparation { torque_delay_s, ..planned }).unwrap();
                let friction = separate(&samples, &Joint::default()).unwrap().friction;
                let velocity = samples.velocity.unwrap();
                let mean_near = |speed: f64| {
                    let near = velocity.iter().zip(&friction).filter(|(v, _)| (v.abs() - speed).abs() < 0.2);
                    let (sum, count) =
                        near.fold((0.0, 0.0), |(sum, count), (v, f)| (sum + f * v.signum(), count + 1.0));
                    sum / count
                };
                mean_near(2.0) - mean_near(1.0)
            };
            let [as_recorded, put_back] = [0.0, found].map(viscous);
            assert!((put_back - 1.2).abs() < 0.015, "{put_back} N m s/rad");
            assert!((as_recorded - 1.2).abs() > 0.03, "{as_recorded} N m s/rad: there is nothing to put back");
        }
    }

    #[test]
    fn friction_that_was_separated_before_has_no_delay() {
        let mut text = String::from("time_s,position_rad,velocity_rad_s,friction_torque_Nm\n");
        for i in 0..2000 {
            let t = PERIOD_S * f64::from(i);
            let velocity = (2.3 * t).cos();
            text += &format!("{t},{},{velocity},{}\n", (2.3 * t).sin() / 2.3, 2.0 * velocity.signum() + 1.2 * velocity);
        }
        let recording = parse("separated.csv", text.as_bytes(), &Joint::default()).unwrap();
        assert_eq!(torque_delay(&[&recording], &Joint::default(), &planned(&recording)), SamplingDelay::default());
    }

    #[test]
    fn no_delay_is_put_back_where_the_motion_shows_none_or_a_long_one() {
        for (delay_s, fast_rad) in [(0.0, 0.25), (3.0 * PERIOD_S, 0.25), (0.5 * PERIOD_S, 0.0)] {
            let recording = recorded(delay_s, fast_rad);
            let delay = torque_delay(&[&recording], &Joint::default(), &planned(&recording));
            assert_eq!(delay.put_back_s, 0.0, "{delay_s} s");
            assert!(delay_s > PERIOD_S || delay.unknown_s >= 0.9 * delay_s, "{delay_s} s: {delay:?}");
        }
    }
}
