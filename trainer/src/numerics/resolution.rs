//! The step in which a converter gives a quantity, told apart from what the quantity travels from one sample to the next.
//!
//! Values of a quantised series are whole multiples of one step from each other, wherever it has been; travel at a constant speed is a
//! multiple of itself only within one stroke. A stroke that comes back over the very same places is told by its counts: a converter whose
//! speed is not exactly one step a sample shows no step or two of them now and then, travel never does.

use std::f64::consts::TAU;

/// Differences below this share of the largest value are the rounding of arithmetic.
const ROUNDING: f64 = 1e-12;
/// Multiples of the step up to which gaps are looked at: further ones add the error of the step itself.
const MOST_MULTIPLES: f64 = 10.5;
/// Mean cosine of the phase of the gaps within the step, half way between those of a series without steps (0) and of one in steps (1).
const IN_STEPS: f64 = 0.5;
/// Single steps in a row to each interruption of them in the same direction, from which they are travel: the speed would otherwise have
/// stayed within a tenth of one step a sample.
const TRAVEL: usize = 10;

/// Step of a series; `None` where it has none or never changes.
pub(crate) fn resolution(values: &[f64]) -> Option<f64> {
    resolution_of_stretches(std::iter::once(values))
}

/// Step of a series whose stretches may be shifted against each other by anything.
pub(crate) fn resolution_of_stretches<'a>(stretches: impl Iterator<Item = &'a [f64]> + Clone) -> Option<f64> {
    let rounding = ROUNDING * stretches.clone().flatten().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let step = {
        let mut all = Vec::new();
        for values in stretches.clone() {
            let mut of_stretch = gaps(values.to_vec(), rounding);
            // Of a series in one piece nothing is copied.
            if all.is_empty() { all = of_stretch } else { all.append(&mut of_stretch) }
        }
        common_step(&all)?
    };
    let counts = Counts::of(stretches.clone(), step);
    if counts.in_a_row <= TRAVEL * counts.interruptions.max(1) {
        return Some(step);
    }
    // The travel of one sample and that of another differ by whole steps as well, and so does none in passing.
    let travel = stretches.flat_map(|values| values.windows(2).map(|pair| (pair[1] - pair[0]).abs()));
    let in_passing = (counts.interruptions > 0).then_some(0.0);
    common_step(&gaps(travel.filter(|travel| *travel > rounding).chain(in_passing).collect(), rounding))
}

/// Gaps between neighbouring values of a series in the order of size.
fn gaps(mut values: Vec<f64>, rounding: f64) -> Vec<f64> {
    values.sort_unstable_by(f64::total_cmp);
    for next in 1..values.len() {
        values[next - 1] = values[next] - values[next - 1];
    }
    values.pop();
    values.retain(|gap| *gap > rounding);
    values
}

/// The step of which all gaps are multiples.
fn common_step(gaps: &[f64]) -> Option<f64> {
    let smallest = gaps.iter().copied().min_by(f64::total_cmp)?;
    // Text rounds each multiple a little up or down: first the single steps, then all within reach of their mean.
    let mut step = smallest;
    for reach in [1.5, MOST_MULTIPLES] {
        let near = gaps.iter().filter(|gap| **gap < reach * step);
        let (travelled, steps) = near.fold((0.0, 0.0), |(sum, steps), gap| (sum + gap, steps + (gap / step).round()));
        step = travelled / steps;
    }
    let phases = gaps.iter().filter(|gap| **gap < MOST_MULTIPLES * step).map(|gap| (TAU * gap / step).cos());
    let (sum, count) = phases.fold((0.0, 0.0), |(sum, count), cosine| (sum + cosine, count + 1.0));
    (sum > IN_STEPS * count).then_some(step)
}

/// How a series steps on in one direction.
#[derive(Default)]
struct Counts {
    /// Single steps at once after another in the same direction.
    in_a_row: usize,
    /// Samples without a step between two of the same direction, and steps of more than one.
    interruptions: usize,
}

