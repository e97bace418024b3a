//! One sample through the network: values forward, derivatives of the output backward.

use super::layers::{Edge, Layer, Network};
use super::spline::LocalBasis;

/// What one edge did with its argument.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::kan) struct EdgeTrace {
    pub(in crate::kan) local: LocalBasis,
    pub(in crate::kan) silu: f64,
    pub(in crate::kan) value: f64,
    pub(in crate::kan) slope: f64,
}

impl EdgeTrace {
    /// What an edge does with `x`, where its basis is `local`.
    #[inline]
    pub(in crate::kan) fn at(edge: &Edge, parameters: &[f64], x: f64, local: LocalBasis, with_base: bool) -> Self {
        let coefficients = &parameters[edge.coefficients()][local.first..=local.first + edge.basis.order()];
        let (mut spline, mut spline_slope) = (0.0, 0.0);
        for ((c, value), slope) in coefficients.iter().zip(&local.value).zip(&local.slope) {
            spline += c * value;
            spline_slope += c * slope;
        }
        let (scale, base) = (parameters[edge.scale()], parameters[edge.base()]);
        let mut trace = Self { local, silu: 0.0, value: scale * spline, slope: scale * spline_slope };
        if with_base || base != 0.0 {
            // SiLU and its slope: x s(x), s(x) (1 + x (1 - s(x))).
            let logistic = 1.0 / (1.0 + libm::exp(-x));
            trace.silu = x * logistic;
            trace.value += base * trace.silu;
            trace.slope += base * logistic * (1.0 + x * (1.0 - logistic));
        }
        trace
    }
}

#[derive(Clone, Debug)]
struct LayerTrace {
    inputs: Vec<f64>,
    /// For each edge an earlier one from the same node with the same basis, where there is one: its functions are worked out once.
    twins: Vec<Option<usize>>,
    edges: Vec<EdgeTrace>,
    /// What the edges add up to, before tanh.
    sums: Vec<f64>,
    terminals: Vec<f64>,
    /// Derivative of the network's output with respect to each sum, before tanh.
    terminal_adjoints: Vec<f64>,
    input_adjoints: Vec<f64>,
}

/// Buffers for one sample; reused from sample to sample.
#[derive(Clone, Debug)]
pub(in crate::kan) struct Trace {
    layers: Vec<LayerTrace>,
    output: f64,
    /// Whether SiLU is wanted even where its weight is zero.
    with_base: bool,
}

impl Trace {
    pub(in crate::kan) fn new(network: &Network) -> Self {
        let layers = network.layers.iter().map(|layer| LayerTrace {
            inputs: vec![0.0; layer.inputs],
            twins: (0..layer.edges.len()).map(|position| twin(layer, position)).collect(),
            edges: vec![EdgeTrace::default(); layer.edges.len()],
            sums: vec![0.0; layer.nodes.terminals()],
            terminals: vec![0.0; layer.nodes.terminals()],
            terminal_adjoints: vec![0.0; layer.nodes.terminals()],
            input_adjoints: vec![0.0; layer.inputs],
        });
        Self { layers: layers.collect(), output: 0.0, with_base: false }
    }

    /// A trace for derivatives with respect to parameters, base weights among them when `with_base`.
    pub(in crate::kan) fn for_training(network: &Network, with_base: bool) -> Self {
        Self { with_base, ..Self::new(network) }
    }

    /// Normalised output for normalised inputs.
    #[inline]
    pub(in crate::kan) fn forward(&mut self, network: &Network, input: impl Fn(usize) -> f64) -> f64 {
        for (i, slot) in self.layers[0].inputs.iter_mut().enumerate() {
            *slot = input(i);
        }
        for (index, layer) in network.layers.iter().enumerate() {
            let (done, rest) = self.layers.split_at_mut(index + 1);
            let trace = &mut done[index];
            trace.run(layer, &network.parameters, self.with_base);
            match rest.first_mut() {
                Some(next) => combine(layer, &trace.terminals, &mut next.inputs),
                None => self.output = trace.terminals[0],
            }
        }
        self.output
    }

