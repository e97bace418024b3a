//! Images as models in memory.

use super::header::{
    COVERED_HEADER_BYTES, Checksum, FORMAT_VERSION, HEADER_BYTES, ImageError, LAW_ERROR_SINCE, MAGIC,
    MAX_PAYLOAD_BYTES, RIGID_BODY_ERROR_SINCE, checksum, verified,
};
use crate::model::{LawError, Model, Provenance};

/// Since when effects are written as they are today.
const EFFECTS_SINCE: u16 = 4;

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
    let (provenance, rest) = provenance(header.version, payload).map_err(|_| ImageError::Malformed)?;
    let LawError { slow, sliding } = provenance.law_error;
    let is_bounded = [slow, sliding].iter().all(|error| error.is_finite() && *error >= 0.0);
    if !is_bounded || !provenance.rigid_body_error.factor.iter().all(|error| error.is_finite()) {
        return Err(ImageError::Malformed);
    }
    let decoded = postcard::take_from_bytes::<Model<CELLS>>(rest);
    if header.version < EFFECTS_SINCE && !decoded.as_ref().is_ok_and(|(model, _)| model.effects.is_empty()) {
        return Err(ImageError::UnsupportedVersion(header.version));
    }
    let (model, rest) = decoded.map_err(|_| ImageError::Malformed)?;
    if !rest.is_empty() || model.cells.len() != usize::from(header.cells) {
        return Err(ImageError::Malformed);
    }
    model.validate()?;
    Ok(Image { provenance, model })
}

/// The provenance at the start of a payload: earlier versions say less, and what they do not say was not determined.
fn provenance(version: u16, payload: &[u8]) -> postcard::Result<(Provenance, &[u8])> {
    let ((joint, trainer_version, recordings_hash, seed), mut rest) = postcard::take_from_bytes(payload)?;
    let (mut law_error, mut rigid_body_error) = Default::default();
    if version >= LAW_ERROR_SINCE {
        (law_error, rest) = postcard::take_from_bytes(rest)?;
    }
    if version >= RIGID_BODY_ERROR_SINCE {
        (rigid_body_error, rest) = postcard::take_from_bytes(rest)?;
    }
    Ok((Provenance { joint, trainer_version, recordings_hash, seed, law_error, rigid_body_error }, rest))
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

/// CRC-32 of a model as it is in memory: another number than before means that memory has changed. Takes as long as the encoding of an image.
#[must_use]
pub fn model_checksum<const CELLS: usize>(model: &Model<CELLS>) -> u32 {
    // Nothing is written that could be too small.
    postcard::serialize_with_flavor(model, Summed(Checksum::new())).unwrap_or(0)
}

/// Takes bytes for their checksum alone.
struct Summed(Checksum);

impl postcard::ser_flavors::Flavor for Summed {
    type Output = u32;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.0 = self.0.over(&[byte]);
        Ok(())
    }

    fn finalize(self) -> postcard::Result<u32> {
        Ok(self.0.value())
    }
}
