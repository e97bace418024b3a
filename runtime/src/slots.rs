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
//! To update: ask [`next_write_beside`] for the slot and the sequence number, erase that slot, program the image, program the header of
//! [`slot_header`] last, reset. The slot in use is never touched, so that a cut at any byte leaves it the newest valid one. Sequence
//! numbers are compared modulo 2^32.

use frikan_shared::image::{ImageError, checksum};
#[cfg(feature = "models")]
use frikan_shared::{authentication::Trust, image::Image};

#[cfg(feature = "models")]
use crate::laws::evaluate::is_built_in;

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

/// The newest slot that can be used, and what `read` makes of its image and tag. Where the newest intact one cannot be used (a later format,
/// too many cells, a tag that is not of whom the drive trusts), the older one.
///
/// # Errors
/// [`ImageError::NoImage`] where no slot is intact, else why the newest intact one cannot be used: compensation stays off.
pub fn newest_usable<'a, T>(
    first: &'a [u8],
    second: &'a [u8],
    read: impl Fn(&'a [u8]) -> Result<T, ImageError>,
) -> Result<(Slot<'a>, T), ImageError> {
    let mut error = ImageError::NoImage;
    for slot in valid_slots(first, second).into_iter().flatten() {
        match read(slot.image) {
            Ok(read) => return Ok((slot, read)),
            Err(fault) if error == ImageError::NoImage => error = fault,
            Err(_) => {}
        }
    }
    Err(error)
}

/// The slot to write next and the sequence number to write: never the slot in use, which is the newest one that `read` can use, always a
/// later number than any.
#[must_use]
pub fn next_write_beside<'a, T>(
    first: &'a [u8],
    second: &'a [u8],
    read: impl Fn(&'a [u8]) -> Result<T, ImageError>,
) -> (Which, u32) {
    let [Some(newest), _] = valid_slots(first, second) else { return (Which::First, 1) };
    let in_use = newest_usable(first, second, read).map_or(newest.which, |(slot, _)| slot.which);
    (in_use.other(), newest.sequence.wrapping_add(1))
}

/// A model that this firmware can evaluate.
#[cfg(feature = "models")]
fn decoded<const CELLS: usize>(image: &[u8], trust: Trust<'_>) -> Result<Image<CELLS>, ImageError> {
    trust
        .decode(image)
        .and_then(|image| if is_built_in(&image.model) { Ok(image) } else { Err(ImageError::NotBuiltIn) })
}

/// As [`next_write_beside`], for a drive that decodes its images.
#[cfg(feature = "models")]
#[must_use]
pub fn next_write<const CELLS: usize>(first: &[u8], second: &[u8], trust: Trust<'_>) -> (Which, u32) {
    next_write_beside(first, second, |image| decoded::<CELLS>(image, trust))
}

/// Decodes the newest model that can be used.
///
/// # Errors
/// As [`newest_usable`].
#[cfg(feature = "models")]
pub fn load<const CELLS: usize>(
    first: &[u8],
    second: &[u8],
    trust: Trust<'_>,
) -> Result<(Which, Image<CELLS>), ImageError> {
    newest_usable(first, second, |image| decoded(image, trust)).map(|(slot, image)| (slot.which, image))
}

#[cfg(all(test, feature = "models", feature = "auth"))]
mod tests;
