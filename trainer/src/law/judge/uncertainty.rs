//! How well the constants of a fitted law are determined: standard errors by leaving out blocks, profile-likelihood intervals (Bates & Watts
//! 1988, chapter 6) scaled to them, condition, correlations.

use super::criterion::{EXACT_RESIDUAL_RATIO, correlation_length};
use crate::law::fitting::problem::{Effort, Fit, Held, Problem};
use crate::law::fitting::projection::dot;
use crate::law::model::structure::Nonlinear;
use crate::numerics::jackknife::Jackknife;

/// Two-sided 95 % point of the normal distribution.
pub(in crate::law) const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A non-linear constant whose standard error exceeds this share of it may have other optima that are nearly as good.
const MULTISTART_RELATIVE_ERROR: f64 = 0.15;
/// Values of such a constant that are tried over its range.
const MULTISTART_VALUES: usize = 24;

/// How hard the refits of an interval try.
const REFIT_EFFORT: Effort = Effort { iterations: 12, tolerance: 1e-2 };

/// What the data say about the constants of a law, in the order of its parameters: non-linear ones, then the coefficients of the terms.
#[derive(Clone, Debug)]
pub struct Uncertainty {
    /// Standard errors: from leaving out blocks or the wider side of the profile interval, whichever is larger;
    /// infinite where the data say nothing, zero where held.
    pub standard_errors: Vec<f64>,
    /// 95 % intervals.
    pub intervals: Vec<[f64; 2]>,
    /// Coefficients of the nuisance columns with standard errors.
    pub nuisance: Vec<(f64, f64)>,
    /// Condition number of the Jacobian with columns scaled to unit length.
    pub condition: f64,
    /// Pairs of constants whose estimates are correlated beyond 0.98, with the correlation.
    pub entangled: Vec<(usize, usize, f64)>,
    /// Standard deviation of the residuals.
    pub noise: f64,
    /// Length over which residuals are correlated, samples.
    pub correlation_length: f64,
}

/// Which intervals to give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interval {
    /// Symmetric, from the standard error.
    Linearised,
    /// Where the likelihood falls off, refitting all else.
    Profile,
}

/// Analyses a converged fit, the constants in `held` being given and not estimated.
pub fn analyse(problem: &Problem<'_>, fit: &Fit, held: &[Nonlinear], kind: Interval) -> Uncertainty {
    let names = fit.structure.nonlinear();
    let count = fit.params.len();
    let free: Vec<usize> = (0..count).filter(|&k| names.get(k).is_none_or(|n| !held.contains(n))).collect();
    let rows = problem.rows();
    let template = fit.structure.template(problem.extents().layout());
    let mut columns = problem.tape_of(&[template]).run(&fit.params, &(0..count).collect::<Vec<_>>());
    let slopes = columns.slopes.swap_remove(0);
    let nuisance = &problem.data().nuisance;
    let jacobian: Vec<&[f64]> = nuisance
        .iter()
        .map(|n| n.values.as_slice())
        .chain(free.iter().map(|&k| slopes[k].as_deref().unwrap_or(&[])))
        .collect();
    let residuals = problem.residuals(fit);
    let correlation_length = correlation_length(&residuals);
    let freedom = (rows as f64 - jacobian.len() as f64).max(1.0);
    let noise = (fit.rss / freedom).sqrt();
    let linear = linearised(&jacobian, rows);
    let jackknife = without_blocks(&jacobian, &residuals);
    // A deviation of the noise for each constant: that of independent noise of one strength which would leave it as uncertain.
    let spread_of = |place: usize| {
        let spread = jackknife[place] / linear.errors[place];
        if spread.is_finite() { spread } else { noise * correlation_length.sqrt() }
    };
    let mut standard_errors = vec![0.0; count];
    let mut spreads = vec![0.0; count];
    for (i, &k) in free.iter().enumerate() {
        spreads[k] = spread_of(nuisance.len() + i);
        standard_errors[k] = spreads[k] * linear.errors[nuisance.len() + i];
    }
    let entangled = linear
        .entangled
        .iter()
        .filter(|(i, j, _)| *i >= nuisance.len() && *j >= nuisance.len())
        .map(|&(i, j, r)| (free[i - nuisance.len()], free[j - nuisance.len()], r))
        .collect();
    let exact = noise <= EXACT_RESIDUAL_RATIO * (problem.total() / rows as f64).sqrt();
    let profiled = kind == Interval::Profile && !exact;
    let mut intervals: Vec<[f64; 2]> = (0..count)
        .map(|k| {
            let se = standard_errors[k];
            if profiled && free.contains(&k) {
                profile(problem, fit, held, k, (se, spreads[k]))
            } else {
                [fit.params[k] - NORMAL_95 * se, fit.params[k] + NORMAL_95 * se]
            }
        })
        .collect();
    if profiled {
        let vague =
            |k: &usize| *k < names.len() && standard_errors[*k] > MULTISTART_RELATIVE_ERROR * fit.params[*k].abs();
        for k in free.iter().copied().filter(vague) {
            other_optima(problem, fit, held, k, &spreads, &mut intervals);
        }
        for &k in &free {
            let [low, high] = intervals[k];
            let widest = (fit.params[k] - low).max(high - fit.params[k]) / NORMAL_95;
            standard_errors[k] = standard_errors[k].max(widest);
        }
    }
    let coefficients = problem.nuisance_coefficients(fit);
    let error_of = |place: usize| spread_of(place) * linear.errors[place];
    let nuisance = coefficients.into_iter().enumerate().map(|(place, c)| (c, error_of(place))).collect();
    Uncertainty {
        standard_errors,
        intervals,
        nuisance,
        condition: linear.condition,
        entangled,
        noise,
        correlation_length,
    }
}

