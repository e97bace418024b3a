//! Law, inputs and rigid body become a model, and a model becomes the bytes of an image.

use crc::{CRC_64_XZ, Crc};
use frikan_shared::image::{Image, decode, encode};
use frikan_shared::model::{Input, Law, LawError, Provenance, RigidBody, RigidBodyError};
use frikan_shared::pool::Pool;
use frikan_shared::table::Cell;
use frikan_shared::units::Unit;

use super::data::inputs::ChosenInput;
pub use crate::compile::host_model::{CELLS, HostModel};
use crate::error::{Error, Result, codes};
use crate::recording::Recording;

/// Largest image that is read, in bytes.
const IMAGE_LIMIT_BYTES: u64 = 1 << 20;

/// A law with what it needs beside it.
#[derive(Clone, Debug)]
pub(super) struct Parts<'a> {
    pub(super) law: Law,
    pub(super) cells: &'a [Cell],
    /// In the order in which the law counts them.
    pub(super) inputs: Vec<&'a ChosenInput>,
    pub(super) unit: Unit,
    pub(super) limit: f64,
    pub(super) rigid_body: RigidBody,
}

/// Puts a model together; `None` where it has no room for its cells or would be refused.
pub(super) fn assemble(parts: &Parts<'_>) -> Option<Box<HostModel>> {
    let inputs = parts.inputs.iter().map(|input| Input {
        quantity: input.quantity.clone(),
        unit: input.unit,
        low: input.low as f32,
        high: input.high as f32,
    });
    let model = HostModel {
        inputs: inputs.collect(),
        output_unit: parts.unit,
        output_limit: parts.limit as f32,
        rigid_body: parts.rigid_body,
        law: parts.law.clone(),
        effects: heapless::Vec::new(),
        cells: Pool::from_slice(parts.cells).ok()?,
    };
    model.validate().ok()?;
    Some(Box::new(model))
}

/// Where a model comes from; the errors of its law and of its rigid body are not determined yet. The joint's name is cut to what an image
/// holds.
pub(crate) fn provenance(joint: &str, recordings: &[Recording], seed: u64) -> Provenance {
    Provenance {
        joint: cut(joint),
        trainer_version: cut(env!("CARGO_PKG_VERSION")),
        recordings_hash: recordings_hash(recordings),
        seed,
        law_error: LawError::default(),
        rigid_body_error: RigidBodyError::default(),
    }
}

/// CRC-64/XZ over the hashes of the recordings in their order, little-endian.
fn recordings_hash(recordings: &[Recording]) -> u64 {
    static CHECKSUM: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);
    let mut digest = CHECKSUM.digest();
    for recording in recordings {
        digest.update(&recording.content_hash.to_le_bytes());
    }
    digest.finalize()
}

fn cut<const N: usize>(text: &str) -> heapless::String<N> {
    let mut short = heapless::String::new();
    for character in text.chars() {
        if short.push(character).is_err() {
            break;
        }
    }
    short
}

/// The bytes of an image.
///
/// # Errors
/// `FRK-D020` when the model would be refused by a decoder.
pub fn to_bytes(image: &Image<CELLS>) -> Result<Vec<u8>> {
    let mut buffer = vec![0; CELLS * 16 + 8192];
    let bytes = encode(image, &mut buffer).map_err(|error| Error::new(&codes::BAD_IMAGE, error.to_string()))?;
    Ok(bytes.to_vec())
}

/// Decodes the bytes of an image.
///
/// # Errors
/// `FRK-D020` with what is wrong with them.
pub fn from_bytes(bytes: &[u8]) -> Result<Box<Image<CELLS>>> {
    decode(bytes).map(Box::new).map_err(|error| Error::new(&codes::BAD_IMAGE, error.to_string()))
}

/// Reads an image from a file, with its bytes.
///
/// # Errors
/// `FRK-I...` when the file cannot be read, `FRK-D019` or `FRK-D020` when it holds no image.
pub fn load(path: &std::path::Path) -> Result<(Vec<u8>, Box<Image<CELLS>>)> {
    let bytes = crate::files::read_whole(path, IMAGE_LIMIT_BYTES)?;
    let image = from_bytes(&bytes).map_err(|error| error.in_file(path.display().to_string()))?;
    Ok((bytes, image))
}
