//! What the benchmarks of training measure, and what they are called.

use frikan_trainer::kan::{Architecture, Blocks, Dataset, FitOptions, Network, Random, fit};

/// Name of the group of benchmarks.
pub const GROUP: &str = "loss_and_gradient";

/// Shapes of networks and numbers of samples of one evaluation of loss and gradient.
pub const EVALUATIONS: [(&str, usize); 10] = [
    ("[1,5,1]", 1_000),
    ("[1,5,1]", 10_000),
    ("[1,5,1]", 100_000),
    ("[1,5,1]", 1_000_000),
    ("[1,1,1]", 10_000),
    ("[1,10,1]", 10_000),
    ("[1,20,1]", 10_000),
    ("[1,5,5,1]", 10_000),
    ("[2,[5,2],1]", 10_000),
    ("[3,[5,2],1]", 10_000),
];

/// Cells of the edges of `[1,5,1]`, over 10 000 samples.
pub const CELLS: [usize; 4] = [5, 20, 40, 80];

/// A network that has seen a few steps of training, with the data of one evaluation.
#[derive(Debug)]
pub struct Evaluation {
    /// Columns of the inputs.
    pub inputs: Vec<Vec<f64>>,
    /// The target.
    pub target: Vec<f64>,
    /// The network.
    pub network: Network,
}

impl Evaluation {
    /// A shape of network on so many samples.
    ///
    /// # Panics
    /// Where the shape has no data, which every shape of this file has.
    #[must_use]
    pub fn new(architecture: &Architecture, samples: usize) -> Self {
        let mut random = Random::new(1, 0);
        let inputs: Vec<Vec<f64>> =
            (0..architecture.inputs).map(|_| (0..samples).map(|_| random.uniform(-1.0, 1.0)).collect()).collect();
        let target: Vec<f64> = (0..samples)
            .map(|row| {
                let others: f64 = inputs[1..].iter().map(|column| column[row]).sum();
                super::paper::friction(super::paper::JOINTS[0], inputs[0][row]) * (1.0 + 0.2 * others)
            })
            .collect();
        let blocks = Blocks::default();
        let few = samples.min(1000);
        let first: Vec<Vec<f64>> = inputs.iter().map(|column| column[..few].to_vec()).collect();
        let data = Dataset { inputs: &first, target: &target[..few], linear: &[], blocks: &blocks };
        let options = FitOptions { steps: 2, ..FitOptions::new(architecture.clone()) };
        let network = fit(&data, &options, &|_| ()).expect("usable samples").network;
        Self { inputs, target, network }
    }
}

/// `[1,5,1]` with so many cells an edge.
///
/// # Panics
/// Never: the shape is one.
#[must_use]
pub fn with_cells(cells: usize) -> Architecture {
    let mut architecture: Architecture = "[1,5,1]".parse().expect("a shape");
    architecture.input_resolution.iter_mut().for_each(|resolution| resolution.cells = cells);
    architecture.hidden_resolution.cells = cells;
    architecture
}
