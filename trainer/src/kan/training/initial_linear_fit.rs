//! The initial linear fit: one spline per input, linear in its coefficients. It gives main effects, the variance of the noise, and
//! knots where the effects bend.

use std::ops::Range;

use super::dataset::{Dataset, row_count};
use super::model::Model;
use super::optimisers::minimise;
use super::settings::{Monitor, Optimiser, Settings, Smoothing};
use super::sparsity::Sparsity;
use crate::kan::network::architecture::Architecture;
use crate::kan::network::error::KanError;
use crate::kan::network::knots::Placement;
use crate::kan::network::layers::Network;
use crate::kan::network::spline::SplineBasis;

/// Main effect of every input, and where its knots lie.
#[derive(Clone, Debug)]
pub(in crate::kan) struct InitialLinearFit {
    pub(in crate::kan) placements: Vec<Placement>,
    /// Residual variance beside the main effects, by generalised cross-validation, normalised target.
    pub(in crate::kan) noise_variance: f64,
    model: Model,
}

impl InitialLinearFit {
    /// Fits with given knots; takes scalings and linear columns over from `model`.
    fn with_knots(
        placements: Vec<Placement>,
        cells: usize,
        model: &Model,
        dataset: &Dataset,
        rows: &[Range<usize>],
    ) -> Result<Self, KanError> {
        let settings = Settings {
            optimiser: Optimiser::GaussNewton,
            steps: 12,
            smoothing: Smoothing::Estimated,
            noise_variance: 1e-2,
            tolerance: 1e-3,
            with_base: false,
            sparsity: Sparsity::NONE,
        };
        let bases: Vec<SplineBasis> = placements.iter().map(|p| p.basis(cells, 3, 0.0)).collect::<Result<_, _>>()?;
        let mut model = model.clone();
        model.network.set_bases(bases);
        let mut monitor = Monitor::new(&|_| {}, 0, &[], settings.steps);
        let (_, noise_variance) = minimise(&mut model, dataset, rows, &settings, &mut monitor);
        Ok(Self { placements, noise_variance, model })
    }

    /// Density of knots proportional to the fourth root of the fourth derivative of the input's effect, estimated from the
    /// jumps of this fit's third derivative (optimal for cubic splines; de Boor, 1973), blended with the density of the
    /// range and of the samples.
    fn equidistributed(&self, input: usize, samples: &Placement) -> Placement {
        let breaks = self.model.network.layers()[0].edge(input, 0).basis.breaks();
        let cells = breaks.len() - 1;
        let network = &self.model.network;
        let slope = |x: f64| network.edge_slope(0, input, 0, network.inputs[input].restore(x));
        let third: Vec<f64> = breaks
            .windows(2)
            .map(|ends| {
                let half = 0.5 * (ends[1] - ends[0]);
                (slope(ends[0]) - 2.0 * slope(ends[0] + half) + slope(ends[1])) / (half * half)
            })
            .collect();
        // Fourth derivative at the inner breaks.
        let fourth: Vec<f64> =
            (1..cells).map(|i| 2.0 * (third[i] - third[i - 1]).abs() / (breaks[i + 1] - breaks[i - 1])).collect();
        let bend: Vec<f64> = (0..cells)
            .map(|i| {
                let neighbours = &fourth[i.saturating_sub(1)..(i + 1).min(fourth.len())];
                let mean = neighbours.iter().sum::<f64>() / neighbours.len().max(1) as f64;
                mean.sqrt().sqrt() * (breaks[i + 1] - breaks[i])
            })
            .collect();
        let total: f64 = bend.iter().sum();
        let mut share = vec![0.0];
        let mut sum = 0.0;
        for i in 1..=cells {
            let even = 0.5 * (breaks[i] - breaks[i - 1]);
            let sampled = samples.share_below(breaks[i]) - samples.share_below(breaks[i - 1]);
            let bent = if total > 0.0 { bend[i - 1] / total } else { even };
            sum += (1.0 - 2.0 * EVEN_KNOT_SHARE) * bent + EVEN_KNOT_SHARE * (even + sampled);
            share.push(sum);
        }
        let all = sum.max(f64::MIN_POSITIVE);
        share.iter_mut().for_each(|s| *s /= all);
        let placement = Placement { position: breaks.to_vec(), share };
        if network.inputs[input].centre == 0.0 { placement.symmetric() } else { placement }
    }

    /// Contribution of one input at a normalised value, normalised target.
    pub(in crate::kan) fn effect(&self, input: usize, x: f64) -> f64 {
        let network = &self.model.network;
        network.edge_activation(0, input, 0, network.inputs[input].restore(x)) / network.output.width
    }

    /// Coefficients of the linear columns beside these effects, normalised.
    pub(in crate::kan) fn linear(&self) -> &[f64] {
        &self.model.linear
    }
}

/// Cells per input.
const CELLS: usize = 30;

/// Crowding about zero that is tried for inputs that reach to both sides of it.
const CROWDINGS: [f64; 4] = [3.0, 4.0, 5.0, 6.0];

/// Rounds of moving knots to where the last round's curve bends.
const ROUNDS: usize = 8;

/// Relative improvement that free knots must bring over crowded ones: under noise their many degrees of freedom find
/// bends that are not there.
const LEAST_IMPROVEMENT: f64 = 0.02;

/// Share of the knots that is spread evenly over the range, and over the samples.
const EVEN_KNOT_SHARE: f64 = 0.02;

/// Fits it from even knots, then crowded ones, then knots moved to where the last curve bends.
pub(in crate::kan) fn initial_linear_fit(
    dataset: &Dataset,
    rows: &[Range<usize>],
) -> Result<InitialLinearFit, KanError> {
    let inputs = dataset.inputs.len();
    let cells = (row_count(rows) / (4 * inputs)).clamp(3, CELLS);
    let architecture = Architecture::additive(inputs, &[]).with_resolution(cells, 3);
    let model = Model::scaled_to(Network::zeros(&architecture)?, dataset, rows);
    let samples: Vec<Placement> = (0..inputs).map(|i| quantiles(&dataset.inputs[i], &model, i, rows)).collect();

    let mut best = InitialLinearFit::with_knots(vec![Placement::uniform(); inputs], cells, &model, dataset, rows)?;
    for input in (0..inputs).filter(|&input| model.network.inputs[input].centre == 0.0) {
        for warp in CROWDINGS {
            let mut placements = best.placements.clone();
            placements[input] = Placement::crowded(warp);
            let crowded = InitialLinearFit::with_knots(placements, cells, &best.model, dataset, rows)?;
            if crowded.noise_variance < best.noise_variance {
                best = crowded;
            }
        }
    }
    let mut last = best.clone();
    let mut least = best.noise_variance * (1.0 - LEAST_IMPROVEMENT);
    for _ in 0..ROUNDS {
        let moved = (0..inputs).map(|input| last.equidistributed(input, &samples[input])).collect();
        last = InitialLinearFit::with_knots(moved, cells, &last.model, dataset, rows)?;
        if last.noise_variance < least {
            least = last.noise_variance;
            best = last.clone();
        }
    }
    Ok(best)
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
