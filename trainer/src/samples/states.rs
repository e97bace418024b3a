//! The states that a filtered sample averages over. Friction bends and jumps with velocity, so that the law of the filtered velocity is not
//! the filtered law; the torque shows the latter (rule P1).
//!
//! The window of the filter is cut into cells of one sampling period, or of a quarter of a wide filter's deviation. Within a cell the velocity is
//! a straight line; where it turns round, or changes much, the cell is averaged piece by piece.

use super::grid::Grid;
use super::plan::{Motion, Preparation, VelocitySource};
use super::prepare::usable;
use super::{Samples, top_speed};
use crate::error::Result;
use crate::numerics::averages::Averages;
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::recording::{Quantity, Recording};
use std::f64::consts::PI;
use std::ops::Range;

/// Cells of a wide filter in one of its standard deviations.
const CELLS_IN_SIGMA: f64 = 4.0;
/// The window reaches over so many standard deviations, as the filter does.
const REACH_SIGMAS: f64 = 4.0;
/// Where the velocity scatters by less than this share of itself within the window, the filtered velocity stands for all of it: what a law
/// bends there is at most half of the square of this, times a bend of the order of the friction.
const EVEN_SHARE: f64 = 0.05;
/// A cell over which the velocity changes by more than this share of itself is averaged by Gauss's rule of three points.
const CHANGE_SHARE: f64 = 0.25;
/// Places and weights of that rule on a unit interval.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Below this share of the top speed a joint rests, whatever its encoder.
const REST_SHARE: f64 = 0.001;
/// Deviations of its noise within which a velocity is not told from rest.
const REST_DEVIATIONS: f64 = 4.0;
/// Noise of the velocity within the states over the top speed. What noise makes of a bend is half its square over that of the bend's width: of
/// the narrowest Stribeck velocities, a fiftieth of the top speed, two thousandths.
const NOISE_SHARE: f64 = 0.001_25;
/// Weight of resting cells from which on a sample says nothing of friction, which is any within break-away there.
const REST_WEIGHT: f64 = 1e-3;

/// The states that samples average over.
#[derive(Clone, Debug, Default)]
pub struct States {
    /// Samples that do not rest, in their order.
    pub rows: Vec<usize>,
    /// For each of them, the states with their weights.
    pub averages: Averages,
    /// Velocity of each state.
    pub velocity: Vec<f64>,
    /// Range of velocities that each state stands for; zero where the velocity is even.
    pub span: Vec<f64>,
    /// For each row, the weight of cells in which the velocity turns round.
    pub turning: Vec<f64>,
    /// For each state the row (as its place in `rows`) that is nearest to it.
    pub nearest: Vec<usize>,
}

/// The states of those of `rows` (ascending) at which the joint does not rest; `None` where nothing is filtered.
///
/// # Errors
/// `FRK-D009` where motion or clock is missing.
pub fn states(
    recordings: &[Recording],
    preparation: &Preparation,
    samples: &Samples,
    rows: &[usize],
) -> Result<Option<States>> {
    let Some(sigma_s) = preparation.sigma_s else { return Ok(None) };
    let top = top_speed(samples.require_velocity()?);
    let mut states = States::default();
    let mut segments = samples.segments.iter();
    for recording in recordings {
        let time = &recording.require(&[Quantity::Time], "a recording with a motion")?.values;
        let grid = Grid::of(recording, time);
        let filter = GaussianFilter::new(sigma_s, grid.period_s);
        let cells = Cells::of(&filter, &Motion::of(recording)?, preparation.velocity, top);
        let quantity = match preparation.velocity {
            VelocitySource::Derived => Quantity::Position,
            VelocitySource::Recorded => Quantity::Velocity,
        };
        let channel = &recording.require(&[quantity], "a recording with a motion")?.values;
        let stride = preparation.stride(grid.period_s);
        for (piece, segment) in usable(&grid, &filter).into_iter().zip(&mut segments) {
            let velocities = cells.velocities(&grid.values(piece, time, channel));
            let own = rows.partition_point(|row| *row < segment.start)..rows.partition_point(|row| *row < segment.end);
            let centre = |row: usize| filter.half_width() + (row - segment.start) * stride;
            let own = rows[own].iter().map(|&row| (row, centre(row) as f64 / cells.periods as f64));
            states.extend(&cells, &velocities, own, samples);
        }
    }
    Ok(Some(states))
}

