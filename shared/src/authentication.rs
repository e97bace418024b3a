//! Who made an image: an optional tag behind it, by a key that trainer and drive share. A table is torque; a CRC finds damage, not
//! forgery.
//!
//! The tag is HMAC-SHA-256 (RFC 2104, FIPS 180-4) over every byte of the image, which makes `openssl dgst -sha256 -mac HMAC` a second
//! opinion. It says who made the image, not that no later one exists.

use hmac::{Hmac, KeyInit, Mac};
use sha2::Sha256;

use crate::image::{Image, ImageError, decode, image_bytes};

/// Bytes of a key.
pub const KEY_BYTES: usize = 32;

/// Bytes of a tag.
pub const TAG_BYTES: usize = 32;

/// A secret that trainer and drive share.
#[derive(Clone)]
pub struct Key([u8; KEY_BYTES]);

impl Key {
    /// The key of these bytes, which come from a source of randomness.
    #[must_use]
    pub const fn new(bytes: [u8; KEY_BYTES]) -> Self {
        Self(bytes)
    }

    fn hasher(&self) -> Hmac<Sha256> {
        let mut block = hmac::digest::Key::<Hmac<Sha256>>::default();
        for (byte, key) in block.iter_mut().zip(&self.0) {
            *byte = *key;
        }
        // A key that is padded with zeros to the length of a block is the same key (RFC 2104).
        Hmac::new(&block)
    }

    /// The tag of an image.
    #[must_use]
    pub fn tag(&self, image: &[u8]) -> [u8; TAG_BYTES] {
        self.hasher().chain_update(image).finalize().into_bytes().into()
    }
}

/// A key is never printed.
impl core::fmt::Debug for Key {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Key(..)")
    }
}

/// Whose images a drive takes.
#[derive(Clone, Copy, Debug)]
pub enum Trust<'a> {
    /// Anyone's: plain images.
    Anyone,
    /// Those of whoever has the key: images with their tag behind them. A plain image is refused.
    Key(&'a Key),
}

impl Trust<'_> {
    /// Bytes that stand behind an image.
    #[must_use]
    pub const fn tag_bytes(self) -> usize {
        match self {
            Self::Anyone => 0,
            Self::Key(_) => TAG_BYTES,
        }
    }

    /// The image at the start of a region of flash, with its tag where one is asked for; what follows is not looked at.
    ///
    /// # Errors
    /// As [`image_bytes`].
    pub fn stored(self, flash: &[u8]) -> Result<&[u8], ImageError> {
        let length = image_bytes(flash)?.saturating_add(self.tag_bytes());
        flash.get(..length).ok_or(ImageError::Truncated)
    }

    /// Decodes exactly one image, after its tag where one is asked for. Tags are compared in constant time, before anything of
    /// the image is read.
    ///
    /// # Errors
    /// [`ImageError::NotAuthentic`] where the tag is not right or not there, and those of [`decode`].
    pub fn decode<const CELLS: usize>(self, bytes: &[u8]) -> Result<Image<CELLS>, ImageError> {
        match self {
            Self::Anyone => decode(bytes),
            Self::Key(key) => {
                let (image, tag) = bytes.split_last_chunk::<TAG_BYTES>().ok_or(ImageError::NotAuthentic)?;
                key.hasher().chain_update(image).verify_slice(tag).map_err(|_| ImageError::NotAuthentic)?;
                decode(image)
            }
        }
    }
}

#[cfg(test)]
mod tests;
