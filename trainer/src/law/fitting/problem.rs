//! Least squares for one structure: variable projection over the linear coefficients (Golub & Pereyra 1973, in the
//! approximation of Kaufman 1975), a descent over the few non-linear constants.

mod descent;
pub mod grid;
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
    /// Stops where less than so many variances of the residuals are left to be taken off the sum of squares; a standard error is what
    /// raises it by one.
    pub tolerance: f64,
}

impl Effort {
    /// Enough to rank structures.
    pub const SEARCH: Self = Self { iterations: 25, tolerance: 1e-3 };
    /// Enough to compare structures by what they leave.
    pub const COMPARISON: Self = Self { iterations: 200, tolerance: 1e-3 };
    /// To a thousandth of the standard errors.
    pub const FINAL: Self = Self { iterations: 200, tolerance: 1e-6 };
}

/// Expressions evaluated for every sample: at its channels, or averaged over its states.
#[derive(Debug)]
pub struct RowTape<'a> {
    tape: Tape,
    averages: Option<&'a Averages>,
}

impl RowTape<'_> {
    /// As [`Tape::run`].
    pub fn run(&self, params: &[f64], slopes: &[usize]) -> Columns {
        let mut columns = self.tape.run(params, slopes);
        if let Some(averages) = self.averages {
            let of_slopes = columns.slopes.iter_mut().flatten().flatten();
            columns.values.iter_mut().chain(of_slopes).for_each(|column| *column = averages.over(column));
        }
        columns
    }
}

/// What is left of the target where the non-linear constants have certain values, the coefficients being the best for them.
struct Point {
    rss: f64,
    residual: Vec<f64>,
    coefficients: Vec<f64>,
    independent: Vec<bool>,
    /// Of the residual, for each constant that was asked for.
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

    /// The fit optimised as far as the samples can tell, the constants in `held` being left where they are.
    pub fn polish(&self, fit: &Fit, held: &[Nonlinear]) -> Fit {
        self.fit_from(&fit.structure, fit.constants(), Held { nonlinear: held, coefficient: None }, Effort::FINAL)
    }

    fn tape(&self, structure: &Structure) -> RowTape<'_> {
        self.tape_of(&structure.columns(self.extents.layout()))
    }

    /// Expressions of the channels that are evaluated for every sample.
    pub fn tape_of(&self, outputs: &[Expr]) -> RowTape<'_> {
        let averages = self.data.states.as_ref().map(|states| &states.averages);
        let places = self.channels.first().map_or(0, |channel| channel.len());
        RowTape { tape: Tape::new(outputs, &self.channels, places), averages }
    }

    /// What is left at `psi`, and how that changes with the non-linear constants in `slopes`.
    fn at(&self, tape: &RowTape<'_>, psi: &[f64], pinned: Option<(usize, f64)>, slopes: &[usize]) -> Point {
        let mut columns = tape.run(psi, slopes);
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
        let derivative = |i: usize| {
            let mut d = vec![0.0; self.rows()];
            for (slopes, &c) in columns.slopes.iter().zip(&coefficients) {
                if let Some(slope) = &slopes[i] {
                    d.iter_mut().zip(slope).for_each(|(d, s)| *d -= c * s);
                }
            }
            self.nuisance.remove_from(&mut d);
            basis.remove_from(&mut d);
            d
        };
        let jacobian = (0..slopes.len()).map(derivative).collect();
        Point { rss: dot(&residual, &residual), residual, coefficients, independent: basis.independent(), jacobian }
    }

    /// Ranges of the non-linear constants of a structure.
    pub fn ranges(&self, structure: &Structure) -> Vec<Range> {
        structure.nonlinear().into_iter().map(|n| self.extents.range(n, structure.sign())).collect()
    }

    /// Sums of squares of a structure with its non-linear constants held.
    pub fn sums(&self, structure: &Structure) -> impl Fn(&[f64]) -> f64 {
        let tape = self.tape(structure);
        move |psi| self.at(&tape, psi, None, &[]).rss
    }
}

impl Fit {
    /// The non-linear constants with their values.
    pub fn nonlinear(&self) -> Vec<(Nonlinear, f64)> {
        self.structure.nonlinear().into_iter().zip(self.params.iter().copied()).collect()
    }

    /// The values of the non-linear constants.
    pub fn constants(&self) -> &[f64] {
        &self.params[..self.params.len() - self.structure.terms().len()]
    }

    /// The coefficients of the terms.
    pub fn coefficients(&self) -> &[f64] {
        &self.params[self.params.len() - self.structure.terms().len()..]
    }
}
