//! Evidence for one set of columns against the base: score statistic, held-out gain, Bayesian criterion.

use crate::diagnose::evidence::law_uncertainty::LawUncertainty;
use crate::numerics::least_squares::{
    Factored, dot, gram, moments, orthonormal, project_out, ridged_gram, rows_in, solve_symmetric, unit_diagonal,
};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Whitened base and target, with the sums of every block: all that the evidence needs besides the candidate.
#[derive(Clone, Debug)]
pub struct Bench {
    /// Whitened target.
    pub target: Vec<f64>,
    /// Runs of each open block.
    pub blocks: Vec<Vec<Range<usize>>>,
    /// Orthonormal directions of the base.
    base_directions: Vec<Vec<f64>>,
    law_uncertainty: LawUncertainty,
    /// Whitened columns of the base, then of the errors of the law.
    beside: Vec<Vec<f64>>,
    /// How many of them are of the base.
    of_base: usize,
    sums: Vec<BlockSums>,
}

#[derive(Clone, Debug)]
struct BlockSums {
    base: DMatrix<f64>,
    base_target: DVector<f64>,
    target: f64,
    rows: f64,
}

/// Evidence for one variant of a hypothesis.
#[derive(Clone, Debug)]
pub struct VariantEvidence {
    /// Explained whitened energy: chi-square with `degrees` under the null.
    pub statistic: f64,
    /// Linear coefficients.
    pub degrees: usize,
    /// Price of the coefficients in nats: half the logarithm of the rows for each; for a series with a prior that of the
    /// marginal likelihood.
    pub complexity: f64,
    /// Linear coefficients of the candidate, on whitened columns as they were given.
    pub coefficients: Vec<f64>,
    /// Residual energy over all open blocks.
    pub residual: f64,
    /// Residual energy of the training part of each fold.
    pub fold_train: Vec<f64>,
    /// Logarithm of the predictive density of each fold, given the others.
    pub fold_likelihood: Vec<f64>,
}

impl VariantEvidence {
    /// Bayesian criterion over the base in nats; free of the scale of the noise.
    pub fn criterion(&self, rows: f64) -> f64 {
        self.criterion_of(rows, self.residual + self.statistic, self.residual)
    }

    /// The criterion by the energy that the base leaves and the energy left with the candidate.
    fn criterion_of(&self, rows: f64, base_energy: f64, energy: f64) -> f64 {
        0.5 * rows * (base_energy / energy).ln() - self.complexity
    }
}

impl Bench {
    /// Collects the sums of each block. `uncertain` is the whitened torque of each direction in which the law is not sure of itself, at
    /// one standard deviation.
    pub fn new(
        base: Vec<Vec<f64>>,
        uncertain: Vec<Vec<f64>>,
        target: Vec<f64>,
        blocks: Vec<Vec<Range<usize>>>,
    ) -> Self {
        let runs: Vec<Range<usize>> = blocks.iter().flatten().cloned().collect();
        let base_directions = orthonormal(&base, &runs);
        let law_uncertainty = LawUncertainty::beside(&base_directions, uncertain, &runs);
        let of_base = base.len();
        let beside = [base, law_uncertainty.columns()].concat();
        let sums = blocks
            .iter()
            .map(|runs| BlockSums {
                base: gram(&beside, runs),
                base_target: moments(&beside, &target, runs),
                target: dot(&target, &target, runs),
                rows: rows_in(runs) as f64,
            })
            .collect();
        Self { target, blocks, base_directions, law_uncertainty, beside, of_base, sums }
    }

    /// Whitened columns of the base.
    pub fn base(&self) -> &[Vec<f64>] {
        &self.beside[..self.of_base]
    }

    /// What base and errors of the law leave of a whitened column, where both count as noise of unit variance.
    pub fn take_off_base(&self, column: &mut [f64]) {
        let runs = self.runs();
        project_out(column, &self.base_directions, &runs);
        self.law_uncertainty.whiten(column, &runs);
    }

    /// What base and errors of the law leave of the target, in the same measure.
    pub fn target_beside_base(&self) -> Vec<f64> {
        let mut target = self.target.clone();
        self.take_off_base(&mut target);
        target
    }

    /// Prior precision of each column beside a candidate: none for the base, one for the errors of the law.
    fn prior(&self) -> DMatrix<f64> {
        DMatrix::from_diagonal(&DVector::from_fn(self.beside.len(), |i, _| f64::from(u8::from(i >= self.of_base))))
    }

    /// All open runs.
    pub fn runs(&self) -> Vec<Range<usize>> {
        self.blocks.iter().flatten().cloned().collect()
    }

    /// Whitened rows in use.
    pub fn rows(&self) -> f64 {
        self.sums.iter().map(|sums| sums.rows).sum()
    }

    /// Evidence of the base alone.
    pub fn alone(&self) -> Option<VariantEvidence> {
        self.evidence(&[])
    }

