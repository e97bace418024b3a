//! A law of the velocity as an integer table in the counts of a drive without floating-point unit.
//!
//! The input of the table is a count of the velocity times a power of two, its output a count of the torque divided by one, so that the drive needs
//! shifts alone ([`frikan_runtime::integer`]). Where the drive has no counts of its own, both are Q formats of 16 bits. How many cells a part of the
//! range takes, and by how many bits counts are shifted, follows from the law: the fewest cells with which every count is within the bound.
//!
//! The error is no estimate: the table is evaluated as the drive does it at every count of the trained range, and compared with the law there.
//! Beyond the range both hold.

pub mod steps;

use frikan_runtime::integer::{LARGEST_TORQUE_COUNTS, LARGEST_VELOCITY_COUNTS, Units};
use frikan_runtime::integer_table::evaluate_integer;
use frikan_shared::integer_table::{
    IntegerShape, IntegerTable, MAX_COEFFICIENT, MAX_SEGMENT_CELLS, REACH_BITS, SEGMENT_BITS, SEGMENTS,
};
use frikan_shared::pool::Pool;
use frikan_shared::table::{Cell, Symmetry};
use rayon::prelude::*;
use thiserror::Error;

use self::steps::beside_zero;
use super::cells::{Cubic, fit_cell, sampled_error};
use super::formula::{Parity, Sampled};
use super::host_model::CELLS;

/// Output steps that partial sums leave unused, for the rounding of coefficients and the flooring of shifts.
const SPARE_STEPS: i32 = 8;
/// Most bits between a value of the table and a count.
const MOST_OUTPUT_BITS: i32 = 14;
/// Smallest step that an image may have, in the unit of its channel.
const SMALLEST_STEP: f64 = 1.0e-9;
/// Steps of the table by which its values may be off the cubics: three shifts that cut, and four coefficients that are rounded.
const ROUNDING_STEPS: f64 = 5.0;
/// Shares of the bound to which the cubics keep at a few points of each cell, so that they keep to the bound at every count.
const PARTS: [f64; 3] = [1.0, 0.75, 0.5];
/// How often the bound is doubled at most.
const DOUBLINGS: i32 = 24;
/// Share of the largest friction by which the directions of an odd law may differ: the rounding of `f32`.
const ODD_SHARE: f64 = 1.0e-6;

/// A law of the velocity: from the velocity to the friction, in the units of the model, with a value everywhere.
pub type VelocityLaw<'a> = &'a (dyn Fn(f64) -> f64 + Sync);

/// What a table has to be made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Trained range of the velocity, in its unit.
    pub range: [f64; 2],
    /// Velocity of a count of the drive, in the unit of the velocity; chosen where there is none.
    pub velocity_count: Option<f64>,
    /// Torque of a count of the drive, in the unit of the friction; chosen where there is none.
    pub torque_count: Option<f64>,
    /// By how much the table may differ from the law where its cells suffice, in the unit of the friction; more only where they do not. The rounding to whole counts
    /// of torque and steps of the table comes to that.
    pub bound: f64,
    /// Most cells.
    pub cells: usize,
}

/// An integer table of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegerLaw {
    /// The table; its first cell is the first of the pool.
    pub table: IntegerTable,
    /// Cells in the order of the pool.
    pub cells: Vec<Cell>,
    /// What the counts of the drive are worth.
    pub units: Units,
    /// How far the drive is off the law.
    pub error: CountedError,
}

/// How far a drive that counts is off the law, over every count of the trained range, in the unit of the friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CountedError {
    /// Counts of the velocity that were compared.
    pub counts: u64,
    /// Largest difference of the torque put out, counts times their worth, from the law.
    pub largest: f64,
    /// Velocity at which it is, in its unit.
    pub at: f64,
    /// Root mean square of the difference.
    pub rms: f64,
    /// Largest friction of the law in the range.
    pub largest_friction: f64,
}

impl CountedError {
    /// The largest difference as a share of the largest friction.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.largest / self.largest_friction.max(f64::MIN_POSITIVE)
    }
}

