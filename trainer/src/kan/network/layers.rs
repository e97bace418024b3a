//! The network itself: layers of edges over one contiguous parameter vector.

use serde::{Deserialize, Serialize};

use super::architecture::{Architecture, Nodes};
use super::error::KanError;
use super::spline::SplineBasis;

/// Affine map between a physical quantity and the unit interval or unit variance that training works in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scaling {
    /// Physical value that maps to zero.
    pub centre: f64,
    /// Physical width of one normalised unit; positive.
    pub width: f64,
}

impl Scaling {
    /// Physical to normalised.
    #[inline]
    pub fn normalise(self, physical: f64) -> f64 {
        (physical - self.centre) / self.width
    }

    /// Normalised to physical.
    #[inline]
    pub fn restore(self, normalised: f64) -> f64 {
        self.centre + self.width * normalised
    }
}

/// One learnable activation: `base * silu(x) + scale * sum of c_m B_m(x)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// Spline basis of this edge.
    pub basis: SplineBasis,
    /// Pruned edges contribute nothing and are not trained.
    pub active: bool,
    offset: usize,
}

impl Edge {
    /// Number of parameters: coefficients, spline scale, base weight.
    pub(in crate::kan) fn parameter_count(&self) -> usize {
        self.basis.len() + 2
    }

    /// Where the spline coefficients lie in the parameter vector.
    pub(in crate::kan) fn coefficients(&self) -> std::ops::Range<usize> {
        self.offset..self.offset + self.basis.len()
    }

    /// Where the spline scale lies.
    pub(in crate::kan) fn scale(&self) -> usize {
        self.offset + self.basis.len()
    }

    /// Where the base weight lies.
    pub(in crate::kan) fn base(&self) -> usize {
        self.scale() + 1
    }
}

/// Edges from the nodes of one layer to the sums ("terminals") of the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Nodes that the edges leave.
    pub inputs: usize,
    /// Nodes that they end in; a multiplicative node owns two consecutive terminals after those of the sums.
    pub nodes: Nodes,
    /// Whether the terminals pass through tanh.
    pub outer_tanh: bool,
    /// `inputs` edges per terminal, terminal after terminal.
    pub edges: Vec<Edge>,
}

impl Layer {
    /// The edge between a node and a terminal.
    pub fn edge(&self, from: usize, to: usize) -> &Edge {
        &self.edges[to * self.inputs + from]
    }

    /// Terminals of one node.
    pub fn terminals_of(&self, node: usize) -> std::ops::Range<usize> {
        match node.checked_sub(self.nodes.sums) {
            None => node..node + 1,
            Some(product) => self.nodes.sums + 2 * product..self.nodes.sums + 2 * product + 2,
        }
    }
}

/// A Kolmogorov-Arnold network with one output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Network {
    /// Physical range of every input.
    pub inputs: Vec<Scaling>,
    /// Physical scale of the output.
    pub output: Scaling,
    pub(in crate::kan) layers: Vec<Layer>,
    pub(in crate::kan) parameters: Vec<f64>,
}

impl Network {
    /// A network of zeros: uniform grids over `[-1, 1]`, unit spline scales, no base term, identity scalings.
    ///
    /// # Errors
    /// [`KanError::Grid`] when a resolution is impossible.
    pub fn zeros(architecture: &Architecture) -> Result<Self, KanError> {
        let mut layers = Vec::new();
        let mut inputs = architecture.inputs;
        let depth = architecture.hidden.len();
        for (index, nodes) in architecture.layers().enumerate() {
            let mut edges = Vec::with_capacity(inputs * nodes.terminals());
            for _ in 0..nodes.terminals() {
                for from in 0..inputs {
                    let resolution = architecture.resolution(index, from);
                    let basis = SplineBasis::uniform(-1.0, 1.0, resolution.cells, resolution.order)?;
                    edges.push(Edge { basis, active: true, offset: 0 });
                }
            }
            layers.push(Layer { inputs, nodes, outer_tanh: architecture.outer_tanh && index < depth, edges });
            inputs = nodes.count();
        }
        let unit = Scaling { centre: 0.0, width: 1.0 };
        let mut network =
            Self { inputs: vec![unit; architecture.inputs], output: unit, layers, parameters: Vec::new() };
        network.lay_out();
        Ok(network)
    }

