//! The criterion by which laws are compared, in nats: misfit and penalties. A penalty is half the logarithm of the (effective) number of samples for each constant (Schwarz 1978), and how
//! many like it there are to try or how far it is from what friction usually does (Chen & Chen 2008).

use crate::law::fitting::problem::{Fit, Problem};
use crate::law::model::structure::{Modulation, Shape, SignForm, Term};

/// Nats for each term: the library offers about this many (in the logarithm) equally likely ones.
const TERM_PENALTY_NATS: f64 = 2.5;
/// Nats for a coefficient whose sign friction does not have: Coulomb, viscous and Stribeck parts dissipate.
const SIGN_PENALTY_NATS: f64 = 5.0;

/// Residuals below this share of the target's root mean square count as exact.
pub const EXACT_RESIDUAL_RATIO: f64 = 1e-7;

fn of_sign(sign: SignForm) -> f64 {
    match sign {
        SignForm::Tanh => 0.0,
        SignForm::Arctan | SignForm::Algebraic => 4.0,
        SignForm::Parabolic | SignForm::Cubic => 4.0,
    }
}

fn of_term(term: Term) -> f64 {
    let shape = match term.shape {
        Shape::Sign | Shape::Viscous | Shape::StribeckExponential => 0.0,
        Shape::Offset | Shape::AbsViscous => 0.5,
        Shape::Quadratic => 1.0,
        Shape::AbsSign | Shape::OddPower | Shape::OddRoot => 1.5,
        Shape::StribeckGaussian | Shape::SignPower | Shape::StribeckPower | Shape::Breakaway => 2.0,
    };
    let modulation = match term.modulation {
        Modulation::Plain => 0.0,
        Modulation::Magnitude(_) | Modulation::Decay(_) => 0.5,
        Modulation::Value(_) | Modulation::Difference(_) => 1.0,
        // The order of a ripple is looked for over hundreds of values.
        Modulation::Sine(_) | Modulation::Cosine(_) => 2.0,
    };
    TERM_PENALTY_NATS + shape + modulation
}

fn dissipates(term: Term) -> bool {
    matches!(term.modulation, Modulation::Plain | Modulation::Decay(_) | Modulation::Magnitude(_))
        && !matches!(term.shape, Shape::AbsSign | Shape::AbsViscous | Shape::Offset)
}

/// What the structure costs apart from its number of constants, nats.
pub fn prior(fit: &Fit) -> f64 {
    let terms: f64 = fit.structure.terms().iter().map(|t| of_term(*t)).sum();
    let wrong = fit.structure.terms().iter().zip(fit.coefficients()).filter(|(t, c)| dissipates(**t) && **c < 0.0);
    of_sign(fit.structure.sign()) + terms + SIGN_PENALTY_NATS * wrong.count() as f64
}

/// How many effective samples there are, and below which mean square a fit counts as exact.
#[derive(Clone, Copy, Debug)]
pub struct Evidence {
    /// Samples given.
    pub rows: usize,
    /// Samples divided by the length over which residuals are correlated.
    pub effective: f64,
    /// Mean square below which residuals are rounding.
    pub exact: f64,
}

/// Held-out blocks guard against what correlated residuals pretend, so that no fewer samples than this are counted.
const LEAST_EFFECTIVE: f64 = 200.0;

impl Evidence {
    /// Of residuals that are correlated over this many samples.
    pub fn of(problem: &Problem<'_>, correlation_length: f64) -> Self {
        let rows = problem.rows();
        Self {
            rows,
            effective: (rows as f64 / correlation_length).max(LEAST_EFFECTIVE.min(rows as f64)),
            exact: EXACT_RESIDUAL_RATIO * EXACT_RESIDUAL_RATIO * problem.total() / rows as f64,
        }
    }

    /// Negative log likelihood of a mean squared residual, up to a constant.
    pub fn misfit(&self, mean_square: f64) -> f64 {
        0.5 * self.effective * libm::log(mean_square.max(self.exact).max(f64::MIN_POSITIVE))
    }

    /// Score of a fit on the samples it was fitted to, nats; lower is better.
    pub fn score(&self, fit: &Fit) -> f64 {
        self.misfit(fit.rss / self.rows as f64)
            + 0.5 * libm::log(self.effective) * fit.structure.constants() as f64
            + prior(fit)
    }

    /// Score from a mean square over held-out samples, which has already paid about one nat for each constant.
    pub fn held_out(&self, fit: &Fit, mean_square: f64) -> f64 {
        let each = (0.5 * libm::log(self.effective) - 1.0).max(0.0);
        self.misfit(mean_square) + each * fit.structure.constants() as f64 + prior(fit)
    }
}

/// Number of samples over which residuals are correlated: one and twice the sum of the autocorrelations up to the first
/// that is not clearly positive (Sokal 1997), at least 1.
pub fn correlation_length(residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let power = crate::law::fitting::projection::dot(residuals, residuals);
    if power <= 0.0 || n < 8 {
        return 1.0;
    }
    let noise = 2.0 / (n as f64).sqrt();
    let mut length = 1.0;
    for lag in 1..n / 4 {
        let rho = crate::law::fitting::projection::dot(&residuals[lag..], &residuals[..n - lag]) / power;
        if rho < noise {
            break;
        }
        length += 2.0 * rho;
    }
    length
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{RngCore, SeedableRng};

    use super::*;

    #[test]
    fn white_residuals_have_length_one_and_repeated_ones_more() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let white: Vec<f64> = (0..4000).map(|_| f64::from(random.next_u32()) - f64::from(u32::MAX / 2)).collect();
        assert!(correlation_length(&white) < 1.2);
        let held: Vec<f64> = white.iter().step_by(10).flat_map(|x| [*x; 10]).collect();
        assert!((6.0..16.0).contains(&correlation_length(&held)), "{}", correlation_length(&held));
    }
}
