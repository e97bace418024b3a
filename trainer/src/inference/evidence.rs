//! Evidence of candidates with normal priors beside what is already in a model.

use crate::inference::reduced::Reduced;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use statrs::distribution::{ContinuousCDF, Normal};
use std::ops::Range;

/// One shape of a candidate.
#[derive(Clone, Debug)]
pub(crate) struct Variant {
    /// Its columns among those of the products.
    pub columns: Range<usize>,
    /// Columns that stand for what it is on all rows, whether or not it is missing; empty where there are no others.
    pub shared: Range<usize>,
    /// Prior mean of each own coefficient; shared ones have none.
    pub mean: Vec<f64>,
    /// Prior variance of each coefficient, of the shared ones too.
    pub variance: Vec<f64>,
    /// Logarithm of its prior weight among the shapes of its candidate: they sum to at most one.
    pub log_weight: f64,
    /// Whether its first coefficient, own and shared together, may not be negative.
    pub only_positive: bool,
}

/// A candidate with its shapes.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    /// Logarithm of its prior weight beside that of others.
    pub log_prior: f64,
    /// Its shapes.
    pub variants: Vec<Variant>,
    /// Whether it may be in a model twice, with other shapes.
    pub repeats: bool,
}

/// A set of variants in a model beside the base: the evidence that they are missing is that of their own and shared columns together
/// over that of the shared ones.
pub(crate) struct Model<'r> {
    whole: Solved<'r>,
    shared: Solved<'r>,
    /// Log evidence against the base alone, nats.
    pub log_evidence: f64,
}

impl<'r> Model<'r> {
    /// A model of variants beside the base; `None` where it is singular to working precision.
    pub fn new(reduced: &'r Reduced, variants: &[&Variant]) -> Option<Self> {
        let whole = Solved::new(reduced, variants.iter().map(|variant| Term::whole(variant)).collect())?;
        let shared = Solved::new(reduced, variants.iter().map(|variant| Term::shared(variant)).collect())?;
        Some(Self { log_evidence: whole.log_evidence - shared.log_evidence, whole, shared })
    }

    /// Log evidence (nats) that a variant adds.
    pub fn gain(&self, variant: &Variant) -> f64 {
        self.whole.gain(&Term::whole(variant)) - self.shared.gain(&Term::shared(variant))
    }

    /// Place and mean of every coefficient, own and shared; `None` where they are not finite.
    pub fn coefficients(&self) -> Option<Vec<(usize, f64)>> {
        let mean = self.whole.mean()?;
        Some(self.whole.places.iter().copied().zip(mean.iter().copied()).collect())
    }

    /// Posterior standard deviation of a sum of coefficients (place, weight).
    pub fn deviation(&self, sum: &[(usize, f64)]) -> f64 {
        let mut direction = DVector::zeros(self.whole.places.len());
        for (place, weight) in sum {
            if let Some(at) = self.whole.places.iter().position(|of| of == place) {
                direction[at] = *weight;
            }
        }
        self.whole.factor.l_dirty().solve_lower_triangular_mut(&mut direction);
        direction.norm()
    }
}

/// A variant beside nothing, factored once for many targets.
pub(crate) struct Alone {
    whole: Option<(Term, Cholesky<f64, Dyn>)>,
    shared: Option<(Term, Cholesky<f64, Dyn>)>,
}

impl Alone {
    pub fn new(reduced: &Reduced, variant: &Variant) -> Self {
        let factored = |term: Term| {
            let is_there = term.places.iter().any(|&j| reduced.gram[(j, j)] > 0.0);
            let factor = is_there.then(|| term.precision(reduced).cholesky()).flatten();
            factor.map(|factor| (term, factor))
        };
        Self { whole: factored(Term::whole(variant)), shared: factored(Term::shared(variant)) }
    }

