//! What stands in front of every payload, and why an image is refused.

use core::hint::black_box;

use crate::invalid::InvalidModel;

/// First bytes of every image.
pub const MAGIC: [u8; 4] = *b"FRKN";

/// Version of the format that this crate writes, and the latest that it reads.
pub const FORMAT_VERSION: u16 = 6;

/// Earliest version that is read.
pub const EARLIEST_VERSION: u16 = 3;

/// Since when the provenance has the error of the law, and the covariance of the rigid body.
pub(super) const LAW_ERROR_SINCE: u16 = 5;
pub(super) const RIGID_BODY_ERROR_SINCE: u16 = 6;

/// Bytes of the header.
pub const HEADER_BYTES: usize = 16;

/// Largest payload that is read.
pub const MAX_PAYLOAD_BYTES: usize = 1 << 20;

/// Bytes of the header that the CRC covers, before it covers the payload.
pub(super) const COVERED_HEADER_BYTES: usize = 12;

/// Why an image is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ImageError {
    /// The bytes end before the image does.
    Truncated,
    /// The bytes do not begin with [`MAGIC`].
    BadMagic,
    /// The format version is not one from [`EARLIEST_VERSION`] to [`FORMAT_VERSION`], or has effects that are written otherwise today.
    UnsupportedVersion(u16),
    /// The payload length exceeds [`MAX_PAYLOAD_BYTES`], or the model has more cells than the reader has room for.
    TooLarge,
    /// Bytes follow the image.
    TrailingBytes,
    /// Header or payload were changed after they were written.
    CrcMismatch,
    /// The payload is not what the format says, although its checksum is right.
    Malformed,
    /// The model cannot be evaluated.
    InvalidModel(InvalidModel),
    /// The buffer to write to is too small.
    BufferTooSmall,
    /// Neither slot of flash holds an image with a right checksum.
    NoImage,
    /// The tag of whom the drive trusts does not stand behind the image.
    NotAuthentic,
    /// The image is of another joint than the firmware asks for.
    OtherJoint,
    /// The torque of the image is in another unit.
    OtherUnit,
    /// The image reads a channel that the drive does not measure.
    MissingChannel,
    /// The image is older than the firmware allows.
    Outdated,
    /// The image holds a kind of law or effect that this firmware was built without.
    NotBuiltIn,
}

impl core::fmt::Display for ImageError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Truncated => f.write_str("the image is truncated"),
            Self::BadMagic => f.write_str("this is not a Frikan image"),
            Self::UnsupportedVersion(version) => write!(f, "image format version {version} is not supported"),
            Self::TooLarge => f.write_str("the image is too large"),
            Self::TrailingBytes => f.write_str("bytes follow the image"),
            Self::CrcMismatch => f.write_str("the image is damaged (checksum mismatch)"),
            Self::Malformed => f.write_str("the payload of the image is malformed"),
            Self::InvalidModel(fault) => write!(f, "the model is invalid: {fault:?}"),
            Self::BufferTooSmall => f.write_str("the buffer is too small for the image"),
            Self::NoImage => f.write_str("there is no intact image"),
            Self::NotAuthentic => f.write_str("the image is not authentic"),
            Self::OtherJoint => f.write_str("the image is of another joint"),
            Self::OtherUnit => f.write_str("the torque of the image is in another unit"),
            Self::MissingChannel => f.write_str("the image reads a channel that the drive does not measure"),
            Self::Outdated => f.write_str("the image is older than the firmware allows"),
            Self::NotBuiltIn => f.write_str("the image needs a part that was left out of this firmware"),
        }
    }
}

impl core::error::Error for ImageError {}

impl From<InvalidModel> for ImageError {
    fn from(fault: InvalidModel) -> Self {
        Self::InvalidModel(fault)
    }
}

/// Bits that a step takes off the sum.
const STEP_BITS: u32 = 2;

/// What these bits at the lower end leave of the sum, by the polynomial of CRC-32, lowest power first (ISO 3309).
const REMAINDERS: [u32; 1 << STEP_BITS] = {
    let mut remainders = [0; 1 << STEP_BITS];
    let mut bits = 0;
    while bits < remainders.len() {
        let (mut remainder, mut step) = (bits as u32, 0);
        while step < STEP_BITS {
            remainder = (remainder >> 1) ^ if remainder & 1 == 1 { 0xEDB8_8320 } else { 0 };
            step += 1;
        }
        remainders[bits] = remainder;
        bits += 1;
    }
    remainders
};

/// CRC-32 (ISO-HDLC) of parts that follow each other. Two bits at a time, for an image is checked once, at start-up: a table for each byte takes 1 kB
/// of flash, and so does the code of the crate `crc`, which leaves the choice of the sum to its user.
#[must_use]
pub fn checksum(parts: &[&[u8]]) -> u32 {
    parts.iter().fold(Checksum::new(), |sum, part| sum.over(part)).value()
}

