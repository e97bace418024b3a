//! A Kolmogorov-Arnold network as tables: every edge a cubic in integers, SiLU base and scale already folded in.
//!
//! Only the inputs are floating point. Each finds its place in a [`Table`] layout, once for all of its edges: the cell, and the way
//! through it as a [`Coordinate`]. From there on everything is a 32-bit integer, so that the sums of the nodes are exact and the next
//! cell is found by one product. The cells of the edges that leave one source lie side by side: row `r` of a source with `k`
//! targets is the pool's cells `first_cell + r k .. first_cell + (r + 1) k`, one for each target.
//!
//! A cell holds integers `a0..a3`. With the coordinate `x` in `[0, 2^31)` and `high(p) = floor(p / 2^32)` its value is
//!
//! ```text
//! a0 + high(x (a1 + high(x (a2 + high(x a3)))))
//! ```
//!
//! so that `a_k` is `2^k` times the coefficient of the `k`-th power of the way from 0 to 1. Sums are taken modulo `2^32`.
//!
//! A sum in an additive node of a hidden layer is a *position*: its upper bits number a row of the pool, and the lower
//! [`Layer::row_bits`] ones are the way through it. Row `r` of a layer with `k` targets is the pool's cells `r k .. (r + 1) k`. A
//! multiplicative node has two sums `s` and `t` of either sign, and its position is `high(s t)` from the middle of its rows. The last sum
//! is the output in steps. That the sums of a network keep to the rows of their nodes is validated, for every input there can be.

use serde::{Deserialize, Serialize};

use crate::input::MAX_INPUTS;
use crate::table::{Cell, Table};

/// Most layers of edges of a network.
pub const MAX_LAYERS: usize = 4;

/// Most nodes that edges can reach in one layer, before products are taken.
pub const MAX_WIDTH: usize = 16;

/// The way through a cell, `2^31` for the whole of it.
pub type Coordinate = i32;

/// An input: the layout that its edges share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Layout of the edges, in rows; its own first cell is 0, and it is not odd.
    pub table: Table,
    /// Index in the pool of the first row.
    pub first_cell: u16,
}

/// A hidden layer: the nodes at the end of its edges, and what leaves them.
///
/// Edges add up in `additive + 2 products` sums. The layer's nodes are the first `additive` of these, followed by
/// the products of consecutive pairs of the others (multiplicative nodes; Liu et al. 2024, KAN 2.0). The edges of every node have
/// as many rows, of equal width over the node's range; those of one node follow those of the node before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layer {
    /// Additive nodes.
    pub additive: u8,
    /// Multiplicative nodes of two factors.
    pub products: u8,
    /// Rows of each node, at least 1.
    pub rows: u16,
    /// The first node's first row, counted in rows of this layer from the start of the pool.
    pub first_row: u16,
}

impl Layer {
    /// Sums in which edges end.
    #[must_use]
    pub fn targets(self) -> usize {
        usize::from(self.additive) + 2 * usize::from(self.products)
    }

    /// Nodes of the layer.
    #[must_use]
    pub fn nodes(self) -> usize {
        usize::from(self.additive) + usize::from(self.products)
    }

    /// Bits of a position below the number of its row: as many as leave room for the last row.
    #[must_use]
    pub fn row_bits(self) -> u32 {
        let end = u32::from(self.first_row) + self.nodes() as u32 * u32::from(self.rows);
        end.leading_zeros().min(31)
    }

    /// `2^32 / 2^row_bits`: the product of a position with it has the row in the high word and the way through it in the low one.
    #[must_use]
    pub fn rows_per_turn(self) -> u32 {
        1 << (32 - self.row_bits())
    }

    /// Position of the start of a node's first row.
    #[must_use]
    pub fn start(self, node: usize) -> u32 {
        (u32::from(self.first_row) + node as u32 * u32::from(self.rows)) << self.row_bits()
    }

