//! The shape of a network: nodes per layer, additive and multiplicative, and the grid of every edge.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::error::KanError;

/// Nodes of one layer: sums, and products of two sums each (MultKAN; Liu et al., 2024).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Nodes {
    /// Additive nodes.
    pub sums: usize,
    /// Multiplicative nodes, each the product of two sums of its own.
    pub products: usize,
}

impl Nodes {
    /// Values that the next layer sees.
    pub fn count(self) -> usize {
        self.sums + self.products
    }

    /// Sums that edges end in: one for an additive node, two for a multiplicative one.
    pub fn terminals(self) -> usize {
        self.sums + 2 * self.products
    }
}

/// Number of cells and polynomial order of a spline edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Resolution {
    /// Grid cells, at least one.
    pub cells: usize,
    /// Polynomial order.
    pub order: usize,
}

/// The shape of a network with one output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Architecture {
    /// Number of inputs.
    pub inputs: usize,
    /// Hidden layers, from the input on; may be empty (then the network is a sum of one spline an input).
    pub hidden: Vec<Nodes>,
    /// Resolution of the edges that leave each input; inputs beyond its length use the last entry.
    pub input_resolution: Vec<Resolution>,
    /// Resolution of all later edges.
    pub hidden_resolution: Resolution,
    /// Hidden layers pass their sums through tanh.
    pub outer_tanh: bool,
}

impl Architecture {
    /// A network with additive hidden nodes only, 10 cells of order 3 everywhere.
    pub fn additive(inputs: usize, hidden: &[usize]) -> Self {
        let resolution = Resolution { cells: 10, order: 3 };
        Self {
            inputs,
            hidden: hidden.iter().map(|&sums| Nodes { sums, products: 0 }).collect(),
            input_resolution: vec![resolution],
            hidden_resolution: resolution,
            outer_tanh: false,
        }
    }

    /// The same shape with one resolution for all edges.
    #[must_use]
    pub fn with_resolution(mut self, cells: usize, order: usize) -> Self {
        self.input_resolution = vec![Resolution { cells, order }];
        self.hidden_resolution = Resolution { cells, order };
        self
    }

    /// Nodes of every layer but the inputs; the last is the output.
    pub(in crate::kan) fn layers(&self) -> impl Iterator<Item = Nodes> + '_ {
        self.hidden.iter().copied().chain([Nodes { sums: 1, products: 0 }])
    }

    /// Resolution of the edges that leave `input`.
    pub(in crate::kan) fn resolution(&self, layer: usize, input: usize) -> Resolution {
        match self.input_resolution.len() {
            0 => self.hidden_resolution,
            n if layer == 0 => self.input_resolution[input.min(n - 1)],
            _ => self.hidden_resolution,
        }
    }
}

impl fmt::Display for Architecture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}", self.inputs)?;
        for nodes in &self.hidden {
            match nodes.products {
                0 => write!(f, ",{}", nodes.sums)?,
                products => write!(f, ",[{},{products}]", nodes.sums)?,
            }
        }
        f.write_str(",1]")
    }
}

impl FromStr for Architecture {
    type Err = KanError;

    /// Reads the paper's notation: `[1,5,1]`, `[2,[5,2],1]` (five sums and two products).
    fn from_str(text: &str) -> Result<Self, KanError> {
        let refuse = |reason| KanError::Architecture { text: text.to_owned(), reason };
        let value: serde_json::Value = serde_json::from_str(text).map_err(|_| refuse("not a list of numbers"))?;
        let items = value.as_array().ok_or_else(|| refuse("not a list"))?;
        let count = |value: &serde_json::Value| {
            let number = value.as_u64().filter(|&n| n <= 1000);
            number.map(|n| n as usize).ok_or_else(|| refuse("a layer is a whole number up to 1000"))
        };
        let [inputs, hidden @ .., output] = items.as_slice() else {
            return Err(refuse("it needs an input and an output layer"));
        };
        if count(output)? != 1 {
            return Err(refuse("it needs exactly one output"));
        }
        let mut architecture = Self::additive(count(inputs)?, &[]);
        if architecture.inputs == 0 {
            return Err(refuse("it needs at least one input"));
        }
        for layer in hidden {
            let nodes = match layer.as_array().map(Vec::as_slice) {
                None => Nodes { sums: count(layer)?, products: 0 },
                Some([sums, products]) => Nodes { sums: count(sums)?, products: count(products)? },
                Some(_) => return Err(refuse("a layer with products is [sums, products]")),
            };
            if nodes.count() == 0 {
                return Err(refuse("a layer has no node"));
            }
            architecture.hidden.push(nodes);
        }
        Ok(architecture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_and_writes_the_papers_notation() {
        for text in ["[1,1]", "[1,5,1]", "[1,5,5,1]", "[2,[5,2],1]", "[3,[0,2],4,1]"] {
            assert_eq!(text.parse::<Architecture>().unwrap().to_string(), text);
        }
        let multiplicative: Architecture = "[1, [5, 2], 1]".parse().unwrap();
        assert_eq!(multiplicative.hidden, [Nodes { sums: 5, products: 2 }]);
        assert_eq!(multiplicative.hidden[0].terminals(), 9);
    }

    #[test]
    fn refuses_what_is_not_an_architecture() {
        for text in [
            "",
            "5",
            "[]",
            "[1]",
            "[1,5,2]",
            "[0,1]",
            "[1,0,1]",
            "[1,[1,2,3],1]",
            "[1,-1,1]",
            "[1,1e9,1]",
            "[1,\"5\",1]",
        ] {
            assert!(text.parse::<Architecture>().is_err(), "{text}");
        }
    }
}
