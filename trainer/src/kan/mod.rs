//! The Kolmogorov-Arnold network: splines, loss and gradient, optimisers, attribution, pruning. Knows no files.

mod adam;
mod architecture;
mod attribution;
mod band;
mod dataset;
mod dense;
mod error;
mod first_order;
mod fit;
mod gauss_newton;
mod gradient;
mod graph;
mod jacobian;
mod knots;
mod lbfgs;
mod model;
mod network;
mod outcome;
mod penalty;
mod pilot;
mod prune;
mod random;
mod refinement;
mod sparsity;
mod spline;
mod start;
mod trace;
mod training;

pub use architecture::{Architecture, Nodes, Resolution};
pub use attribution::Attribution;
pub use band::standard_errors;
pub use dataset::{Blocks, Dataset};
pub use error::KanError;
pub use fit::{FitOptions, FitResult, fit, refit};
pub use gradient::loss_and_gradient;
pub use graph::{GraphEdge, GraphNode, GraphSummary, NodeKind};
pub use network::{Edge, Layer, Network, Scaling};
pub use outcome::{Convergence, Status, Step};
pub use prune::{PruneOptions, Pruned, Removed, prune};
pub use random::Random;
pub use sparsity::Sparsity;
pub use spline::{Grid, LocalBasis, MAX_ORDER, SplineBasis};
pub use training::{Optimiser, Progress, ProgressCallback, Smoothing};

#[cfg(test)]
mod tests;
