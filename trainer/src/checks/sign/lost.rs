//! A torque that was recorded as a magnitude: it is never below zero, while the motion asks for both signs.
//!
//! A torque that never changes its sign may well be right, beside a constant load. So the law is fitted twice, to the torque as it is
//! and to the torque with the sign that the law itself gives it, by turns (alternating least squares); the sign is lost where the law that
//! changes sign leaves clearly less.

use crate::checks::law::{Columns, PositionTerms, moving};
use crate::checks::motion::{smooth, top_speed, torque};
use crate::checks::note::{Fault, Note};
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::products::norm;
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::{mean, t_statistic};
use crate::recording::Recording;
use crate::samples::VelocitySource;
use std::ops::Range;

/// Turns of fitting and giving signs: signs settle within a few.
const MOST_TURNS: usize = 30;
/// Standard errors of the difference of both laws from which it is clear.
const CLEAR: f64 = 4.0;
/// Share of the samples in which the law has the lesser sign, at least: a law that hardly changes its sign says nothing of it.
const LESSER_SIGN: f64 = 0.1;
/// Mean square that the law with signs leaves over that of the torque as it is, at most: what a few samples near zero leave is no sign.
const MOST_LEFT: f64 = 0.5;

/// Notes a torque without its sign.
pub(in crate::checks) fn magnitude(recording: &Recording) -> Option<Note> {
    let channel = recording.actuator().or_else(|| recording.separated_friction())?;
    if channel.values.iter().any(|value| *value < 0.0) {
        return None;
    }
    let samples = smooth(recording, VelocitySource::Derived)?;
    let velocity = samples.velocity.as_deref()?;
    let top = top_speed(velocity);
    let columns = Columns::of(&samples, top, PositionTerms::Gravity(1.0))?.values;
    let rows = moving(velocity, top);
    let pick = |series: &[f64]| rows.iter().map(|row| series[*row]).collect::<Vec<f64>>();
    let columns: Vec<Vec<f64>> = columns.iter().map(|column| pick(column)).collect();
    let torque = pick(torque(&samples)?);
    let blocks = even_blocks(rows.len(), ERROR_BLOCKS);
    let as_recorded = least_squares(&columns, &torque, &blocks).residuals;
    // Whatever dominates the torque gives its signs to begin with.
    let begun = columns.iter().map(|column| settled(&columns, &torque, column, &blocks));
    let (left, signs) = begun.min_by(|a, b| norm(&a.0).total_cmp(&norm(&b.0)))?;
    let negative = signs.iter().filter(|sign| **sign < 0.0).count() as f64 / signs.len().max(1) as f64;
    let square =
        |left: &[f64], block: &Range<usize>| mean(&left[block.clone()].iter().map(|x| x * x).collect::<Vec<_>>());
    let [before, after] =
        [&as_recorded, &left].map(|left| blocks.iter().map(|b| square(left, b)).collect::<Vec<f64>>());
    let gained: Vec<f64> = before.iter().zip(&after).map(|(before, after)| before - after).collect();
    let is_lost = (LESSER_SIGN..=1.0 - LESSER_SIGN).contains(&negative)
        && mean(&after) < MOST_LEFT * mean(&before)
        && t_statistic(&gained) > CLEAR;
    is_lost.then(|| Note::of_all(Fault::LostSign { left: (mean(&after) / mean(&before)).sqrt() }))
}

/// What the law leaves of the torque with the signs that it gives it, and these signs, from those of one column on.
fn settled(columns: &[Vec<f64>], torque: &[f64], begin: &[f64], blocks: &[Range<usize>]) -> (Vec<f64>, Vec<f64>) {
    let mut signs: Vec<f64> = begin.iter().map(|value| value.signum()).collect();
    let mut left = Vec::new();
    for _ in 0..MOST_TURNS {
        let signed: Vec<f64> = torque.iter().zip(&signs).map(|(torque, sign)| torque * sign).collect();
        left = least_squares(columns, &signed, blocks).residuals;
        let of_law = signed.iter().zip(&left).map(|(signed, left)| (signed - left).signum());
        let of_law: Vec<f64> = of_law.collect();
        if of_law == signs {
            break;
        }
        signs = of_law;
    }
    (left, signs)
}