/// How a recording is cut into cells.
struct Cells {
    period_s: f64,
    /// Sampling periods of a cell.
    periods: usize,
    /// Deviation of the filter in cells.
    sigma: f64,
    source: VelocitySource,
    /// The filter before the velocity, where its noise asks for one.
    light: Option<GaussianFilter>,
    /// Speed below which the joint may rest.
    rest: f64,
}

impl Cells {
    fn of(filter: &GaussianFilter, motion: &Motion, source: VelocitySource, top: f64) -> Self {
        let (sigma_s, period_s) = (filter.sigma_s, filter.period_s);
        let periods = ((sigma_s / (CELLS_IN_SIGMA * period_s)) as usize).max(1);
        let noise = motion.noise(source);
        // Of a difference over two cells, or of a sample.
        let unfiltered = match source {
            VelocitySource::Derived => noise * 0.5_f64.sqrt() / (periods as f64 * period_s),
            VelocitySource::Recorded => noise,
        };
        let limit = NOISE_SHARE * top;
        // Deviation of the filter that leaves the limit of white noise, s; no wider than that of the torque.
        let needed = match source {
            VelocitySource::Derived => (noise * noise * period_s / (4.0 * PI.sqrt() * limit * limit)).cbrt(),
            VelocitySource::Recorded => noise * noise * period_s / (2.0 * PI.sqrt() * limit * limit),
        };
        let light = (unfiltered > limit).then(|| GaussianFilter::new(needed.min(sigma_s), period_s));
        let left = match (&light, source) {
            (None, _) => unfiltered,
            (Some(light), VelocitySource::Derived) => noise * light.noise_gain(Order::First),
            (Some(light), VelocitySource::Recorded) => noise * light.noise_gain(Order::Smooth),
        };
        let rest = (REST_SHARE * top).max(REST_DEVIATIONS * left);
        Self { period_s, periods, sigma: sigma_s / (periods as f64 * period_s), source, light, rest }
    }

    /// Velocity at the edges of the cells of a segment, and over each of them, from position or velocity at its samples.
    fn velocities(&self, channel: &[f64]) -> [Vec<f64>; 2] {
        let every = |values: &[f64]| values.iter().step_by(self.periods).copied().collect::<Vec<f64>>();
        let edges = match (&self.light, self.source) {
            (Some(light), VelocitySource::Derived) => every(&light.apply_everywhere(channel, Order::First)),
            (Some(light), VelocitySource::Recorded) => every(&light.apply_everywhere(channel, Order::Smooth)),
            (None, VelocitySource::Recorded) => every(channel),
            (None, VelocitySource::Derived) => {
                let length = self.periods as f64 * self.period_s;
                let over: Vec<f64> = every(channel).windows(2).map(|edge| (edge[1] - edge[0]) / length).collect();
                let last = over.len().saturating_sub(1);
                let mean = |edge: usize| 0.5 * (over[edge.saturating_sub(1)] + over[edge.min(last)]);
                let edges = if over.is_empty() { Vec::new() } else { (0..=over.len()).map(mean).collect() };
                return [edges, over];
            }
        };
        let over = edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1])).collect();
        [edges, over]
    }

    /// Cells of the window around a place, within `count` cells.
    fn window(&self, centre: f64, count: usize) -> Range<usize> {
        let reach = REACH_SIGMAS * self.sigma;
        ((centre - reach).round().max(0.0) as usize)..((centre + reach).round().max(0.0) as usize).min(count)
    }

    fn weight(&self, cell: usize, centre: f64) -> f64 {
        (-0.5 * ((cell as f64 + 0.5 - centre) / self.sigma).powi(2)).exp()
    }
}

