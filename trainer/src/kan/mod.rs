//! The Kolmogorov-Arnold network (Liu et al., 2024). Knows no files, no laws, no recordings.
//!
//! The rooms know each other in one direction: `network` (what it is), `training` (how it is fitted), `inspection` (what it holds).

mod inspection;
mod network;
mod training;

pub use inspection::attribution::Attribution;
pub use inspection::confidence_band::standard_errors;
pub use inspection::graph::{GraphEdge, GraphNode, GraphSummary, NodeKind};
pub use inspection::prune::{PruneOptions, Pruned, Removed, prune};
pub use network::architecture::{Architecture, Nodes, Resolution};
pub use network::error::KanError;
pub use network::layers::{Edge, Layer, Network, Scaling};
pub use network::random::Random;
pub use network::spline::{Grid, LocalBasis, MAX_ORDER, SplineBasis};
pub use training::dataset::{Blocks, Dataset};
pub use training::fit::{FitOptions, FitResult, fit, refit};
pub use training::gradient::loss_and_gradient;
pub use training::outcome::{Convergence, Status, Step};
pub use training::settings::{Optimiser, Progress, ProgressCallback, Smoothing};
pub use training::sparsity::Sparsity;

#[cfg(test)]
mod tests;
