//! Where a density of evidence sits: the interval of one axis, or of two together, that holds most of it on the fewest samples.

use std::ops::Range;

/// An interval of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// Channel name; the sign of velocity is in the interval itself for `velocity`.
    pub channel: &'static str,
    /// Lower end in the channel's SI unit.
    pub from: f64,
    /// Upper end.
    pub to: f64,
}

/// An interval of a channel, or of two, with its share of the evidence and of the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The interval.
    pub side: Side,
    /// That of a second channel where both together are sharper than any one.
    pub and: Option<Side>,
    /// Share of the explained excess inside, 0..1.
    pub share_of_excess: f64,
    /// Share of the samples inside, 0..1.
    pub share_of_samples: f64,
}

/// Share of the evidence inside a region less its share of the samples (0..1), above which the region is named. Chosen
/// by judgement: lower names regions that evenly spread evidence makes by chance, higher leaves broad ones unnamed.
const LEAST_SURPLUS: f64 = 0.12;

/// Rise of that surplus by a second axis (0..1), above which two axes are named. Chosen by judgement: lower names a
/// second axis that only follows the first; `two_axes_are_named_where_they_are_sharper_together` holds both sides.
const LEAST_SECOND_AXIS_SURPLUS: f64 = 0.07;

/// Quantile bins of an axis: the resolution of a region, 2.5 % of the samples.
const QUANTILE_BINS: usize = 40;

/// Intervals of one axis, sharpest first, each of which is paired with every other axis. A limit of the computing time.
const PAIRED_INTERVALS: usize = 3;

impl Region {
    /// Its interval, and that of the second channel if there is one.
    pub fn sides(&self) -> impl Iterator<Item = &Side> {
        std::iter::once(&self.side).chain(&self.and)
    }

    /// Whether the region holds so much more of the evidence than of the samples that it is worth naming.
    #[must_use]
    pub fn is_telling(&self) -> bool {
        self.contrast() > LEAST_SURPLUS
    }

    /// How much denser the evidence is inside than on average, weighed by what it holds.
    fn contrast(&self) -> f64 {
        self.share_of_excess - self.share_of_samples
    }
}

/// Name of an axis with its value a row.
pub(crate) type Axis<'a> = (&'static str, &'a [f64]);

/// A density of evidence over rows, with its sum.
struct Evidence<'a> {
    density: &'a [f64],
    total: f64,
}

/// Regions of every axis, sharpest first, that of two axes before them where it is sharper. Empty where there is no evidence.
pub(crate) fn regions(axes: &[Axis], density: &[f64]) -> Vec<Region> {
    let evidence = Evidence { density, total: density.iter().sum() };
    if evidence.total <= 0.0 {
        return Vec::new();
    }
    let all: Vec<usize> = (0..density.len()).collect();
    let mut regions: Vec<Region> = axes
        .iter()
        .filter_map(|axis| {
            let (side, inside) = evidence.densest(axis, &all)?;
            Some(evidence.region(side, None, &inside))
        })
        .collect();
    regions.sort_by(|a, b| b.contrast().total_cmp(&a.contrast()));
    if let Some(both) = conjunction(&evidence, axes, &regions) {
        regions.insert(0, both);
    }
    regions
}

/// The region of two axes, if it is sharper than the sharpest of one. Stretches of time are told apart from these.
fn conjunction(evidence: &Evidence, axes: &[Axis], regions: &[Region]) -> Option<Region> {
    let lasting = || regions.iter().filter(|region| region.side.channel != "time");
    let axis_of = |side: &Side| axes.iter().find(|(name, _)| *name == side.channel);
    let inside = |side: &Side, values: &[f64]| -> Vec<usize> {
        (0..values.len()).filter(|&i| (side.from..=side.to).contains(&values[i])).collect()
    };
    let firsts = lasting().take(PAIRED_INTERVALS).filter_map(|first| Some((&first.side, axis_of(&first.side)?)));
    let pairs = firsts.flat_map(|(first, first_axis)| {
        let inside_first = inside(first, first_axis.1);
        let others = axes.iter().filter(|(name, _)| *name != "time" && *name != first.channel);
        others.filter_map(move |second| {
            let (other, _) = evidence.densest(second, &inside_first)?;
            let (side, rows) = evidence.densest(first_axis, &inside(&other, second.1))?;
            Some(evidence.region(side, Some(other), &rows))
        })
    });
    let both = pairs.max_by(|a, b| a.contrast().total_cmp(&b.contrast()))?;
    (both.contrast() > lasting().next()?.contrast() + LEAST_SECOND_AXIS_SURPLUS).then_some(both)
}