    /// Evidence of the base with the given whitened columns; `None` where they depend on the base.
    pub fn evidence(&self, columns: &[Vec<f64>]) -> Option<VariantEvidence> {
        self.weigh(columns, &[], true)
    }

    /// Drops the whitened columns that the base and those before them hold.
    pub fn retain_independent(&self, columns: &mut Vec<Vec<f64>>) {
        let runs = self.runs();
        let mut held = self.base_directions.clone();
        columns.retain(|column| {
            let mut free = column.clone();
            project_out(&mut free, &held, &runs);
            let share = dot(&free, &free, &runs) / dot(column, column, &runs);
            if share > LEAST_INDEPENDENT_SHARE {
                held.extend(orthonormal(&[free], &runs));
            }
            share > LEAST_INDEPENDENT_SHARE
        });
    }

    /// As [`Self::evidence`], with the held-out folds only where asked for. `ridge` is the prior precision of each
    /// coefficient over what all rows tell of it; empty for none.
    pub fn weigh(&self, columns: &[Vec<f64>], ridge: &[f64], folds: bool) -> Option<VariantEvidence> {
        let (p, d) = (self.beside.len(), columns.len());
        let blocks: Vec<(DMatrix<f64>, DVector<f64>)> = self
            .blocks
            .iter()
            .zip(&self.sums)
            .map(|(runs, sums)| {
                let mut normal = DMatrix::zeros(p + d, p + d);
                let mut right = DVector::zeros(p + d);
                normal.view_mut((0, 0), (p, p)).copy_from(&sums.base);
                right.rows_mut(0, p).copy_from(&sums.base_target);
                for (a, column) in columns.iter().enumerate() {
                    right[p + a] = dot(column, &self.target, runs);
                    for (b, base) in self.beside.iter().enumerate() {
                        let value = dot(column, base, runs);
                        normal[(p + a, b)] = value;
                        normal[(b, p + a)] = value;
                    }
                    for (b, other) in columns.iter().enumerate().take(a + 1) {
                        let value = dot(column, other, runs);
                        normal[(p + a, p + b)] = value;
                        normal[(p + b, p + a)] = value;
                    }
                }
                (normal, right)
            })
            .collect();
        let normal: DMatrix<f64> = blocks.iter().fold(DMatrix::zeros(p + d, p + d), |sum, (n, _)| sum + n);
        let right: DVector<f64> = blocks.iter().fold(DVector::zeros(p + d), |sum, (_, r)| sum + r);
        let mut prior = DMatrix::<f64>::zeros(p + d, p + d);
        prior.view_mut((0, 0), (p, p)).copy_from(&self.prior());
        for (a, share) in ridge.iter().enumerate() {
            prior[(p + a, p + a)] = (share * normal[(p + a, p + a)]).max(f64::MIN_POSITIVE);
        }
        let posterior = &normal + &prior;
        if d > 0 && ridge.is_empty() && !independent(&posterior, p) {
            return None;
        }
        let energy: f64 = self.sums.iter().map(|sums| sums.target).sum();
        let base_residual = energy - explained(&posterior.view((0, 0), (p, p)).into(), &right.rows(0, p).into())?;
        let full = Factored::new(&posterior)?;
        let solution = full.solve(&right)?;
        let residual = energy - solution.dot(&right);
        let coefficients = solution.iter().skip(p).copied().collect();
        let rows = self.rows();
        let complexity = if ridge.is_empty() {
            0.5 * d as f64 * rows.ln()
        } else {
            let lower = posterior.clone().cholesky()?.l();
            (p..p + d).map(|i| 0.5 * (lower[(i, i)] * lower[(i, i)] / prior[(i, i)]).ln()).sum()
        };
        let mut fold_train = Vec::with_capacity(blocks.len());
        let mut fold_likelihood = Vec::with_capacity(blocks.len());
        for ((block_normal, block_right), sums) in blocks.iter().zip(&self.sums).filter(|_| folds) {
            // The predictive density of a block: what its other blocks do not determine makes it wide, not wrong.
            let right = &right - block_right;
            let trained = Factored::scaled(&(&posterior - block_normal), unit_diagonal(&posterior))?;
            let train = (energy - sums.target - trained.solve(&right)?.dot(&right)).max(f64::MIN_POSITIVE);
            let variance = train / (rows - sums.rows - (p + d) as f64).max(1.0);
            let width = full.log_determinant() - trained.log_determinant();
            fold_train.push(train);
            fold_likelihood.push(-0.5 * (sums.rows * variance.ln() + (residual - train) / variance + width));
        }
        Some(VariantEvidence {
            statistic: base_residual - residual,
            degrees: d,
            complexity,
            coefficients,
            residual,
            fold_train,
            fold_likelihood,
        })
    }

