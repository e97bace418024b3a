//! What the statistics do when nothing is missing: draws of moving blocks of the residual with random signs and places,
//! the tail of every hypothesis' statistic, and the family-wise probability (Westfall and Young 1993).

use crate::numerics::least_squares::{dot, project_out, rows_in};
use crate::numerics::random::uniform;
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use std::ops::Range;

/// Length of a moving block in whitened rows (Kuensch 1989), about two seconds at the usual rates of working rows.
/// Raised from 64: it has to be longer than the colour that whitening leaves, or slow hypotheses seem too surprising;
/// longer leaves fewer independent blocks.
const BLOCK_ROWS: usize = 256;

/// The tails of every hypothesis' statistic where nothing is missing, fitted to the null draws.
#[derive(Clone, Debug)]
pub struct NullDraws {
    /// For each group, location and scale of the Gumbel tail of its statistic in -log p.
    tails: Vec<(f64, f64)>,
    /// Family of each group.
    families: Vec<Family>,
    /// Effective number of independent hypotheses of each family.
    effective: [f64; 2],
}

/// The two families of hypotheses. Each has a share of the false alarms to itself, so that the many structures without a name,
/// which are rarely what is missing, do not cost the effects that have one their power (weighted Bonferroni; Holm 1979).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Effects of the catalogue.
    Named,
    /// Structures without a name.
    Generic,
}

impl Family {
    /// Share of the false alarms.
    fn share(self) -> f64 {
        match self {
            Family::Named => 0.97,
            Family::Generic => 0.03,
        }
    }
}

/// Directions of each variant of a hypothesis, orthonormal and one value a row.
pub(crate) type Directions = Vec<Vec<Vec<f64>>>;

/// Draws whose statistics are worked out at a time: some 8 B a row each.
const DRAWS_AT_A_TIME: usize = 32;

/// What the null draws know of a hypothesis.
pub(crate) struct NullGroup<'a> {
    /// Its family.
    pub family: Family,
    /// Whether its coefficients may only be positive.
    pub only_positive: bool,
    /// Makes the directions of its variants, with the base projected out; that of a single column has its sign.
    pub directions: Box<dyn Fn() -> Directions + Sync + Send + 'a>,
}

/// -log of the upper tail of chi-square.
pub(crate) fn chi_square_surprise(statistic: f64, degrees: usize) -> f64 {
    if statistic <= 0.0 || degrees == 0 {
        return 0.0;
    }
    let half = 0.5 * degrees as f64;
    let tail = statrs::function::gamma::checked_gamma_ur(half, 0.5 * statistic).unwrap_or(1.0);
    if tail > 1e-280 {
        -tail.ln()
    } else {
        // Leading term of the asymptotic series.
        0.5 * statistic - (half - 1.0) * (0.5 * statistic).ln() + statrs::function::gamma::ln_gamma(half)
    }
}

