//! Activations of a trained network as piecewise polynomials that can bound themselves, so that tables made from them
//! carry a certificate.

use crate::compile::formula::Curve;
use crate::compile::interval::Interval;
use crate::compile::series::{ORDERS, Series};
use crate::kan::Network;

/// A polynomial on each cell between breaks, continued along its tangent beyond them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piecewise {
    breaks: Vec<f64>,
    /// Coefficients of each cell in the distance from its left break, constant first. The tangents stand first and last.
    cells: Vec<Vec<f64>>,
    order: usize,
}

impl Piecewise {
    /// One activation, read off its network in as many points as its order needs. In the first layer the argument is
    /// the physical input; the last layer's activations are in the unit of the output.
    pub(super) fn of(network: &Network, layer: usize, from: usize, to: usize) -> Self {
        let edge = network.layers()[layer].edge(from, to);
        let order = edge.basis.order();
        let physical = |x: f64| if layer == 0 { network.inputs[from].restore(x) } else { x };
        let breaks: Vec<f64> = edge.basis.breaks().iter().map(|b| physical(*b)).collect();
        let value = |x: f64| network.edge_activation(layer, from, to, x);
        let inside = breaks.windows(2).map(|pair| interpolated(&value, pair[0], pair[1], order));
        let (first, last) = (breaks[0], breaks[breaks.len() - 1]);
        let tangent = |x: f64| vec![value(x), network.edge_slope(layer, from, to, x)];
        let mut cells = vec![tangent(first)];
        cells.extend(inside);
        cells.push(tangent(last));
        Self { breaks, cells, order }
    }

    /// The function plus a constant.
    pub(super) fn raised(mut self, by: f64) -> Self {
        for cell in &mut self.cells {
            cell[0] += by;
        }
        self
    }

    /// Left break from which the coefficients of a cell count.
    fn origin(&self, cell: usize) -> f64 {
        self.breaks[cell.saturating_sub(1).min(self.breaks.len() - 1)]
    }

    fn cell_of(&self, x: f64) -> usize {
        self.breaks.partition_point(|b| *b <= x)
    }

    /// Largest magnitude of the slope over `[low, high]`, sampled.
    pub(super) fn steepest(&self, low: f64, high: f64) -> f64 {
        const POINTS: usize = 200;
        let at = |i: usize| low + (high - low) * i as f64 / POINTS as f64;
        (0..POINTS)
            .map(|i| ((self.value(at(i + 1)) - self.value(at(i))) / (at(i + 1) - at(i))).abs())
            .fold(0.0, f64::max)
    }

    /// Enclosures of the Taylor coefficients of the function at any point of `over`.
    fn taylor(&self, over: Interval) -> [Interval; ORDERS] {
        let (first, last) = (self.cell_of(over.low), self.cell_of(over.high));
        let mut hull: Option<[Interval; ORDERS]> = None;
        for cell in first..=last {
            let origin = Interval::point(self.origin(cell));
            let low = if cell == first { over.low } else { self.breaks[cell - 1] };
            let high = if cell == last { over.high } else { self.breaks[cell] };
            let own = shifted(&self.cells[cell], Interval::new(low, high) - origin);
            hull = Some(hull.map_or(own, |hull| std::array::from_fn(|k| hull[k].hull(own[k]))));
        }
        let mut hull = hull.unwrap_or([Interval::ENTIRE; ORDERS]);
        // Across a break one derivative beyond the continuous ones is bounded, those above do not exist.
        let outermost = first == 0 || last == self.cells.len() - 1;
        let bounded = if first == last {
            ORDERS
        } else if outermost {
            3
        } else {
            self.order + 1
        };
        for coefficient in hull.iter_mut().skip(bounded) {
            *coefficient = Interval::ENTIRE;
        }
        hull
    }

    /// The function of a function that is given by its series.
    pub(super) fn compose(&self, u: Series) -> Series {
        let outer = self.taylor(u.0[0]);
        let zero = Interval::point(0.0);
        let mut result = [zero; ORDERS];
        result[0] = outer[0];
        // Powers of the series without its constant: power[k] is the coefficient of order k.
        let mut power = u.0;
        power[0] = zero;
        for coefficient in outer.iter().skip(1) {
            for k in 1..ORDERS {
                result[k] = result[k] + *coefficient * power[k];
            }
            let mut next = [zero; ORDERS];
            for (i, left) in power.iter().enumerate().skip(1) {
                for j in 1..ORDERS.saturating_sub(i) {
                    next[i + j] = next[i + j] + *left * u.0[j];
                }
            }
            power = next;
        }
        Series(result)
    }
}

