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
        let count = simulated.len().max(1) as f64;
        let mut score = Self { n: simulated.len(), ..Self::default() };
        let (mut squares, mut of_velocity) = (0.0, 0.0);
        for (simulated, recorded) in simulated.iter().zip(recorded) {
            let error = (simulated.position - recorded.position).abs();
            score.mae += error / count;
            squares += error * error;
            score.max = score.max.max(error);
            of_velocity += (simulated.velocity - recorded.velocity).powi(2);
        }
        Self { rmse: (squares / count).sqrt(), velocity_rmse: (of_velocity / count).sqrt(), ..score }
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
