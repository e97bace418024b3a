//! The step of the integer compensator, bit for bit against a reference of its own: written with products and divisions of wide numbers, where the
//! drive shifts.

use frikan_runtime::integer::{
    IntegerCompensator, IntegerLimits, LARGEST_TORQUE_COUNTS, LARGEST_VELOCITY_COUNTS, ONE, Units,
};
use frikan_shared::integer_table::{IntegerShape, REACH_BITS};
use frikan_shared::model::{Law, Model};
use frikan_shared::table::{Cell, Symmetry};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use crate::compile::reference::integer_value;
use crate::compile::verify::Comparison;

/// Words of a call as an emulated drive takes them.
pub const INTEGER_CALL_WORDS: usize = 7;

/// Limits that leave every friction as it is: gain, torque and slew.
const OPEN: [u16; 3] = [ONE, LARGEST_TORQUE_COUNTS as u16, u16::MAX];

/// One call of the step, with what the firmware does before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntegerCall {
    /// Whether the compensator is reset.
    pub reset: bool,
    /// Gain in `2^-15`, torque in counts, slew in counts a step.
    pub limits: [u16; 3],
    /// Velocity, counts.
    pub velocity: i32,
}

impl IntegerCall {
    /// The words of `tests/firmware/model/src/integer.rs`.
    #[must_use]
    pub fn words(&self, units: Units) -> [f32; INTEGER_CALL_WORDS] {
        let [gain, torque, slew] = self.limits.map(|limit| f32::from_bits(u32::from(limit)));
        let reset = f32::from_bits(u32::from(self.reset));
        [reset, gain, torque, slew, units.velocity, units.torque, f32::from_bits(self.velocity as u32)]
    }
}

/// A step at which answer and reference differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntegerDifference {
    /// Number of the step, from 0.
    pub step: u64,
    /// The call.
    pub call: IntegerCall,
    /// The torque that came out, counts.
    pub computed: i32,
    /// The torque of the reference, counts.
    pub expected: i32,
}

/// The counts in which a model's friction is a matter of 16 bits: the given ones, else the finest multiples of its steps by a power of two. None where the law is no
/// integer table.
#[must_use]
pub fn units<const CELLS: usize>(model: &Model<CELLS>, [velocity, torque]: [Option<f64>; 2]) -> Option<Units> {
    let (Law::IntegerTable(table), Some(top_speed)) = (&model.law, model.top_speed()) else { return None };
    let shape = table.shape();
    let most = LARGEST_TORQUE_COUNTS as f32;
    let doubled = |step: f32, bits: i32| step * 2f32.powi(bits);
    let finest_velocity = (-MOST_BITS..=MOST_BITS).map(|bits| doubled(shape.input_step, bits));
    let value = |cell: &Cell| cell.integers().into_iter().map(|c| c.unsigned_abs() as f32).sum::<f32>() + 3.0;
    let largest = model.cells.iter().map(value).fold(0.0, f32::max) * shape.output_step;
    let finest_torque = (0..=MOST_BITS).map(|bits| doubled(shape.output_step, bits));
    let given = |unit: Option<f64>| unit.map(|unit| unit as f32);
    let mut velocities = finest_velocity.filter(|unit| top_speed <= most * unit);
    let mut torques = finest_torque.filter(|unit| largest <= most * unit);
    Some(Units {
        velocity: given(velocity).or_else(|| velocities.next())?,
        torque: given(torque).or_else(|| torques.next())?,
    })
}

/// Most bits between a count and a step that are tried.
const MOST_BITS: i32 = 14;

/// The friction of a model in counts, and the step of the compensator that has it.
#[derive(Clone, Debug)]
pub struct IntegerReference<'a> {
    shape: IntegerShape,
    cells: &'a [Cell],
    /// Counts of a step of the table, and values of the table of a count of torque: powers of two.
    counts_a_step: f64,
    values_a_count: f64,
    /// The lowest and the highest count at which the friction still changes.
    range: [i64; 2],
    torque: i64,
}

impl<'a> IntegerReference<'a> {
    /// At rest; none where the law is no integer table.
    #[must_use]
    pub fn new<const CELLS: usize>(model: &'a Model<CELLS>, units: Units) -> Option<Self> {
        let (Law::IntegerTable(table), [input]) = (&model.law, &model.inputs[..]) else { return None };
        let shape = table.shape();
        let counts_a_step = f64::from(shape.input_step) / f64::from(units.velocity);
        let last = f64::from((1u32 << REACH_BITS) - 1);
        // Every count that is cut to the last step, or the last one that is not beyond it.
        let most =
            if counts_a_step >= 1.0 { (last + 1.0) * counts_a_step - 1.0 } else { (last * counts_a_step).floor() };
        let most = most.min(f64::from(LARGEST_VELOCITY_COUNTS));
        let end = |end: f32| (f64::from(end) / f64::from(units.velocity)).floor().clamp(0.0, most) as i64;
        Some(Self {
            shape,
            cells: &model.cells,
            counts_a_step,
            values_a_count: f64::from(units.torque) / f64::from(shape.output_step),
            range: [-end(-input.low), end(input.high)],
            torque: 0,
        })
    }

