//! Applies the planned filter to a recording: samples for a fit.

mod every_row;

use std::ops::Range;

use super::Samples;
use super::grid::{Grid, Segment};
use super::plan::{Preparation, VelocitySource};
use crate::error::{Error, Result, codes};
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::recording::{Quantity, Recording};

pub use every_row::prepare_every_row;
pub(crate) use every_row::{EveryRow, prepare_every_row_of};

/// Temperatures are smoothed over this standard deviation, s: their sensor's noise would otherwise hand what
/// temperature explains to its rivals (rule P5).
const TEMPERATURE_SIGMA_S: f64 = 2.0;

/// Samples for a fit: filter edges dropped, decimated to the useful band.
///
/// # Errors
/// `FRK-D009` when the task lacks a column, `FRK-D017` when no stretch is long enough for the filter.
pub fn prepare(recording: &Recording, preparation: &Preparation) -> Result<Samples> {
    let Some(sigma_s) = preparation.sigma_s else { return Ok(unfiltered(recording, &(0..recording.len()))) };
    let time = &recording.require(&[Quantity::Time], "a recording with a motion")?.values;
    let grid = Grid::of(recording, time);
    let filter = GaussianFilter::new(sigma_s, grid.period_s);
    let stride = preparation.stride(grid.period_s);
    let torque_filter = filter.advanced_by(preparation.torque_delay_s);
    let window = 2 * filter.half_width() + 1;
    let usable = usable(&grid, &filter);
    if usable.is_empty() {
        let message = format!("no uninterrupted stretch has the {window} samples that the filter needs");
        return Err(Error::new(&codes::SEGMENTS_TOO_SHORT, message).in_file(recording.file()));
    }

    let mut samples = empty(recording, preparation, Some(1.0 / (grid.period_s * stride as f64)));
    let everything = |_: &str| true;
    for segment in usable {
        let start = samples.time.len();
        let count = (segment.points - window) / stride + 1;
        let first = filter.half_width();
        samples.time.extend((0..count).map(|i| segment.start_s + (first + i * stride) as f64 * grid.period_s));
        let motion = |channel: &[f64], order| filter.apply(&grid.values(segment, time, channel), order, stride);
        let torque = |channel: &[f64]| torque_filter.apply(&grid.values(segment, time, channel), Order::Smooth, stride);
        extend(&mut samples, recording, preparation, &everything, motion, torque);
        if let Some(channel) = target(recording) {
            let unfiltered = grid.values(segment, time, channel);
            samples.recorded.get_or_insert_default().extend((0..count).map(|i| unfiltered[first + i * stride]));
        }
        samples.segments.push(start..start + count);
    }
    smooth_temperatures(&mut samples);
    samples.recordings = vec![(recording.label.clone(), 0..samples.time.len())];
    Ok(samples)
}

/// The torque, force or current alone, as [`prepare`] filters it; nothing where a recording has none.
///
/// # Errors
/// `FRK-D009` without a clock.
pub(in crate::samples) fn prepare_actuator(recording: &Recording, preparation: &Preparation) -> Result<Vec<f64>> {
    let Some(channel) = recording.actuator() else { return Ok(Vec::new()) };
    let Some(sigma_s) = preparation.sigma_s else { return Ok(channel.values.clone()) };
    let time = &recording.require(&[Quantity::Time], "a recording with a motion")?.values;
    let grid = Grid::of(recording, time);
    let filter = GaussianFilter::new(sigma_s, grid.period_s);
    let (stride, torque_filter) = (preparation.stride(grid.period_s), filter.advanced_by(preparation.torque_delay_s));
    let filtered = |segment| torque_filter.apply(&grid.values(segment, time, &channel.values), Order::Smooth, stride);
    Ok(usable(&grid, &filter).into_iter().flat_map(filtered).collect())
}

/// Segments that are as long as the filter.
pub(in crate::samples) fn usable<'a>(grid: &'a Grid, filter: &GaussianFilter) -> Vec<&'a Segment> {
    grid.segments.iter().filter(|segment| segment.points > 2 * filter.half_width()).collect()
}

/// What a prediction is scored on.
fn target(recording: &Recording) -> Option<&[f64]> {
    recording.separated_friction().or_else(|| recording.actuator()).map(|channel| channel.values.as_slice())
}