impl Curve for Piecewise {
    fn value(&self, x: f64) -> f64 {
        let cell = self.cell_of(x);
        let t = x - self.origin(cell);
        self.cells[cell].iter().rev().fold(0.0, |sum, c| sum * t + c)
    }

    fn series(&self, over: Interval) -> Series {
        self.compose(Series::variable(over))
    }
}

/// Taylor coefficients of a polynomial at any point of `t`.
fn shifted(coefficients: &[f64], t: Interval) -> [Interval; ORDERS] {
    std::array::from_fn(|k| {
        (k..coefficients.len()).rev().fold(Interval::point(0.0), |sum, power| {
            sum * t + Interval::point(binomial(power, k) * coefficients[power])
        })
    })
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// The polynomial of `order` through a function that is one on `[low, high]`, in powers of the distance from `low`.
fn interpolated(value: &impl Fn(f64) -> f64, low: f64, high: f64, order: usize) -> Vec<f64> {
    let nodes: Vec<f64> = (0..=order).map(|i| (high - low) * i as f64 / order.max(1) as f64).collect();
    let mut differences: Vec<f64> = nodes.iter().map(|t| value(low + t)).collect();
    // Newton's divided differences in place, then expanded by Horner's scheme.
    for level in 1..=order {
        for i in (level..=order).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - level]);
        }
    }
    let mut polynomial = vec![0.0; order + 1];
    for i in (0..=order).rev() {
        for power in (1..=order).rev() {
            polynomial[power] = polynomial[power - 1] - nodes[i] * polynomial[power];
        }
        polynomial[0] = differences[i] - nodes[i] * polynomial[0];
    }
    polynomial
}

/// A network of one input as one function.
#[derive(Clone, Debug)]
pub(super) struct NetworkCurve {
    /// `[layer][terminal][from]`; `None` where pruned.
    pub(super) edges: Vec<Vec<Vec<Option<Piecewise>>>>,
    sums: Vec<usize>,
    centre: f64,
}

impl NetworkCurve {
    /// All activations of a network without outer tanh.
    pub(super) fn of(network: &Network) -> Self {
        let edges = network.layers().iter().enumerate().map(|(index, layer)| {
            let edge =
                |from: usize, to: usize| layer.edge(from, to).active.then(|| Piecewise::of(network, index, from, to));
            (0..layer.nodes.terminals()).map(|to| (0..layer.inputs).map(|from| edge(from, to)).collect()).collect()
        });
        Self {
            edges: edges.collect(),
            sums: network.layers().iter().map(|layer| layer.nodes.sums).collect(),
            centre: network.output.centre,
        }
    }

    /// Carries values of any arithmetic through the network.
    fn carry<T: Copy>(
        &self,
        inputs: Vec<T>,
        zero: T,
        apply: impl Fn(&Piecewise, T) -> T,
        add: impl Fn(T, T) -> T,
        multiply: impl Fn(T, T) -> T,
    ) -> T {
        let mut nodes = inputs;
        for (layer, sums) in self.edges.iter().zip(&self.sums) {
            let terminals: Vec<T> = layer
                .iter()
                .map(|edges| {
                    let live = edges.iter().zip(&nodes).filter_map(|(edge, x)| edge.as_ref().map(|edge| (edge, *x)));
                    live.fold(zero, |sum, (edge, x)| add(sum, apply(edge, x)))
                })
                .collect();
            let (additive, factors) = terminals.split_at(*sums);
            nodes = additive.to_vec();
            nodes.extend(factors.chunks_exact(2).map(|pair| multiply(pair[0], pair[1])));
        }
        nodes[0]
    }
}

impl Curve for NetworkCurve {
    fn value(&self, x: f64) -> f64 {
        let width = self.edges.first().and_then(|layer| layer.first()).map_or(1, Vec::len);
        self.centre + self.carry(vec![x; width], 0.0, |edge, x| edge.value(x), |a, b| a + b, |a, b| a * b)
    }

    fn series(&self, over: Interval) -> Series {
        let width = self.edges.first().and_then(|layer| layer.first()).map_or(1, Vec::len);
        let inputs = vec![Series::variable(over); width];
        let sum = self.carry(inputs, Series::constant(0.0), |edge, u| edge.compose(u), |a, b| a + b, |a, b| a * b);
        Series::constant(self.centre) + sum
    }
}