/// Why a law did not become an integer table.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum IntegerError {
    /// The range is empty or not finite, or the law has no value somewhere in it.
    #[error("the law has no finite value everywhere from {low} to {high}")]
    Range {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// The trained range has no count, or more than 24 bits with the sign.
    #[error(
        "the trained range is {counts:.0} counts of the velocity; it has to be from 1 to {LARGEST_VELOCITY_COUNTS}"
    )]
    VelocityCount {
        /// Counts of the larger end.
        counts: f64,
    },
    /// The friction has more counts than 16 bits with the sign.
    #[error("the friction takes {counts:.0} counts of torque, {LARGEST_TORQUE_COUNTS} at most")]
    TorqueCount {
        /// Counts that a value of the table takes.
        counts: f64,
    },
    /// Not even the coarsest table has room.
    #[error("no integer table of at most {cells} cells follows the law")]
    Cells {
        /// Cells that there may be.
        cells: usize,
    },
}

/// Makes the integer table of `law`: the bound of `wanted` is doubled until the cells suffice.
///
/// # Errors
/// [`IntegerError`], one for each way in which it cannot be done.
pub fn compile_integers(law: VelocityLaw<'_>, wanted: &Wanted) -> Result<IntegerLaw, IntegerError> {
    let [low, high] = wanted.range;
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(IntegerError::Range { low, high });
    }
    // A Q format of 16 bits where the drive says nothing else.
    let velocity = match wanted.velocity_count {
        Some(count) => count as f32,
        None => power_of_two_above(low.abs().max(high.abs()) / f64::from(LARGEST_TORQUE_COUNTS)) as f32,
    };
    let scale = Scale::new(f64::from(velocity), wanted.range)?;
    let expected = Expected::new(law, &scale).ok_or(IntegerError::Range { low, high })?;
    let symmetry = expected.symmetry();
    let sides = if symmetry == Symmetry::Sided { 2 } else { 1 };
    // The signs share the cells of the side that reaches further.
    let [positive, negative] = scale.ends;
    let mirrored = |velocity: f64| -law(-velocity);
    let law: VelocityLaw<'_> = if symmetry == Symmetry::Odd && negative > positive { &mirrored } else { law };
    let mut refused = IntegerError::Cells { cells: wanted.cells };
    let bounds = (0..=DOUBLINGS).map(|doubling| wanted.bound * 2f64.powi(doubling));
    for (bound, part) in bounds.flat_map(|bound| PARTS.map(|part| (bound, part))) {
        let Some(segments) = segments(law, &scale, symmetry, part * bound) else { continue };
        let side: usize = segments.iter().copied().map(usize::from).sum();
        if side * sides > wanted.cells {
            continue;
        }
        match fill(law, &scale, (segments, symmetry), wanted.torque_count) {
            Ok((table, cells, torque)) => {
                let error = expected.error(&table, &cells, &scale, f64::from(torque));
                let rounding = 0.5 * f64::from(torque) + ROUNDING_STEPS * f64::from(table.shape().output_step);
                if error.largest <= bound + rounding {
                    return Ok(IntegerLaw { table, cells, units: Units { velocity, torque }, error });
                }
            }
            Err(error) => refused = error,
        }
    }
    Err(refused)
}

/// The counts of the velocity and the steps of the table.
struct Scale {
    /// Velocity of a count.
    count: f64,
    /// Last counts of the trained range, of positive and of negative velocities.
    ends: [u32; 2],
    /// Bits by which a count is shifted to the left, then to the right, to become steps.
    left: u32,
    right: u32,
}