/// Appends one segment of every channel, filtered by `apply`, that of the actuator by `apply_to_actuator`.
fn extend(
    samples: &mut Samples,
    recording: &Recording,
    preparation: &Preparation,
    is_read: &dyn Fn(&str) -> bool,
    apply: impl Fn(&[f64], Order) -> Vec<f64>,
    apply_to_actuator: impl Fn(&[f64]) -> Vec<f64>,
) {
    let grow = |list: &mut Option<Vec<f64>>, source: Option<&[f64]>, order| {
        if let Some(channel) = source {
            list.get_or_insert_default().extend(apply(channel, order));
        }
    };
    let position = recording.values(Quantity::Position);
    let recorded_velocity = recording.values(Quantity::Velocity);
    grow(&mut samples.position, position, Order::Smooth);
    match preparation.velocity {
        VelocitySource::Derived => {
            grow(&mut samples.velocity, position, Order::First);
            grow(&mut samples.acceleration, position, Order::Second);
        }
        VelocitySource::Recorded => {
            grow(&mut samples.velocity, recorded_velocity, Order::Smooth);
            grow(&mut samples.acceleration, recorded_velocity, Order::First);
        }
    }
    if let Some(channel) = recording.actuator() {
        samples.actuator.get_or_insert_default().extend(apply_to_actuator(&channel.values));
    }
    grow(&mut samples.rigid_body, recording.values(Quantity::RigidBodyTorque), Order::Smooth);
    grow(&mut samples.friction, recording.separated_friction().map(|c| c.values.as_slice()), Order::Smooth);
    for (name, values) in named_channels(recording).filter(|(name, _)| is_read(name)) {
        let filtered = apply(values, Order::Smooth);
        match samples.channels.iter_mut().find(|(own, _)| own == name) {
            Some((_, list)) => list.extend(filtered),
            None => samples.channels.push((name.to_owned(), filtered)),
        }
    }
}

/// Every channel that is neither motion, actuator, rigid body nor separated friction.
fn named_channels(recording: &Recording) -> impl Iterator<Item = (&str, &[f64])> {
    let actuator = recording.actuator().and_then(|channel| channel.quantity);
    let friction = recording.separated_friction().and_then(|channel| channel.quantity);
    recording
        .channels
        .iter()
        .filter(move |channel| match channel.quantity {
            None => true,
            Some(
                Quantity::Time
                | Quantity::Position
                | Quantity::Velocity
                | Quantity::Acceleration
                | Quantity::RigidBodyTorque,
            ) => false,
            other => other != actuator && other != friction,
        })
        .map(|channel| (channel.name.as_str(), channel.values.as_slice()))
}

/// What smooths temperatures of so many samples a second once more.
fn temperature_filter(rate_hz: f64) -> GaussianFilter {
    GaussianFilter::new(TEMPERATURE_SIGMA_S, 1.0 / rate_hz)
}

fn smooth_temperatures(samples: &mut Samples) {
    let Some(rate_hz) = samples.rate_hz else { return };
    let filter = temperature_filter(rate_hz);
    let segments: Vec<Range<usize>> = samples.segments.clone();
    for (_, values) in samples.channels.iter_mut().filter(|(name, _)| name == "temperature") {
        for segment in &segments {
            let smooth = filter.apply_everywhere(&values[segment.clone()], Order::Smooth);
            values[segment.clone()].copy_from_slice(&smooth);
        }
    }
}

/// Rows of a separated recording as they are: nothing to differentiate, so nothing to filter.
fn unfiltered(recording: &Recording, rows: &Range<usize>) -> Samples {
    let of = |values: &[f64]| values[rows.clone()].to_vec();
    let own = |quantity| recording.values(quantity).map(of);
    let named = named_channels(recording).map(|(name, values)| (name.to_owned(), of(values)));
    Samples {
        axis: recording.axis,
        time: own(Quantity::Time).unwrap_or_default(),
        position: own(Quantity::Position),
        velocity: own(Quantity::Velocity),
        acceleration: own(Quantity::Acceleration),
        actuator: recording.actuator().map(|channel| of(&channel.values)),
        actuator_unit: unit_of(recording),
        rigid_body: own(Quantity::RigidBodyTorque),
        friction: recording.separated_friction().map(|channel| of(&channel.values)),
        recorded: target(recording).map(of),
        channels: named.collect(),
        segments: std::iter::once(0..rows.len()).collect(),
        recordings: vec![(recording.label.clone(), 0..rows.len())],
        rate_hz: None,
        sigma_s: None,
        filter: "friction recorded already separated; not filtered".to_owned(),
    }
}

fn empty(recording: &Recording, preparation: &Preparation, rate_hz: Option<f64>) -> Samples {
    Samples {
        axis: recording.axis,
        time: Vec::new(),
        position: None,
        velocity: None,
        acceleration: None,
        actuator: None,
        actuator_unit: unit_of(recording),
        rigid_body: None,
        friction: None,
        recorded: None,
        channels: Vec::new(),
        segments: Vec::new(),
        recordings: Vec::new(),
        rate_hz,
        sigma_s: preparation.sigma_s,
        filter: preparation.to_string(),
    }
}

fn unit_of(recording: &Recording) -> &'static str {
    recording.separated_friction().or_else(|| recording.actuator()).map_or("", |channel| channel.unit)
}
