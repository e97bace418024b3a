//! Least squares for one structure: variable projection over the linear coefficients (Golub & Pereyra 1973, in the
//! approximation of Kaufman 1975), Levenberg-Marquardt over the few non-linear constants.

mod grid;
mod values;

use super::projection::{Basis, dot};
use crate::law::model::data::LawData;
use crate::law::model::expression::Expr;
use crate::law::model::ranges::{Extents, Range};
use crate::law::model::structure::{Nonlinear, Structure};
use crate::law::model::tape::{Columns, Tape};
use crate::numerics::averages::Averages;

/// Data prepared for many fits: what the nuisance columns explain is projected out once.
#[derive(Debug)]
pub struct Problem<'a> {
    data: &'a LawData,
    channels: Vec<&'a [f64]>,
    nuisance: Basis,
    target: Vec<f64>,
    extents: &'a Extents,
}

/// A fitted structure.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Which law.
    pub structure: Structure,
    /// Non-linear constants (in the order of [`Structure::nonlinear`]), then the coefficients of the terms.
    pub params: Vec<f64>,
    /// Sum of squared residuals.
    pub rss: f64,
    /// Whether the optimiser stopped because nothing more was to be gained.
    pub converged: bool,
    /// Terms whose column the other terms or the nuisance columns already hold.
    pub dependent: Vec<bool>,
}

/// Constants that an optimisation leaves where they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held<'a> {
    /// Non-linear constants, at their starting values.
    pub nonlinear: &'a [Nonlinear],
    /// One coefficient (by index of its term) and its value.
    pub coefficient: Option<(usize, f64)>,
}

/// How hard an optimisation tries.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Most iterations.
    pub iterations: usize,
    /// Stops when a step reduces the sum of squares by a smaller share.
    pub tolerance: f64,
}

impl Effort {
    /// Enough to rank structures.
    pub const SEARCH: Self = Self { iterations: 25, tolerance: 1e-6 };
    /// Until rounding stops it.
    pub const FINAL: Self = Self { iterations: 200, tolerance: 1e-15 };
}

/// Expressions evaluated for every sample: at its channels, or averaged over its states.
#[derive(Debug)]
pub struct RowTape<'a> {
    tape: Tape,
    averages: Option<&'a Averages>,
}

impl RowTape<'_> {
    /// As [`Tape::run`].
    pub fn run(&self, params: &[f64], slopes: bool) -> Columns {
        let mut columns = self.tape.run(params, slopes);
        if let Some(averages) = self.averages {
            let of_slopes = columns.slopes.iter_mut().flatten().flatten();
            columns.values.iter_mut().chain(of_slopes).for_each(|column| *column = averages.over(column));
        }
        columns
    }
}

struct Point {
    rss: f64,
    residual: Vec<f64>,
    coefficients: Vec<f64>,
    independent: Vec<bool>,
    jacobian: Vec<Vec<f64>>,
}

impl<'a> Problem<'a> {
    /// Prepares `data`, which must have passed [`LawData::check`].
    pub fn new(data: &'a LawData, extents: &'a Extents) -> Self {
        let nuisance = Basis::new(data.nuisance.iter().map(|n| n.values.as_slice()));
        let mut target = data.target.clone();
        nuisance.remove_from(&mut target);
        Self { data, channels: data.columns(), nuisance, target, extents }
    }

    /// The data.
    pub fn data(&self) -> &LawData {
        self.data
    }

    /// The extents of its channels.
    pub fn extents(&self) -> &Extents {
        self.extents
    }

    /// Number of samples.
    pub fn rows(&self) -> usize {
        self.target.len()
    }

    /// Sum of squares of the target after the nuisance columns.
    pub fn total(&self) -> f64 {
        dot(&self.target, &self.target)
    }

    /// The fit optimised until rounding stops it, the constants in `held` being left where they are.
    pub fn polish(&self, fit: &Fit, held: &[Nonlinear]) -> Fit {
        let psi = &fit.params[..fit.structure.nonlinear().len()];
        self.fit_from(&fit.structure, psi, Held { nonlinear: held, coefficient: None }, Effort::FINAL)
    }