    /// Assigns every edge its place and starts all parameters from zero, spline scales from one.
    fn lay_out(&mut self) {
        let mut offset = 0;
        for edge in self.layers.iter_mut().flat_map(|layer| &mut layer.edges) {
            edge.offset = offset;
            offset += edge.parameter_count();
        }
        self.parameters = vec![0.0; offset];
        for layer in &self.layers {
            for edge in &layer.edges {
                self.parameters[edge.scale()] = 1.0;
            }
        }
    }

    /// Puts other bases under the edges, in the order of layers and edges; coefficients restart from zero.
    pub(in crate::kan) fn set_bases(&mut self, bases: impl IntoIterator<Item = SplineBasis>) {
        for (edge, basis) in self.layers.iter_mut().flat_map(|layer| &mut layer.edges).zip(bases) {
            edge.basis = basis;
        }
        self.lay_out();
    }

    /// Lets an edge's spline follow a curve, smoothed by the basis (Schoenberg's variation-diminishing approximation).
    pub(in crate::kan) fn set_curve(&mut self, layer: usize, position: usize, curve: impl Fn(f64) -> f64) {
        let edge = &self.layers[layer].edges[position];
        for (slot, x) in self.parameters[edge.coefficients()].iter_mut().zip(edge.basis.greville()) {
            *slot = curve(x);
        }
    }

    /// Layers from the inputs to the output.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// All parameters, edge after edge: spline coefficients, spline scale, base weight.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Spline coefficients and base weights of active edges. Spline scales are not counted: each is redundant
    /// with the coefficients that it multiplies.
    pub fn coefficient_count(&self) -> usize {
        self.active_edges().map(|edge| edge.basis.len() + 1).sum()
    }

    pub(in crate::kan) fn active_edges(&self) -> impl Iterator<Item = &Edge> {
        self.layers.iter().flat_map(|layer| &layer.edges).filter(|edge| edge.active)
    }

    /// Adds a constant, in physical units, to the output.
    pub fn shift_output(&mut self, amount: f64) {
        self.output.centre += amount;
    }

    /// Switches an edge off (or on again). Parameters keep their values.
    ///
    /// # Errors
    /// [`KanError::Shape`] when there is no such edge.
    pub fn set_active(&mut self, layer: usize, from: usize, to: usize, active: bool) -> Result<(), KanError> {
        let layers = self.layers.len();
        let layer =
            self.layers.get_mut(layer).ok_or(KanError::Shape { what: "layer", expected: layers, found: layer })?;
        if from >= layer.inputs || to >= layer.nodes.terminals() {
            let expected = layer.edges.len();
            return Err(KanError::Shape { what: "edge of the layer", expected, found: to * layer.inputs + from });
        }
        layer.edges[to * layer.inputs + from].active = active;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_parameters_as_the_paper_does() {
        let network = Network::zeros(&Architecture::additive(1, &[5])).unwrap();
        assert_eq!(network.parameters().len(), 2 * 5 * (10 + 3) + 2 * 2 * 5);
        let multiplicative = Network::zeros(&"[1,[5,2],1]".parse().unwrap()).unwrap();
        assert_eq!(multiplicative.parameters().len(), (9 + 7) * 15);
    }

    #[test]
    fn refuses_to_switch_an_edge_that_is_not_there() {
        let mut network = Network::zeros(&Architecture::additive(1, &[2])).unwrap();
        assert!(network.set_active(0, 0, 1, false).is_ok());
        assert!(network.set_active(0, 1, 0, false).is_err());
        assert!(network.set_active(1, 0, 1, false).is_err());
        assert!(network.set_active(2, 0, 0, false).is_err());
    }

    #[test]
    fn survives_serialisation() {
        let mut network = Network::zeros(&"[2,[1,1],1]".parse().unwrap()).unwrap();
        network.parameters.iter_mut().enumerate().for_each(|(i, p)| *p = (i as f64 * 0.7).sin());
        let text = serde_json::to_string(&network).unwrap();
        assert!(serde_json::from_str::<Network>(&text).unwrap() == network);
    }
}