/// What a sample is found to be.
enum Kind {
    /// Its velocity is even: the filtered one stands for all.
    Even,
    /// It averages over these cells.
    Bent(Range<usize>),
}

impl States {
    /// Adds the samples of a segment, each with its place in cells; `edges` holds the velocity at the edges of the cells, `over` that of each.
    fn extend(
        &mut self,
        cells: &Cells,
        [edges, over]: &[Vec<f64>; 2],
        own: impl Iterator<Item = (usize, f64)>,
        samples: &Samples,
    ) {
        let count = over.len();
        let velocity = samples.velocity.as_deref().unwrap_or_default();
        let rests: Vec<bool> = over.iter().map(|velocity| velocity.abs() < cells.rest).collect();
        let mut needed = vec![false; count];
        let mut found = Vec::new();
        for (row, centre) in own {
            let window = cells.window(centre, count);
            let weights = || window.clone().map(|cell| (cell, cells.weight(cell, centre)));
            let sum: f64 = weights().map(|(_, weight)| weight).sum();
            let resting: f64 = weights().filter(|(cell, _)| rests[*cell]).map(|(_, weight)| weight).sum();
            if window.is_empty() || resting > REST_WEIGHT * sum {
                continue;
            }
            let middle = velocity[row];
            let scatter: f64 =
                weights().map(|(cell, weight)| weight * (0.5 * (edges[cell] + edges[cell + 1]) - middle).powi(2)).sum();
            if (scatter / sum).sqrt() <= EVEN_SHARE * middle.abs() {
                found.push((row, centre, Kind::Even));
            } else {
                needed[window.clone()].fill(true);
                found.push((row, centre, Kind::Bent(window)));
            }
        }
        let mut begins = vec![0; count + 1];
        let mut centres = found.iter().map(|(_, centre, _)| *centre).enumerate().peekable();
        let first = self.rows.len();
        let mut nearest = 0;
        let mut shares = Vec::new();
        for cell in 0..count {
            begins[cell] = self.velocity.len();
            if needed[cell] {
                while let Some((place, _)) = centres.next_if(|(_, centre)| *centre <= cell as f64 + 0.5) {
                    nearest = place;
                }
                for (share, velocity) in pieces(edges[cell], edges[cell + 1]) {
                    self.velocity.push(velocity);
                    self.span.push(share * (edges[cell + 1] - edges[cell]).abs());
                    self.nearest.push(first + nearest);
                    shares.push(share);
                }
            }
        }
        begins[count] = self.velocity.len();
        let start = begins[0];
        let turns = |cell: usize| edges[cell] * edges[cell + 1] < 0.0;
        for (row, centre, kind) in found {
            match kind {
                Kind::Even => {
                    self.turning.push(0.0);
                    self.averages.push(self.velocity.len(), std::iter::once(1.0));
                    self.velocity.push(velocity[row]);
                    self.span.push(0.0);
                    self.nearest.push(self.rows.len());
                }
                Kind::Bent(window) => {
                    let weights = window.clone().flat_map(|cell| {
                        let weight = cells.weight(cell, centre);
                        shares[begins[cell] - start..begins[cell + 1] - start].iter().map(move |share| share * weight)
                    });
                    self.averages.push(begins[window.start], weights);
                    let weights = |counts: &dyn Fn(usize) -> bool| -> f64 {
                        window.clone().filter(|cell| counts(*cell)).map(|cell| cells.weight(cell, centre)).sum()
                    };
                    self.turning.push(weights(&turns) / weights(&|_| true));
                }
            }
            self.rows.push(row);
        }
    }
}