/// Standard errors of the coefficients of a linear model by leaving out blocks of rows, from its columns and what it leaves.
fn without_blocks(jacobian: &[&[f64]], residuals: &[f64]) -> Vec<f64> {
    let norms: Vec<f64> = jacobian.iter().map(|column| dot(column, column).sqrt()).collect();
    let scaled = |(column, norm): (&&[f64], &f64)| match column.len() {
        0 => vec![0.0; residuals.len()],
        _ => column.iter().map(|value| value / norm).collect(),
    };
    let columns: Vec<Vec<f64>> = jacobian.iter().zip(&norms).map(scaled).collect();
    let errors = Jackknife::new(&columns, residuals).errors();
    let error = |place: usize| errors.iter().map(|error| error[place].powi(2)).sum::<f64>().sqrt();
    norms.iter().enumerate().map(|(place, norm)| error(place) / norm).collect()
}

struct Linearised {
    /// Standard errors for unit noise.
    errors: Vec<f64>,
    entangled: Vec<(usize, usize, f64)>,
    condition: f64,
}

fn linearised(jacobian: &[&[f64]], rows: usize) -> Linearised {
    let n = jacobian.len();
    let norms: Vec<f64> = jacobian.iter().map(|c| dot(c, c).sqrt()).collect();
    let live: Vec<usize> = (0..n).filter(|&j| norms[j] > 0.0 && norms[j].is_finite()).collect();
    let mut errors = vec![f64::INFINITY; n];
    if live.is_empty() || rows < live.len() {
        return Linearised { errors, entangled: Vec::new(), condition: f64::INFINITY };
    }
    let scaled = nalgebra::DMatrix::from_fn(rows, live.len(), |i, j| jacobian[live[j]][i] / norms[live[j]]);
    let svd = scaled.qr().r().svd(false, true);
    let largest = svd.singular_values.max();
    let smallest = svd.singular_values.min();
    let v = svd.v_t.expect("requested").transpose();
    // Directions that the data do not see at all widen every constant they move.
    let inverse: Vec<f64> =
        svd.singular_values.iter().map(|s| if *s > 1e-12 * largest { 1.0 / (s * s) } else { f64::INFINITY }).collect();
    let entry = |a: usize, b: usize| -> f64 {
        (0..live.len())
            .map(|m| {
                let product = v[(a, m)] * v[(b, m)];
                if product.abs() < 1e-10 && inverse[m].is_infinite() { 0.0 } else { product * inverse[m] }
            })
            .sum()
    };
    let mut entangled = Vec::new();
    for a in 0..live.len() {
        errors[live[a]] = entry(a, a).sqrt() / norms[live[a]];
        for b in 0..a {
            let r = entry(a, b) / (entry(a, a) * entry(b, b)).sqrt();
            if r.is_nan() || r.abs() > 0.98 {
                entangled.push((live[b], live[a], if r.is_nan() { 1.0 } else { r }));
            }
        }
    }
    Linearised { errors, entangled, condition: if smallest > 0.0 { largest / smallest } else { f64::INFINITY } }
}

