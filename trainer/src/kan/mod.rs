//! The Kolmogorov-Arnold network: splines, loss and gradient, optimisers, attribution, pruning. Knows no files.

mod architecture;
mod dataset;
mod dense;
mod error;
mod fit;
mod gauss_newton;
mod jacobian;
mod knots;
mod model;
mod network;
mod outcome;
mod penalty;
mod random;
mod spline;
mod start;
mod trace;
mod training;

pub use architecture::{Architecture, Nodes, Resolution};
pub use dataset::{Blocks, Dataset};
pub use error::KanError;
pub use fit::{FitOptions, FitResult, fit};
pub use network::{Edge, Layer, Network, Scaling};
pub use outcome::{Convergence, Status, Step};
pub use random::Random;
pub use spline::{Grid, LocalBasis, MAX_ORDER, SplineBasis};
pub use training::{Progress, ProgressCallback, Smoothing};
