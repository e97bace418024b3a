//! Images whose law is an integer table of the velocity alone, read where they lie, without an operation on floats.

use super::around_law::{BeforeLaw, BehindLaw, Cells, symmetry};
use super::fields::Fields;
use super::header::{Header, ImageError, verified, verified_at_start};
use crate::integer_table::{SEGMENTS, largest_value, segment_starts};
use crate::invalid::InvalidModel;
use crate::table::Symmetry;
use crate::units::Unit;

/// The integer table of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegerTableImage<'a> {
    /// Cells of each segment, from zero outwards.
    pub segments: &'a [u8; SEGMENTS],
    /// The first cell of each segment, for positive inputs.
    pub starts: [u16; SEGMENTS],
    /// Cells of all segments.
    pub side: u16,
    /// Whether the signs share cells.
    pub symmetry: Symmetry,
    /// Unit of the input for each step.
    pub input_step: f32,
    /// Unit of the output for each step.
    pub output_step: f32,
    /// The model's cells, into which the table indexes.
    pub cells: Cells<'a>,
    /// Largest magnitude of a value of the table, in its steps.
    pub largest: u32,
    /// Trained range of the velocity, in its unit.
    pub range: [f32; 2],
    /// Unit of the output.
    pub output_unit: Unit,
    /// Name of the joint.
    pub joint: &'a [u8],
}

impl<'a> IntegerTableImage<'a> {
    /// Reads exactly one image of an integer table of the velocity without other inputs and without effects. The checksum and all that an
    /// evaluation in integers relies on are checked as [`super::decode`] checks them; provenance, output limit and rigid body are passed over,
    /// whatever they are, and so are steps and range: nothing is calculated with them.
    ///
    /// # Errors
    /// [`ImageError::NotBuiltIn`] for any other law, and those of [`super::decode`].
    #[inline(always)]
    pub fn read(bytes: &'a [u8]) -> Result<Self, ImageError> {
        let (header, payload) = verified(bytes)?;
        Self::of_payload(&header, payload)
    }

    /// As [`IntegerTableImage::read`], of the image at the start of a region of flash; what follows is not looked at.
    ///
    /// # Errors
    /// Those of [`IntegerTableImage::read`].
    #[inline(always)]
    pub fn at_start(flash: &'a [u8]) -> Result<Self, ImageError> {
        let (header, payload) = verified_at_start(flash)?;
        Self::of_payload(&header, payload)
    }

    #[inline(always)]
    fn of_payload(header: &Header, payload: &'a [u8]) -> Result<Self, ImageError> {
        let fields = &mut Fields::new(payload);
        let before = BeforeLaw::read(header, fields);
        let first_cell = fields.number() as u16;
        let segments = fields.bytes(SEGMENTS).first_chunk().unwrap_or(&NO_SEGMENTS);
        let symmetry = symmetry(fields);
        let [input_step, output_step] = [fields.float(), fields.float()];
        let behind = BehindLaw::read(before.law == INTEGER_TABLE, header, fields)?;
        let (starts, end) = segment_starts(segments, first_cell).ok_or(InvalidModel::TableShape)?;
        let side = end - u32::from(first_cell);
        let count = if symmetry == Symmetry::Sided { 2 * side } else { side };
        let mut words = Fields::new(behind.column(first_cell, count)?.as_flattened());
        let mut largest = 0;
        for _ in 0..count {
            let coefficients = [(); 4].map(|()| words.word().cast_signed());
            largest = largest_value(coefficients).ok_or(InvalidModel::Coefficient)?.max(largest);
        }
        let BehindLaw { cells, output_unit, .. } = behind;
        let joint = before.joint;
        Ok(Self {
            segments,
            starts,
            side: side as u16,
            symmetry,
            input_step,
            output_step,
            cells,
            largest,
            range: behind.range(),
            output_unit,
            joint,
        })
    }
}

/// What stands for segments that are missing; no table has these.
const NO_SEGMENTS: [u8; SEGMENTS] = [0; SEGMENTS];

/// Number of the law's variant.
const INTEGER_TABLE: u32 = 4;