    /// Half of the positions of a node.
    #[must_use]
    pub fn half_width(self) -> u32 {
        u32::from(self.rows) << (self.row_bits() - 1)
    }
}

/// What the image says of a network; everything else of [`Network`] follows from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NetworkShape {
    /// The model's inputs in their order.
    pub sources: heapless::Vec<Source, MAX_INPUTS>,
    /// Hidden layers from input to output.
    pub layers: heapless::Vec<Layer, { MAX_LAYERS - 1 }>,
    /// Unit of the output for each step of the last sum, positive and finite.
    pub output_step: f32,
}

/// A network of one input and one hidden layer of additive nodes: each node is on the way to its only edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneHiddenLayer {
    /// The input.
    pub source: Source,
    /// Nodes of the layer.
    pub nodes: u32,
    /// [`Layer::rows_per_turn`] of the layer.
    pub rows_per_turn: u32,
}

/// A network of tables, ready to evaluate. After the last hidden layer all edges end in one sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "NetworkShape", into = "NetworkShape")]
pub struct Network {
    shape: NetworkShape,
    /// The network once more, where it is of this simple kind.
    pub one_hidden_layer: Option<OneHiddenLayer>,
    /// Unit of the output for each step of the last sum.
    pub output_step: f32,
}

impl Network {
    /// The network of a shape. A shape out of its documented range gives a harmless network, which validation refuses.
    #[must_use]
    pub fn new(shape: NetworkShape) -> Self {
        let one_hidden_layer = match (shape.sources.as_slice(), shape.layers.as_slice()) {
            (&[source], &[layer]) if layer.products == 0 => {
                Some(OneHiddenLayer { source, nodes: u32::from(layer.additive), rows_per_turn: layer.rows_per_turn() })
            }
            _ => None,
        };
        Self { one_hidden_layer, output_step: shape.output_step, shape }
    }

    /// What the image says of this network.
    #[must_use]
    pub fn shape(&self) -> &NetworkShape {
        &self.shape
    }

    /// The inputs in their order.
    #[must_use]
    pub fn sources(&self) -> &[Source] {
        &self.shape.sources
    }

    /// Hidden layers from input to output.
    #[must_use]
    pub fn layers(&self) -> &[Layer] {
        &self.shape.layers
    }

    /// Sums after the edges that leave layer `index`, counted from the inputs.
    #[must_use]
    pub fn targets(&self, index: usize) -> usize {
        self.layers().get(index).map_or(1, |layer| layer.targets())
    }
}

impl From<NetworkShape> for Network {
    fn from(shape: NetworkShape) -> Self {
        Self::new(shape)
    }
}

impl From<Network> for NetworkShape {
    fn from(network: Network) -> Self {
        network.shape
    }
}

/// Units by which the flooring of the evaluation and the whole numbers of its bound are off together, at most.
const FLOORING: i64 = 8;

impl Cell {
    /// The range of the value of a cell of a network, as it is evaluated but for the modulus: between the least and the largest of the
    /// cubic's Bernstein coefficients, give or take the flooring. `None` where a partial sum before the last could exceed 32 bits.
    #[must_use]
    pub fn integer_range(&self) -> Option<(i64, i64)> {
        let [a0, a1, a2, a3] = self.integers().map(i64::from);
        let limit = i64::from(i32::MAX);
        // A product with the coordinate halves the magnitude.
        let second = a2.abs() + a3.abs() / 2 + 1;
        let first = a1.abs() + second / 2 + 1;
        let [d1, d2, d3] = [a1 / 2, a2 / 4, a3 / 8];
        let bernstein = [a0, a0 + d1 / 3, a0 + (2 * d1 + d2) / 3, a0 + d1 + d2 + d3];
        let low = bernstein.into_iter().fold(i64::MAX, i64::min) - FLOORING;
        let high = bernstein.into_iter().fold(i64::MIN, i64::max) + FLOORING;
        (second <= limit && first <= limit).then_some((low, high))
    }
}
