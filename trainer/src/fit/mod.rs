//! The whole way from recordings to an image: samples, separation, inputs, network, law, choice, model. Prints nothing.
//!
//! [`fit`] is the way, [`predict`](predict::predict) what a model makes of samples, [`Outcome`] all that is to be told.

mod activations;
mod builder;
mod choose;
mod formula;
mod gather;
mod inputs;
mod learn;
pub mod model;
mod options;
pub mod outcome;
mod physical;
pub mod predict;
mod rigid;
mod rivals;
mod run;
mod score;
mod simple;
mod tables;
mod turn;
mod turns;

pub use activations::label_activations;
pub use formula::formula_of;
pub use model::{CELLS, HostModel};
pub use options::{Budget, Options, Progress, ProgressCallback, Stage, Training};
pub use outcome::Outcome;
pub use run::fit;
