//! Two slots in flash: the newest valid model wins, and a write that is cut anywhere leaves the one before.
//!
//! A slot holds a header of 16 bytes and an image behind it, with its tag where the drive asks for one:
//!
//! | offset | bytes | field |
//! |---|---|---|
//! | 0 | 4 | magic, ASCII `FSLT` |
//! | 4 | 4 | sequence number, little-endian |
//! | 8 | 4 | bytes of the image and its tag, little-endian |
//! | 12 | 4 | CRC-32 (ISO-HDLC) over bytes 0 to 11, the image and its tag, little-endian |
//!
//! To update: ask [`next_write`] for the slot and the sequence number, erase that slot, program the image, program the header of
//! [`slot_header`] last, reset. The slot in use is never touched, so that a cut at any byte leaves it the newest valid one. Sequence
//! numbers are compared modulo 2^32.

use frikan_shared::authentication::Trust;
use frikan_shared::image::{Image, ImageError, checksum};

/// First bytes of a used slot.
pub const SLOT_MAGIC: [u8; 4] = *b"FSLT";

/// Bytes of the header of a slot.
pub const SLOT_HEADER_BYTES: usize = 16;

/// Bytes of the header that the CRC covers, before it covers the image.
const COVERED_HEADER_BYTES: usize = 12;

/// One of the two slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The first.
    First,
    /// The second.
    Second,
}

impl Which {
    /// The other slot.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}

/// A slot whose checksum is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot<'a> {
    /// Which one it is.
    pub which: Which,
    /// Its sequence number.
    pub sequence: u32,
    /// Its image, with the tag where there is one, not yet decoded.
    pub image: &'a [u8],
}

/// The header for `image` with a sequence number. `None` for an image of 4 GiB or more.
#[must_use]
pub fn slot_header(sequence: u32, image: &[u8]) -> Option<[u8; SLOT_HEADER_BYTES]> {
    let length = u32::try_from(image.len()).ok()?;
    let mut header = [0; SLOT_HEADER_BYTES];
    let (covered, crc32) = header.split_at_mut(COVERED_HEADER_BYTES);
    let fields = [SLOT_MAGIC, sequence.to_le_bytes(), length.to_le_bytes()];
    for (byte, field) in covered.iter_mut().zip(fields.iter().flatten()) {
        *byte = *field;
    }
    let sum = checksum(&[covered, image]).to_le_bytes();
    for (byte, field) in crc32.iter_mut().zip(sum) {
        *byte = field;
    }
    Some(header)
}

/// The slot in `bytes`, where its checksum is right.
fn read(which: Which, bytes: &[u8]) -> Option<Slot<'_>> {
    let (header, rest) = bytes.split_first_chunk::<SLOT_HEADER_BYTES>()?;
    let &[m0, m1, m2, m3, s0, s1, s2, s3, l0, l1, l2, l3, c0, c1, c2, c3] = header;
    if [m0, m1, m2, m3] != SLOT_MAGIC {
        return None;
    }
    let length = usize::try_from(u32::from_le_bytes([l0, l1, l2, l3])).ok()?;
    let image = rest.get(..length)?;
    let covered = header.get(..COVERED_HEADER_BYTES)?;
    if checksum(&[covered, image]) != u32::from_le_bytes([c0, c1, c2, c3]) {
        return None;
    }
    Some(Slot { which, sequence: u32::from_le_bytes([s0, s1, s2, s3]), image })
}

/// The slots whose checksums are right, the newest first; the first slot where the numbers are equal.
#[must_use]
pub fn valid_slots<'a>(first: &'a [u8], second: &'a [u8]) -> [Option<Slot<'a>>; 2] {
    match (read(Which::First, first), read(Which::Second, second)) {
        (Some(first), Some(second)) => {
            // Half the circle of numbers counts as later.
            let second_is_newer = (second.sequence.wrapping_sub(first.sequence) as i32) > 0;
            if second_is_newer { [Some(second), Some(first)] } else { [Some(first), Some(second)] }
        }
        (first, second) => [first.or(second), None],
    }
}

/// The newest slot that can be used, and its image. Where the newest intact one cannot (a later format, too many cells, a tag that is
/// not of whom `trust` names), the older one.
fn usable<'a, const CELLS: usize>(
    first: &'a [u8],
    second: &'a [u8],
    trust: Trust<'_>,
) -> Result<(Slot<'a>, Image<CELLS>), ImageError> {
    let mut error = ImageError::NoImage;
    for slot in valid_slots(first, second).into_iter().flatten() {
        match trust.decode(slot.image) {
            Ok(image) => return Ok((slot, image)),
            Err(fault) if error == ImageError::NoImage => error = fault,
            Err(_) => {}
        }
    }
    Err(error)
}

/// The slot to write next and the sequence number to write: never the slot in use, always a later number than any.
#[must_use]
pub fn next_write<const CELLS: usize>(first: &[u8], second: &[u8], trust: Trust<'_>) -> (Which, u32) {
    let [Some(newest), _] = valid_slots(first, second) else { return (Which::First, 1) };
    let in_use = usable::<CELLS>(first, second, trust).map_or(newest.which, |(slot, _)| slot.which);
    (in_use.other(), newest.sequence.wrapping_add(1))
}

/// Decodes the newest model that can be used.
///
/// # Errors
/// [`ImageError::NoImage`] where no slot is intact, else why the newest intact one cannot be used: compensation stays off.
pub fn load<const CELLS: usize>(
    first: &[u8],
    second: &[u8],
    trust: Trust<'_>,
) -> Result<(Which, Image<CELLS>), ImageError> {
    usable(first, second, trust).map(|(slot, image)| (slot.which, image))
}

#[cfg(test)]
mod tests;