impl NullDraws {
    /// Draws the null `count` times. `residual` is whitened, what the base and the clear candidates leave.
    pub(crate) fn draw(groups: &[NullGroup], residual: &[f64], runs: &[Range<usize>], count: usize, seed: u64) -> Self {
        let rows = rows_in(runs);
        let gather =
            |column: &[f64]| -> Vec<f64> { runs.iter().flat_map(|run| column[run.clone()].iter().copied()).collect() };
        let pool = gather(residual);
        let packed_runs = [0..rows];
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let draws: Vec<Vec<Block>> = (0..count)
            .map(|_| (0..rows.div_ceil(BLOCK_ROWS)).map(|_| Block::draw(&mut random, rows)).collect())
            .collect();
        // One group after the other, so that only one group's directions and draws are held at a time.
        let surprises: Vec<Vec<f64>> = groups
            .par_iter()
            .map(|NullGroup { family, only_positive, directions }| {
                let mut variants = directions();
                variants.iter_mut().flatten().for_each(|direction| *direction = gather(direction));
                // What a named effect explains is its evidence and no measure of its chance (ter Braak 1992). A series of a dozen
                // terms also holds the slow noise itself.
                let own = match family {
                    Family::Named => strongest(&variants, &pool),
                    Family::Generic => None,
                };
                let mut pool = pool.clone();
                if let Some(own) = own {
                    project_out(&mut pool, own, &packed_runs);
                }
                // The directions are free of the base, so that what a draw has of it does not count.
                let largest = |draws: &[Vec<Block>]| {
                    let values = draws.iter().flat_map(|blocks| resample(&pool, blocks)).collect();
                    largest_surprises(&variants, *only_positive, &DMatrix::from_vec(rows, draws.len(), values))
                };
                draws.chunks(DRAWS_AT_A_TIME).flat_map(largest).collect()
            })
            .collect();
        let families: Vec<Family> = groups.iter().map(|group| group.family).collect();
        let tails: Vec<(f64, f64)> = surprises.iter().map(|values| gumbel(values)).collect();
        // min-p over a family: 1 - (1 - p)^K with K fitted to the draws.
        let effective = [Family::Named, Family::Generic].map(|family| {
            let members: Vec<usize> = (0..families.len()).filter(|&group| families[group] == family).collect();
            let log_survival = |draw: usize| {
                let alone = |&group: &usize| tail_probability(surprises[group][draw], tails[group]);
                (1.0 - members.iter().map(alone).fold(1.0, f64::min)).max(1e-300).ln()
            };
            let log_survivals: f64 = (0..count).map(log_survival).sum();
            (count as f64 / -log_survivals).clamp(1.0, 10.0 * members.len().max(1) as f64)
        });
        Self { tails, families, effective }
    }

    /// Family-wise probability that a group's surprise (-log p of its best variant) arises when nothing is missing, over the
    /// share of false alarms that its family has.
    pub fn family_wise(&self, group: usize, surprise: f64) -> f64 {
        let alone = tail_probability(surprise, self.tails[group]);
        let family = self.families[group];
        let within = -(self.effective[family as usize] * (-alone).ln_1p()).exp_m1();
        (within / family.share()).min(1.0)
    }
}

/// A stretch of the residual in a draw: where it begins, and with which sign it is taken.
struct Block {
    start: usize,
    sign: f64,
}

impl Block {
    fn draw(random: &mut ChaCha8Rng, rows: usize) -> Self {
        let start = (uniform(random) * rows as f64) as usize;
        Self { start, sign: if uniform(random) < 0.5 { -1.0 } else { 1.0 } }
    }
}

/// A pool of residuals in another order: block behind block, from its end on at its beginning.
fn resample(pool: &[f64], blocks: &[Block]) -> Vec<f64> {
    let value = |i: usize| {
        let Block { start, sign } = blocks[i / BLOCK_ROWS];
        sign * pool[(start + i % BLOCK_ROWS) % pool.len()]
    };
    (0..pool.len()).map(value).collect()
}

/// The variant with the largest surprise in a residual; `None` where there are no variants.
fn strongest<'v>(variants: &'v [Vec<Vec<f64>>], residual: &[f64]) -> Option<&'v Vec<Vec<f64>>> {
    let surprising = variants.iter().map(|variant| {
        let energy = variant.iter().map(|d| dot(d, residual, &[0..residual.len()]).powi(2)).sum();
        (chi_square_surprise(energy, variant.len()), variant)
    });
    surprising.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, variant)| variant)
}

/// The largest surprise among the variants of a group, for each draw (a column). A single coefficient of an impossible sign is none;
/// several count with any sign, which errs on the side of caution.
fn largest_surprises(variants: &[Vec<Vec<f64>>], only_positive: bool, draws: &DMatrix<f64>) -> Vec<f64> {
    let flat: Vec<&Vec<f64>> = variants.iter().flatten().collect();
    let shares = DMatrix::from_fn(flat.len(), draws.nrows(), |i, j| flat[i][j]) * draws;
    let largest = |draw: usize| {
        let mut row = 0;
        let mut largest = 0.0f64;
        for variant in variants {
            let of_variant = shares.view((row, draw), (variant.len(), 1));
            row += variant.len();
            if only_positive && variant.len() == 1 && of_variant[0] < 0.0 {
                continue;
            }
            let energy = of_variant.norm_squared();
            largest = largest.max(chi_square_surprise(energy, variant.len()));
        }
        largest
    };
    (0..draws.ncols()).map(largest).collect()
}

