//! What a report draws: torque, residuals before and after, the torque of each effect and every channel, at working rows.

use crate::diagnose::answer::location::locate_density;
use crate::diagnose::answer::region::Region;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::proof::locked_rows::rest;
use crate::diagnose::proof::refit::Refit;
use crate::numerics::statistics::quantile;
use std::ops::Range;

/// Series at the working rows behind the common filter; all of one length.
#[derive(Clone, Debug, Default)]
pub struct Traces {
    /// Time in s.
    pub time: Vec<f64>,
    /// Velocity in rad/s or m/s.
    pub velocity: Vec<f64>,
    /// Recorded actuator torque (N m, N or A), as are those below.
    pub torque: Vec<f64>,
    /// What the refitted base model leaves.
    pub before: Vec<f64>,
    /// What base and effects leave together.
    pub after: Vec<f64>,
    /// Torque of each finding, in their order.
    pub effects: Vec<Vec<f64>>,
    /// What base and effects leave together over the deviation that is expected of it: of the noise, and of what is fitted.
    pub expected_ratio: Vec<f64>,
    /// Whether the row was locked away from fitting and choosing.
    pub locked: Vec<bool>,
    /// Whether friction keeps its sign as far as the row's filter reaches.
    pub sign_is_sure: Vec<bool>,
    /// Channels and derived axes that vary, by name.
    pub channels: Vec<(&'static str, Vec<f64>)>,
    /// First row of each uninterrupted run, ascending.
    pub run_starts: Vec<usize>,
}

/// What the locked stretch with the most, over what is expected, is left with: what happened in it once, no open row saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstLocked {
    /// Its root mean square.
    pub rms: f64,
    /// Over what is expected of noise and fit, and then over that of the open stretch with the most.
    pub over_open: f64,
    /// From and to, in s.
    pub when_s: [f64; 2],
}

