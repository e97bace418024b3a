//! Values and slopes of a network and of its activations, in physical units.

use super::layers::Network;
use super::trace::{EdgeTrace, Trace};

impl Network {
    /// Output at one point, physical units in and out. `inputs` has one value per input; missing ones count as
    /// the centre of their range.
    pub fn evaluate(&self, inputs: &[f64]) -> f64 {
        let mut trace = Trace::new(self);
        self.output.restore(trace.forward(self, |i| self.normalised(inputs, i)))
    }

    /// Output at many points; `inputs` holds one column per input, as in a [`crate::kan::Dataset`].
    pub fn evaluate_columns(&self, inputs: &[Vec<f64>]) -> Vec<f64> {
        let mut trace = Trace::new(self);
        let rows = inputs.first().map_or(0, Vec::len);
        (0..rows)
            .map(|row| self.output.restore(trace.forward(self, |i| self.inputs[i].normalise(inputs[i][row]))))
            .collect()
    }

    /// Partial derivatives of the output with respect to each input, physical units.
    pub fn slopes(&self, inputs: &[f64]) -> Vec<f64> {
        let mut trace = Trace::new(self);
        trace.forward(self, |i| self.normalised(inputs, i));
        trace.backward(self);
        let slopes = trace.input_slopes();
        slopes.iter().zip(&self.inputs).map(|(slope, scaling)| slope * self.output.width / scaling.width).collect()
    }

    fn normalised(&self, inputs: &[f64], input: usize) -> f64 {
        inputs.get(input).map_or(0.0, |&value| self.inputs[input].normalise(value))
    }

    /// Value of one activation at `x`. In the first layer `x` is the physical input; the last layer's activations
    /// are contributions to the output in physical units. `to` counts terminals (see [`crate::kan::Layer::terminals_of`]).
    pub fn edge_activation(&self, layer: usize, from: usize, to: usize, x: f64) -> f64 {
        self.edge_value_and_slope(layer, from, to, x).0
    }

    /// Derivative of [`Network::edge_activation`] with respect to `x`.
    pub fn edge_slope(&self, layer: usize, from: usize, to: usize, x: f64) -> f64 {
        self.edge_value_and_slope(layer, from, to, x).1
    }

    fn edge_value_and_slope(&self, layer: usize, from: usize, to: usize, x: f64) -> (f64, f64) {
        let edge = self.layers[layer].edge(from, to);
        if !edge.active {
            return (0.0, 0.0);
        }
        let (x, gain_in) = match layer {
            0 => (self.inputs[from].normalise(x), 1.0 / self.inputs[from].width),
            _ => (x, 1.0),
        };
        let gain_out = if layer + 1 == self.layers.len() { self.output.width } else { 1.0 };
        let trace = EdgeTrace::at(edge, &self.parameters, x, edge.basis.at(x), false);
        (trace.value * gain_out, trace.slope * gain_in * gain_out)
    }
}
