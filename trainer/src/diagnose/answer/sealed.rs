//! What a written model leaves of rows that decided nothing: the figures that are told of it.

use crate::diagnose::proof::locked_rows::ratio_interval;

/// Residuals of the recorded actuator, as `trainer predict` writes them, of the model compared with and of the written one.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Time of each row, s, ascending.
    pub time: Vec<f64>,
    /// Recorded less predicted by the model that the recording was compared with, in the actuator's unit.
    pub before: Vec<f64>,
    /// Recorded less predicted by the written model.
    pub after: Vec<f64>,
}

/// Error before and after on sealed rows.
#[derive(Clone, Debug, PartialEq)]
pub struct SealedScore {
    /// Stretches of the recording, from and to, both within, s.
    pub when_s: Vec<[f64; 2]>,
    /// Rows within them.
    pub n: usize,
    /// Root mean square of the residuals of the model compared with, in the actuator's unit.
    pub before_rmse: f64,
    /// The same of the written model.
    pub after_rmse: f64,
    /// After over before.
    pub ratio: f64,
    /// 95 % interval of the ratio, from stretch to stretch.
    pub ratio_ci95: [f64; 2],
}

impl SealedScore {
    /// Whether the written model leaves more than the model compared with, by the interval of their ratio.
    ///
    /// # Examples
    /// ```
    /// use frikan_trainer::diagnose::{Residuals, SealedScore};
    /// let time: Vec<f64> = (0..100).map(f64::from).collect();
    /// let after: Vec<f64> = time.iter().map(|t| 2.0 + 0.1 * t.sin()).collect();
    /// let residuals = Residuals { before: vec![1.0; 100], after, time };
    /// let stretches: Vec<[f64; 2]> = (0..10).map(|k| [10.0 * f64::from(k), 10.0 * f64::from(k) + 9.0]).collect();
    /// assert!(SealedScore::of(&residuals, &stretches).unwrap().is_worse());
    /// ```
    #[must_use]
    pub fn is_worse(&self) -> bool {
        self.ratio_ci95[0] > 1.0
    }

    /// Scores two models on stretches of a recording (from, to; s). `None` where no row lies within, or nothing was left before.
    ///
    /// # Examples
    /// ```
    /// use frikan_trainer::diagnose::{Residuals, SealedScore};
    /// let time: Vec<f64> = (0..100).map(f64::from).collect();
    /// let residuals = Residuals { before: vec![2.0; 100], after: vec![1.0; 100], time };
    /// let score = SealedScore::of(&residuals, &[[10.0, 19.0], [60.0, 64.0]]).unwrap();
    /// assert_eq!((score.n, score.ratio), (15, 0.5));
    /// ```
    #[must_use]
    pub fn of(residuals: &Residuals, when_s: &[[f64; 2]]) -> Option<Self> {
        let energy = |series: &[f64], [from, to]: [f64; 2]| {
            let rows = residuals.time.iter().zip(series).filter(|(time, _)| (from..=to).contains(*time));
            rows.fold((0.0, 0), |(sum, n), (_, left)| (sum + left * left, n + 1))
        };
        let stretches: Vec<((f64, usize), (f64, usize))> =
            when_s.iter().map(|when| (energy(&residuals.before, *when), energy(&residuals.after, *when))).collect();
        let n: usize = stretches.iter().map(|(before, _)| before.1).sum();
        let pairs: Vec<(f64, f64)> =
            stretches.iter().filter(|(before, _)| before.1 > 0).map(|(before, after)| (before.0, after.0)).collect();
        let (before, after) = pairs.iter().fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
        if n == 0 || before == 0.0 {
            return None;
        }
        let [before_rmse, after_rmse] = [before, after].map(|energy| (energy / n as f64).sqrt());
        let ratio = after_rmse / before_rmse;
        Some(Self {
            when_s: when_s.to_vec(),
            n,
            before_rmse,
            after_rmse,
            ratio,
            ratio_ci95: ratio_interval(&pairs, ratio),
        })
    }
}
