//! An integer table in flash, with the shifts between its steps and the counts of a drive.

use core::hint::black_box;

use frikan_shared::image::{Cells, Checksum, ImageError, IntegerTableImage};
use frikan_shared::integer_table::{SEGMENT_BITS, SEGMENTS, WAY_BITS};
use frikan_shared::invalid::InvalidModel;
use frikan_shared::table::Symmetry;

use crate::laws::integer_table::{LAST, cubic, positive_part, sign};

/// What a count of the drive is worth: of velocity, rad/s, and of torque, N m (or what else the image has as units). Positive and not subnormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// A count of the velocity.
    pub velocity: f32,
    /// A count of the torque.
    pub torque: f32,
}

/// Velocities of more counts hold the friction that this many have; 24 bits with the sign.
pub const LARGEST_VELOCITY_COUNTS: i32 = (1 << 23) - 1;

/// Most counts of a torque: 16 bits with the sign.
pub const LARGEST_TORQUE_COUNTS: i32 = i16::MAX as i32;

/// Most bits by which the output is shifted: a value of [`LARGEST_TORQUE_COUNTS`] still keeps to its range.
const MOST_OUTPUT_BITS: u32 = 14;

/// The integer table of an image in flash, for the counts of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegerTableInPlace<'a> {
    cells: Cells<'a>,
    /// Cells of each segment.
    segments: &'a [u8; SEGMENTS],
    /// The first cell of each segment, for positive velocities.
    starts: [u16; SEGMENTS],
    /// Cells by which those of negative velocities lie further on; 0 where the signs share.
    negative_offset: u16,
    /// Steps of the table for a count, as far as a count has more than one.
    steps_a_count: u32,
    /// Bits by which these are shifted to the right, as far as a step has more than one count.
    input_bits: u32,
    /// Half a count in values of the table, and the bits by which these are shifted to the right to become counts.
    half: i32,
    output_bits: u32,
    /// Counts up to which the table is looked up, for positive and for negative velocities.
    reach: [i32; 2],
    /// All ones where a negative velocity turns the sign of the friction, else 0.
    sign_mask: i32,
}

impl<'a> IntegerTableInPlace<'a> {
    /// The table of exactly one image.
    ///
    /// # Errors
    /// Those of [`IntegerTableImage::read`]; [`ImageError::OtherUnit`] where the steps of the table are not counts of these `units` times powers of
    /// two that a step can shift by, [`InvalidModel::OutputLimit`] where it could put out more than [`LARGEST_TORQUE_COUNTS`].
    #[inline(never)]
    pub fn new(image: &'a [u8], units: Units) -> Result<Self, ImageError> {
        IntegerTableImage::read(image).and_then(|image| Self::of(image, units))
    }

    /// The table of the image at the start of a region of flash; what follows is not looked at.
    ///
    /// # Errors
    /// As [`IntegerTableInPlace::new`].
    #[inline(never)]
    pub fn at_start(flash: &'a [u8], units: Units) -> Result<Self, ImageError> {
        IntegerTableImage::at_start(flash).and_then(|image| Self::of(image, units))
    }

    /// The table of an image that was read, such as [`frikan_shared::authentication::admission::Admission`] admits.
    ///
    /// # Errors
    /// As [`IntegerTableInPlace::new`], but for those of reading.
    #[inline(always)]
    pub fn of(image: IntegerTableImage<'a>, units: Units) -> Result<Self, ImageError> {
        let IntegerTableImage { segments, symmetry, cells, range: [low, high], .. } = image;
        let input_bits = bits_between(units.velocity, image.input_step);
        let output_bits = bits_between(units.torque, image.output_step);
        if input_bits.unsigned_abs() > MOST_INPUT_BITS || output_bits.cast_unsigned() > MOST_OUTPUT_BITS {
            return Err(ImageError::OtherUnit);
        }
        if image.largest > LARGEST_TORQUE_COUNTS.unsigned_abs() << output_bits {
            return Err(InvalidModel::OutputLimit.into());
        }
        let [left, right] = [input_bits.max(0), (-input_bits).max(0)];
        // The last count that is a step of the table.
        let last = ((LAST << right) | ((1 << right) - 1)) >> left;
        let reach = [high, -low].map(|end| quotient(end, units.velocity).min(last));
        Ok(Self {
            cells,
            segments,
            starts: image.starts,
            negative_offset: if symmetry == Symmetry::Sided { image.side } else { 0 },
            steps_a_count: 1 << left,
            input_bits: right.cast_unsigned(),
            half: (1 << output_bits) >> 1,
            output_bits: output_bits.cast_unsigned(),
            reach,
            sign_mask: if symmetry == Symmetry::Odd { -1 } else { 0 },
        })
    }