impl Evidence<'_> {
    fn region(&self, side: Side, and: Option<Side>, rows: &[usize]) -> Region {
        let held: f64 = rows.iter().map(|&i| self.density[i]).sum();
        Region {
            side,
            and,
            share_of_excess: (held / self.total).clamp(0.0, 1.0),
            share_of_samples: rows.len() as f64 / self.density.len() as f64,
        }
    }

    /// The interval of an axis with the largest evidence above the average among some rows, with the rows inside (Kadane's maximal
    /// sum over quantile bins). `None` where the axis is constant.
    fn densest(&self, (channel, values): &Axis, rows: &[usize]) -> Option<(Side, Vec<usize>)> {
        let mut order = rows.to_vec();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let (&first, &last) = (order.first()?, order.last()?);
        if values[first] >= values[last] {
            return None;
        }
        let mean = self.total / self.density.len() as f64;
        // Equal values stay in one bin: parted they would stand in the order of time.
        let start_of_equals = |edge: usize| match order.get(edge) {
            Some(&row) => order.partition_point(|&i| values[i] < values[row]),
            None => edge,
        };
        let mut edges: Vec<usize> =
            (0..=QUANTILE_BINS).map(|k| start_of_equals(order.len() * k / QUANTILE_BINS)).collect();
        edges.dedup();
        let sums: Vec<f64> =
            edges.windows(2).map(|e| order[e[0]..e[1]].iter().map(|&i| self.density[i] - mean).sum()).collect();
        let best = maximal_sum(&sums);
        let inside = &order[edges[best.start]..edges[best.end]];
        let side = Side { channel, from: values[*inside.first()?], to: values[*inside.last()?] };
        Some((side, inside.to_vec()))
    }
}

/// Range of consecutive entries with the largest sum (Kadane).
pub(crate) fn maximal_sum(values: &[f64]) -> Range<usize> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn only(channel: &'static str, values: &[f64], density: &[f64]) -> Region {
        regions(&[(channel, values)], density).swap_remove(0)
    }

    #[test]
    fn maximal_sum_finds_the_best_stretch() {
        assert_eq!(maximal_sum(&[-1.0, 2.0, -0.5, 3.0, -4.0, 1.0]), 1..4);
        assert_eq!(maximal_sum(&[-3.0, -1.0, -2.0]), 1..2);
    }

    #[test]
    fn an_interval_holds_a_local_bump() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
        let density: Vec<f64> = values.iter().map(|v| if (0.3..0.4).contains(v) { 1.0 } else { 0.0 }).collect();
        let region = only("position", &values, &density);
        assert!((region.side.from - 0.3).abs() < 0.03 && (region.side.to - 0.4).abs() < 0.03, "{region:?}");
        assert!(region.share_of_excess > 0.99 && region.share_of_samples < 0.16);
    }

    #[test]
    fn equal_values_are_not_parted_by_time() {
        let values: Vec<f64> = (0..1000).map(|i| if i < 900 { 0.0 } else { 0.5 }).collect();
        let density: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i < 100))).collect();
        let region = only("dwell", &values, &density);
        assert!((region.side.from, region.side.to) == (0.0, 0.0) && region.share_of_samples == 0.9, "{region:?}");
    }

    #[test]
    fn two_axes_are_named_where_they_are_sharper_together() {
        let position: Vec<f64> = (0..10_000).map(|i| f64::from(i % 100) / 100.0).collect();
        let load: Vec<f64> = (0..10_000).map(|i| f64::from(i / 100) / 100.0).collect();
        let axes = [("position", position.as_slice()), ("load", load.as_slice())];
        let density = |inside: &dyn Fn(f64, f64) -> bool| -> Vec<f64> {
            position.iter().zip(&load).map(|(x, y)| f64::from(u8::from(inside(*x, *y)))).collect()
        };
        let corner = regions(&axes, &density(&|x, y| (0.3..0.5).contains(&x) && (0.6..0.8).contains(&y)));
        let and = corner[0].and.as_ref().unwrap();
        assert!((and.from, and.to) != (corner[0].side.from, corner[0].side.to));
        assert!(corner[0].share_of_excess > 0.99 && corner[0].share_of_samples < 0.05, "{:?}", corner[0]);
        let stripe = regions(&axes, &density(&|x, _| (0.3..0.5).contains(&x)));
        assert!(stripe.iter().all(|region| region.and.is_none()) && stripe[0].side.channel == "position", "{stripe:?}");
    }
}
