//! Images as models in memory.

use super::header::{
    COVERED_HEADER_BYTES, FORMAT_VERSION, HEADER_BYTES, ImageError, MAGIC, MAX_PAYLOAD_BYTES, checksum, verified,
};
use crate::model::{LawError, Model, Provenance};

/// A model with its provenance.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<const CELLS: usize> {
    /// Where the model comes from.
    pub provenance: Provenance,
    /// The model.
    pub model: Model<CELLS>,
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
