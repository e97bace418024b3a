//! The whole way from recordings to an image: samples, separation, inputs, network, law, choice, model. Prints nothing.
//!
//! [`fit`] is the way, [`predict`](predict::predict) what a model makes of samples, [`Outcome`] all that is to be told.

mod agreement;
mod choice;
mod data;
mod filtered;
mod forces;
mod gate;
mod integer_summary;
mod integers;
mod law_error;
mod laws;
pub mod model;
mod options;
pub mod outcome;
pub mod predict;
mod preparation_error;
mod rigid_body_error;
mod run;
pub mod score;

pub use forces::OtherForces;
pub use gate::{Identifiable, identifiable};
pub use integer_summary::IntegerSummary;
pub use laws::activations::label_activations;
pub use laws::formula::formula_of;
pub use model::{CELLS, HostModel};
pub use options::{Budget, Options, Progress, ProgressCallback, Stage, Training};
pub use outcome::Outcome;
pub use run::fit;