    /// Energy of a whitened column that the base cannot hold: the non-centrality of unit amplitude.
    pub fn visible_energy(&self, column: &[f64]) -> Option<f64> {
        let runs = self.runs();
        let right = moments(&self.beside, column, &runs);
        let normal = self.sums.iter().fold(self.prior(), |sum, s| sum + &s.base);
        let energy = dot(column, column, &runs) - explained(&normal, &right)?;
        (energy > 0.0).then_some(energy)
    }

    /// Coefficients of the base. `ridge` as in [`Self::weigh`], one a base column.
    pub fn solve(&self, ridge: &[f64]) -> Option<Vec<f64>> {
        let runs = self.runs();
        let normal = ridged_gram(self.base(), ridge, &runs);
        Some(solve_symmetric(&normal, &moments(self.base(), &self.target, &runs))?.iter().copied().collect())
    }
}

fn explained(normal: &DMatrix<f64>, right: &DVector<f64>) -> Option<f64> {
    if right.is_empty() {
        return Some(0.0);
    }
    solve_symmetric(normal, right).map(|solution| solution.dot(right))
}

/// Share (0..1) of its energy that a regressor keeps beside the base and the regressors before it, above which it is
/// independent of them. Chosen by judgement: far above roundoff (1e-11 is added to the unit diagonal); smaller lets
/// roundoff decide, larger drops weak regressors.
const LEAST_INDEPENDENT_SHARE: f64 = 1e-5;

/// Whether each candidate column keeps a share of its energy that the base (and the columns before) cannot hold.
fn independent(normal: &DMatrix<f64>, base: usize) -> bool {
    let size = normal.nrows();
    let scale: Vec<f64> = normal.diagonal().iter().map(|d| d.max(0.0).sqrt()).collect();
    if scale.iter().skip(base).any(|s| *s <= 0.0) {
        return false;
    }
    let correlation = DMatrix::from_fn(size, size, |i, j| {
        let ridge = if i == j { 1e-11 } else { 0.0 };
        let product = scale[i] * scale[j];
        ridge + if product > 0.0 { normal[(i, j)] / product } else { 0.0 }
    });
    correlation.cholesky().is_some_and(|factor| {
        let lower = factor.l();
        (base..size).all(|i| lower[(i, i)] * lower[(i, i)] > LEAST_INDEPENDENT_SHARE)
    })
}

/// Logarithm of a sum of exponentials.
fn log_sum(logarithms: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = logarithms.clone().fold(f64::NEG_INFINITY, f64::max);
    largest + logarithms.map(|l| (l - largest).exp()).sum::<f64>().ln()
}

/// Evidence for a group: in each fold its variants are averaged with the weights that the other folds give them, so that a
/// near tie of two shapes does not hang on the one that was chosen.
#[derive(Clone, Debug)]
pub struct GroupEvidence {
    /// Index of the variant with the best criterion over all open blocks.
    pub best: usize,
    /// Score statistic of that variant.
    pub statistic: f64,
    /// Its linear coefficients.
    pub degrees: usize,
    /// SimulatedEffect-out gain over the base in nats.
    pub held_out: f64,
    /// Gain of each fold.
    pub fold_gain: Vec<f64>,
    /// Bayesian criterion over the base in nats, grid included.
    pub criterion: f64,
}

impl GroupEvidence {
    /// Estimate of the non-centrality: the statistic less what noise alone gives so many coefficients.
    pub fn beyond_noise(&self) -> f64 {
        self.statistic - self.degrees as f64
    }

    /// Weighs the variants of a group against the base.
    pub fn weigh(
        base: &VariantEvidence,
        variants: &[Option<VariantEvidence>],
        rows: f64,
        grid_size: f64,
    ) -> Option<Self> {
        let criterion = |variant: &VariantEvidence| variant.criterion_of(rows, base.residual, variant.residual);
        let tested = || variants.iter().enumerate().filter_map(|(i, v)| v.as_ref().map(|v| (i, v)));
        let (best, variant) = tested().max_by(|(_, a), (_, b)| criterion(a).total_cmp(&criterion(b)))?;
        let folds = base.fold_likelihood.len();
        let fold_gain: Vec<f64> = (0..folds)
            .map(|fold| {
                let weighed: Vec<(f64, f64)> = tested()
                    .map(|(_, v)| {
                        let trained = v.criterion_of(rows, base.fold_train[fold], v.fold_train[fold]);
                        (trained, v.fold_likelihood[fold] - base.fold_likelihood[fold])
                    })
                    .collect();
                let joint = log_sum(weighed.iter().map(|(trained, gain)| trained + gain));
                joint - log_sum(weighed.iter().map(|(trained, _)| *trained))
            })
            .collect();
        Some(Self {
            best,
            statistic: variant.statistic,
            degrees: variant.degrees,
            held_out: fold_gain.iter().sum(),
            fold_gain,
            criterion: criterion(variant) - 0.5 * grid_size.ln(),
        })
    }
}
