//! Limits of the search, fixed on one set of seeds and reported on another.

/// Limits of the search.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Family-wise probability below which an effect is a finding, locked rows included.
    pub family_wise_level: f64,
    /// Least score in nats of an effect that the open rows prove, and beside all the others that were found.
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
    /// Largest number of rivals that cannot be told from an effect: what nearly everything could stand for is no finding.
    pub most_rivals: usize,
    /// Null draws a round.
    pub null_draws: usize,
    /// Largest number of accepted effects.
    pub most_findings: usize,
    /// Seed of the null draws.
    pub seed: u64,
}

/// Evidence that tells two effects apart, nats: a likelihood ratio of 20, which Kass and Raftery (1995) call strong.
/// Larger leaves more rivals beside a name, smaller names wrongly more often.
pub const AMBIGUITY_MARGIN_NATS: f64 = 3.0;
/// Error of one model over that of another (root mean squares), up to which they leave as much. Chosen by judgement: the scatter of refits of
/// one recording; larger gives up real effects for fewer findings.
pub(crate) const EQUAL_ERROR_RATIO: f64 = 1.02;
/// Error of a model on other rows than those it was compared on, over its error on those (root mean squares), up to which it is the
/// same error: other stretches of a recording may suit a formula less. Chosen by judgement: smaller takes the scatter between
/// stretches for an event or an effect, larger misses an event of half the error.
pub(crate) const OTHER_ROWS_ERROR_RATIO: f64 = 1.5;

impl Default for Settings {
    fn default() -> Self {
        Self {
            family_wise_level: 0.006,
            least_score: 4.0,
            candidate_level: 0.1,
            candidate_score: 1.0,
            unconfirmed_level: 2e-5,
            unconfirmed_score: 6.0,
            largest_locked_loss: 5.0,
            ambiguity_margin: AMBIGUITY_MARGIN_NATS,
            most_rivals: 12,
            null_draws: 200,
            most_findings: 4,
            seed: 0,
        }
    }
}

/// Family-wise level over the usual one where the quantisation of the encoder limits the band: what it adds follows the
/// motion, and the null draws understate it three to five times.
const QUANTISED_LEVEL_RATIO: f64 = 0.25;

impl Settings {
    /// Limits for a recording whose band is limited by the grain of its encoder.
    pub(crate) fn behind_quantisation(self) -> Self {
        Self { family_wise_level: QUANTISED_LEVEL_RATIO * self.family_wise_level, ..self }
    }

    /// Largest family-wise probability and least score on the open rows, for what the locked rows can confirm and for what they
    /// cannot.
    pub(crate) fn on_open_rows(&self, confirmable: bool) -> (f64, f64) {
        if confirmable {
            (self.candidate_level, self.candidate_score)
        } else {
            (self.unconfirmed_level, self.unconfirmed_score)
        }
    }
}