    fn tape(&self, structure: &Structure) -> RowTape<'_> {
        self.tape_of(&structure.columns(self.extents.layout()), structure.nonlinear().len())
    }

    /// Expressions of the channels that are evaluated for every sample.
    pub fn tape_of(&self, outputs: &[Expr], params: usize) -> RowTape<'_> {
        let averages = self.data.states.as_ref().map(|states| &states.averages);
        let places = self.channels.first().map_or(0, |channel| channel.len());
        RowTape { tape: Tape::new(outputs, params, &self.channels, places), averages }
    }

    fn at(&self, tape: &RowTape<'_>, psi: &[f64], pinned: Option<(usize, f64)>, jacobian: bool) -> Point {
        let mut columns = tape.run(psi, jacobian);
        let mut basis = Basis::default();
        let mut residual = self.target.clone();
        for (j, column) in columns.values.iter_mut().enumerate() {
            let before = dot(column, column);
            self.nuisance.remove_from(column);
            // What is left of a column inside the span of the nuisance columns is rounding.
            if dot(column, column) <= 1e-18 * before {
                column.fill(0.0);
            }
            if let Some((_, value)) = pinned.filter(|p| p.0 == j) {
                residual.iter_mut().zip(&*column).for_each(|(r, c)| *r -= value * c);
                column.fill(0.0);
            }
            basis.push(column);
        }
        let products = basis.remove_from(&mut residual);
        let mut coefficients = basis.coefficients(&products);
        if let Some((j, value)) = pinned {
            coefficients[j] = value;
        }
        let mut derivatives = Vec::new();
        if jacobian {
            for k in 0..psi.len() {
                let mut d = vec![0.0; self.rows()];
                for (slopes, &c) in columns.slopes.iter().zip(&coefficients) {
                    if let Some(slope) = &slopes[k] {
                        d.iter_mut().zip(slope).for_each(|(d, s)| *d -= c * s);
                    }
                }
                self.nuisance.remove_from(&mut d);
                basis.remove_from(&mut d);
                derivatives.push(d);
            }
        }
        Point {
            rss: dot(&residual, &residual),
            residual,
            coefficients,
            independent: basis.independent(),
            jacobian: derivatives,
        }
    }

    /// Ranges of the non-linear constants of a structure.
    pub fn ranges(&self, structure: &Structure) -> Vec<Range> {
        structure.nonlinear().into_iter().map(|n| self.extents.range(n, structure.sign())).collect()
    }

    /// Fits from the non-linear constants `psi`; what is `held` stays where it is.
    pub fn fit_from(&self, structure: &Structure, psi: &[f64], held: Held<'_>, effort: Effort) -> Fit {
        let tape = self.tape(structure);
        let ranges = self.ranges(structure);
        let free: Vec<usize> = structure
            .nonlinear()
            .iter()
            .enumerate()
            .filter(|(_, n)| !held.nonlinear.contains(n))
            .map(|(k, _)| k)
            .collect();
        let mut psi = psi.to_vec();
        let mut point = self.at(&tape, &psi, held.coefficient, true);
        let mut damping = 1e-3;
        let mut converged = free.is_empty();
        let floor = 1e-30 * self.total();
        for _ in 0..effort.iterations {
            if converged || point.rss <= floor {
                converged = true;
                break;
            }
            let Some((trial, tried, reduction)) =
                self.step(&tape, (&ranges, &free, held.coefficient), &psi, &point, &mut damping)
            else {
                // No damping gave a descent: a minimum to rounding.
                converged = true;
                break;
            };
            psi = trial;
            point = tried;
            converged = reduction < effort.tolerance;
        }
        let dependent = point.independent.iter().map(|i| !i).collect();
        let params = psi.iter().chain(&point.coefficients).copied().collect();
        Fit { structure: structure.clone(), params, rss: point.rss, converged, dependent }
    }

    /// One accepted step: the new constants, the point there and the share by which the sum of squares fell.
    fn step(
        &self,
        tape: &RowTape<'_>,
        (ranges, free, pinned): (&[Range], &[usize], Option<(usize, f64)>),
        psi: &[f64],
        point: &Point,
        damping: &mut f64,
    ) -> Option<(Vec<f64>, Point, f64)> {
        let scale = |k: usize| if ranges[k].logarithmic { psi[k] } else { 1.0 };
        let n = free.len();
        let mut normal = nalgebra::DMatrix::zeros(n, n);
        let mut gradient = nalgebra::DVector::zeros(n);
        for (i, &k) in free.iter().enumerate() {
            gradient[i] = scale(k) * dot(&point.jacobian[k], &point.residual);
            for (j, &l) in free.iter().enumerate().take(i + 1) {
                normal[(i, j)] = scale(k) * scale(l) * dot(&point.jacobian[k], &point.jacobian[l]);
                normal[(j, i)] = normal[(i, j)];
            }
        }
        let largest = (0..n).map(|i| normal[(i, i)]).fold(0.0, f64::max);
        if largest.is_nan() || largest <= 0.0 {
            return None;
        }
        while *damping < 1e12 {
            let mut damped = normal.clone();
            for i in 0..n {
                damped[(i, i)] += *damping * normal[(i, i)].max(1e-12 * largest);
            }
            let step = damped.cholesky().map(|c| c.solve(&gradient));
            if let Some(step) = step {
                let mut trial = psi.to_vec();
                for (i, &k) in free.iter().enumerate() {
                    let range = &ranges[k];
                    let moved = if range.logarithmic {
                        psi[k] * libm::exp((-step[i]).clamp(-1.5, 1.5))
                    } else {
                        psi[k] - step[i]
                    };
                    trial[k] = moved.clamp(range.lower, range.upper);
                }
                if trial == psi {
                    return None;
                }
                let tried = self.at(tape, &trial, pinned, true);
                if tried.rss < point.rss {
                    *damping = (*damping * 0.1).max(1e-12);
                    let reduction = (point.rss - tried.rss) / point.rss;
                    return Some((trial, tried, reduction));
                }
            }
            *damping *= 8.0;
        }
        *damping = 1.0;
        None
    }

    /// Sum of squares with the non-linear constants held at `psi`.
    pub fn rss_at(&self, structure: &Structure, psi: &[f64]) -> f64 {
        self.at(&self.tape(structure), psi, None, false).rss
    }
}

impl Fit {
    /// The non-linear constants with their values.
    pub fn nonlinear(&self) -> Vec<(Nonlinear, f64)> {
        self.structure.nonlinear().into_iter().zip(self.params.iter().copied()).collect()
    }

    /// The coefficients of the terms.
    pub fn coefficients(&self) -> &[f64] {
        &self.params[self.params.len() - self.structure.terms().len()..]
    }
}
