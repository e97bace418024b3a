//! Units of columns whose names say none, from what they hold.

use std::f64::consts::TAU;

use crate::recording::quantity::{Axis, Quantity, Unit};

/// Rates at which joints are recorded, Hz; between them a clock is looked for, next to their geometric mean.
const RATES_HZ: (f64, f64) = (2.0, 50_000.0);

/// How far the ratio of a velocity to the derivative of the position may be from that of two units: neighbours such as rpm and deg/s
/// are a factor of 6 apart, and a derivative is noisy.
const SAME_UNIT: f64 = 1.3;

/// Least correlation of a velocity with the derivative of its position.
const SAME_MOTION: f64 = 0.7;

/// A span that radians hardly have, and one that they need not have, rad: eight turns and two.
const HARDLY_RADIANS: f64 = 8.0 * TAU;
const MAYBE_DEGREES: f64 = 2.0 * TAU;

/// A speed that joints do not reach, rad/s: the fastest legs reach 30.
const TOO_FAST_RAD_S: f64 = 35.0;

/// A unit and why.
pub(super) struct Told {
    pub(super) unit: &'static Unit,
    pub(super) scale: f64,
    pub(super) why: String,
}

impl Told {
    fn plain(unit: &'static Unit, why: String) -> Self {
        Self { unit, scale: 1.0, why }
    }
}

/// Four significant digits.
pub(super) fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// Median step of what increases; `None` where it does not.
pub(super) fn median_step(values: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite()).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().filter(|step| *step > 0.0)
}

/// The unit of a clock by its steps.
pub(super) fn of_time(values: &[f64]) -> Option<Told> {
    let step = median_step(values)?;
    let middle = (RATES_HZ.0 * RATES_HZ.1).sqrt().ln();
    let rate = |unit: &Unit| 1.0 / (step * unit.factor);
    let plausible = Quantity::Time.units().iter().filter(|unit| (RATES_HZ.0..=RATES_HZ.1).contains(&rate(unit)));
    let distance = |unit: &&Unit| (rate(unit).ln() - middle).abs();
    let unit = plausible.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    Some(Told::plain(
        unit,
        format!("its steps of {} are a clock of {} Hz in {}", short(step), short(rate(unit)), unit.suffix),
    ))
}

/// The unit of a position by its span, and its speed where that leaves it open; time in s.
pub(super) fn of_position(values: &[f64], time: &[f64], axis: Axis) -> Option<Told> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let span = finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min);
    let speed = || {
        let steps = values.windows(2).zip(time.windows(2)).map(|(q, t)| ((q[1] - q[0]) / (t[1] - t[0])).abs());
        let mut speeds: Vec<f64> = steps.filter(|speed| speed.is_finite()).collect();
        speeds.sort_by(f64::total_cmp);
        // Single steps of a coarse encoder are no speeds.
        speeds.get(speeds.len() * 95 / 100).copied().unwrap_or(0.0)
    };
    let whole = span > 100.0 && finite().all(|value| value.fract() == 0.0);
    let (suffix, why) = match axis {
        Axis::Linear if span < TAU => ("m", "metres, by a span of"),
        Axis::Linear => ("mm", "millimetres, by a span of"),
        Axis::Rotary if whole => ("count", "whole numbers only, counts of an encoder, over"),
        Axis::Rotary if span <= MAYBE_DEGREES => ("rad", "radians, by a span of"),
        Axis::Rotary if span > HARDLY_RADIANS => ("deg", "degrees, by a span of"),
        Axis::Rotary if speed() > TOO_FAST_RAD_S => ("deg", "degrees, as it is too fast for radians, over a span of"),
        Axis::Rotary => ("rad", "radians, as it is slow for degrees, over a span of"),
    };
    let unit = Quantity::Position.unit(suffix)?;
    span.is_finite().then(|| Told::plain(unit, format!("{why} {}", short(span))))
}

