//! How an optimisation went: every step, why it ended, and how flat the loss was there.

use serde::{Deserialize, Serialize};

/// Why an optimiser stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The loss and the smoothing stopped changing.
    Converged,
    /// No step along any tried direction lowers the loss any more (rounding limit or a kink).
    Stalled,
    /// The validation loss has stopped falling; the best network seen is returned.
    ValidationRose,
    /// The allowed number of steps was used up while the loss was still falling.
    StepLimit,
}

impl Status {
    /// Whether the end is a minimum as far as the optimiser can tell.
    pub fn is_settled(self) -> bool {
        self != Self::StepLimit
    }
}

/// One accepted step. Losses are mean squared errors in squared units of the target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Counts from zero (the start, before any step).
    pub step: usize,
    /// Mean squared error on the training rows.
    pub loss: f64,
    /// Mean squared error on the validation rows, when there are any.
    pub validation_loss: Option<f64>,
    /// Euclidean norm of the gradient of the normalised mean loss.
    pub gradient_norm: f64,
    /// Effective degrees of freedom, where the optimiser estimates them.
    pub degrees_of_freedom: Option<f64>,
}

/// What an optimiser reports at its end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Convergence {
    /// Why it stopped.
    pub status: Status,
    /// Accepted steps.
    pub steps: usize,
    /// Evaluations of the loss, with or without gradient.
    pub evaluations: usize,
    /// Gradient norm at the end, as in [`Step::gradient_norm`].
    pub gradient_norm: f64,
}
