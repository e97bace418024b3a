//! A Kolmogorov-Arnold network as tables: every edge a cubic table, SiLU base and scale already folded in.
//!
//! All edges that leave one node share the node's cell layout, so that the cell is found once per node. The cells
//! of those edges lie side by side: row `r` of a source with `k` targets is the pool's cells
//! `first_cell + r k .. first_cell + (r + 1) k`, one for each target.

use serde::{Deserialize, Serialize};

use crate::table::Table;

/// Most layers of edges of a network.
pub const MAX_LAYERS: usize = 4;

/// Most nodes that edges can reach in one layer, before products are taken.
pub const MAX_WIDTH: usize = 16;

/// Most nodes with outgoing edges, over all layers.
pub const MAX_SOURCES: usize = 16;

/// A node with outgoing edges: the layout that its edges share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Layout of the edges, in rows; its own first cell is 0.
    pub table: Table,
    /// Index in the pool of the first row.
    pub first_cell: u16,
}

/// A layer of edges with the nodes at its end.
///
/// Edges add up in `additive + 2 products` nodes. The layer's outputs are the first `additive` of these, followed by
/// the products of consecutive pairs of the others (multiplicative nodes; Liu et al. 2024, KAN 2.0).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layer {
    /// Additive nodes.
    pub additive: u8,
    /// Multiplicative nodes of two factors.
    pub products: u8,
}

impl Layer {
    /// Nodes in which edges add up.
    #[must_use]
    pub fn targets(self) -> usize {
        usize::from(self.additive) + 2 * usize::from(self.products)
    }

    /// Outputs of the layer.
    #[must_use]
    pub fn outputs(self) -> usize {
        usize::from(self.additive) + usize::from(self.products)
    }
}

/// What becomes of the sum at the end of the network.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Outer {
    /// It is the output.
    Linear,
    /// The output is `offset + scale * tanh(sum)`.
    Tanh {
        /// Amplitude, in the unit of the output.
        scale: f32,
        /// Centre, in the unit of the output.
        offset: f32,
    },
}

/// A network of tables. The sources of the first layer are the model's inputs in their order, those of every later
/// layer the outputs of the layer before; the last layer has one output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Network {
    /// Layers from input to output.
    pub layers: heapless::Vec<Layer, MAX_LAYERS>,
    /// Sources of all layers, one after the other.
    pub sources: heapless::Vec<Source, MAX_SOURCES>,
    /// What becomes of the last sum.
    pub outer: Outer,
}