impl Scale {
    fn new(count: f64, [low, high]: [f64; 2]) -> Result<Self, IntegerError> {
        let ends = [high, -low].map(|end| (end / count).floor().max(0.0));
        let most = ends[0].max(ends[1]);
        if !(1.0..=f64::from(LARGEST_VELOCITY_COUNTS)).contains(&most) {
            return Err(IntegerError::VelocityCount { counts: most });
        }
        let last = (1u32 << REACH_BITS) - 1;
        let most = most as u32;
        let left = (0..REACH_BITS).take_while(|left| most << left <= last).last().unwrap_or(0);
        let right = (0..u32::BITS).find(|right| most >> right <= last).unwrap_or(0);
        let scale = Self { count, ends: ends.map(|end| end as u32), left, right };
        if scale.step() < SMALLEST_STEP {
            Err(IntegerError::VelocityCount { counts: f64::from(most) })
        } else {
            Ok(scale)
        }
    }

    /// Velocity of a step of the table.
    fn step(&self) -> f64 {
        self.count * 2f64.powi(self.right as i32 - self.left as i32)
    }

    fn steps(&self, count: u32) -> i32 {
        ((count << self.left) >> self.right) as i32
    }
}

/// What the law has at every count, for positive and for negative velocities.
struct Expected([Vec<f64>; 2]);

/// Signs of the sides.
const SIGNS: [i32; 2] = [1, -1];

impl Expected {
    fn new(law: VelocityLaw<'_>, scale: &Scale) -> Option<Self> {
        let side = |sign: i32, end: u32| -> Vec<f64> {
            (0..=end).into_par_iter().map(|count| law(f64::from(sign) * f64::from(count) * scale.count)).collect()
        };
        let [positive, negative] = scale.ends;
        let sides = [side(1, positive), side(-1, negative)];
        sides.iter().flatten().all(|value| value.is_finite()).then_some(Self(sides))
    }

    fn largest(&self) -> f64 {
        self.0.iter().flatten().fold(0.0, |most, value| most.max(value.abs()))
    }

    /// Odd where the directions are alike as far as both reach.
    fn symmetry(&self) -> Symmetry {
        let [positive, negative] = &self.0;
        let tolerance = ODD_SHARE * self.largest();
        let odd = positive.iter().zip(negative).all(|(up, down)| (up + down).abs() <= tolerance);
        if odd { Symmetry::Odd } else { Symmetry::Sided }
    }

    /// The largest difference of what the drive puts out. At rest it puts out nothing, and so does the law.
    fn error(&self, table: &IntegerTable, cells: &[Cell], scale: &Scale, torque_count: f64) -> CountedError {
        let mut error = CountedError { counts: 1, largest_friction: self.largest(), ..CountedError::default() };
        let Ok(pool) = Pool::<CELLS>::from_slice(cells) else {
            return CountedError { largest: f64::INFINITY, ..error };
        };
        let shape = table.shape();
        let values_a_count = torque_count / f64::from(shape.output_step);
        let mut squares = 0.0;
        for (values, sign) in self.0.iter().zip(SIGNS) {
            for (count, value) in (0..).zip(values).skip(1) {
                let value_there = match (sign, scale.steps(count)) {
                    (-1, 0) => beside_zero(&shape, cells),
                    (_, steps) => evaluate_integer(table, &pool, sign * steps),
                };
                let counts = (f64::from(value_there) / values_a_count + 0.5).floor();
                let difference = (counts * torque_count - value).abs();
                error.counts += 1;
                squares += difference * difference;
                if difference > error.largest {
                    (error.largest, error.at) = (difference, f64::from(sign) * f64::from(count) * scale.count);
                }
            }
        }
        CountedError { rms: (squares / error.counts as f64).sqrt(), ..error }
    }
}

/// Fewest equal cells of each segment with which the cubics stay within `bound`, by a few points of each; none where a segment would take too many.
fn segments(law: VelocityLaw<'_>, scale: &Scale, symmetry: Symmetry, bound: f64) -> Option<[u8; SEGMENTS]> {
    let curve = Sampled { value: law, parity: Parity::Neither };
    let holds = |near: f64, far: f64| sampled_error(&curve, near, far, &fit_cell(&curve, near, far)) <= bound;
    let mut cells = [0; SEGMENTS];
    for (count, segment) in cells.iter_mut().zip(0u32..) {
        *count = (1..=MAX_SEGMENT_CELLS).find(|&count| {
            segment_edges(segment, count, scale.step())
                .all(|(near, far)| holds(near, far) && (symmetry != Symmetry::Sided || holds(-near, -far)))
        })?;
    }
    Some(cells)
}

