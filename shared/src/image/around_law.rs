//! What stands before and behind the law of an image that is read in place.

use super::fields::Fields;
use super::header::{Header, ImageError, LAW_ERROR_SINCE, RIGID_BODY_ERROR_SINCE};
use crate::invalid::InvalidModel;
use crate::table::Symmetry;
use crate::units::Unit;

/// Cells as they lie in an image, aligned to nothing.
pub type Cells<'a> = &'a [[u8; 16]];

/// What a payload says before its law.
pub(super) struct BeforeLaw<'a> {
    /// Name of the joint.
    pub(super) joint: &'a [u8],
    /// Number of the law's variant.
    pub(super) law: u32,
}

impl<'a> BeforeLaw<'a> {
    /// Passes over the provenance, whatever it is.
    #[inline(always)]
    pub(super) fn read(header: &Header, fields: &mut Fields<'a>) -> Self {
        let [joint, _version]: [&[u8]; PROVENANCE_NAMES] = core::array::from_fn(|_| fields.name());
        for _ in 0..PROVENANCE_NUMBERS {
            fields.number();
        }
        let floats = if header.version >= RIGID_BODY_ERROR_SINCE { RIGID_BODY_ERROR_FLOATS } else { 0 };
        let floats = if header.version >= LAW_ERROR_SINCE { floats + LAW_ERROR_FLOATS } else { 0 };
        fields.bytes(4 * floats);
        Self { joint, law: fields.number() }
    }
}

/// What a payload says behind its law.
pub(super) struct BehindLaw<'a> {
    /// The model's cells.
    pub(super) cells: Cells<'a>,
    /// Unit of the output.
    pub(super) output_unit: Unit,
    /// Unit of the input, a byte, and its trained range, two floats.
    input: &'a [u8],
}

impl<'a> BehindLaw<'a> {
    /// Passes over limit and rigid body, whatever they are. `is_known` says whether the law is the one that the reader has.
    ///
    /// # Errors
    /// Where it is not or something around it is not known, and where the payload does not end here.
    #[inline(always)]
    pub(super) fn read(is_known: bool, header: &Header, fields: &mut Fields<'a>) -> Result<Self, ImageError> {
        let count = fields.number();
        let (cells, _) = fields.bytes(16 * usize::from(header.cells)).as_chunks();
        let (inputs, quantity) = (fields.number(), fields.number());
        let input = fields.bytes(INPUT_BYTES);
        let output_unit = Unit::ALL.get(fields.number() as usize).copied().unwrap_or(Unit::One);
        fields.bytes(4 * (LIMIT_FLOATS + BODY_FLOATS));
        let effects = fields.number();
        if !is_known || inputs != 1 || quantity != VELOCITY || effects != 0 {
            return Err(ImageError::NotBuiltIn);
        }
        if !fields.are_all() || count != u32::from(header.cells) {
            return Err(ImageError::Malformed);
        }
        Ok(Self { cells, output_unit, input })
    }

    /// Trained range of the input.
    #[inline(always)]
    pub(super) fn range(&self) -> [f32; 2] {
        let fields = &mut Fields::new(self.input);
        let _unit = fields.bytes(1);
        [fields.float(), fields.float()]
    }

    /// So many cells from one on.
    #[inline(always)]
    pub(super) fn column(&self, first: u16, count: u32) -> Result<Cells<'a>, InvalidModel> {
        let column = self.cells.get(usize::from(first)..).and_then(|cells| cells.get(..count as usize));
        column.ok_or(InvalidModel::CellOutOfPool)
    }
}

/// The next field as a symmetry.
#[inline(always)]
pub(super) fn symmetry(fields: &mut Fields<'_>) -> Symmetry {
    match fields.number() {
        0 => Symmetry::Odd,
        1 => Symmetry::Even,
        _ => Symmetry::Sided,
    }
}

/// Number of the quantity's variant.
const VELOCITY: u32 = 0;

/// What of the image is passed over.
const PROVENANCE_NAMES: usize = 2;
const PROVENANCE_NUMBERS: usize = 2;
const LAW_ERROR_FLOATS: usize = 2;
const RIGID_BODY_ERROR_FLOATS: usize = 15;
const INPUT_BYTES: usize = 9;
const LIMIT_FLOATS: usize = 1;
const BODY_FLOATS: usize = 5;