    /// Log evidence (nats) for a target with some products.
    pub fn gain(&self, moments: impl Fn(usize) -> f64) -> f64 {
        let of = |part: &Option<(Term, Cholesky<f64, Dyn>)>| {
            let Some((term, factor)) = part else { return 0.0 };
            let right = DVector::from_fn(term.places.len(), |i, _| moments(term.places[i]) + term.expected(i));
            let Some(weighed) = factor.l_dirty().solve_lower_triangular(&right) else { return 0.0 };
            term.gain(factor, weighed)
        };
        of(&self.whole) - of(&self.shared)
    }
}

/// Columns that come into a model together.
struct Term {
    places: Vec<usize>,
    /// Prior mean and variance of each coefficient.
    mean: Vec<f64>,
    variance: Vec<f64>,
    /// Where its sign is known: the coefficients (places among its columns) whose sum may not be negative.
    positive: Vec<usize>,
}

impl Term {
    fn whole(variant: &Variant) -> Self {
        let width = variant.columns.len();
        let places: Vec<usize> = variant.columns.clone().chain(variant.shared.clone()).collect();
        let first = if variant.shared.is_empty() { vec![0] } else { vec![0, width] };
        Self {
            mean: variant.mean.iter().copied().chain(variant.shared.clone().map(|_| 0.0)).collect(),
            variance: variant.variance.iter().copied().cycle().take(places.len()).collect(),
            places,
            positive: if variant.only_positive { first } else { Vec::new() },
        }
    }

    /// What the prior mean of a coefficient adds to its product with the target.
    fn expected(&self, index: usize) -> f64 {
        self.mean[index] / self.variance[index]
    }

    /// Log evidence, nats, that the prior means take from a model in which nothing comes near them.
    fn log_of_means(&self) -> f64 {
        (0..self.mean.len()).map(|i| -0.5 * self.mean[i] * self.expected(i)).sum()
    }

    /// Posterior precision of its coefficients alone.
    fn precision(&self, reduced: &Reduced) -> DMatrix<f64> {
        DMatrix::from_fn(self.places.len(), self.places.len(), |i, j| {
            reduced.gram[(self.places[i], self.places[j])] + if i == j { self.variance[i].recip() } else { 0.0 }
        })
    }

    /// Log evidence of its columns by their factored precision and `L^-1 h`.
    fn gain(&self, factor: &Cholesky<f64, Dyn>, weighed: DVector<f64>) -> f64 {
        let gain = log_integral(factor, &weighed, &self.variance) + self.log_of_means();
        if self.positive.is_empty() {
            return gain;
        }
        let mut mean = weighed;
        factor.l_dirty().tr_solve_lower_triangular_mut(&mut mean);
        gain + log_sign_ratio_of(factor, &mean, self, 0)
    }

    fn shared(variant: &Variant) -> Self {
        let places: Vec<usize> = variant.shared.clone().collect();
        let positive = if variant.only_positive && !places.is_empty() { vec![0] } else { Vec::new() };
        Self {
            mean: vec![0.0; places.len()],
            variance: variant.variance.iter().copied().take(places.len()).collect(),
            places,
            positive,
        }
    }
}

/// A solved set of columns with normal priors.
struct Solved<'r> {
    reduced: &'r Reduced,
    places: Vec<usize>,
    factor: Cholesky<f64, Dyn>,
    /// `L^-1 h`.
    weighed: DVector<f64>,
    log_evidence: f64,
}

impl<'r> Solved<'r> {
    fn new(reduced: &'r Reduced, terms: Vec<Term>) -> Option<Self> {
        let places: Vec<usize> = terms.iter().flat_map(|term| term.places.iter().copied()).collect();
        let variance: Vec<f64> = terms.iter().flat_map(|term| term.variance.iter().copied()).collect();
        let size = places.len();
        let matrix = DMatrix::from_fn(size, size, |i, j| {
            reduced.gram[(places[i], places[j])] + if i == j { variance[i].recip() } else { 0.0 }
        });
        let factor = matrix.cholesky()?;
        let expected: Vec<f64> =
            terms.iter().flat_map(|term| (0..term.places.len()).map(|i| term.expected(i))).collect();
        let moments = DVector::from_fn(size, |i, _| reduced.moments[places[i]] + expected[i]);
        let weighed = factor.l_dirty().solve_lower_triangular(&moments)?;
        let of_means: f64 = terms.iter().map(Term::log_of_means).sum();
        let log_evidence = log_integral(&factor, &weighed, &variance) + of_means;
        let mut solved = Self { reduced, places, log_evidence, factor, weighed };
        if terms.iter().any(|term| !term.positive.is_empty()) {
            let mean = solved.mean()?;
            let mut begin = 0;
            for term in &terms {
                solved.log_evidence += log_sign_ratio_of(&solved.factor, &mean, term, begin);
                begin += term.places.len();
            }
        }
        Some(solved)
    }