impl Traces {
    /// Traces of a finished workbench.
    pub(crate) fn of(workbench: &Workbench, baseline: &Refit, improved: &Refit) -> Self {
        let prepared = workbench.prepared;
        let state = &prepared.state;
        let mut locked = vec![false; prepared.rows.len()];
        let mut run_starts = Vec::new();
        for block in &prepared.blocks {
            for run in &block.runs {
                run_starts.push(run.start);
                locked[run.clone()].fill(block.locked);
            }
        }
        run_starts.sort_unstable();
        let effects = improved.effects.iter().map(|effect| workbench.torque_of(effect)).collect();
        let channels = Channel::axes(state)
            .into_iter()
            .filter_map(|channel| Some((channel.name(), prepared.at_rows(&channel.series(state)?))))
            .filter(|(_, values)| varies(values))
            .collect();
        let after = rest(workbench, improved);
        let ratio = |(left, fitted): (&f64, &f64)| left / improved.noise.rms.hypot(*fitted).max(f64::MIN_POSITIVE);
        Self {
            expected_ratio: after.iter().zip(&improved.torque_deviation(workbench)).map(ratio).collect(),
            time: prepared.at_rows(&state.time),
            velocity: prepared.at_rows(&state.velocity),
            torque: prepared.filtered(&prepared.torque),
            before: rest(workbench, baseline),
            after,
            effects,
            locked,
            sign_is_sure: prepared.sign_is_sure(),
            channels,
            run_starts,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Values of a channel; velocity keeps its sign.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&[f64]> {
        if name == "velocity" {
            return Some(&self.velocity);
        }
        self.channels.iter().find(|(channel, _)| *channel == name).map(|(_, values)| values.as_slice())
    }

    /// The locked stretch that is left with the most, reversals left out: where friction turns over, a fraction of a sample decides.
    /// `None` where nothing is locked.
    #[must_use]
    pub fn worst_locked(&self) -> Option<WorstLocked> {
        let ends = self.run_starts.iter().skip(1).copied().chain([self.len()]);
        let (shut, open): (Vec<_>, Vec<_>) =
            self.run_starts.iter().copied().zip(ends).partition(|(start, _)| self.locked[*start]);
        let usual_length = quantile(shut.iter().map(|(start, end)| (end - start) as f64), 0.5) as usize;
        let sure = |piece: &Range<usize>| piece.clone().filter(|row| self.sign_is_sure[*row]);
        // Pieces of one length, as a short one may hold little but a reversal.
        let pieces = |(start, end): (usize, usize)| {
            let starts = (start..end).step_by(usual_length.max(1));
            let pieces = starts.map(move |start| start..(start + usual_length.max(1)).min(end));
            pieces.filter(|piece| 4 * sure(piece).count() > usual_length)
        };
        let rms = |series: &[f64], piece: &Range<usize>| {
            let energy: f64 = sure(piece).map(|row| series[row].powi(2)).sum();
            (energy / sure(piece).count() as f64).sqrt()
        };
        // What no open row is like is fitted by guess, and off by as much.
        let over_expected = |piece: Range<usize>| (rms(&self.expected_ratio, &piece), piece);
        let worst = |stretches: Vec<(usize, usize)>| {
            stretches.into_iter().flat_map(pieces).map(over_expected).max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let of_open = worst(open).map_or(0.0, |(ratio, _)| ratio);
        worst(shut).map(|(ratio, piece)| WorstLocked {
            over_open: ratio / of_open.max(f64::MIN_POSITIVE),
            rms: rms(&self.after, &piece),
            when_s: [self.time[piece.start], self.time[piece.end - 1]],
        })
    }

    /// What base and effects leave within a stretch of time (s), 0 elsewhere.
    pub(crate) fn left_within(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let within = |(time, left): (&f64, &f64)| if (from..=to).contains(time) { *left } else { 0.0 };
        self.time.iter().zip(&self.after).map(within).collect()
    }

    /// Where all effects together lower the squared residual: regions, sharpest first, and stretches of time in s.
    #[must_use]
    pub fn excess(&self) -> (Vec<Region>, Vec<[f64; 2]>) {
        let density: Vec<f64> = self.before.iter().zip(&self.after).map(|(b, a)| b * b - a * a).collect();
        let axes: Vec<(&'static str, &[f64])> = std::iter::once(("velocity", self.velocity.as_slice()))
            .chain(self.channels.iter().map(|(name, values)| (*name, values.as_slice())))
            .collect();
        let location = locate_density(&axes, &self.time, &density);
        (location.regions, location.when_s)
    }
}

fn varies(values: &[f64]) -> bool {
    values.iter().any(|value| *value != values[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five stretches of twenty rows of which the last is locked, and a locked one of four; `events` are rows that
    /// stick out, `reversal` those around one.
    fn locked_over_open(events: Range<usize>, reversal: Range<usize>) -> f64 {
        let mut after: Vec<f64> = (0..104).map(|i| if i % 2 == 0 { 0.1 } else { -0.1 }).collect();
        after[events].fill(1.0);
        let locked = (0..104).map(|i| i >= 80).collect();
        let sign_is_sure = (0..104).map(|i| !reversal.contains(&i)).collect();
        let run_starts = vec![0, 20, 40, 60, 80, 100];
        let expected_ratio = after.iter().map(|left| left / 0.1).collect();
        Traces { time: vec![0.0; 104], after, expected_ratio, locked, sign_is_sure, run_starts, ..Traces::default() }
            .worst_locked()
            .unwrap()
            .over_open
    }

    #[test]
    fn a_row_that_no_open_row_is_like_may_be_off_by_as_much_as_its_fit_is_unsure() {
        let over_open = |unsure: f64| {
            let after: Vec<f64> = (0..40).map(|row| if row == 30 { 1.0 } else { 0.1 }).collect();
            let expected = |row: usize| if row == 30 { 0.1_f64.hypot(unsure) } else { 0.1 };
            let expected_ratio = after.iter().enumerate().map(|(row, left)| left / expected(row)).collect();
            let (locked, sign_is_sure) = ((0..40).map(|row| row >= 20).collect(), vec![true; 40]);
            let traces =
                Traces { time: vec![0.0; 40], after, expected_ratio, locked, sign_is_sure, ..Traces::default() };
            Traces { run_starts: vec![0, 20], ..traces }.worst_locked().map_or(0.0, |worst| worst.over_open)
        };
        assert!(over_open(0.0) > 2.0 && over_open(1.0) < 1.1, "{} {}", over_open(0.0), over_open(1.0));
    }

    #[test]
    fn a_locked_stretch_sticks_out_by_more_than_the_open_ones_and_by_more_than_a_reversal() {
        assert!(locked_over_open(85..95, 0..0) > 5.0);
        assert!([0..0, 45..55, 101..103].into_iter().all(|events| locked_over_open(events, 0..0) <= 1.0));
        assert!(locked_over_open(88..92, 88..92) <= 1.0, "a fraction of a sample at a reversal");
        assert!(locked_over_open(85..95, 88..92) > 5.0, "more than a reversal");
    }
}