/// Gumbel location and scale by moments; the scale is at least one, that of independent exponential tails.
fn gumbel(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let scale = (6.0 * variance).sqrt() / std::f64::consts::PI;
    let scale = scale.max(1.0);
    (mean - 0.577_215_664_9 * scale, scale)
}

fn tail_probability(surprise: f64, (location, scale): (f64, f64)) -> f64 {
    -(-(-(surprise - location) / scale).exp()).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random::normal;

    fn group(family: Family, only_positive: bool, variant: &[Vec<f64>]) -> NullGroup<'_> {
        NullGroup { family, only_positive, directions: Box::new(|| vec![variant.to_vec()]) }
    }

    /// White noise, and a constant direction of as many rows.
    fn noise_and_direction(rows: usize, seed: u64) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        ((0..rows).map(|_| normal(&mut random)).collect(), vec![vec![(rows as f64).powf(-0.5); rows]])
    }

    #[test]
    fn what_can_have_one_sign_alone_is_half_as_likely_by_chance() {
        let rows = 4_000;
        let (noise, direction) = noise_and_direction(rows, 8);
        let runs = std::iter::once(0..rows).collect::<Vec<_>>();
        let chance = |only_positive: bool| {
            let null = NullDraws::draw(&[group(Family::Named, only_positive, &direction)], &noise, &runs, 400, 1);
            null.family_wise(0, chi_square_surprise(12.0, 1))
        };
        let ratio = chance(true) / chance(false);
        assert!((0.35..0.7).contains(&ratio), "{ratio}");
    }

    #[test]
    fn what_a_direction_explains_does_not_widen_its_own_null() {
        let rows = 2_000;
        let (noise, direction) = noise_and_direction(rows, 3);
        let chance = |effect: f64| {
            let residual: Vec<f64> = noise.iter().zip(&direction[0]).map(|(e, d)| e + effect * d).collect();
            let group = group(Family::Named, false, &direction);
            let runs = std::iter::once(0..rows).collect::<Vec<_>>();
            let null = NullDraws::draw(&[group], &residual, &runs, 200, 1);
            null.family_wise(0, chi_square_surprise(25.0, 1))
        };
        let (with, without) = (chance(5.0), chance(0.0));
        assert!(with < 2.0 * without, "{with} against {without}");
        assert!(with < 1e-4);
    }

    #[test]
    fn a_long_series_is_not_taken_for_an_effect_where_the_noise_is_slow() {
        let rows = 1_500;
        let direction = |order: usize| -> Vec<f64> {
            let angle = std::f64::consts::PI * order as f64 / rows as f64;
            (0..rows).map(|i| (2.0 / rows as f64).sqrt() * (angle * (i as f64 + 0.5)).cos()).collect()
        };
        let series: Vec<Vec<f64>> = (1..=12).map(direction).collect();
        let runs = std::iter::once(0..rows).collect::<Vec<_>>();
        let is_surprising = |seed: u64| {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut slow = 0.0;
            let noise: Vec<f64> = (0..rows)
                .map(|_| {
                    slow = 0.97 * slow + 0.03 * normal(&mut random);
                    slow + normal(&mut random)
                })
                .collect();
            let energy: f64 = series.iter().map(|d| dot(d, &noise, &runs).powi(2)).sum();
            let group = group(Family::Generic, false, &series);
            let null = NullDraws::draw(&[group], &noise, &runs, 60, seed);
            tail_probability(chi_square_surprise(energy, series.len()), null.tails[0]) < 0.03
        };
        let alarms = (0..40).filter(|seed| is_surprising(*seed)).count();
        assert!(alarms <= 3, "{alarms} of 40");
    }
}