    fn mean(&self) -> Option<DVector<f64>> {
        let mut solution = self.weighed.clone();
        self.factor.l_dirty().tr_solve_lower_triangular_mut(&mut solution).then_some(solution)
    }

    /// Log evidence (nats) that a term adds.
    fn gain(&self, term: &Term) -> f64 {
        let width = term.places.len();
        if width == 0 || term.places.iter().all(|&j| self.reduced.gram[(j, j)] <= 0.0) {
            return 0.0;
        }
        let mut across =
            DMatrix::from_fn(self.places.len(), width, |i, j| self.reduced.gram[(self.places[i], term.places[j])]);
        self.factor.l_dirty().solve_lower_triangular_mut(&mut across);
        let matrix = term.precision(self.reduced) - across.tr_mul(&across);
        let moments = DVector::from_fn(width, |i, _| self.reduced.moments[term.places[i]] + term.expected(i))
            - across.tr_mul(&self.weighed);
        let Some(factor) = matrix.cholesky() else { return 0.0 };
        let Some(weighed) = factor.l_dirty().solve_lower_triangular(&moments) else { return 0.0 };
        term.gain(&factor, weighed)
    }
}

/// Log of the integral over coefficients with normal priors of some variance.
fn log_integral(factor: &Cholesky<f64, Dyn>, weighed: &DVector<f64>, variance: &[f64]) -> f64 {
    let log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|pivot| pivot.ln()).sum();
    let prior: f64 = variance.iter().map(|variance| variance.ln()).sum();
    0.5 * weighed.norm_squared() - log_determinant - 0.5 * prior
}

/// Log evidence that the known sign of a term adds, whose columns begin at `begin` of a solved system.
fn log_sign_ratio_of(factor: &Cholesky<f64, Dyn>, mean: &DVector<f64>, term: &Term, begin: usize) -> f64 {
    if term.positive.is_empty() {
        return 0.0;
    }
    let sum: f64 = term.positive.iter().map(|place| mean[begin + place]).sum();
    let mut direction = DVector::zeros(mean.len());
    term.positive.iter().for_each(|place| direction[begin + place] = 1.0);
    factor.l_dirty().solve_lower_triangular_mut(&mut direction);
    log_sign_ratio(sum, direction.norm())
}

/// Log evidence of a half normal prior over that of the normal one, for a posterior mean and deviation: twice the posterior's mass
/// on the right side.
fn log_sign_ratio(mean: f64, deviation: f64) -> f64 {
    let z = mean / deviation.max(f64::MIN_POSITIVE);
    if z < -30.0 {
        // Asymptote of the normal distribution's tail (Abramowitz and Stegun 1964, 26.2.12).
        return -0.5 * z * z - (-z).ln() - 0.5 * (0.5 * std::f64::consts::PI).ln();
    }
    (2.0 * Normal::standard().cdf(z)).ln()
}

