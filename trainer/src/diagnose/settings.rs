//! Limits of the search, fixed on one set of seeds and reported on another.

use super::prove::Proof;

/// Limits of the search.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Family-wise probability below which an effect is a finding, locked rows included.
    pub family_wise_level: f64,
    /// Least score in nats, locked rows included.
    pub least_score: f64,
    /// Family-wise probability on the open rows below which the locked rows are asked about an effect.
    pub candidate_level: f64,
    /// Least score in nats on the open rows at which the locked rows are asked about an effect.
    pub candidate_score: f64,
    /// Family-wise probability below which an effect is a finding that no locked rows can confirm, such as a one-off event.
    pub unconfirmed_level: f64,
    /// Least score in nats of such an effect.
    pub unconfirmed_score: f64,
    /// Loss in nats on the locked rows that no effect survives.
    pub largest_locked_loss: f64,
    /// Margin in nats within which rivals cannot be told apart.
    pub ambiguity_margin: f64,
    /// Null draws a round.
    pub null_draws: usize,
    /// Largest number of accepted effects.
    pub most_findings: usize,
    /// Seed of the null draws.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            family_wise_level: 0.004,
            least_score: 4.0,
            candidate_level: 0.05,
            candidate_score: 2.0,
            unconfirmed_level: 2e-5,
            unconfirmed_score: 6.0,
            largest_locked_loss: 5.0,
            ambiguity_margin: 3.0,
            null_draws: 200,
            most_findings: 4,
            seed: 0,
        }
    }
}

/// Share of the false alarms that is left where the grain of the encoder limits the band: what it adds follows the motion, and
/// the null draws understate it three to five times.
const BEHIND_GRAIN: f64 = 0.25;

/// Share of the level that is left to what the locked rows do not bear out.
const BEYOND_DOUBT: f64 = 0.1;

impl Settings {
    /// Limits for a recording whose band is limited by the grain of its encoder.
    pub(super) fn behind_grain(self) -> Self {
        Self { family_wise_level: BEHIND_GRAIN * self.family_wise_level, ..self }
    }

    /// Largest family-wise probability and least score on the open rows, for what the locked rows can confirm and for what they
    /// cannot.
    pub(super) fn on_open_rows(&self, confirmable: bool) -> (f64, f64) {
        if confirmable {
            (self.candidate_level, self.candidate_score)
        } else {
            (self.unconfirmed_level, self.unconfirmed_score)
        }
    }

    /// Whether open and locked rows together carry an effect: by its score and the evidence of the locked rows, in nats, and by
    /// its p-value on the open rows over the likelihood ratio of the locked ones. That ratio is an e-value of independent rows,
    /// so that the quotient is a p-value (Ignatiadis, Wang and Ramdas 2024). What makes the locked rows a little worse has to be
    /// beyond doubt on the open ones, and nothing carries what makes them clearly worse, whitened and not: beside larger effects,
    /// whose formulas err slowly, whitening may see a loss where the error falls.
    pub(super) fn carried(&self, score: f64, family_wise: f64, locked: &Proof) -> bool {
        let level = if locked.gain_nats < 0.0 { BEYOND_DOUBT } else { 1.0 } * self.family_wise_level;
        score + locked.evidence_nats >= self.least_score
            && family_wise * (-locked.evidence_nats).exp() <= level
            && (locked.gain_nats >= -self.largest_locked_loss || locked.improved_rmse < locked.baseline_rmse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_carried(score: f64, family_wise: f64, gain_nats: f64, evidence_nats: f64) -> bool {
        let locked = Proof { gain_nats, evidence_nats, ..Proof::default() };
        Settings::default().carried(score, family_wise, &locked)
    }

    #[test]
    fn locked_rows_decide_about_a_weak_candidate() {
        assert!(is_carried(3.0, 0.02, 4.5, 4.0));
        assert!(!is_carried(3.0, 0.02, 0.5, 0.5), "the score is too low");
        assert!(!is_carried(6.0, 0.02, 0.5, 0.5), "the probability is too high");
        assert!(is_carried(20.0, 1e-8, -4.0, -1.5), "a strong one survives a locked row or two against it");
        assert!(!is_carried(5.0, 1e-3, -2.0, -2.0));
        assert!(!is_carried(12.0, 5e-6, -6.0, -2.0), "a lasting one does not survive what clearly speaks against it");
        assert!(!is_carried(8.0, 1e-3, -2.0, -0.5), "p would do, but the locked rows get worse");
        assert!(!is_carried(80.0, 1e-30, -20.0, -4.0), "nothing survives locked rows that clearly speak against it");
    }

    #[test]
    fn a_loss_behind_whitening_is_none_where_the_error_falls() {
        let locked = Proof {
            baseline_rmse: 242.0,
            improved_rmse: 142.0,
            gain_nats: -20.0,
            evidence_nats: -4.0,
            ..Proof::default()
        };
        assert!(Settings::default().carried(80.0, 1e-30, &locked));
    }
}