/// Widens the intervals by every fit over the range of non-linear constant `k` that the data cannot tell from the best one.
fn other_optima(
    problem: &Problem<'_>,
    fit: &Fit,
    held: &[Nonlinear],
    k: usize,
    spreads: &[f64],
    intervals: &mut [[f64; 2]],
) {
    let names = fit.structure.nonlinear();
    let range = &problem.ranges(&fit.structure)[k];
    let mut kept = held.to_vec();
    kept.push(names[k]);
    let mut psi = fit.constants().to_vec();
    for i in 0..MULTISTART_VALUES {
        let share = (i as f64 + 0.5) / MULTISTART_VALUES as f64;
        psi[k] = if range.logarithmic {
            range.lower * libm::pow(range.upper / range.lower, share)
        } else {
            range.lower + share * (range.upper - range.lower)
        };
        let tried = problem.fit_from(&fit.structure, &psi, Held { nonlinear: &kept, coefficient: None }, REFIT_EFFORT);
        let room = NORMAL_95 * NORMAL_95 - (tried.rss - fit.rss) / (spreads[k] * spreads[k]);
        if room <= 0.0 {
            continue;
        }
        let errors = problem.coefficient_errors(&tried);
        for (j, interval) in intervals.iter_mut().enumerate() {
            let half = if j < names.len() { 0.0 } else { room.sqrt() * spreads[j] * errors[j - names.len()] };
            interval[0] = interval[0].min(tried.params[j] - half);
            interval[1] = interval[1].max(tried.params[j] + half);
        }
    }
}

/// Profile-likelihood interval of constant `k`: where the sum of squares, all else refitted, has risen by 1.96² variances.
fn profile(problem: &Problem<'_>, fit: &Fit, held: &[Nonlinear], k: usize, (se, spread): (f64, f64)) -> [f64; 2] {
    let names = fit.structure.nonlinear();
    let best = fit.params[k];
    let limits = problem.ranges(&fit.structure).get(k).map(|r| (r.lower, r.upper));
    let refit = |value: f64, psi: &[f64]| -> Fit {
        let mut psi = psi.to_vec();
        let mut kept = held.to_vec();
        let coefficient = match names.get(k) {
            Some(name) => {
                psi[k] = value;
                kept.push(*name);
                None
            }
            None => Some((k - names.len(), value)),
        };
        problem.fit_from(&fit.structure, &psi, Held { nonlinear: &kept, coefficient }, REFIT_EFFORT)
    };
    let end = |direction: f64| -> f64 {
        let first = if se.is_finite() && se > 0.0 { NORMAL_95 * se } else { best.abs().max(1e-3) };
        let mut distance = first;
        let mut inside = 0.0;
        let mut outside = f64::INFINITY;
        let mut psi = fit.constants().to_vec();
        for _ in 0..10 {
            let mut value = best + direction * distance;
            if let Some((lower, upper)) = limits {
                // Half-way in the ratio to a bound that the linearised step would pass.
                if value <= lower {
                    value = if lower > 0.0 { (lower * (best - inside)).sqrt() } else { lower };
                }
                value = value.min(upper);
                distance = (value - best).abs();
            }
            let tried = refit(value, &psi);
            let rise = ((tried.rss - fit.rss).max(0.0)).sqrt() / (spread * NORMAL_95);
            if rise <= 1.0 {
                inside = distance;
                psi = tried.constants().to_vec();
                if let Some((lower, upper)) = limits
                    && (value >= upper || value <= lower * 1.02)
                {
                    return if direction > 0.0 { f64::INFINITY } else { lower.min(0.0) };
                }
            } else {
                outside = distance;
            }
            if (rise - 1.0).abs() < 0.02 {
                return best + direction * distance;
            }
            let guess = distance / rise.max(1e-3);
            distance = if outside.is_infinite() {
                guess.min(distance * 3.0)
            } else if guess > inside && guess < outside {
                guess
            } else {
                0.5 * (inside + outside)
            };
        }
        if outside.is_infinite() { direction * f64::INFINITY } else { best + direction * 0.5 * (inside + outside) }
    };
    [end(-1.0), end(1.0)]
}