/// Logarithm of the sum of exponentials.
pub(crate) fn log_sum_exp(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return largest;
    }
    largest + values.map(|value| (value - largest).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_columns() -> Reduced {
        Reduced {
            gram: DMatrix::from_row_slice(2, 2, &[100.0, 40.0, 40.0, 90.0]),
            moments: DVector::from_vec(vec![30.0, -12.0]),
            energy: 500.0,
        }
    }

    fn variant(columns: Range<usize>, only_positive: bool) -> Variant {
        let [mean, variance] = [0.0, 0.5].map(|value| vec![value; columns.len()]);
        Variant { mean, variance, columns, shared: 0..0, log_weight: 0.0, only_positive }
    }

    #[test]
    fn the_evidence_of_one_coefficient_is_its_normal_integral() {
        let reduced = two_columns();
        let model = Model::new(&reduced, &[&variant(0..1, false)]).unwrap();
        // Integral of exp(h g - G g^2 / 2) over a normal prior, by sums.
        let step = 1e-4;
        let integrand = |g: f64| (30.0 * g - 50.0 * g * g - g * g).exp() / (std::f64::consts::PI).sqrt();
        let expected: f64 = (-40_000..40_000).map(|k| step * integrand(step * f64::from(k))).sum();
        assert!((model.log_evidence - expected.ln()).abs() < 1e-6, "{} {}", model.log_evidence, expected.ln());
        let positive: f64 = (0..40_000).map(|k| 2.0 * step * integrand(step * (f64::from(k) + 0.5))).sum();
        let signed = Model::new(&reduced, &[&variant(0..1, true)]).unwrap();
        assert!((signed.log_evidence - positive.ln()).abs() < 1e-6);
    }

    #[test]
    fn a_coefficient_that_physics_knows_is_expected_there() {
        let reduced = two_columns();
        let known = Variant { mean: vec![0.7], variance: vec![0.04], ..variant(0..1, false) };
        let model = Model::new(&reduced, &[&known]).unwrap();
        let step = 1e-4;
        let prior = |g: f64| (-0.5 * (g - 0.7).powi(2) / 0.04).exp() / (2.0 * std::f64::consts::PI * 0.04).sqrt();
        let integrand = |g: f64| (30.0 * g - 50.0 * g * g).exp() * prior(g);
        let expected: f64 = (-40_000..40_000).map(|k| step * integrand(step * f64::from(k))).sum();
        assert!((model.log_evidence - expected.ln()).abs() < 1e-6, "{} {}", model.log_evidence, expected.ln());
        let beside = Model::new(&reduced, &[&variant(1..2, false)]).unwrap();
        let both = Model::new(&reduced, &[&variant(1..2, false), &known]).unwrap();
        assert!((beside.log_evidence + beside.gain(&known) - both.log_evidence).abs() < 1e-9);
        let alone = Alone::new(&reduced, &known).gain(|place| reduced.moments[place]);
        assert!((alone - model.log_evidence).abs() < 1e-9);
    }

    #[test]
    fn what_all_rows_show_is_not_missing() {
        // The shared column explains on all rows what the own one does on some.
        let reduced = Reduced {
            gram: DMatrix::from_row_slice(2, 2, &[50.0, 50.0, 50.0, 100.0]),
            moments: DVector::from_vec(vec![50.0, 100.0]),
            energy: 500.0,
        };
        let alone = variant(0..1, false);
        let beside = Variant { shared: 1..2, ..alone.clone() };
        assert!(Model::new(&reduced, &[&alone]).unwrap().log_evidence > 20.0);
        assert!(Model::new(&reduced, &[&beside]).unwrap().log_evidence < 0.0);
    }

    #[test]
    fn gains_add_up_to_the_evidence_of_the_set() {
        let reduced = two_columns();
        let [first, second] = [variant(0..1, false), variant(1..2, false)];
        let nothing = Model::new(&reduced, &[]).unwrap();
        let one = Model::new(&reduced, &[&first]).unwrap();
        let both = Model::new(&reduced, &[&first, &second]).unwrap();
        assert!((nothing.gain(&first) - one.log_evidence).abs() < 1e-9);
        assert!((one.log_evidence + one.gain(&second) - both.log_evidence).abs() < 1e-9);
    }

    #[test]
    fn a_wrong_sign_far_off_is_ruled_out_without_losing_its_figures() {
        assert!((log_sign_ratio(-31.0, 1.0) - log_sign_ratio(-29.0, 1.0) + 60.0).abs() < 0.1);
        assert!((log_sign_ratio(40.0, 1.0) - 2f64.ln()).abs() < 1e-12);
    }
}