/// Ends of the cells of a segment for positive velocities.
fn segment_edges(segment: u32, count: u8, step: f64) -> impl Iterator<Item = (f64, f64)> {
    let width = f64::from(1u32 << SEGMENT_BITS) / f64::from(count);
    let start = f64::from(segment << SEGMENT_BITS);
    let end = move |cell: u8| (start + width * f64::from(cell)) * step;
    (0..count).map(move |cell| (end(cell), end(cell + 1)))
}

/// Table, cells, and the torque of a count.
fn fill(
    law: VelocityLaw<'_>,
    scale: &Scale,
    (segments, symmetry): ([u8; SEGMENTS], Symmetry),
    torque_count: Option<f64>,
) -> Result<(IntegerTable, Vec<Cell>, f32), IntegerError> {
    let curve = Sampled { value: law, parity: Parity::Neither };
    let side = (0u32..).zip(segments).flat_map(|(segment, count)| segment_edges(segment, count, scale.step()));
    let side: Vec<(f64, f64)> = side.collect();
    let mirrored = side.iter().map(|&(near, far)| (-near, -far));
    let edges: Vec<(f64, f64)> = match symmetry {
        Symmetry::Sided => side.iter().copied().chain(mirrored).collect(),
        Symmetry::Odd | Symmetry::Even => side,
    };
    let cubics: Vec<Cubic> = edges.iter().map(|&(near, far)| fit_cell(&curve, near, far)).collect();
    // The finest step at which every partial sum keeps to its 16 bits, and the friction that every value keeps to.
    let sums = cubics.iter().map(|[_, c1, c2, c3]| c1.abs() + c2.abs() + c3.abs());
    let finest = sums.clone().fold(SMALLEST_STEP, f64::max) / f64::from(MAX_COEFFICIENT - SPARE_STEPS);
    let largest = cubics.iter().zip(sums).fold(0.0, |most: f64, ([c0, ..], sum)| most.max(c0.abs() + sum));
    let spared = f64::from(LARGEST_TORQUE_COUNTS - SPARE_STEPS);
    let torque = match torque_count {
        Some(count) => f64::from(count as f32),
        None => power_of_two_above(finest.max(largest / spared)),
    };
    let counts = largest / torque;
    let bits = (torque / finest.max(SMALLEST_STEP)).log2().floor();
    if counts > spared || bits < 0.0 {
        return Err(IntegerError::TorqueCount { counts: counts.max(finest * f64::from(MAX_COEFFICIENT) / torque) });
    }
    let unit = torque * 2f64.powi(-(bits as i32).min(MOST_OUTPUT_BITS));
    let whole = |cubic: &Cubic| Cell::from_integers(cubic.map(|c| (c / unit).round() as i32));
    let (first_cell, input_step, output_step) = (0, scale.step() as f32, unit as f32);
    let table = IntegerTable::new(IntegerShape { first_cell, cells: segments, symmetry, input_step, output_step });
    Ok((table, cubics.iter().map(whole).collect(), torque as f32))
}

/// The Q format of a count of 16 bits with the sign, where its worth is a power of two from `2^-15` to 1: `Q3.12` for `2^-12`.
#[must_use]
pub fn q_format(count: f32) -> Option<String> {
    // From 0, so that a count of 1 has no -0.
    let fraction_bits = 0.0 - f64::from(count).log2();
    let is_format = fraction_bits.fract() == 0.0 && (0.0..=15.0).contains(&fraction_bits);
    is_format.then(|| format!("Q{}.{fraction_bits}", 15.0 - fraction_bits))
}

/// The smallest power of two that is not less.
fn power_of_two_above(number: f64) -> f64 {
    2f64.powi(number.log2().ceil() as i32)
}

#[cfg(test)]
mod tests;
