//! The model image: the only place that knows bytes. `IMAGE_FORMAT.md` beside this crate is its specification.
//!
//! Sixteen bytes of header (magic, version, cells, payload length, CRC-32), then a postcard payload. Decoding allocates
//! nothing, refuses every damaged image with an error of its own kind, and returns only models that passed
//! [`crate::validate`].

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

use crate::model::{LawError, Model, Provenance};
use crate::validate::InvalidModel;

/// First bytes of every image.
pub const MAGIC: [u8; 4] = *b"FRKN";

/// Version of the format that this crate writes and reads.
pub const FORMAT_VERSION: u16 = 6;

/// Bytes of the header.
pub const HEADER_BYTES: usize = 16;

/// Largest payload that is read.
pub const MAX_PAYLOAD_BYTES: usize = 1 << 20;

/// Bytes of the header that the CRC covers, before it covers the payload.
const COVERED_HEADER_BYTES: usize = 12;

/// Bit by bit: an image is checked once at start-up, and a table would cost 1 KB of flash.
static CHECKSUM: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// Why an image is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImageError {
    /// The bytes end before the image does.
    Truncated,
    /// The bytes do not begin with [`MAGIC`].
    BadMagic,
    /// The format version is not [`FORMAT_VERSION`].
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
        }
    }
}

impl core::error::Error for ImageError {}

impl From<InvalidModel> for ImageError {
    fn from(fault: InvalidModel) -> Self {
        Self::InvalidModel(fault)
    }
}

/// A model with its provenance.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<const CELLS: usize> {
    /// Where the model comes from.
    pub provenance: Provenance,
    /// The model.
    pub model: Model<CELLS>,
}

/// CRC-32 (ISO-HDLC) of parts that follow each other.
#[must_use]
pub fn checksum(parts: &[&[u8]]) -> u32 {
    let mut digest = CHECKSUM.digest();
    for part in parts {
        digest.update(part);
    }
    digest.finalize()
}

/// The header's fields after magic and version were found right.
struct Header {
    cells: u16,
    payload_bytes: usize,
    crc32: u32,
}

fn header(bytes: &[u8]) -> Result<Header, ImageError> {
    let (&[m0, m1, m2, m3, v0, v1, c0, c1, l0, l1, l2, l3, s0, s1, s2, s3], _) =
        bytes.split_first_chunk::<HEADER_BYTES>().ok_or(ImageError::Truncated)?;
    if [m0, m1, m2, m3] != MAGIC {
        return Err(ImageError::BadMagic);
    }
    let version = u16::from_le_bytes([v0, v1]);
    if version != FORMAT_VERSION {
        return Err(ImageError::UnsupportedVersion(version));
    }
    let payload_bytes = u32::from_le_bytes([l0, l1, l2, l3]) as usize;
    if payload_bytes > MAX_PAYLOAD_BYTES {
        return Err(ImageError::TooLarge);
    }
    Ok(Header { cells: u16::from_le_bytes([c0, c1]), payload_bytes, crc32: u32::from_le_bytes([s0, s1, s2, s3]) })
}

/// Length in bytes of the image at the start of `bytes`, header included, as its header states it.
///
/// # Errors
/// [`ImageError::Truncated`], [`ImageError::BadMagic`], [`ImageError::UnsupportedVersion`] or [`ImageError::TooLarge`].
pub fn image_bytes(bytes: &[u8]) -> Result<usize, ImageError> {
    Ok(HEADER_BYTES + header(bytes)?.payload_bytes)
}

/// The CRC-32 that an image carries.
///
/// # Errors
/// As [`image_bytes`].
pub fn image_crc32(bytes: &[u8]) -> Result<u32, ImageError> {
    Ok(header(bytes)?.crc32)
}

/// Header and payload of exactly one image, its length and checksum verified.
fn verified(bytes: &[u8]) -> Result<(Header, &[u8]), ImageError> {
    let header = header(bytes)?;
    let payload = bytes.get(HEADER_BYTES..).ok_or(ImageError::Truncated)?;
    match payload.len() {
        length if length < header.payload_bytes => return Err(ImageError::Truncated),
        length if length > header.payload_bytes => return Err(ImageError::TrailingBytes),
        _ => {}
    }
    let covered = bytes.get(..COVERED_HEADER_BYTES).ok_or(ImageError::Truncated)?;
    if checksum(&[covered, payload]) != header.crc32 {
        return Err(ImageError::CrcMismatch);
    }
    Ok((header, payload))
}

/// Decodes exactly one image.
///
/// # Errors
/// One [`ImageError`] for each way in which bytes can fail to be an image of a usable model.
pub fn decode<const CELLS: usize>(bytes: &[u8]) -> Result<Image<CELLS>, ImageError> {
    let (header, payload) = verified(bytes)?;
    if usize::from(header.cells) > CELLS {
        return Err(ImageError::TooLarge);
    }
    let (provenance, rest) = postcard::take_from_bytes::<Provenance>(payload).map_err(|_| ImageError::Malformed)?;
    let LawError { slow, sliding } = provenance.law_error;
    let is_bounded = [slow, sliding].iter().all(|error| error.is_finite() && *error >= 0.0);
    if !is_bounded || !provenance.rigid_body_error.factor.iter().all(|error| error.is_finite()) {
        return Err(ImageError::Malformed);
    }
    let (model, rest) = postcard::take_from_bytes::<Model<CELLS>>(rest).map_err(|_| ImageError::Malformed)?;
    if !rest.is_empty() || model.cells.len() != usize::from(header.cells) {
        return Err(ImageError::Malformed);
    }
    model.validate()?;
    Ok(Image { provenance, model })
}

/// Encodes an image into `buffer` and returns the bytes that it takes.
///
/// # Errors
/// [`ImageError::InvalidModel`] where decoding would refuse the model, [`ImageError::BufferTooSmall`],
/// [`ImageError::TooLarge`].
pub fn encode<'a, const CELLS: usize>(image: &Image<CELLS>, buffer: &'a mut [u8]) -> Result<&'a [u8], ImageError> {
    image.model.validate()?;
    let cells = u16::try_from(image.model.cells.len()).map_err(|_| ImageError::TooLarge)?;
    let (head, rest) = buffer.split_first_chunk_mut::<HEADER_BYTES>().ok_or(ImageError::BufferTooSmall)?;
    let provenance_bytes = postcard::to_slice(&image.provenance, rest).map_err(|_| ImageError::BufferTooSmall)?.len();
    let model_room = rest.get_mut(provenance_bytes..).ok_or(ImageError::BufferTooSmall)?;
    let model_bytes = postcard::to_slice(&image.model, model_room).map_err(|_| ImageError::BufferTooSmall)?.len();
    let payload_bytes = provenance_bytes + model_bytes;
    if payload_bytes > MAX_PAYLOAD_BYTES {
        return Err(ImageError::TooLarge);
    }
    let payload = rest.get(..payload_bytes).ok_or(ImageError::BufferTooSmall)?;

    let fields =
        [&MAGIC[..], &FORMAT_VERSION.to_le_bytes(), &cells.to_le_bytes(), &(payload_bytes as u32).to_le_bytes()];
    for (byte, field) in head.iter_mut().zip(fields.into_iter().flatten()) {
        *byte = *field;
    }
    let (covered, crc32) = head.split_at_mut(COVERED_HEADER_BYTES);
    crc32.copy_from_slice(&checksum(&[covered, payload]).to_le_bytes());
    buffer.get(..HEADER_BYTES + payload_bytes).ok_or(ImageError::BufferTooSmall)
}

#[cfg(test)]
mod tests;