impl Counts {
    fn of<'a>(stretches: impl Iterator<Item = &'a [f64]>, step: f64) -> Self {
        let mut counts = Self::default();
        for values in stretches {
            let steps = |at: usize| ((values[at + 1] - values[at]) / step).round();
            for at in 1..values.len().saturating_sub(1) {
                let (now, before) = (steps(at), steps(at - 1));
                counts.in_a_row += usize::from(now.abs() == 1.0 && now == before);
                let is_passed_over = at > 1 && before == 0.0 && now * steps(at - 2) > 0.0;
                counts.interruptions += usize::from(now.abs() > 1.0 || is_passed_over);
            }
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rounded(value: f64, step: f64) -> f64 {
        (value / step).round() * step
    }

    #[track_caller]
    fn assert_step(values: &[f64], wanted: f64) {
        let found = resolution(values).unwrap_or(0.0);
        assert!((found / wanted - 1.0).abs() < 0.01, "{found:e} for {wanted:e}");
    }

    /// Strokes there and back, one pair a speed (a sample), each as many samples long.
    fn strokes(speeds: &[f64], samples: usize) -> Vec<f64> {
        let mut position = 0.0;
        let directions = speeds.iter().flat_map(|speed| [*speed, -speed]);
        let steps = directions.flat_map(|step| vec![step; samples]);
        steps
            .map(|step| {
                position += step;
                position
            })
            .collect()
    }

    #[test]
    fn an_encoder_shows_its_step_however_its_text_is_rounded() {
        let step = TAU / 16384.0;
        for [amplitude, frequency] in [[0.9, 0.004], [2e-3, 0.01], [40.0, 0.03]] {
            let swing = |i: i32| amplitude * (frequency * f64::from(i)).sin();
            let encoder: Vec<f64> = (0..20_000).map(|i| rounded(swing(i), step)).collect();
            assert_step(&encoder, step);
            let text: Vec<f64> = encoder.iter().map(|value| rounded(*value, 1e-6)).collect();
            assert_step(&text, step);
        }
        // A joint at rest between two steps.
        let rest: Vec<f64> = (0..1000).map(|i| step * f64::from(5 + i32::from(i % 7 == 0))).collect();
        assert_step(&rest, step);
    }

    #[test]
    fn travel_is_no_step() {
        // Every stroke runs over the same places: nothing but the travel is ever seen.
        let same = strokes(&[1.33e-4; 10], 300);
        assert_eq!(resolution(&same), None);
        // Text in micrometres, at speeds that are no multiple of it.
        let text: Vec<f64> = strokes(&[1.333e-4; 4], 300).iter().map(|q| rounded(*q, 1e-6)).collect();
        assert_step(&text, 1e-6);
        let speeds: Vec<f64> = strokes(&[5.13e-5, 9.31e-5, 1.33e-4], 400).iter().map(|q| rounded(*q, 4e-6)).collect();
        assert_step(&speeds, 4e-6);
        // An encoder that is passed at nearly one step a sample.
        let encoder: Vec<f64> = strokes(&[0.97e-3; 4], 300).iter().map(|q| rounded(*q, 1e-3)).collect();
        assert_step(&encoder, 1e-3);
    }

    #[test]
    fn a_series_without_steps_has_none_that_matters() {
        let smooth: Vec<f64> = (0..5000).map(|i| (0.0137 * f64::from(i)).sin() + 0.1 * f64::from(i).sin()).collect();
        assert!(resolution(&smooth).is_none_or(|step| step < 1e-6));
        assert_eq!((resolution(&[2.0; 50]), resolution(&[])), (None, None));
    }

    #[test]
    fn stretches_may_be_shifted_against_each_other() {
        let swing: Vec<f64> = (0..4000).map(|i| rounded((0.01 * f64::from(i)).sin(), 1e-3)).collect();
        let shifted: Vec<f64> = swing.iter().map(|q| q + 3.1234e-4).collect();
        let found = resolution_of_stretches([&swing[..], &shifted].into_iter()).unwrap();
        assert!((found / 1e-3 - 1.0).abs() < 1e-6, "{found:e}");
    }
}
