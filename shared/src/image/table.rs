//! Images whose law is a table of the velocity alone, read where they lie: nothing is copied but the shape of the table.

use core::hint::black_box;

use super::around_law::{BeforeLaw, BehindLaw, Cells, symmetry};
use super::fields::Fields;
use super::header::{Header, ImageError, verified, verified_at_start};
use crate::invalid::{InvalidModel, ensure};
use crate::table::{Geometric, GeometricShape, is_usable};
use crate::units::Unit;

/// The table of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableImage<'a> {
    /// Layout of the table.
    pub layout: Geometric,
    /// The model's cells, into which the layout indexes.
    pub cells: Cells<'a>,
    /// Unit of the output.
    pub output_unit: Unit,
    /// Name of the joint.
    pub joint: &'a [u8],
}

impl<'a> TableImage<'a> {
    /// Reads exactly one image of a geometric table of the velocity without other inputs and without effects. The checksum and all that an
    /// evaluation relies on are checked as [`super::decode`] checks them; provenance, rigid body and the trained range, which the table has
    /// in itself, are passed over, whatever they are.
    ///
    /// # Errors
    /// [`ImageError::NotBuiltIn`] for any other law, and those of [`super::decode`].
    #[inline(always)]
    pub fn read(bytes: &'a [u8]) -> Result<Self, ImageError> {
        let (header, payload) = verified(bytes)?;
        Self::of_payload(&header, payload)
    }

    /// As [`TableImage::read`], of the image at the start of a region of flash; what follows is not looked at.
    ///
    /// # Errors
    /// Those of [`TableImage::read`].
    #[inline(always)]
    pub fn at_start(flash: &'a [u8]) -> Result<Self, ImageError> {
        let (header, payload) = verified_at_start(flash)?;
        Self::of_payload(&header, payload)
    }

    #[inline(always)]
    fn of_payload(header: &Header, payload: &'a [u8]) -> Result<Self, ImageError> {
        let fields = &mut Fields::new(payload);
        let before = BeforeLaw::read(header, fields);
        let shape = GeometricShape {
            first_cell: fields.number() as u16,
            offset_exponent: fields.byte() as i8,
            octave_cells_log2: fields.byte(),
            symmetry: symmetry(fields),
            reach: fields.float(),
            reach_negative: fields.float(),
        };
        let behind = BehindLaw::read(before.law == GEOMETRIC, header, fields)?;
        ensure(shape.is_within_range(), InvalidModel::TableShape)?;
        let layout = Geometric::new(shape);
        ensure(layout.fits(), InvalidModel::TableShape)?;
        let column = behind.column(shape.first_cell, layout.cells())?;
        let (words, _) = column.as_flattened().as_chunks();
        // Behind a black box the loop stays as short as it is written.
        let are_usable = words.iter().all(|word| is_usable(black_box(u32::from_le_bytes(*word))));
        ensure(are_usable, InvalidModel::Coefficient)?;
        Ok(Self { layout, cells: behind.cells, output_unit: behind.output_unit, joint: before.joint })
    }
}

/// Number of the law's variant.
const GEOMETRIC: u32 = 0;
