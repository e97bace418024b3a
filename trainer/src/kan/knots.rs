//! Knots where the law bends: a pilot fit of one spline per input, its curvature equidistributed over the cells.

use std::ops::Range;

use super::architecture::Architecture;
use super::dataset::{Dataset, row_count};
use super::error::KanError;
use super::model::Model;
use super::network::Network;
use super::spline::{Grid, SplineBasis};
use super::training::{Optimiser, Settings, Smoothing, Watch, minimise};

/// Monotone map from a normalised input in `[-1, 1]` to a share of the knots in `[0, 1]`, linear between points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placement {
    position: Vec<f64>,
    share: Vec<f64>,
}

impl Placement {
    fn uniform() -> Self {
        Self { position: vec![-1.0, 1.0], share: vec![0.0, 1.0] }
    }

    /// Share of the knots below `x`.
    pub(super) fn share_below(&self, x: f64) -> f64 {
        interpolate(&self.position, &self.share, x)
    }

    /// Boundaries of `cells` cells; inner ones are moved by `shift` cells, `-0.5 ..= 0.5`.
    pub(super) fn breaks(&self, cells: usize, shift: f64) -> Vec<f64> {
        let inner = |i: usize| interpolate(&self.share, &self.position, (i as f64 + shift) / cells as f64);
        let mut breaks: Vec<f64> = (0..=cells)
            .map(|i| {
                if i == 0 {
                    -1.0
                } else if i == cells {
                    1.0
                } else {
                    inner(i)
                }
            })
            .collect();
        // Cells never vanish, however steep the law.
        let least = MINIMUM_CELL / cells as f64;
        for i in 1..cells {
            breaks[i] = breaks[i].max(breaks[i - 1] + least).min(1.0 - least * (cells - i) as f64);
        }
        breaks
    }

    /// The basis over such cells.
    pub(super) fn basis(&self, cells: usize, order: usize, shift: f64) -> Result<SplineBasis, KanError> {
        SplineBasis::new(Grid { order, breaks: self.breaks(cells, shift) })
    }
}

/// Smallest width of a cell relative to that of a uniform one.
const MINIMUM_CELL: f64 = 1e-4;

/// Main effect of every input, and where its knots should lie.
#[derive(Clone, Debug)]
pub(super) struct Pilot {
    pub(super) placements: Vec<Placement>,
    /// Residual variance beside the main effects, by generalised cross-validation, normalised target.
    pub(super) noise_variance: f64,
    model: Model,
}

impl Pilot {
    /// Contribution of one input at a normalised value, normalised target.
    pub(super) fn effect(&self, input: usize, x: f64) -> f64 {
        let network = &self.model.network;
        network.edge_activation(0, input, 0, network.inputs[input].restore(x)) / network.output.width
    }

    /// Coefficients of the linear columns beside these effects, normalised.
    pub(super) fn linear(&self) -> &[f64] {
        &self.model.linear
    }
}

/// Rounds of fitting and moving knots.
const ROUNDS: usize = 8;

/// Share of the knots that is spread evenly over the range, and over the samples.
const SPREAD: f64 = 0.15;

/// Fits the pilot.
pub(super) fn pilot(dataset: &Dataset, rows: &[Range<usize>]) -> Result<Pilot, KanError> {
    let inputs = dataset.inputs.len();
    let cells = (row_count(rows) / (4 * inputs)).clamp(3, CELLS);
    let architecture = Architecture::additive(inputs, &[]).with_resolution(cells, 3);
    let mut model = Model::scaled_to(Network::zeros(&architecture)?, dataset, rows);
    let samples: Vec<Placement> =
        (0..inputs).map(|i| quantiles(dataset.inputs[i].as_slice(), &model, i, rows)).collect();
    let settings = Settings {
        optimiser: Optimiser::GaussNewton,
        steps: 12,
        smoothing: Smoothing::Estimated,
        noise_variance: 1e-2,
        tolerance: 1e-3,
        with_base: false,
    };
    let mut placements = vec![Placement::uniform(); inputs];
    let mut best: Option<(f64, Pilot)> = None;
    for _ in 0..ROUNDS {
        let bases: Vec<SplineBasis> = placements.iter().map(|p| p.basis(cells, 3, 0.0)).collect::<Result<_, _>>()?;
        model.network.set_bases(bases.iter().cloned());
        let (_, score) =
            minimise(&mut model, dataset, rows, &settings, &mut Watch::new(&|_| {}, 0, &[], settings.steps));
        let found = Pilot { placements: placements.clone(), noise_variance: score, model: model.clone() };
        let moved: Vec<Placement> = (0..inputs).map(|i| equidistributed(&found, i, &bases[i], &samples[i])).collect();
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            // The knots for the network come from the best curve, not from those that it was fitted with.
            best = Some((score, Pilot { placements: moved.clone(), ..found }));
        }
        placements = moved;
    }
    Ok(best.map_or_else(|| Pilot { placements, noise_variance: 1.0, model }, |(_, pilot)| pilot))
}

