//! The way down over the non-linear constants of one structure: Levenberg-Marquardt, to whose curvature is added what the residuals' own second
//! derivatives bring wherever that foretells steps better (Dennis, Gay & Welsch 1981). Without it, a constant that the samples hardly see is
//! approached by a small share of the way in each step.

use nalgebra::{DMatrix, DVector};

use super::{Effort, Fit, Held, Point, Problem, RowTape};
use crate::law::fitting::projection::dot;
use crate::law::model::ranges::Range;
use crate::law::model::structure::Structure;

/// Damping of the first step, as a share of the curvature.
const FIRST_DAMPING: f64 = 1e-3;
/// Least damping; a constant that moves nothing is given this share of the largest curvature.
const LEAST_DAMPING: f64 = 1e-12;
/// Damping beyond which no step leads down.
const MOST_DAMPING: f64 = 1e12;
/// Factors by which damping grows after a step in vain, and shrinks after a good one.
const MORE_DAMPING: f64 = 8.0;
const LESS_DAMPING: f64 = 0.1;
/// A step is good where the sum of squares falls by at least this share of what was foretold.
const GOOD_SHARE: f64 = 0.5;
/// A positive constant changes by at most this in its logarithm in one step.
const LONGEST_LOGARITHM: f64 = 1.5;
/// Steps in succession that brought less than was asked for, after which there is no more to be had.
const PATIENCE: usize = 2;
/// Sums of squares below this share of that of the target are rounding.
const ROUNDING: f64 = 1e-30;

/// The non-linear constants of one structure on their way.
struct Descent<'p, 'a> {
    problem: &'p Problem<'a>,
    tape: RowTape<'p>,
    ranges: Vec<Range>,
    /// Those that move.
    free: Vec<usize>,
    pinned: Option<(usize, f64)>,
}

/// Where a descent is: values of the constants, what they leave, and half its slope and curvature in the scale of the steps (in logarithms where the
/// range is logarithmic), of the constants that move.
struct Place {
    psi: Vec<f64>,
    point: Point,
    slope: DVector<f64>,
    /// Products of the Jacobian.
    curvature: DMatrix<f64>,
}

impl Problem<'_> {
    /// Fits from the non-linear constants `psi`; what is `held` stays where it is.
    pub fn fit_from(&self, structure: &Structure, psi: &[f64], held: Held<'_>, effort: Effort) -> Fit {
        let names = structure.nonlinear();
        let free = (0..names.len()).filter(|&k| !held.nonlinear.contains(&names[k])).collect();
        let descent = Descent {
            problem: self,
            tape: self.tape(structure),
            ranges: self.ranges(structure),
            free,
            pinned: held.coefficient,
        };
        let (place, converged) = descent.run(psi.to_vec(), effort);
        let dependent = place.point.independent.iter().map(|i| !i).collect();
        let params = place.psi.iter().chain(&place.point.coefficients).copied().collect();
        Fit { structure: structure.clone(), params, rss: place.point.rss, converged, dependent }
    }
}

impl Descent<'_, '_> {
    /// The lowest place that is found, and whether it is one.
    fn run(&self, psi: Vec<f64>, effort: Effort) -> (Place, bool) {
        let mut place = self.place(psi);
        let mut bend = Bend::none(self.free.len());
        let mut damping = FIRST_DAMPING;
        let mut idle = 0;
        for _ in 0..effort.iterations {
            let worth = effort.tolerance * place.point.rss / self.problem.rows() as f64;
            if self.free.is_empty() || place.point.rss <= ROUNDING * self.problem.total() {
                return (place, true);
            }
            let Some(next) = self.step(&place, &mut bend, &mut damping, worth) else { return (place, true) };
            let fall = place.point.rss - next.point.rss;
            place = next;
            idle = if fall < worth { idle + 1 } else { 0 };
            if idle == PATIENCE {
                return (place, true);
            }
        }
        (place, false)
    }

    fn place(&self, psi: Vec<f64>) -> Place {
        let point = self.problem.at(&self.tape, &psi, self.pinned, &self.free);
        let scale: Vec<f64> = (0..self.free.len()).map(|i| self.scale(&psi, i)).collect();
        let slope = |i: usize| scale[i] * dot(&point.jacobian[i], &point.residual);
        let product = |i: usize, j: usize| scale[i] * scale[j] * dot(&point.jacobian[i], &point.jacobian[j]);
        let n = self.free.len();
        Place {
            slope: DVector::from_fn(n, |i, _| slope(i)),
            curvature: DMatrix::from_fn(n, n, |i, j| product(i.max(j), i.min(j))),
            psi,
            point,
        }
    }

