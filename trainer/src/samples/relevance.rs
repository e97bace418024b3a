//! Which inputs friction depends on: correlation, and variance that an input explains on samples held out.

use std::ops::Range;

use super::BendingLaw;
use super::Samples;
use super::blocks::{blocks, correlation_time};
use super::hold_out::motions;
use crate::error::Result;
use crate::numerics::regression::least_squares;

/// An input besides velocity is picked when it explains at least this share of the variance of friction more...
pub const LEAST_ADDED_SHARE: f64 = 0.02;
/// ...and at least this share of the variance that velocity leaves.
pub const LEAST_SHARE_OF_REST: f64 = 0.15;
/// Quantile bins of an input, for each direction of motion.
const BINS: usize = 12;
/// Folds of blocks that are held out in turn.
const FOLDS: usize = 4;
/// Inputs that may be picked unasked: the physics knows them and they do not contain friction themselves, as a tracking
/// error or a second actuator channel does. In order of preference.
const PICKED: &[&str] = &["velocity", "load_torque", "rigid_body_torque", "temperature", "position"];

/// What one input has to do with friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Relevance {
    /// Name of the input.
    pub input: String,
    /// Pearson correlation with friction, -1 to 1; zero where the input does not change.
    pub correlation: f64,
    /// Share of the variance of friction that the input alone explains on samples held out; at most 1, and below zero
    /// where its bins predict worse than the mean.
    pub explained: f64,
    /// Share of the variance of friction that it explains, together with the direction, of what velocity leaves.
    pub added: f64,
    /// Whether the rule picks it: velocity always, others from [`LEAST_ADDED_SHARE`] and [`LEAST_SHARE_OF_REST`] on.
    pub picked: bool,
}

/// Relevance of every input that the samples offer for `friction` (one value a sample), strongest first.
///
/// # Errors
/// `FRK-D009` without velocity, `FRK-D016` without motion.
pub fn relevance(samples: &Samples, friction: &[f64]) -> Result<Vec<Relevance>> {
    let velocity = samples.require_velocity()?;
    let law = BendingLaw::over(velocity)?;
    let folds = folds(samples, friction);
    let left = least_squares(&law.columns(velocity), friction, &samples.segments).residuals;
    let total = variance(friction);
    let least_added = LEAST_ADDED_SHARE.max(LEAST_SHARE_OF_REST * variance(&left) / total);
    let mut table: Vec<Relevance> = samples
        .input_names()
        .into_iter()
        .filter_map(|name| samples.input(name).map(|values| (name, values)))
        .map(|(name, values)| {
            let added = held_out_gain(&left, values, Some(velocity), &folds) / total;
            let allowed = PICKED.contains(&name);
            Relevance {
                input: name.to_owned(),
                correlation: correlation(values, friction),
                explained: held_out_gain(friction, values, None, &folds) / total,
                added,
                picked: name == "velocity" || (allowed && added >= least_added),
            }
        })
        .collect();
    keep_one_load(&mut table);
    table.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    Ok(table)
}

/// The names that the rule picks, velocity first.
#[must_use]
pub fn picked_inputs(table: &[Relevance]) -> Vec<String> {
    let is_picked = |name: &&&str| table.iter().any(|row| row.picked && row.input == ***name);
    PICKED.iter().filter(is_picked).map(|name| (*name).to_owned()).collect()
}

/// A measured load and the rigid-body model of it say the same; the better of the two is kept.
fn keep_one_load(table: &mut [Relevance]) {
    let find = |table: &[Relevance], name: &str| table.iter().position(|row| row.input == name && row.picked);
    if let Some((load, body)) = find(table, "load_torque").zip(find(table, "rigid_body_torque")) {
        let weaker = if table[load].added >= table[body].added { body } else { load };
        table[weaker].picked = false;
    }
}

/// Motions that are held out in turn, or else long contiguous parts: an input that says nothing but when a row was recorded has
/// no value in common with the part that is held out.
fn folds(samples: &Samples, friction: &[f64]) -> Vec<Vec<Range<usize>>> {
    let pieces = blocks(samples, correlation_time(friction, &samples.segments));
    let numbers = motions(samples);
    let motion = |piece: &Range<usize>| {
        let recording = samples.recordings.iter().position(|(_, rows)| rows.contains(&piece.start));
        recording.map_or(0, |recording| numbers[recording])
    };
    let count = FOLDS.min(pieces.len()).max(1);
    let several = numbers.iter().any(|number| *number > 0);
    let mut folds = vec![Vec::new(); count];
    for (index, piece) in pieces.iter().enumerate() {
        let fold = if several { motion(piece) % count } else { index * count / pieces.len() };
        folds[fold].push(piece.clone());
    }
    folds.retain(|fold| !fold.is_empty());
    folds
}

