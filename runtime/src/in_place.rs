//! A table of the velocity, read from the image where it lies: checked once, then a few words of memory and a step of constant time.
//!
//! The bits are those of the same image decoded. What a drive without room for a decoded model calls:
//!
//! ```
//! use frikan_runtime::compensator::{Limited, Limits};
//! use frikan_runtime::in_place::TableInPlace;
//! use frikan_runtime::measurement::Measurement;
//!
//! # let flash: &[u8] = &[];
//! let mut joint = Limited::by(TableInPlace::new(flash), Limits::new(0.9, 40.0, 8.0e3).unwrap());
//! let answer = joint.step(&Measurement { velocity: 0.3, ..Measurement::MISSING }, 1.0e-3);
//! assert_eq!(answer.torque, 0.0); // there is no image
//! ```

use frikan_shared::image::{Cells, Checksum, ImageError, TableImage};
use frikan_shared::table::Cell;

use crate::compensator::FrictionModel;
use crate::laws::table::{cubic, place_position};
use crate::measurement::{Friction, Measurement};
use crate::usable::{Usable, finite, not_zero};

/// The table of an image in flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableInPlace<'a> {
    /// Positive velocities, then negative ones.
    sides: [Side; 2],
    /// `c` of `w = |v| + c`.
    offset: f32,
    /// The product of a position with it has the cell in the high word and the fraction in the low one.
    cells_per_turn: u32,
    /// The bits that a negative velocity turns in the output.
    negative_sign: u32,
    cells: Cells<'a>,
}

/// The cells of one sign; see [`frikan_shared::table::Side`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    origin: u32,
    last_position: u32,
}

impl<'a> TableInPlace<'a> {
    /// The table of exactly one image.
    ///
    /// # Errors
    /// Those of [`TableImage::read`].
    #[inline(never)]
    pub fn new(image: &'a [u8]) -> Result<Self, ImageError> {
        TableImage::read(image).map(Self::from)
    }

    /// The table of the image at the start of a region of flash; what follows is not looked at.
    ///
    /// # Errors
    /// Those of [`TableImage::at_start`].
    #[inline(never)]
    pub fn at_start(flash: &'a [u8]) -> Result<Self, ImageError> {
        TableImage::at_start(flash).map(Self::from)
    }

    /// The value of the table at a velocity; that at an end for NaN.
    #[must_use]
    #[inline(always)]
    pub fn value(&self, velocity: f32) -> f32 {
        f32::from_bits(self.unsigned(velocity).to_bits() ^ self.sign(velocity))
    }

    /// The value before the velocity turns its sign.
    #[inline(always)]
    fn unsigned(&self, velocity: f32) -> f32 {
        let is_negative = velocity.to_bits() >> 31;
        let side = &self.sides[is_negative as usize];
        let width = velocity.abs() + self.offset;
        let position = width.to_bits().wrapping_sub(side.origin).min(side.last_position);
        let place = place_position(position, self.cells_per_turn, 0, 0);
        // Every row is one of the table, which was proved to lie within the cells.
        let bytes = self.cells.get(place.row as usize).unwrap_or(&[0; 16]);
        cubic(&Cell::from(*bytes), place)
    }

    /// The bits that a velocity turns in the value.
    #[inline(always)]
    fn sign(&self, velocity: f32) -> u32 {
        velocity.to_bits() & self.negative_sign
    }
}

impl<'a> From<TableImage<'a>> for TableInPlace<'a> {
    #[inline(always)]
    fn from(TableImage { layout, cells, .. }: TableImage<'a>) -> Self {
        let [positive, negative] = layout.sides;
        Self {
            sides: layout.sides.map(|side| Side { origin: side.origin, last_position: side.last_position }),
            offset: layout.offset,
            cells_per_turn: positive.cells_per_turn,
            negative_sign: negative.sign,
            cells,
        }
    }
}

impl FrictionModel for TableInPlace<'_> {
    #[inline(always)]
    fn friction(&mut self, measurement: &Measurement, dt: f32, is_step: i32, largest_position: f32) -> Friction {
        self.share(1.0, measurement, dt, is_step, largest_position)
    }

    /// With the sign turned behind the product, where the bits are at hand.
    #[inline(always)]
    fn share(&mut self, gain: f32, measurement: &Measurement, _: f32, is_step: i32, _: f32) -> Friction {
        let velocity = measurement.velocity;
        let usable = Usable::where_negative_of_little(finite(velocity) & is_step);
        // What the table gives was proved finite and within the limit. At rest there is no friction of it.
        let moves = (not_zero(velocity) >> 31) as u32;
        let torque = ((gain * self.unsigned(velocity)).to_bits() ^ self.sign(velocity)) & moves;
        Friction { torque: f32::from_bits(torque), position: 0.0, usable }
    }

    fn rest(&mut self) {}

    fn checksum(&self) -> Option<u32> {
        let [positive, negative] = self.sides;
        let words = [
            positive.origin,
            positive.last_position,
            negative.origin,
            negative.last_position,
            self.offset.to_bits(),
            self.cells_per_turn,
            self.negative_sign,
        ];
        let sum = words.into_iter().fold(Checksum::new(), |sum, word| sum.over(&word.to_le_bytes()));
        Some(sum.over(self.cells.as_flattened()).value())
    }
}

#[cfg(all(test, feature = "models"))]
mod tests;
