//! Where a finding sits: evidence density along time and every channel, and the interval that holds most of it.

use super::channel::Channel;
use super::conclude::{Refit, weighted};
use super::prove::rest;
use super::search::Search;
use crate::physics::EffectId;
use std::ops::Range;

/// An interval of a channel with its share of the evidence and of the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Channel name; the sign of velocity is in the interval itself for `velocity`.
    pub channel: &'static str,
    /// Lower end in the channel's SI unit.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Share of the explained excess inside, 0..1.
    pub share_of_excess: f64,
    /// Share of the samples inside, 0..1.
    pub share_of_samples: f64,
}

/// Regions and times of one finding.
#[derive(Clone, Debug, Default)]
pub struct Location {
    /// Regions: first that which a sentence names, then the sharpest.
    pub regions: Vec<Region>,
    /// Stretches of time in s that hold the most evidence.
    pub when_s: Vec<[f64; 2]>,
}

/// Least surplus of the share of evidence over the share of samples at which a region is worth naming.
const TELLING: f64 = 0.12;

/// Bins a channel for the search of the maximal interval.
const BINS: usize = 40;

/// Locates one effect of a refit: the evidence that it adds to all the others.
pub(crate) fn locate(search: &Search, refit: &Refit, index: usize) -> Location {
    let runs = search.prepared.open_runs();
    let with = rest(search, refit);
    let effect = &refit.effects[index];
    let torque = weighted(&search.filtered_columns(&effect.label, &effect.shape), &effect.coefficients);
    let mut white_with = with.clone();
    let mut white_without: Vec<f64> = with.iter().zip(&torque).map(|(r, t)| r + t).collect();
    refit.noise.whiten(&mut white_with, &runs);
    refit.noise.whiten(&mut white_without, &runs);
    let rows: Vec<usize> = runs.iter().flat_map(Range::clone).collect();
    let density: Vec<f64> = rows.iter().map(|&i| 0.5 * (white_without[i].powi(2) - white_with[i].powi(2))).collect();
    let state = &search.prepared.state;
    let at_rows = |series: &[f64]| -> Vec<f64> { rows.iter().map(|&i| series[search.prepared.rows[i]]).collect() };
    let mut axes = vec![("velocity", at_rows(&state.velocity))];
    axes.extend(Channel::axes(state).into_iter().filter_map(|axis| Some((axis.name(), at_rows(&axis.series(state)?)))));
    let axes: Vec<(&'static str, &[f64])> = axes.iter().map(|(name, values)| (*name, values.as_slice())).collect();
    let mut location = locate_density(&axes, &at_rows(&state.time), &density);
    location.name_first(effect.label.effect());
    location
}

impl Region {
    /// Whether the region holds so much more of the evidence than of the samples that it is worth naming.
    #[must_use]
    pub fn is_telling(&self) -> bool {
        contrast(self) > TELLING
    }
}

impl Location {
    /// Puts first the sharpest region that says something of the effect: of an event that in time, of what lasts that of a channel.
    fn name_first(&mut self, effect: EffectId) {
        let says_something = |region: &Region| match effect {
            EffectId::TransientEvent => region.channel == "time",
            EffectId::SlowDrift | EffectId::WarmUp | EffectId::Unknown => true,
            _ => region.channel != "time",
        };
        let first = self.regions.iter().position(|region| region.is_telling() && says_something(region));
        if let Some(first) = first {
            self.regions[..=first].rotate_right(1);
        }
    }
}

/// Locates a density of evidence along time and along every axis, given as name and value a row.
pub(crate) fn locate_density(axes: &[(&'static str, &[f64])], time: &[f64], density: &[f64]) -> Location {
    let mut regions: Vec<Region> = axes.iter().filter_map(|(name, values)| interval(name, values, density)).collect();
    regions.sort_by(|a, b| contrast(b).total_cmp(&contrast(a)));
    Location { regions, when_s: when(time, density) }
}

/// How much denser the evidence is inside than on average, weighed by what it holds.
fn contrast(region: &Region) -> f64 {
    region.share_of_excess - region.share_of_samples
}

/// The interval of a channel with the largest evidence above the average (Kadane's maximal sum over quantile bins).
fn interval(channel: &'static str, values: &[f64], density: &[f64]) -> Option<Region> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let (&first, &last) = (order.first()?, order.last()?);
    if values[first] >= values[last] {
        return None;
    }
    let total: f64 = density.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let mean = total / density.len() as f64;
    // Equal values stay in one bin: parted they would stand in the order of time.
    let start_of_equals = |edge: usize| match order.get(edge) {
        Some(&row) => order.partition_point(|&i| values[i] < values[row]),
        None => edge,
    };
    let mut edges: Vec<usize> = (0..=BINS).map(|k| start_of_equals(order.len() * k / BINS)).collect();
    edges.dedup();
    let sums: Vec<f64> = edges.windows(2).map(|e| order[e[0]..e[1]].iter().map(|&i| density[i] - mean).sum()).collect();
    let best = maximal_sum(&sums);
    let (begin, end) = (edges[best.start], edges[best.end]);
    let inside: f64 = order[begin..end].iter().map(|&i| density[i]).sum();
    Some(Region {
        channel,
        from: values[order[begin]],
        to: values[order[end - 1]],
        share_of_excess: (inside / total).clamp(0.0, 1.0),
        share_of_samples: (end - begin) as f64 / order.len() as f64,
    })
}

/// Range of consecutive entries with the largest sum (Kadane).
fn maximal_sum(values: &[f64]) -> Range<usize> {
    let (mut best, mut best_sum) = (0..1, f64::NEG_INFINITY);
    let (mut begin, mut sum) = (0, 0.0);
    for (i, value) in values.iter().enumerate() {
        if sum <= 0.0 {
            (begin, sum) = (i, 0.0);
        }
        sum += value;
        if sum > best_sum {
            (best, best_sum) = (begin..i + 1, sum);
        }
    }
    best
}

/// Up to five stretches of time in which the evidence is densest.
fn when(time: &[f64], density: &[f64]) -> Vec<[f64; 2]> {
    let total: f64 = density.iter().sum();
    if total <= 0.0 || time.is_empty() {
        return Vec::new();
    }
    let mean = total / density.len() as f64;
    let width = (density.len() / 240).max(4);
    let mut sums: Vec<f64> = density.chunks(width).map(|c| c.iter().map(|d| d - 1.5 * mean).sum()).collect();
    let mut stretches = Vec::new();
    while stretches.len() < 5 {
        let best = maximal_sum(&sums);
        let gain: f64 = sums[best.clone()].iter().sum();
        if gain < 0.05 * total {
            break;
        }
        let end = (best.end * width).min(time.len()) - 1;
        stretches.push([time[best.start * width], time[end]]);
        sums[best].fill(f64::NEG_INFINITY);
    }
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maximal_sum_finds_the_best_stretch() {
        assert_eq!(maximal_sum(&[-1.0, 2.0, -0.5, 3.0, -4.0, 1.0]), 1..4);
        assert_eq!(maximal_sum(&[-3.0, -1.0, -2.0]), 1..2);
    }

    #[test]
    fn interval_holds_a_local_bump() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
        let density: Vec<f64> = values.iter().map(|v| if (0.3..0.4).contains(v) { 1.0 } else { 0.0 }).collect();
        let region = interval("position", &values, &density).unwrap();
        assert!((region.from - 0.3).abs() < 0.03 && (region.to - 0.4).abs() < 0.03, "{region:?}");
        assert!(region.share_of_excess > 0.99 && region.share_of_samples < 0.16);
    }

    #[test]
    fn equal_values_are_not_parted_by_time() {
        let values: Vec<f64> = (0..1000).map(|i| if i < 900 { 0.0 } else { 0.5 }).collect();
        let density: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i < 100))).collect();
        let region = interval("dwell", &values, &density).unwrap();
        assert!((region.from, region.to) == (0.0, 0.0) && region.share_of_samples == 0.9, "{region:?}");
    }

    #[test]
    fn what_lasts_is_placed_on_a_channel_and_an_event_in_time() {
        let region =
            |channel, share| Region { channel, from: 0.0, to: 1.0, share_of_excess: share, share_of_samples: 0.1 };
        let first = |effect: EffectId, of_velocity: f64| {
            let regions = vec![region("time", 0.8), region("velocity", of_velocity), region("load", 0.6)];
            let mut location = Location { regions, when_s: Vec::new() };
            location.name_first(effect);
            location.regions[0].channel
        };
        assert_eq!(first(EffectId::SlowDrift, 0.7), "time");
        assert_eq!(first(EffectId::Presliding, 0.7), "velocity");
        assert_eq!(first(EffectId::Presliding, 0.2), "load", "a region that tells nothing is passed over");
    }
}