/// Mean square that bin means of `input` take off `target` on the fold held out; bins are told apart by the sign of
/// `direction` where it is given.
fn held_out_gain(target: &[f64], input: &[f64], direction: Option<&[f64]>, folds: &[Vec<Range<usize>>]) -> f64 {
    let edges = quantile_edges(input);
    let bin = |i: usize| {
        let place = edges.partition_point(|edge| *edge <= input[i]);
        place + if direction.is_some_and(|v| v[i] < 0.0) { edges.len() + 1 } else { 0 }
    };
    let bins: Vec<usize> = (0..target.len()).map(bin).collect();
    let count = 2 * (edges.len() + 1);
    // Sum and number of the targets in each bin of each fold.
    let sums_in = |fold: &Vec<Range<usize>>| {
        let mut sums = vec![(0.0, 0.0); count];
        for i in fold.iter().cloned().flatten() {
            let (sum, number) = &mut sums[bins[i]];
            *sum += target[i];
            *number += 1.0;
        }
        sums
    };
    let by_fold: Vec<Vec<(f64, f64)>> = folds.iter().map(sums_in).collect();
    let added = |a: (f64, f64), b: &(f64, f64)| (a.0 + b.0, a.1 + b.1);
    let mut gain = 0.0;
    for held in 0..folds.len() {
        let learnt = |fold: &usize| *fold != held || folds.len() == 1;
        let over = |bin: usize| (0..folds.len()).filter(learnt).map(|fold| &by_fold[fold][bin]).fold((0.0, 0.0), added);
        let sums: Vec<(f64, f64)> = (0..count).map(over).collect();
        let (all_sum, all_number) = sums.iter().fold((0.0, 0.0), added);
        let overall = all_sum / f64::max(all_number, 1.0);
        for i in folds[held].iter().cloned().flatten() {
            let (sum, number) = sums[bins[i]];
            let mean = if number > 0.0 { sum / number } else { overall };
            gain += (target[i] - overall).powi(2) - (target[i] - mean).powi(2);
        }
    }
    gain / target.len().max(1) as f64
}

/// Inner edges of equally filled bins; fewer where values repeat.
fn quantile_edges(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let mut edges: Vec<f64> = (1..BINS).filter_map(|k| sorted.get(k * sorted.len() / BINS).copied()).collect();
    edges.dedup();
    edges
}

fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let sum: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    (sum / values.len().max(1) as f64).max(f64::MIN_POSITIVE)
}

/// Pearson correlation of two series of one length; 0 where one of them does not vary.
#[must_use]
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len().max(1) as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let cross: f64 = a.iter().zip(b).map(|(x, y)| (x - mean_a) * (y - mean_b)).sum::<f64>() / a.len().max(1) as f64;
    let scale = (variance(a) * variance(b)).sqrt();
    if scale > f64::MIN_POSITIVE { cross / scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Friction over velocity, optionally growing with load; load and temperature move on their own.
    fn samples(load_share: f64) -> (Samples, Vec<f64>) {
        let n = 6000;
        let wave = |f: f64| (0..n).map(|i| (f * i as f64).sin()).collect::<Vec<f64>>();
        let (velocity, load, temperature) = (wave(0.031), wave(0.0077), wave(0.0023));
        let friction = velocity
            .iter()
            .zip(&load)
            .map(|(v, l)| (2.0 + load_share * l.abs()) * (v / 0.01).tanh() + 0.5 * v)
            .collect();
        let samples = Samples {
            channels: vec![("load_torque".into(), load), ("temperature".into(), temperature)],
            ..Samples::of_velocity(velocity)
        };
        (samples, friction)
    }

    #[test]
    fn only_velocity_is_picked_when_nothing_else_matters() {
        let (samples, friction) = samples(0.0);
        let table = relevance(&samples, &friction).unwrap();
        assert_eq!(picked_inputs(&table), ["velocity"]);
        assert_eq!(table[0].input, "velocity");
        assert!(table[0].correlation > 0.8 && table[0].explained > 0.9, "{table:?}");
    }

    #[test]
    fn a_load_that_scales_friction_is_picked_though_it_does_not_correlate() {
        let (samples, friction) = samples(2.0);
        let table = relevance(&samples, &friction).unwrap();
        assert_eq!(picked_inputs(&table), ["velocity", "load_torque"]);
        let load = table.iter().find(|row| row.input == "load_torque").unwrap();
        assert!(load.correlation.abs() < 0.1, "{load:?}");
    }
}
