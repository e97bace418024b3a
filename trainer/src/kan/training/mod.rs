//! How a network is fitted to samples: data, first weights, loss and gradient, penalties, optimisers. Knows no use of the
//! trained network.

pub mod dataset;
pub mod fit;
pub mod gradient;
pub mod initial_linear_fit;
pub mod initial_weights;
pub mod jacobian;
pub mod model;
pub mod optimisers;
pub mod outcome;
pub mod penalty;
pub mod settings;
pub mod sparsity;