/// Velocities that stand for a cell, each with its share of it, where the velocity goes in a straight line from one edge to the other.
fn pieces(from: f64, to: f64) -> Vec<(f64, f64)> {
    let change = to - from;
    let gauss = |begin: f64, end: f64| {
        GAUSS.map(|(place, weight)| (weight * (end - begin), from + change * (begin + place * (end - begin))))
    };
    if from * to < 0.0 {
        let turn = -from / change;
        [gauss(0.0, turn), gauss(turn, 1.0)].concat()
    } else if change.abs() > CHANGE_SHARE * from.abs().min(to.abs()) {
        gauss(0.0, 1.0).to_vec()
    } else {
        vec![(1.0, 0.5 * (from + to))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;
    use crate::samples::prepare;

    #[test]
    fn a_cell_in_which_the_velocity_turns_round_has_a_sign_between_the_two() {
        for (from, to) in [(0.3, -0.1), (-0.2, 0.6), (0.1, 0.5), (0.4, 0.41), (0.0, 0.2)] {
            let sum = |of: fn(f64) -> f64| pieces(from, to).iter().map(|(share, v)| share * of(*v)).sum::<f64>();
            let change = to - from;
            let sign = (f64::abs(to) - f64::abs(from)) / change;
            let square = (to.powi(3) - from.powi(3)) / (3.0 * change);
            assert!((sum(f64::signum) - sign).abs() < 1e-12, "{from} {to}");
            assert!((sum(|v| v) - 0.5 * (from + to)).abs() < 1e-12 && (sum(|v| v * v) - square).abs() < 1e-4);
        }
    }

    /// Without noise, what a law averaged over the states leaves of the filtered torque is a small part of what the law of the filtered velocity
    /// leaves; the joint turns round within samples, and friction declines from rest within a tenth of the top speed.
    #[test]
    fn the_filtered_law_is_the_average_over_the_states() {
        let law = |v: f64| v.signum() * (2.0 + (-v.abs() / 0.2).exp()) + 1.2 * v;
        let period = 0.004;
        let place = |t: f64| 0.8 * (2.3 * t).sin() + 0.2 * (5.1 * t).sin();
        let velocity = |t: f64| 1.84 * (2.3 * t).cos() + 1.02 * (5.1 * t).cos();
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for i in 0..4000 {
            let t = f64::from(i) * period;
            // A torque is the mean over the sample around its instant.
            let within = (0..50).map(|k| law(velocity(t + ((f64::from(k) + 0.5) / 50.0 - 0.5) * period)));
            text += &format!("{t},{},{}\n", place(t), within.sum::<f64>() / 50.0);
        }
        let recording = crate::recording::parse("swing.csv", text.as_bytes(), &Joint::default()).unwrap();
        for sigma_s in [0.004, 0.02] {
            let preparation = Preparation {
                sigma_s: Some(sigma_s),
                rate_hz: None,
                velocity: VelocitySource::Derived,
                acceleration_noise: 0.0,
                torque_delay_s: 0.0,
            };
            let samples = prepare(&recording, &preparation).unwrap();
            let rows: Vec<usize> = (0..samples.len()).collect();
            let recordings = std::slice::from_ref(&recording);
            let states = states(recordings, &preparation, &samples, &rows).unwrap().unwrap();
            assert!(states.rows.len() > 3 * rows.len() / 4, "{} of {}", states.rows.len(), rows.len());
            let averaged = states.averages.over(&states.velocity.iter().map(|v| law(*v)).collect::<Vec<f64>>());
            let (torque, filtered) = (samples.actuator.unwrap(), samples.velocity.unwrap());
            let rms = |left: &dyn Fn(usize) -> f64| {
                let sum: f64 = (0..states.rows.len()).map(|place| left(place).powi(2)).sum();
                (sum / states.rows.len() as f64).sqrt()
            };
            let of_states = rms(&|place| torque[states.rows[place]] - averaged[place]);
            let of_filtered = rms(&|place| torque[states.rows[place]] - law(filtered[states.rows[place]]));
            assert!(of_states < 0.1 * of_filtered, "{of_states} N m against {of_filtered} N m at {sigma_s} s");
        }
    }
}
