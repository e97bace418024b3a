//! What the function of a channel in an unnamed structure may look like.

use crate::figures::digits;
use crate::numerics::pattern_search::Movable;
use crate::physics::{SERIES_ORDERS, Shape};
use std::f64::consts::PI;

/// The function of the channel in a generic rival.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Any: a cosine series of the channel's rank.
    Free,
    /// Cosine series over the range of the channel, as effects with a name have it; shape: order, and the range.
    Series,
    /// Linear and quadratic in the channel: it goes beyond the values that it was fitted on.
    Quadratic,
    /// A bump; shape: where, and how wide, in units of the channel.
    Place,
    /// A wave; shape: radians per unit of the channel.
    Wave,
    /// A smooth step; shape: where, and how wide, in units of the channel.
    Step,
}

/// A function of the channel.
pub(crate) type Function<'a> = Box<dyn Fn(f64) -> f64 + 'a>;

/// The forms that are written as a formula, by definition all but the series.
pub(crate) const FORMULA_FORMS: [Form; 4] = [Form::Quadratic, Form::Place, Form::Wave, Form::Step];

/// Largest number of waves over the range of the channel on the grid: as resolved as a series of order twelve.
const LARGEST_WAVE_COUNT: f64 = 6.0;
/// Step of the number of waves on the grid: a quarter of a period over the range, which a refinement climbs from either
/// side.
const WAVE_COUNT_STEP: f64 = 0.25;
/// Centres of a step over the range of the channel on the grid: closer than the wider of [`STEP_WIDTHS`].
const STEP_CENTRES: usize = 24;
/// Widths of a step on the grid, as parts of the range of the channel; refined afterwards.
const STEP_WIDTHS: [f64; 2] = [32.0, 8.0];

impl Form {
    /// Shapes over a range of the channel; bumps are a width apart, of each width as part of the range.
    pub(crate) fn grid(self, (low, high): (f64, f64), widths: [usize; 2]) -> Vec<Shape> {
        let range = high - low;
        let places = |parts: usize| (0..parts).map(move |k| low + (k as f64 + 0.5) * range / parts as f64);
        match self {
            Form::Free => Vec::new(),
            Form::Series => SERIES_ORDERS.map(|order| vec![order, low, high]).to_vec(),
            Form::Quadratic => vec![Vec::new()],
            Form::Place => {
                let of_width = |parts| places(parts).map(move |place| vec![place, range / parts as f64]);
                widths.into_iter().flat_map(of_width).collect()
            }
            Form::Wave => {
                let count = (LARGEST_WAVE_COUNT / WAVE_COUNT_STEP) as usize;
                (2..=count).map(|k| vec![std::f64::consts::TAU * k as f64 * WAVE_COUNT_STEP / range]).collect()
            }
            Form::Step => {
                let at = |place| STEP_WIDTHS.map(|parts| vec![place, range / parts]);
                places(STEP_CENTRES).flat_map(at).collect()
            }
        }
    }

    /// How the parameters of a shape may move between the points of the grid.
    pub(crate) fn movable(self, shape: &[f64], (low, high): (f64, f64)) -> Vec<Movable> {
        let range = high - low;
        let place_and_width = |step| {
            let width = Movable { index: 1, step: shape[1] / 3.0, low: range / 400.0, high: range };
            vec![Movable { index: 0, step, low, high }, width]
        };
        match self {
            Form::Free | Form::Series | Form::Quadratic => Vec::new(),
            Form::Place => place_and_width(0.5 * shape[1]),
            Form::Step => place_and_width(0.5 * range / STEP_CENTRES as f64),
            Form::Wave => {
                let one = std::f64::consts::TAU / range;
                vec![Movable {
                    index: 0,
                    step: 0.5 * WAVE_COUNT_STEP * one,
                    low: 0.25 * one,
                    high: 2.0 * LARGEST_WAVE_COUNT * one,
                }]
            }
        }
    }

    /// Its functions of the channel; none of a free one.
    pub(crate) fn functions(self, shape: &[f64]) -> Vec<Function<'_>> {
        match self {
            Form::Free => Vec::new(),
            Form::Series => {
                let angle = |x: f64| PI * (x - shape[1]) / (shape[2] - shape[1]);
                (1..=shape[0] as usize).map(|j| Box::new(move |x| (j as f64 * angle(x)).cos()) as Function).collect()
            }
            Form::Quadratic => vec![Box::new(|x| x), Box::new(|x| x * x)],
            Form::Place => vec![Box::new(|x| (-((x - shape[0]) / shape[1]).powi(2)).exp())],
            Form::Wave => vec![Box::new(|x| (shape[0] * x).cos()), Box::new(|x| (shape[0] * x).sin())],
            Form::Step => vec![Box::new(|x| ((x - shape[0]) / shape[1]).tanh())],
        }
    }

    /// How its functions read; none of a series.
    pub(crate) fn texts(self, shape: &[f64], channel: &str) -> Vec<String> {
        let from = |place: f64| {
            let sign = if place < 0.0 { '+' } else { '-' };
            format!("({channel} {sign} {})", digits(place.abs()))
        };
        match self {
            Form::Free | Form::Series => Vec::new(),
            Form::Quadratic => vec![channel.to_string(), format!("{channel}^2")],
            Form::Place => vec![format!("exp(-({} / {})^2)", from(shape[0]), digits(shape[1]))],
            Form::Wave => ["cos", "sin"].map(|wave| format!("{wave}({} {channel})", digits(shape[0]))).to_vec(),
            Form::Step => vec![format!("tanh({} / {})", from(shape[0]), digits(shape[1]))],
        }
    }
}