/// [`checksum`] of parts that are there one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Checksum(u32);

impl Checksum {
    /// Of nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self(u32::MAX)
    }

    /// With the next bytes.
    #[must_use]
    pub fn over(self, bytes: &[u8]) -> Self {
        Self(sum_over(self.0, bytes))
    }

    /// The checksum of all bytes.
    #[must_use]
    pub fn value(self) -> u32 {
        !self.0
    }
}

impl Default for Checksum {
    fn default() -> Self {
        Self::new()
    }
}

/// Goes on with a sum over bytes.
#[inline(never)]
fn sum_over(mut sum: u32, bytes: &[u8]) -> u32 {
    for byte in bytes {
        sum ^= u32::from(*byte);
        let mut left = u8::BITS;
        while left != 0 {
            sum = (sum >> STEP_BITS) ^ REMAINDERS[(sum & (REMAINDERS.len() as u32 - 1)) as usize];
            // Behind a black box the loop stays as short as it is written.
            left = black_box(left - STEP_BITS);
        }
    }
    sum
}

/// The header's fields after magic and version were found right.
pub(super) struct Header {
    pub(super) version: u16,
    pub(super) cells: u16,
    payload_bytes: usize,
    crc32: u32,
}

#[inline]
fn header(bytes: &[u8]) -> Result<Header, ImageError> {
    let (head, _) = bytes.split_first_chunk::<HEADER_BYTES>().ok_or(ImageError::Truncated)?;
    let [magic, version_and_cells, length, crc32] = head.as_chunks().0 else { return Err(ImageError::Truncated) };
    if *magic != MAGIC {
        return Err(ImageError::BadMagic);
    }
    let [v0, v1, c0, c1] = *version_and_cells;
    let version = u16::from_le_bytes([v0, v1]);
    if !(EARLIEST_VERSION..=FORMAT_VERSION).contains(&version) {
        return Err(ImageError::UnsupportedVersion(version));
    }
    let payload_bytes = u32::from_le_bytes(*length) as usize;
    if payload_bytes > MAX_PAYLOAD_BYTES {
        return Err(ImageError::TooLarge);
    }
    Ok(Header { version, cells: u16::from_le_bytes([c0, c1]), payload_bytes, crc32: u32::from_le_bytes(*crc32) })
}

/// Length in bytes of the image at the start of `bytes`, header included, as its header states it.
///
/// # Errors
/// [`ImageError::Truncated`], [`ImageError::BadMagic`], [`ImageError::UnsupportedVersion`] or [`ImageError::TooLarge`].
pub fn image_bytes(bytes: &[u8]) -> Result<usize, ImageError> {
    Ok(HEADER_BYTES + header(bytes)?.payload_bytes)
}

/// The format version of an image.
///
/// # Errors
/// As [`image_bytes`].
pub fn image_version(bytes: &[u8]) -> Result<u16, ImageError> {
    Ok(header(bytes)?.version)
}

/// The CRC-32 that an image carries.
///
/// # Errors
/// As [`image_bytes`].
pub fn image_crc32(bytes: &[u8]) -> Result<u32, ImageError> {
    Ok(header(bytes)?.crc32)
}

/// The payload behind a header, its checksum verified; what follows is not looked at.
#[inline]
fn verified_payload<'a>(header: &Header, bytes: &'a [u8]) -> Result<&'a [u8], ImageError> {
    let (head, rest) = bytes.split_first_chunk::<HEADER_BYTES>().ok_or(ImageError::Truncated)?;
    let payload = rest.get(..header.payload_bytes).ok_or(ImageError::Truncated)?;
    let (covered, _) = head.split_first_chunk::<COVERED_HEADER_BYTES>().ok_or(ImageError::Truncated)?;
    if checksum(&[covered, payload]) == header.crc32 { Ok(payload) } else { Err(ImageError::CrcMismatch) }
}

/// Header and payload of exactly one image, its length and checksum verified.
pub(super) fn verified(bytes: &[u8]) -> Result<(Header, &[u8]), ImageError> {
    let header = header(bytes)?;
    if bytes.len() > HEADER_BYTES + header.payload_bytes {
        return Err(ImageError::TrailingBytes);
    }
    let payload = verified_payload(&header, bytes)?;
    Ok((header, payload))
}

/// Header and payload of the image at the start of a region, its checksum verified; what follows is not looked at.
#[inline(always)]
pub(super) fn verified_at_start(flash: &[u8]) -> Result<(Header, &[u8]), ImageError> {
    let header = header(flash)?;
    let payload = verified_payload(&header, flash)?;
    Ok((header, payload))
}