    /// The next place down; `None` where no step is `worth` it.
    fn step(&self, place: &Place, bend: &mut Bend, damping: &mut f64, worth: f64) -> Option<Place> {
        let stuck: Vec<bool> = (0..self.free.len()).map(|i| self.is_stuck(place, i)).collect();
        let slope = DVector::from_fn(stuck.len(), |i, _| if stuck[i] { 0.0 } else { place.slope[i] });
        let largest = place.curvature.diagonal().max();
        if largest.is_nan() || largest <= 0.0 {
            return None;
        }
        while *damping < MOST_DAMPING {
            let mut curvature = bend.added_to(&place.curvature);
            let whole = curvature.clone();
            for i in 0..stuck.len() {
                curvature[(i, i)] += *damping * place.curvature[(i, i)].max(LEAST_DAMPING * largest);
                if stuck[i] {
                    curvature.row_mut(i).fill(0.0);
                    curvature.column_mut(i).fill(0.0);
                    curvature[(i, i)] = 1.0;
                }
            }
            let Some(step) = curvature.cholesky().map(|factor| factor.solve(&slope)) else {
                *damping *= MORE_DAMPING;
                continue;
            };
            let (psi, moved) = self.moved(&place.psi, &step);
            if psi == place.psi {
                return None;
            }
            let promise = -(2.0 * moved.dot(&slope) + moved.dot(&(&whole * &moved)));
            if promise < worth {
                return None;
            }
            let next = self.place(psi);
            let fall = place.point.rss - next.point.rss;
            bend.learn(self, (place, &next), &moved, fall);
            if fall > 0.0 {
                let factor = if fall > GOOD_SHARE * promise { LESS_DAMPING } else { 1.0 };
                *damping = (*damping * factor).max(LEAST_DAMPING);
                return Some(next);
            }
            *damping = (*damping * MORE_DAMPING).max(FIRST_DAMPING);
        }
        *damping = 1.0;
        None
    }

    /// Change of a constant with a step of its own: its value where steps are in its logarithm.
    fn scale(&self, psi: &[f64], i: usize) -> f64 {
        let k = self.free[i];
        if self.ranges[k].logarithmic { psi[k] } else { 1.0 }
    }

    /// Whether a constant is at the end of its range, and lower sums lie beyond.
    fn is_stuck(&self, place: &Place, i: usize) -> bool {
        let (value, range) = (place.psi[self.free[i]], &self.ranges[self.free[i]]);
        value <= range.lower && place.slope[i] > 0.0 || value >= range.upper && place.slope[i] < 0.0
    }

    /// The constants after a step down, within their ranges, and the way there in the scale of the steps.
    fn moved(&self, psi: &[f64], step: &DVector<f64>) -> (Vec<f64>, DVector<f64>) {
        let mut to = psi.to_vec();
        let mut moved = DVector::zeros(step.len());
        for (i, &k) in self.free.iter().enumerate() {
            let Range { lower, upper, logarithmic, .. } = self.ranges[k];
            if logarithmic {
                to[k] *= libm::exp((-step[i]).clamp(-LONGEST_LOGARITHM, LONGEST_LOGARITHM));
            } else {
                to[k] -= step[i];
            }
            to[k] = to[k].clamp(lower, upper);
            moved[i] = if logarithmic { libm::log(to[k] / psi[k]) } else { to[k] - psi[k] };
        }
        (to, moved)
    }
}

/// What the second derivatives of the residuals add to the curvature, as far as the steps so far have shown it.
struct Bend {
    matrix: DMatrix<f64>,
    /// Whether the last step was foretold better with it.
    counts: bool,
}

impl Bend {
    fn none(n: usize) -> Self {
        Self { matrix: DMatrix::zeros(n, n), counts: false }
    }

    fn added_to(&self, curvature: &DMatrix<f64>) -> DMatrix<f64> {
        if self.counts { curvature + &self.matrix } else { curvature.clone() }
    }

    /// From a step and the fall of the sum of squares along it: the sized update of Dennis, Gay & Welsch, equations (2.5) to (2.8).
    fn learn(&mut self, descent: &Descent<'_, '_>, (from, to): (&Place, &Place), moved: &DVector<f64>, fall: f64) {
        let foretold =
            |bend: &DMatrix<f64>| -(2.0 * moved.dot(&from.slope) + moved.dot(&((&from.curvature + bend) * moved)));
        let miss = |bend: &DMatrix<f64>| (foretold(bend) - fall).abs();
        self.counts = miss(&self.matrix) < miss(&DMatrix::zeros(moved.len(), moved.len()));
        let old_jacobian = |i: usize| descent.scale(&from.psi, i) * dot(&from.point.jacobian[i], &to.point.residual);
        let wanted = &to.slope - DVector::from_fn(moved.len(), |i, _| old_jacobian(i));
        let change = &to.slope - &from.slope;
        let along = moved.dot(&change);
        let own = moved.dot(&(&self.matrix * moved));
        let size = if own == 0.0 { 1.0 } else { (moved.dot(&wanted) / own).abs().min(1.0) };
        if along > 0.0 && along.is_finite() {
            let bend = &self.matrix * size;
            let missing = &wanted - &bend * moved;
            let outer = &missing * change.transpose();
            let correction = (&outer + outer.transpose()) / along
                - &change * change.transpose() * (missing.dot(moved) / (along * along));
            self.matrix = bend + correction;
        }
    }
}
