//! How far a simulated motion came off the recorded one.

use super::simulate::State;

/// Errors of a simulated motion, in the units of position and velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Rows.
    pub n: usize,
    /// Mean absolute error of the position.
    pub mae: f64,
    /// Root mean square error of the position.
    pub rmse: f64,
    /// Largest error of the position.
    pub max: f64,
    /// Root mean square error of the velocity.
    pub velocity_rmse: f64,
}

impl Score {
    /// Errors of simulated states against recorded ones of the same length.
    #[must_use]
    pub fn of(simulated: &[State], recorded: &[State]) -> Self {
        let mut errors = Errors::of_rows(simulated.len());
        simulated.iter().zip(recorded).for_each(|(simulated, recorded)| errors.add(simulated, recorded));
        errors.score()
    }

    /// Errors over several recordings taken as one.
    #[must_use]
    pub fn over(scores: &[Self]) -> Self {
        let n: usize = scores.iter().map(|score| score.n).sum();
        let count = n.max(1) as f64;
        let mean =
            |of: &dyn Fn(&Self) -> f64| scores.iter().map(|score| score.n as f64 * of(score)).sum::<f64>() / count;
        Self {
            n,
            mae: mean(&|score| score.mae),
            rmse: mean(&|score| score.rmse.powi(2)).sqrt(),
            max: scores.iter().fold(0.0, |most, score| most.max(score.max)),
            velocity_rmse: mean(&|score| score.velocity_rmse.powi(2)).sqrt(),
        }
    }
}

/// Sums of errors, row by row.
pub(super) struct Errors {
    score: Score,
    squares: f64,
    of_velocity: f64,
}

impl Errors {
    /// None yet, of so many rows.
    pub(super) fn of_rows(n: usize) -> Self {
        Self { score: Score { n, ..Score::default() }, squares: 0.0, of_velocity: 0.0 }
    }

    fn count(&self) -> f64 {
        self.score.n.max(1) as f64
    }

    /// Adds a row.
    pub(super) fn add(&mut self, simulated: &State, recorded: &State) {
        let error = (simulated.position - recorded.position).abs();
        self.score.mae += error / self.count();
        self.squares += error * error;
        self.score.max = self.score.max.max(error);
        self.of_velocity += (simulated.velocity - recorded.velocity).powi(2);
    }

    pub(super) fn score(self) -> Score {
        let mean = |sum: f64| sum / self.count();
        Score { rmse: mean(self.squares).sqrt(), velocity_rmse: mean(self.of_velocity).sqrt(), ..self.score }
    }
}
