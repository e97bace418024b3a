//! What can be held out so that it is new: a motion that is repeated stands on one side only.

use std::ops::Range;

use super::Samples;

/// A motion comes back where velocities a period apart differ by less than this share of their common power; a start that is
/// not repeated may take most of that.
const SAME_SHARE: f64 = 0.05;
/// Two recordings show one motion where they differ by less than this share.
const SAME_RECORDING_SHARE: f64 = 0.1;
/// Before a motion can come back it has to have left: velocities that differ by this share.
const DIFFERENT_SHARE: f64 = 0.5;
/// Points at which a motion is compared with itself.
const POINTS: usize = 3000;
/// Recordings of one motion may differ in length by this share.
const LENGTH_SHARE: f64 = 0.05;

/// The motion that each recording shows, numbered from zero: recordings of the same motion have one number.
#[must_use]
pub fn motions(samples: &Samples) -> Vec<usize> {
    let Some(velocity) = samples.velocity.as_deref() else { return (0..samples.recordings.len()).collect() };
    let mut first: Vec<&Range<usize>> = Vec::new();
    let mut numbers = Vec::with_capacity(samples.recordings.len());
    for (_, rows) in &samples.recordings {
        let known = first.iter().position(|other| same(&velocity[rows.clone()], &velocity[(*other).clone()]));
        numbers.push(known.unwrap_or(first.len()));
        if known.is_none() {
            first.push(rows);
        }
    }
    numbers
}

fn same(a: &[f64], b: &[f64]) -> bool {
    let length = a.len().min(b.len());
    let alike = a.len().abs_diff(b.len()) as f64 <= LENGTH_SHARE * length as f64;
    alike && length > 0 && difference(&a[..length], &b[..length]) < SAME_RECORDING_SHARE
}

/// Mean square of the difference over the sum of the mean squares: 0 for equal series, 1 for unrelated ones.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let power: f64 = a.iter().chain(b).map(|x| x * x).sum();
    let apart: f64 = a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum();
    apart / power.max(f64::MIN_POSITIVE)
}

/// Period, in samples, of a motion that repeats itself over the whole of `rows`, at least twice; `None` where it does not.
#[must_use]
pub fn period(samples: &Samples, rows: &Range<usize>) -> Option<usize> {
    let velocity = samples.velocity.as_deref()?.get(rows.clone())?;
    let stride = velocity.len().div_ceil(POINTS).max(1);
    let mean = velocity.iter().sum::<f64>() / velocity.len().max(1) as f64;
    let points: Vec<f64> = velocity.iter().step_by(stride).map(|v| v - mean).collect();
    let at = |lag: usize| difference(&points[lag..], &points[..points.len() - lag]);
    let mut left = false;
    let mut best: Option<(usize, f64)> = None;
    for lag in 1..=points.len() / 2 {
        let apart = at(lag);
        left |= apart > DIFFERENT_SHARE;
        match best {
            Some((_, least)) if apart > least => break,
            _ if left && apart < SAME_SHARE => best = Some((lag, apart)),
            _ => {}
        }
    }
    best.map(|(lag, _)| lag * stride)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(parts: &[Vec<f64>]) -> Samples {
        let mut recordings = Vec::new();
        let mut start = 0;
        for part in parts {
            recordings.push((String::new(), start..start + part.len()));
            start += part.len();
        }
        Samples { recordings, ..Samples::of_velocity(parts.concat()) }
    }

    fn wave(frequencies: &[f64], noise: f64) -> Vec<f64> {
        let mut state = 1u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..4000).map(|i| frequencies.iter().map(|f| (f * f64::from(i)).sin()).sum::<f64>() + noise * draw()).collect()
    }

    #[test]
    fn a_sine_repeats_and_two_that_share_no_period_do_not() {
        let found = period(&samples(&[wave(&[0.02], 0.2)]), &(0..4000)).unwrap();
        assert!(found.abs_diff(314) <= 3, "{found}");
        assert_eq!(period(&samples(&[wave(&[0.013, 0.0297, 0.0711], 0.2)]), &(0..4000)), None);
        assert_eq!(period(&samples(&[vec![1.0; 4000]]), &(0..4000)), None);
    }

    #[test]
    fn two_takes_of_one_motion_have_one_number() {
        let (first, second) = (wave(&[0.02, 0.031], 0.1), wave(&[0.05], 0.1));
        let again: Vec<f64> = wave(&[0.02, 0.031], 0.2)[..3900].to_vec();
        assert_eq!(motions(&samples(&[first, second, again])), [0, 1, 0]);
        assert_eq!(motions(&samples(&[vec![1.0; 500], vec![2.0; 500]])), [0, 1]);
    }
}