/// Cells of the pilot per input.
const CELLS: usize = 30;

/// Points per cell at which curvature is taken.
const SUBCELLS: usize = 4;

/// Density of knots proportional to the square root of the curvature of the input's effect (the optimum for
/// interpolation between two knots; de Boor, 1973), blended with the range's and the samples' own.
fn equidistributed(pilot: &Pilot, input: usize, basis: &SplineBasis, samples: &Placement) -> Placement {
    let breaks = basis.breaks();
    let mut position = vec![breaks[0]];
    for cell in breaks.windows(2) {
        position.extend((1..=SUBCELLS).map(|k| cell[0] + (cell[1] - cell[0]) * k as f64 / SUBCELLS as f64));
    }
    let network = &pilot.model.network;
    let slope = |x: f64| network.edge_slope(0, input, 0, network.inputs[input].restore(x));
    let slopes: Vec<f64> = position.iter().map(|&x| slope(x)).collect();
    let bend: Vec<f64> = (1..position.len())
        .map(|i| ((slopes[i] - slopes[i - 1]).abs() * (position[i] - position[i - 1])).sqrt())
        .collect();
    // A running mean over one cell keeps the knots from chasing single wiggles.
    let half = SUBCELLS / 2;
    let smooth: Vec<f64> = (0..bend.len())
        .map(|i| {
            let window = &bend[i.saturating_sub(half)..(i + half + 1).min(bend.len())];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect();
    let total: f64 = smooth.iter().sum();
    let mut share = vec![0.0];
    let mut sum = 0.0;
    for i in 1..position.len() {
        let even = 0.5 * (position[i] - position[i - 1]);
        let sampled = samples.share_below(position[i]) - samples.share_below(position[i - 1]);
        let bent = if total > 0.0 { smooth[i - 1] / total } else { even };
        sum += (1.0 - 2.0 * SPREAD) * bent + SPREAD * (even + sampled);
        share.push(sum);
    }
    let all = sum.max(f64::MIN_POSITIVE);
    share.iter_mut().for_each(|s| *s /= all);
    Placement { position, share }
}

/// The empirical distribution of an input, at no more than a few dozen points.
fn quantiles(column: &[f64], model: &Model, input: usize, rows: &[Range<usize>]) -> Placement {
    let scaling = model.network.inputs[input];
    let count = row_count(rows);
    let stride = count.div_ceil(MOST_SORTED).max(1);
    let mut values: Vec<f64> =
        rows.iter().flat_map(|range| &column[range.clone()]).step_by(stride).map(|&v| scaling.normalise(v)).collect();
    values.sort_by(f64::total_cmp);
    let mut placement = Placement { position: vec![-1.0], share: vec![0.0] };
    for k in 1..32 {
        let x = values[k * (values.len() - 1) / 32];
        if x > placement.position[placement.position.len() - 1] + 1e-9 && x < 1.0 - 1e-9 {
            placement.position.push(x);
            placement.share.push(k as f64 / 32.0);
        }
    }
    placement.position.push(1.0);
    placement.share.push(1.0);
    placement
}

/// Samples that are sorted for quantiles; of more, every so-many-th is taken.
const MOST_SORTED: usize = 20_000;

fn interpolate(from: &[f64], to: &[f64], x: f64) -> f64 {
    let i = from.partition_point(|&f| f <= x).clamp(1, from.len() - 1);
    let width = from[i] - from[i - 1];
    let t = if width > 0.0 { ((x - from[i - 1]) / width).clamp(0.0, 1.0) } else { 0.0 };
    to[i - 1] + (to[i] - to[i - 1]) * t
}