/// Slope of `values` over time at every row but the first and the last, by the rows beside it.
pub(super) fn slopes(values: &[f64], time: &[f64]) -> Vec<f64> {
    let rows = 1..values.len().min(time.len()).saturating_sub(1);
    rows.map(|row| (values[row + 1] - values[row - 1]) / (time[row + 1] - time[row - 1])).collect()
}

/// Slopes over a column, whose first row has none, and their correlation with it about zero.
pub(super) fn compared(slopes: &[f64], column: &[f64]) -> (f64, f64) {
    let (mut both, mut own, mut derived) = (0.0, 0.0, 0.0);
    for (slope, value) in slopes.iter().zip(column.iter().skip(1)) {
        if slope.is_finite() && value.is_finite() {
            both += slope * value;
            own += value * value;
            derived += slope * slope;
        }
    }
    (both / own, both / (own * derived).sqrt())
}

/// The unit and sign of a velocity by the derivative of the position; time in s, position in SI.
pub(super) fn of_velocity(velocity: &[f64], time: &[f64], position: &[f64], axis: Axis) -> Option<Told> {
    let (factor, correlation) = compared(&slopes(position, time), velocity);
    if correlation.is_nan() || correlation.abs() < SAME_MOTION {
        return None;
    }
    let units =
        Quantity::Velocity.units().iter().filter(|unit| unit.axis == Some(axis) && !unit.suffix.starts_with("count"));
    let apart = |unit: &&Unit| (factor.abs() / unit.factor).ln().abs();
    let unit = units.min_by(|a, b| apart(a).total_cmp(&apart(b))).filter(|unit| apart(unit) < SAME_UNIT.ln())?;
    let scale = factor.signum();
    let direction = if scale < 0.0 { ", in the opposite direction" } else { "" };
    Some(Told { unit, scale, why: format!("the derivative of the position in {}{direction}", unit.suffix) })
}

/// Counts a turn of an encoder that is read in whole numbers: the power of two that its span is within.
pub(super) fn counts_per_turn(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let span = finite().fold(1.0, f64::max) - finite().fold(f64::INFINITY, f64::min).min(0.0);
    span.log2().ceil().clamp(4.0, 32.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_spans_and_derivatives_tell_units() {
        let rows = || (0..500).map(f64::from);
        for (step, suffix) in [(0.002, "s"), (2.0, "ms"), (4000.0, "us"), (1e6, "ns"), (0.02, "s")] {
            assert_eq!(of_time(&rows().map(|row| row * step).collect::<Vec<_>>()).unwrap().unit.suffix, suffix);
        }
        let time: Vec<f64> = rows().map(|row| row * 0.01).collect();
        let position: Vec<f64> = time.iter().map(|time| time.sin()).collect();
        assert_eq!(of_position(&position, &time, Axis::Rotary).unwrap().unit.suffix, "rad");
        let degrees: Vec<f64> = position.iter().map(|angle| angle.to_degrees()).collect();
        assert_eq!(of_position(&degrees, &time, Axis::Rotary).unwrap().unit.suffix, "deg");
        for (factor, suffix) in [(7.0, "rad"), (20.0, "rad"), (40.0, "deg")] {
            let wide: Vec<f64> = position.iter().map(|angle| factor * angle).collect();
            let quick: Vec<f64> = time.iter().map(|time| if factor > 30.0 { time / 3.0 } else { *time }).collect();
            assert_eq!(of_position(&wide, &quick, Axis::Rotary).unwrap().unit.suffix, suffix, "{factor}");
        }
        for (factor, suffix, scale) in [(1.0, "rad_s", 1.0), (-57.3, "deg_s", -1.0), (9.55, "rpm", 1.0)] {
            let velocity: Vec<f64> = time.iter().map(|time| factor * time.cos()).collect();
            let told = of_velocity(&velocity, &time, &position, Axis::Rotary).unwrap();
            assert_eq!((told.unit.suffix, told.scale), (suffix, scale));
        }
        assert!(of_velocity(&position, &time, &position, Axis::Rotary).is_none());
        assert_eq!(counts_per_turn(&[0.5, 8170.0, 3.0]), 8192.0);
    }
}
