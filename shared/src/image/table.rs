//! Images whose law is a table of the velocity alone, read where they lie: nothing is copied but the shape of the table.

use core::hint::black_box;

use super::fields::Fields;
use super::header::{Header, ImageError, LAW_ERROR_SINCE, RIGID_BODY_ERROR_SINCE, header, verified, verified_payload};
use crate::invalid::{InvalidModel, ensure};
use crate::table::{Geometric, GeometricShape, Symmetry, is_usable};
use crate::units::Unit;

/// Cells as they lie in an image, aligned to nothing.
pub type Cells<'a> = &'a [[u8; 16]];

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
        let header = header(flash)?;
        let payload = verified_payload(&header, flash)?;
        Self::of_payload(&header, payload)
    }

    #[inline(always)]
    fn of_payload(header: &Header, payload: &'a [u8]) -> Result<Self, ImageError> {
        let mut fields = Fields::new(payload);
        let [joint, _version]: [&[u8]; PROVENANCE_NAMES] = core::array::from_fn(|_| fields.name());
        for _ in 0..PROVENANCE_NUMBERS {
            fields.number();
        }
        let floats = if header.version >= RIGID_BODY_ERROR_SINCE { RIGID_BODY_ERROR_FLOATS } else { 0 };
        let floats = if header.version >= LAW_ERROR_SINCE { floats + LAW_ERROR_FLOATS } else { 0 };
        fields.bytes(4 * floats);
        let law = fields.number();
        let shape = GeometricShape {
            first_cell: fields.number() as u16,
            offset_exponent: fields.byte() as i8,
            octave_cells_log2: fields.byte(),
            symmetry: match fields.number() {
                0 => Symmetry::Odd,
                1 => Symmetry::Even,
                _ => Symmetry::Sided,
            },
            reach: fields.float(),
            reach_negative: fields.float(),
        };
        let count = fields.number();
        let (cells, _) = fields.bytes(16 * usize::from(header.cells)).as_chunks();
        let (inputs, quantity) = (fields.number(), fields.number());
        fields.bytes(INPUT_BYTES);
        let output_unit = Unit::ALL.get(fields.number() as usize).copied().unwrap_or(Unit::One);
        fields.bytes(4 * (LIMIT_FLOATS + BODY_FLOATS));
        let effects = fields.number();
        if law != GEOMETRIC || inputs != 1 || quantity != VELOCITY || effects != 0 {
            return Err(ImageError::NotBuiltIn);
        }
        if !fields.are_all() || count != u32::from(header.cells) {
            return Err(ImageError::Malformed);
        }
        ensure(shape.is_within_range(), InvalidModel::TableShape)?;
        let layout = Geometric::new(shape);
        ensure(layout.fits(), InvalidModel::TableShape)?;
        let first = usize::from(shape.first_cell);
        let column = cells.get(first..).and_then(|cells| cells.get(..layout.cells() as usize));
        // Behind a black box the loop stays as short as it is written.
        let words = black_box(column.ok_or(InvalidModel::CellOutOfPool)?.as_flattened().as_chunks().0);
        ensure(words.iter().all(|word| is_usable(u32::from_le_bytes(*word))), InvalidModel::Coefficient)?;
        Ok(Self { layout, cells, output_unit, joint })
    }
}

/// Numbers of variants: of the law and of the quantity.
const GEOMETRIC: u32 = 0;
const VELOCITY: u32 = 0;

/// What of the image is passed over.
const PROVENANCE_NAMES: usize = 2;
const PROVENANCE_NUMBERS: usize = 2;
const LAW_ERROR_FLOATS: usize = 2;
const RIGID_BODY_ERROR_FLOATS: usize = 15;
const INPUT_BYTES: usize = 9;
const LIMIT_FLOATS: usize = 1;
const BODY_FLOATS: usize = 5;
