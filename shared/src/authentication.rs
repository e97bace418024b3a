//! Who made an image: an optional tag behind it, by a key that trainer and drive share. A table is torque; a CRC finds damage, not
//! forgery.
//!
//! The tag is HMAC-SHA-256 (RFC 2104, FIPS 180-4) over every byte of the image, which makes `openssl dgst -sha256 -mac HMAC` a second
//! opinion. It says who made the image, not that no later one exists.

#[cfg(feature = "auth")]
use hmac::{Hmac, KeyInit, Mac};
#[cfg(feature = "auth")]
use sha2::Sha256;

#[cfg(feature = "models")]
use crate::image::{Image, decode};
use crate::image::{ImageError, image_bytes};

/// Bytes of a key.
pub const KEY_BYTES: usize = 32;

/// Bytes of a tag.
pub const TAG_BYTES: usize = 32;

/// A secret that trainer and drive share.
#[cfg(feature = "auth")]
#[derive(Clone)]
pub struct Key([u8; KEY_BYTES]);

/// A secret that nobody has: this firmware was built without the feature `auth`.
#[cfg(not(feature = "auth"))]
#[derive(Clone)]
pub enum Key {}

#[cfg(feature = "auth")]
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

    /// Whether a tag is that of an image, in constant time.
    fn has_made(&self, image: &[u8], tag: &[u8; TAG_BYTES]) -> bool {
        self.hasher().chain_update(image).verify_slice(tag).is_ok()
    }
}

#[cfg(not(feature = "auth"))]
impl Key {
    fn has_made(&self, _: &[u8], _: &[u8; TAG_BYTES]) -> bool {
        match *self {}
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

    /// The image of exactly one image and its tag where one is asked for. Tags are compared in constant time, before anything of
    /// the image is read.
    ///
    /// # Errors
    /// [`ImageError::NotAuthentic`] where the tag is not right or not there.
    pub fn authentic(self, bytes: &[u8]) -> Result<&[u8], ImageError> {
        match self {
            Self::Anyone => Ok(bytes),
            Self::Key(key) => {
                let (image, tag) = bytes.split_last_chunk::<TAG_BYTES>().ok_or(ImageError::NotAuthentic)?;
                if key.has_made(image, tag) { Ok(image) } else { Err(ImageError::NotAuthentic) }
            }
        }
    }

    /// Decodes exactly one image, after its tag where one is asked for.
    ///
    /// # Errors
    /// Those of [`Trust::authentic`] and of [`decode`].
    #[cfg(feature = "models")]
    pub fn decode<const CELLS: usize>(self, bytes: &[u8]) -> Result<Image<CELLS>, ImageError> {
        decode(self.authentic(bytes)?)
    }
}

#[cfg(all(test, feature = "auth", feature = "models"))]
mod tests;