    /// Friction at a velocity, both in counts: at most [`LARGEST_TORQUE_COUNTS`], 0 at rest, held beyond the trained range.
    #[must_use]
    #[inline(always)]
    pub fn friction(&self, velocity: i32) -> i32 {
        let negative = sign(velocity);
        let reach = self.reach[(velocity as u32 >> 31) as usize];
        // The negative of the magnitude, which even `i32::MIN` has; behind a black box, or the compiler goes around all that follows at rest.
        let below = black_box(velocity.wrapping_abs().wrapping_neg());
        let held = reach.wrapping_sub(positive_part(reach.wrapping_add(below))) as u32;
        let steps = held.wrapping_mul(self.steps_a_count).wrapping_shr(self.input_bits);
        let segment = (steps >> SEGMENT_BITS) as usize & (SEGMENTS - 1);
        // In cells, the way through them in the lower bits.
        let way = (steps & WITHIN_SEGMENT).wrapping_mul(u32::from(self.segments[segment]));
        let cell = u32::from(self.starts[segment])
            + (way >> SEGMENT_BITS)
            + (negative as u32 & u32::from(self.negative_offset));
        let x = ((way & WITHIN_SEGMENT) << (WAY_BITS - SEGMENT_BITS)) as i32;
        // Every cell is one of the table, which was proved to lie within the image.
        let Some(cell) = self.cells.get(cell as usize) else { return 0 };
        let value = cubic(coefficients(cell), x, negative & self.sign_mask);
        // At rest there is no friction of it.
        value.wrapping_add(self.half).wrapping_shr(self.output_bits) & sign(below)
    }

    /// CRC-32 of what is evaluated, as it is now in memory and flash.
    pub(super) fn checksum(&self) -> u32 {
        let [positive, negative] = self.reach.map(i32::to_le_bytes);
        let words = self.starts.iter().fold(Checksum::new(), |sum, start| sum.over(&start.to_le_bytes()));
        let numbers = [self.steps_a_count, self.input_bits, self.half.cast_unsigned(), self.output_bits];
        let sum =
            numbers.into_iter().fold(words.over(&positive).over(&negative), |sum, word| sum.over(&word.to_le_bytes()));
        sum.over(self.segments).over(self.cells.as_flattened()).value()
    }
}

/// The steps of a segment, less one.
const WITHIN_SEGMENT: u32 = (1 << SEGMENT_BITS) - 1;

/// Most bits between a count of the velocity and a step of the table, to either side.
const MOST_INPUT_BITS: u32 = 17;

/// Mantissa bits of an `f32`, and what stands above them in the pattern of one that is not subnormal.
const MANTISSA_BITS: u32 = 23;
const MANTISSA: i32 = (1 << MANTISSA_BITS) - 1;

/// The number `n` for which `unit` is `2^n` times `step`, both positive; one far too large where there is none.
fn bits_between(unit: f32, step: f32) -> i32 {
    let [unit, step] = [unit, step].map(|number| number.to_bits() as i32);
    let are_alike = (unit ^ step) & MANTISSA == 0;
    if are_alike { (unit >> MANTISSA_BITS) - (step >> MANTISSA_BITS) } else { i32::MAX }
}

/// How often `unit`, positive, goes into `end`: whole, 0 where that is not positive, and at most [`LARGEST_VELOCITY_COUNTS`]. By shifts and differences of the
/// mantissas, as a drive without division has it.
#[inline(never)]
fn quotient(end: f32, unit: f32) -> i32 {
    let [end, unit] = [end, unit].map(|number| number.to_bits() as i32);
    let mantissa = |number: i32| (number & MANTISSA) | (MANTISSA + 1);
    // Negative for an end that is not positive, too.
    let doublings = (end >> MANTISSA_BITS) - (unit >> MANTISSA_BITS);
    let (mut rest, unit) = (mantissa(end), mantissa(unit));
    let mut quotient = 0;
    let mut left = doublings.min(MANTISSA_BITS as i32);
    while left >= 0 {
        // Behind a black box the loop stays as short as it is written.
        let goes_not = black_box(sign(rest.wrapping_sub(unit)));
        rest = rest.wrapping_sub(unit & !goes_not) << 1;
        quotient = 2 * quotient + 1 + goes_not;
        left -= 1;
    }
    if doublings < MANTISSA_BITS as i32 { quotient } else { LARGEST_VELOCITY_COUNTS }
}

/// The integer coefficients of a cell, of which all but the first were proved to fit in 16 bits.
#[inline(always)]
fn coefficients(cell: &[u8; 16]) -> [i32; 4] {
    let [a, b, c, d, e, f, _, _, g, h, _, _, i, j, _, _] = *cell;
    let narrow = |low, high| i32::from(i16::from_le_bytes([low, high]));
    [i32::from_le_bytes([a, b, c, d]), narrow(e, f), narrow(g, h), narrow(i, j)]
}
