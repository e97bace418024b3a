//! A network together with the coefficients of the linear columns, as training sees both: normalised, one vector.

use std::ops::Range;

use super::dataset::{Dataset, fold_chunks};
use crate::kan::network::layers::{Network, Scaling};
use crate::kan::network::trace::Trace;

/// Network plus linear columns.
#[derive(Clone, Debug)]
pub(in crate::kan) struct Model {
    pub(in crate::kan) network: Network,
    /// Coefficients of the linear columns, target and columns normalised.
    pub(in crate::kan) linear: Vec<f64>,
    /// Root mean square of each linear column.
    pub(in crate::kan) linear_width: Vec<f64>,
}

impl Model {
    /// Takes the scalings of inputs, target and linear columns from the training rows.
    pub(in crate::kan) fn scaled_to(mut network: Network, dataset: &Dataset, rows: &[Range<usize>]) -> Self {
        network.inputs = dataset.inputs.iter().map(|column| range_of(column, rows)).collect();
        network.output = spread_of(dataset.target, rows);
        let linear_width: Vec<f64> = dataset.linear.iter().map(|column| root_mean_square(column, rows)).collect();
        Self { network, linear: vec![0.0; linear_width.len()], linear_width }
    }

    /// Takes up a network that already has its scalings. Missing coefficients of linear columns start from zero.
    pub(in crate::kan) fn resumed(
        network: Network,
        coefficients: &[f64],
        dataset: &Dataset,
        rows: &[Range<usize>],
    ) -> Self {
        let linear_width: Vec<f64> = dataset.linear.iter().map(|column| root_mean_square(column, rows)).collect();
        let width = network.output.width;
        let coefficient = |(i, w): (usize, &f64)| coefficients.get(i).map_or(0.0, |c| c * w / width);
        Self { linear: linear_width.iter().enumerate().map(coefficient).collect(), network, linear_width }
    }

    /// Coefficients of the linear columns in physical units (target unit per column unit).
    pub(in crate::kan) fn linear_coefficients(&self) -> Vec<f64> {
        let width = self.network.output.width;
        self.linear.iter().zip(&self.linear_width).map(|(a, w)| a * width / w).collect()
    }

    /// Normalised prediction minus normalised target of one row.
    #[inline]
    pub(in crate::kan) fn residual(&self, dataset: &Dataset, row: usize, trace: &mut Trace) -> f64 {
        let network = &self.network;
        let mut value = trace.forward(network, |i| network.inputs[i].normalise(dataset.inputs[i][row]));
        for ((a, width), column) in self.linear.iter().zip(&self.linear_width).zip(dataset.linear) {
            value += a * column[row] / width;
        }
        value - network.output.normalise(dataset.target[row])
    }

    /// Sum of squared normalised residuals.
    pub(in crate::kan) fn residual_sum(&self, dataset: &Dataset, rows: &[Range<usize>]) -> f64 {
        let chunk = |rows: &[Range<usize>]| {
            let mut trace = Trace::new(&self.network);
            rows.iter().cloned().flatten().map(|row| self.residual(dataset, row, &mut trace).powi(2)).sum::<f64>()
        };
        fold_chunks(rows, 0.0, chunk, |sum, part| sum + part)
    }
}

fn over<'a>(column: &'a [f64], rows: &'a [Range<usize>]) -> impl Iterator<Item = f64> + 'a {
    rows.iter().flat_map(|range| column[range.clone()].iter().copied())
}

fn root_mean_square(column: &[f64], rows: &[Range<usize>]) -> f64 {
    let (sum, count) = over(column, rows).fold((0.0, 0usize), |(sum, count), v| (sum + v * v, count + 1));
    positive((sum / count.max(1) as f64).sqrt())
}

/// One when there is no spread to divide by.
fn positive(width: f64) -> f64 {
    if width > 0.0 && width.is_finite() { width } else { 1.0 }
}

/// Maps the range of a column into `[-1, 1]`. Zero stays the middle where the range reaches to both of its sides, so
/// that laws with a symmetry about zero show it.
fn range_of(column: &[f64], rows: &[Range<usize>]) -> Scaling {
    let (low, high) = over(column, rows).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let reach = low.abs().max(high.abs());
    if low < 0.0 && high > 0.0 && low.abs().min(high) > SYMMETRY_RATIO * reach {
        return Scaling { centre: 0.0, width: reach };
    }
    Scaling { centre: 0.5 * low + 0.5 * high, width: positive(0.5 * high - 0.5 * low) }
}

/// How far the shorter side of a range must reach, relative to the longer one, for zero to be its middle.
const SYMMETRY_RATIO: f64 = 0.6;

/// Maps a column to zero mean and unit variance.
fn spread_of(column: &[f64], rows: &[Range<usize>]) -> Scaling {
    let count = rows.iter().map(Range::len).sum::<usize>().max(1) as f64;
    let centre = over(column, rows).sum::<f64>() / count;
    let variance = over(column, rows).map(|v| (v - centre).powi(2)).sum::<f64>() / count;
    Scaling { centre, width: positive(variance.sqrt()) }
}

/// Where each trained number lies in the vector of unknowns: per active edge its coefficients, then its base weight
/// (when base weights are trained), edge after edge, then the linear columns. Spline scales are left out, being
/// redundant with the coefficients.
#[derive(Clone, Debug)]
pub(in crate::kan) struct Unknowns {
    /// `[layer][edge]`: first unknown of an active edge.
    starts: Vec<Vec<Option<usize>>>,
    pub(in crate::kan) with_base: bool,
    network: usize,
    linear: usize,
}

impl Unknowns {
    pub(in crate::kan) fn of(model: &Model, with_base: bool) -> Self {
        let mut next = 0;
        let mut starts = Vec::new();
        for layer in model.network.layers() {
            let start = |edge: &crate::kan::network::layers::Edge| {
                edge.active.then(|| {
                    let start = next;
                    next += edge.basis.len() + usize::from(with_base);
                    start
                })
            };
            starts.push(layer.edges.iter().map(start).collect());
        }
        Self { starts, with_base, network: next, linear: model.linear.len() }
    }

    pub(in crate::kan) fn len(&self) -> usize {
        self.network + self.linear
    }

    /// First unknown that belongs to a linear column.
    pub(in crate::kan) fn linear_start(&self) -> usize {
        self.network
    }

    pub(in crate::kan) fn start(&self, layer: usize, position: usize) -> Option<usize> {
        self.starts[layer][position]
    }

    pub(in crate::kan) fn read(&self, model: &Model) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.len());
        for edge in model.network.active_edges() {
            values.extend_from_slice(&model.network.parameters()[edge.coefficients()]);
            if self.with_base {
                values.push(model.network.parameters()[edge.base()]);
            }
        }
        values.extend_from_slice(&model.linear);
        values
    }

    pub(in crate::kan) fn write(&self, values: &[f64], model: &mut Model) {
        let network = &mut model.network;
        let mut next = 0;
        for edge in network.layers.iter().flat_map(|layer| &layer.edges).filter(|edge| edge.active) {
            let length = edge.basis.len();
            network.parameters[edge.coefficients()].copy_from_slice(&values[next..next + length]);
            next += length;
            if self.with_base {
                network.parameters[edge.base()] = values[next];
                next += 1;
            }
        }
        model.linear.copy_from_slice(&values[next..]);
    }
}