    /// The lowest and the highest count at which the friction still changes.
    #[must_use]
    pub fn range(&self) -> [i64; 2] {
        self.range
    }

    /// Friction at a velocity, both in counts.
    #[must_use]
    pub fn friction(&self, velocity: i32) -> i64 {
        let [low, high] = self.range;
        if velocity == 0 {
            return 0;
        }
        let held = i64::from(velocity).clamp(low.min(0), high.max(0));
        let steps = (held.unsigned_abs() as f64 / self.counts_a_step).floor() as i32;
        // The sign stays where the range ends at 0.
        let value = match (velocity < 0, steps) {
            (true, 0) => beside_zero(&self.shape, self.cells),
            (true, steps) => integer_value(&self.shape, self.cells, -steps),
            (false, steps) => integer_value(&self.shape, self.cells, steps),
        };
        (f64::from(value) / self.values_a_count + 0.5).floor() as i64
    }

    /// The torque after a call, counts.
    pub fn step(&mut self, call: &IntegerCall) -> i32 {
        if call.reset {
            self.torque = 0;
        }
        let [gain, torque, slew] = call.limits.map(i64::from);
        let share = (self.friction(call.velocity) * gain + i64::from(ONE) / 2).div_euclid(i64::from(ONE));
        self.torque += (share.clamp(-torque, torque) - self.torque).clamp(-slew, slew);
        self.torque as i32
    }
}

/// The value of a table at 0 as the end of the negative side, which [`integer_value`] has as that of the positive.
pub(super) fn beside_zero(shape: &IntegerShape, cells: &[Cell]) -> i32 {
    let side: usize = shape.cells.iter().copied().map(usize::from).sum();
    let cell = usize::from(shape.first_cell) + if shape.symmetry == Symmetry::Sided { side } else { 0 };
    let [value, ..] = cells[cell].integers();
    if shape.symmetry == Symmetry::Odd { -value } else { value }
}

/// Every count of the range of a model and a few beyond where they are at most `counts`, else so many of them, evenly; the ends of an `i32`; then half as many
/// steps through random counts with limits and resets. None where the law is no integer table.
#[must_use]
pub fn integer_calls<const CELLS: usize>(
    model: &Model<CELLS>,
    units: Units,
    counts: usize,
) -> Option<Vec<IntegerCall>> {
    let [low, high] = IntegerReference::new(model, units)?.range();
    let stride = ((high - low) as usize).div_ceil(counts).max(1);
    let open = |velocity: i32| IntegerCall { reset: false, limits: OPEN, velocity };
    let ends = [i32::MIN, i32::MIN + 1, i32::MAX, 0, 1, -1, low as i32, high as i32];
    let all = (low - BEYOND..=high + BEYOND).step_by(stride).map(|velocity| velocity as i32);
    let mut calls: Vec<IntegerCall> = all.chain(ends).map(open).collect();
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let span = (high - low) as u64 + 2 * BEYOND as u64;
    calls.extend((0..calls.len() / 2).map(|_| {
        let bits = random.next_u32();
        let [gain, torque, slew] = [random.next_u32(), random.next_u32(), random.next_u32()];
        let velocity = match bits % 8 {
            0 => random.next_u32() as i32,
            _ => (low - BEYOND) as i32 + (u64::from(random.next_u32()) % span.max(1)) as i32,
        };
        // Small limits are the ones that bind.
        let small = |bits: u32, most: u32| ((bits >> 8) % (most >> (bits % 12)).max(1)) as u16;
        let limits = [small(gain, u32::from(ONE) + 1), small(torque, 1 << 15), small(slew, 1 << 16).max(1)];
        IntegerCall { reset: bits >> 28 == 0, limits, velocity }
    }));
    Some(calls)
}

/// Counts beyond the range that are stepped through.
const BEYOND: i64 = 3;

/// Seed of the steps with limits.
const SEED: u64 = 53;

/// Compares the answers that a drive gives to `calls`, one after the other from its start, with those of the reference. A call without an answer counts as
/// compared and not equal. None where the law is no integer table.
#[must_use]
pub fn compare_integer_answers<const CELLS: usize>(
    model: &Model<CELLS>,
    units: Units,
    calls: &[IntegerCall],
    answers: impl IntoIterator<Item = i32>,
) -> Option<Comparison<IntegerDifference>> {
    let mut reference = IntegerReference::new(model, units)?;
    let difference =
        |step, call: &IntegerCall, computed, expected| IntegerDifference { step, call: *call, computed, expected };
    Some(Comparison::of_answers(calls, answers, |call| reference.step(call), difference))
}

/// The torque of the runtime's compensator after a call, counts.
pub fn integer_step(compensator: &mut IntegerCompensator<'_>, call: &IntegerCall) -> i32 {
    if call.reset {
        compensator.reset();
    }
    let [gain, torque, slew] = call.limits;
    // Limits that are refused leave those before in force.
    if let Ok(limits) = IntegerLimits::new(gain, torque, slew) {
        compensator.set_limits(limits);
    }
    compensator.step(call.velocity)
}