    /// Derivatives of the normalised output, for the sample of the last [`Trace::forward`].
    pub(in crate::kan) fn backward(&mut self, network: &Network) {
        for index in (0..network.layers.len()).rev() {
            let (until, after) = self.layers.split_at_mut(index + 1);
            let (trace, layer) = (&mut until[index], &network.layers[index]);
            match after.first() {
                Some(next) => trace.adjoints_from(layer, &next.input_adjoints),
                None => trace.terminal_adjoints[0] = 1.0,
            }
            trace.input_adjoints.fill(0.0);
            for (to, edges) in layer.edges.chunks_exact(layer.inputs).enumerate() {
                for (from, edge) in edges.iter().enumerate() {
                    if edge.active {
                        let slope = trace.edges[to * layer.inputs + from].slope;
                        trace.input_adjoints[from] += trace.terminal_adjoints[to] * slope;
                    }
                }
            }
        }
    }

    /// Derivatives with respect to the normalised inputs.
    pub(in crate::kan) fn input_slopes(&self) -> &[f64] {
        &self.layers[0].input_adjoints
    }

    /// Derivative of the output with respect to one edge's value, and what the edge did.
    #[inline]
    pub(in crate::kan) fn edge(&self, layer: usize, position: usize, inputs: usize) -> (f64, &EdgeTrace) {
        let trace = &self.layers[layer];
        (trace.terminal_adjoints[position / inputs], &trace.edges[position])
    }

    /// Values of the nodes that feed a layer.
    pub(in crate::kan) fn inputs(&self, layer: usize) -> &[f64] {
        &self.layers[layer].inputs
    }

    /// What the edges of a layer add up to.
    pub(in crate::kan) fn sums(&self, layer: usize) -> &[f64] {
        &self.layers[layer].sums
    }
}

impl LayerTrace {
    #[inline]
    fn run(&mut self, layer: &Layer, parameters: &[f64], with_base: bool) {
        for (to, edges) in layer.edges.chunks_exact(layer.inputs).enumerate() {
            let mut sum = 0.0;
            for (from, edge) in edges.iter().enumerate() {
                if edge.active {
                    let (position, x) = (to * layer.inputs + from, self.inputs[from]);
                    let local = match self.twins[position] {
                        Some(twin) => self.edges[twin].local,
                        None => edge.basis.at(x),
                    };
                    let trace = EdgeTrace::at(edge, parameters, x, local, with_base);
                    sum += trace.value;
                    self.edges[position] = trace;
                }
            }
            self.sums[to] = sum;
            self.terminals[to] = if layer.outer_tanh { libm::tanh(sum) } else { sum };
        }
    }

    fn adjoints_from(&mut self, layer: &Layer, node_adjoints: &[f64]) {
        let sums = layer.nodes.sums;
        self.terminal_adjoints[..sums].copy_from_slice(&node_adjoints[..sums]);
        for product in 0..layer.nodes.products {
            let (left, right) = (sums + 2 * product, sums + 2 * product + 1);
            self.terminal_adjoints[left] = node_adjoints[sums + product] * self.terminals[right];
            self.terminal_adjoints[right] = node_adjoints[sums + product] * self.terminals[left];
        }
        if layer.outer_tanh {
            for (adjoint, terminal) in self.terminal_adjoints.iter_mut().zip(&self.terminals) {
                *adjoint *= 1.0 - terminal * terminal;
            }
        }
    }
}

/// The first active edge from the same node whose basis an edge shares, where that is not itself.
fn twin(layer: &Layer, position: usize) -> Option<usize> {
    let grid = |edge: usize| (layer.edges[edge].basis.order(), layer.edges[edge].basis.breaks());
    let mut others = (position % layer.inputs..position).step_by(layer.inputs);
    others.find(|&other| layer.edges[other].active && grid(other) == grid(position))
}

/// Node values from terminals: sums pass, products multiply their two.
#[inline]
fn combine(layer: &Layer, terminals: &[f64], nodes: &mut [f64]) {
    let sums = layer.nodes.sums;
    nodes[..sums].copy_from_slice(&terminals[..sums]);
    for (node, pair) in nodes[sums..].iter_mut().zip(terminals[sums..].chunks_exact(2)) {
        *node = pair[0] * pair[1];
    }
}
