//! What evidence noise alone brings: the null replayed on this very recording, whose whitened residual is drawn again in blocks.

use crate::inference::evidence::{Alone, Candidate, log_sum_exp};
use crate::inference::reduced::Reduced;
use crate::numerics::random::uniform;
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

/// Replays of the null; a limit of the computing time that tells the extreme value's location within an eighth of its scale.
const REPLAYS: u64 = 60;
/// Share of healthy recordings in which something is named at most.
const ALARM_SHARE: f64 = 0.01;
/// Euler's constant: mean of the standard Gumbel distribution.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Noise of the recording's own kind: pieces of the whitened residual of one length, each with a random place and sign (Kunsch 1989).
pub(crate) struct Replay<'a> {
    /// Whitened residual, row by row.
    pub residual: &'a [f64],
    /// Rows of a piece.
    pub piece: usize,
    /// Seed.
    pub seed: u64,
}

impl Replay<'_> {
    fn draw(&self, index: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(index);
        let rows = self.residual.len();
        let mut drawn = Vec::with_capacity(rows);
        while drawn.len() < rows {
            let start = (uniform(&mut random) * rows as f64) as usize;
            let sign = if uniform(&mut random) < 0.5 { -1.0 } else { 1.0 };
            let take = self.piece.min(rows - drawn.len());
            drawn.extend((start..start + take).map(|i| sign * self.residual[i % rows]));
        }
        drawn
    }

    /// Products of drawn noise with columns, one row a replay.
    pub fn moments(&self, columns: &[Vec<f64>]) -> DMatrix<f64> {
        let rows: Vec<Vec<f64>> = (0..REPLAYS)
            .into_par_iter()
            .map(|index| {
                let noise = self.draw(index);
                columns.iter().map(|column| crate::numerics::products::interleaved_dot::<4>(column, &noise)).collect()
            })
            .collect();
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| rows[i][j])
    }
}

/// Evidence that noise alone brings to every candidate.
pub(crate) struct NullEvidence {
    /// Log evidence (nats) of each candidate, one row a replay.
    reached: Vec<Vec<f64>>,
    log_priors: Vec<f64>,
}

impl NullEvidence {
    /// By the products of noise with all columns, one row a replay.
    pub fn new(reduced: &Reduced, moments: &DMatrix<f64>, candidates: &[Candidate]) -> Self {
        let factored: Vec<Vec<(f64, Alone)>> = candidates
            .par_iter()
            .map(|candidate| candidate.variants.iter().map(|v| (v.log_weight, Alone::new(reduced, v))).collect())
            .collect();
        let of_replay = |replay: usize| -> Vec<f64> {
            let gain = |(weight, alone): &(f64, Alone)| weight + alone.gain(|place| moments[(replay, place)]);
            factored
                .iter()
                .map(|variants| log_sum_exp(variants.iter().map(gain).collect::<Vec<_>>().into_iter()))
                .collect()
        };
        Self {
            reached: (0..moments.nrows()).into_par_iter().map(of_replay).collect(),
            log_priors: candidates.iter().map(|candidate| candidate.log_prior).collect(),
        }
    }

    /// Nats that a member of a set has to bring, so that in one healthy recording of a hundred something is more likely than nothing. Of
    /// sets of any size the odds against nothing are those of independent members, `prod (1 + w) - 1`, which is one where the weights
    /// sum to the logarithm of two.
    pub fn price(&self, temper: f64) -> f64 {
        let odds = |reached: &Vec<f64>| {
            let weighed: Vec<f64> = reached.iter().zip(&self.log_priors).map(|(e, prior)| prior + temper * e).collect();
            log_sum_exp(weighed.into_iter())
        };
        let reached: Vec<f64> = self.reached.iter().map(odds).collect();
        gumbel_quantile(&reached, 1.0 - ALARM_SHARE) - std::f64::consts::LN_2.ln()
    }
}

/// Quantile of the Gumbel distribution that has the mean and the deviation of the values: the largest of many is so distributed.
fn gumbel_quantile(values: &[f64], share: f64) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let scale = deviation * 6f64.sqrt() / std::f64::consts::PI;
    mean - EULER * scale - scale * (-share.ln()).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::evidence::Variant;
    use crate::inference::posterior::Posterior;
    use crate::inference::products::products;
    use crate::inference::sets::Field;
    use crate::numerics::random::normal;

    #[test]
    fn the_quantile_of_gumbel_values_is_theirs() {
        let values: Vec<f64> = (0..2000).map(|i| 3.0 - 2.0 * (-((f64::from(i) + 0.5) / 2000.0).ln()).ln()).collect();
        let expected = 3.0 - 2.0 * (-0.99f64.ln()).ln();
        assert!((gumbel_quantile(&values, 0.99) / expected - 1.0).abs() < 0.02);
    }

    #[test]
    fn the_price_makes_something_likelier_than_nothing_in_one_healthy_recording_of_a_hundred() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let rows = 300;
        let mut draw = || -> Vec<f64> { (0..rows).map(|_| normal(&mut random)).collect() };
        let columns: Vec<Vec<f64>> = (0..20).map(|_| draw()).collect();
        let candidate = |column: usize| Candidate {
            log_prior: 0.0,
            variants: vec![Variant {
                columns: column..column + 1,
                shared: 0..0,
                mean: vec![0.0],
                variance: vec![0.1],
                log_weight: 0.0,
                only_positive: false,
            }],
            repeats: false,
        };
        let candidates: Vec<Candidate> = (0..20).map(candidate).collect();
        let of_target =
            |target: Vec<f64>| Reduced::without_base(&products(&[columns.clone(), vec![target]].concat()), 0);
        let residual = draw();
        let moments = Replay { residual: &residual, piece: 10, seed: 1 }.moments(&columns);
        let price = NullEvidence::new(&of_target(residual.clone()), &moments, &candidates).price(1.0);
        let mut is_alarm = |_: usize| {
            let reduced = of_target(draw());
            let field = Field { reduced: &reduced, candidates: &candidates, price, temper: 1.0 };
            Posterior::of(&field, field.search()).nothing() < 0.5
        };
        let alarms = (0..300).filter(|&k| is_alarm(k)).count();
        assert!(alarms <= 12, "{alarms} of 300; three are expected");
    }
}
