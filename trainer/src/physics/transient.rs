//! F3, Kulldorff 1997: a one-off event, found by scanning windows in time. The windows are proposed by the residual itself,
//! so their score pays for all that were looked at.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;
use std::ops::Range;

pub(super) struct TransientEvent;

/// Lengths of the scanned windows, s, in steps of three at which a window still holds most of an event (Kulldorff
/// 1997); refined afterwards. Chosen by judgement: shorter ones are glitches, longer ones drift.
const WINDOWS_S: [f64; 4] = [0.12, 0.35, 1.0, 3.0];

/// Windows of a length that are proposed. A limit of the computing time; the score pays for all that were scanned.
const PROPOSED_WINDOWS: usize = 6;

/// Mean deviation of a window in medians of a sample's deviation, above which its edges show by themselves and are
/// fitted. Chosen by judgement: what such an event is left with beside a window that misses its edges would pass for
/// strong noise; lower fits the edges of noise.
const EDGE_DEVIATION_RATIO: f64 = 6.0;

/// Of all windows at half-window steps, those in which the residual of the base deviates most on one side, a clear one from edge
/// to edge. Samples slower than `slow` do not count: near standstill the residual is that of stiction.
fn most_deviating(state: &JointState, window: f64, slow: f64) -> Vec<Shape> {
    let rest: Vec<f64> = state.torque.iter().zip(&state.predicted).map(|(t, p)| t - p).collect();
    let moving: Vec<bool> = state.velocity.iter().map(|v| v.abs() > slow).collect();
    let count = moving.iter().filter(|m| **m).count().max(1) as f64;
    let mean = rest.iter().zip(&moving).filter(|(_, m)| **m).map(|(r, _)| r).sum::<f64>() / count;
    let deviation = |range: &Range<usize>| {
        let sum: f64 = range.clone().filter(|&i| moving[i]).map(|i| rest[i] - mean).sum();
        let moved = range.clone().filter(|&i| moving[i]).count().max(1) as f64;
        (sum, moved)
    };
    let energy = |range: &Range<usize>| {
        let (sum, moved) = deviation(range);
        sum * sum / moved
    };
    let length = ((window / state.period) as usize).max(2);
    let mut windows: Vec<(f64, Range<usize>, &Range<usize>)> = Vec::new();
    for segment in &state.segments {
        let mut begin = segment.start;
        while begin < segment.end {
            let range = begin..(begin + length).min(segment.end);
            windows.push((energy(&range), range, segment));
            begin += (length / 2).max(1);
        }
    }
    windows.sort_by(|a, b| b.0.total_cmp(&a.0));
    let usual = quantile((0..rest.len()).filter(|&i| moving[i]).map(|i| (rest[i] - mean).abs()), 0.5);
    let proposed = windows.into_iter().take(PROPOSED_WINDOWS).map(|(_, range, segment)| {
        let (sum, moved) = deviation(&range);
        if sum.abs() > EDGE_DEVIATION_RATIO * usual * moved { from_edge_to_edge(range, segment, energy) } else { range }
    });
    proposed.map(|range| vec![state.time[range.start], state.time[range.end - 1] + state.period]).collect()
}

/// Moves the ends of a range within another to where it has most energy, by steps that halve.
fn from_edge_to_edge(
    range: Range<usize>,
    within: &Range<usize>,
    energy: impl Fn(&Range<usize>) -> f64,
) -> Range<usize> {
    let mut step = range.len() / 2;
    let mut best = (energy(&range), range);
    while step > 0 {
        let Range { start, end } = best.1;
        let moved = [
            start.saturating_sub(step).max(within.start)..end,
            start + step..end,
            start..end.saturating_sub(step),
            start..(end + step).min(within.end),
        ];
        let weighed = moved.into_iter().filter(|range| range.len() >= 2).map(|range| (energy(&range), range));
        match weighed.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|moved| moved.0 > best.0) {
            Some(better) => best = better,
            None => step /= 2,
        }
    }
    best.1
}

impl Hypothesis for TransientEvent {
    fn id(&self) -> EffectId {
        EffectId::TransientEvent
    }

    fn equation(&self) -> &'static str {
        "dF = A while t_1 <= t < t_2"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let speeds = [0.03 * state.top_speed(), 2.0 * state.sign_velocity];
        WINDOWS_S
            .into_iter()
            .flat_map(|window| speeds.into_iter().flat_map(move |slow| most_deviating(state, window, slow)))
            .collect()
    }

    fn scanned(&self, state: &JointState) -> Option<f64> {
        Some(WINDOWS_S.into_iter().map(|window| state.duration() / (0.5 * window)).sum())
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        vec![state.map(|i| f64::from(state.time[i] >= shape[0] && state.time[i] < shape[1]))]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("event_torque", "A", Dimension::Torque)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("event_start", "t_1", Dimension::Second),
            ShapeName::new("event_end", "t_2", Dimension::Second),
        ]
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some((*state.time.first()?, *state.time.last()?))
    }

    fn step(&self, _state: &JointState, _index: usize, shape: &[f64]) -> f64 {
        0.3 * (shape[1] - shape[0]).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_grows_and_shrinks_to_the_edges_of_what_it_lies_on() {
        let event = 37..91;
        let energy = |range: &Range<usize>| {
            let sum = range.clone().filter(|i| event.contains(i)).count() as f64;
            sum * sum / range.len() as f64
        };
        for window in [40..50, 80..180, 30..100, 0..60] {
            assert_eq!(from_edge_to_edge(window, &(0..200), energy), event);
        }
        assert_eq!(from_edge_to_edge(40..50, &(40..60), energy), 40..60);
    }
}
