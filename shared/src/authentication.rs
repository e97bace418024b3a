//! Who made an image: an optional tag behind it, by a key that trainer and drive share, or a signature, by a secret that no drive has. A table is torque; a CRC finds damage, not
//! forgery.
//!
//! The tag is HMAC-SHA-256 (RFC 2104, FIPS 180-4) over every byte before it, which makes `openssl dgst -sha256 -mac HMAC` a second
//! opinion. It says who made the image; the number of a release, between image and tag, says which of two is the later one.

pub mod admission;
pub mod signature;

#[cfg(feature = "auth")]
use hmac::{Hmac, KeyInit, Mac};
#[cfg(feature = "auth")]
use sha2::Sha256;

#[cfg(feature = "models")]
use crate::image::{Image, decode};
use crate::image::{ImageError, image_bytes};
use signature::{PublicKey, SIGNATURE_BYTES};

/// Bytes of a key.
pub const KEY_BYTES: usize = 32;

/// Bytes of a tag.
pub const TAG_BYTES: usize = 32;

/// First bytes of the number of a release, which stands between image and tag, and under the tag.
pub const RELEASE_MAGIC: [u8; 4] = *b"FRLS";

/// Bytes of it: [`RELEASE_MAGIC`] and the number, little-endian.
pub const RELEASE_BYTES: usize = 8;

/// What stands behind the image of a release, before the tag.
#[must_use]
pub fn release_block(release: u32) -> [u8; RELEASE_BYTES] {
    let ([a, b, c, d], [e, f, g, h]) = (RELEASE_MAGIC, release.to_le_bytes());
    [a, b, c, d, e, f, g, h]
}

/// An image before the number of its release, and the number, 0 where there is none.
fn without_release(bytes: &[u8]) -> (&[u8], u32) {
    let block = bytes.split_last_chunk::<RELEASE_BYTES>();
    match block.map(|(image, block)| (image, block.as_chunks().0)) {
        // The tag has said that whoever made the image has put it there, as far as the header goes.
        Some((image, [RELEASE_MAGIC, number])) if image_bytes(image) == Ok(image.len()) => {
            (image, u32::from_le_bytes(*number))
        }
        _ => (bytes, 0),
    }
}

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
    /// Those of whoever has the secret of this public key: images with their signature behind them. A plain image is refused.
    Signed(&'a PublicKey),
}

impl Trust<'_> {
    /// Bytes of the tag or the signature behind an image.
    #[must_use]
    pub const fn tag_bytes(self) -> usize {
        match self {
            Self::Anyone => 0,
            Self::Key(_) => TAG_BYTES,
            Self::Signed(_) => SIGNATURE_BYTES,
        }
    }

    /// The image at the start of a region of flash, with the number of its release and its tag where one is asked for; what follows is not looked at.
    ///
    /// # Errors
    /// As [`image_bytes`].
    pub fn stored(self, flash: &[u8]) -> Result<&[u8], ImageError> {
        let image = image_bytes(flash)?;
        let has_release =
            self.tag_bytes() > 0 && flash.get(image..).is_some_and(|behind| behind.starts_with(&RELEASE_MAGIC));
        let release = if has_release { RELEASE_BYTES } else { 0 };
        flash.get(..image.saturating_add(release + self.tag_bytes())).ok_or(ImageError::Truncated)
    }

    /// The image of exactly one image and its tag where one is asked for. Tags are compared in constant time, before anything of
    /// the image is read.
    ///
    /// # Errors
    /// [`ImageError::NotAuthentic`] where the tag is not right or not there.
    pub fn authentic(self, bytes: &[u8]) -> Result<&[u8], ImageError> {
        self.released(bytes).map(|(image, _)| image)
    }

    /// As [`Trust::authentic`], with the number of the release, which the tag covers as well; 0 where there is none.
    ///
    /// # Errors
    /// [`ImageError::NotAuthentic`] where the tag is not right or not there.
    pub fn released(self, bytes: &[u8]) -> Result<(&[u8], u32), ImageError> {
        match self {
            Self::Anyone => Ok((bytes, 0)),
            Self::Key(key) => {
                let (tagged, tag) = bytes.split_last_chunk::<TAG_BYTES>().ok_or(ImageError::NotAuthentic)?;
                if key.has_made(tagged, tag) { Ok(without_release(tagged)) } else { Err(ImageError::NotAuthentic) }
            }
            Self::Signed(key) => {
                let (signed, signature) =
                    bytes.split_last_chunk::<SIGNATURE_BYTES>().ok_or(ImageError::NotAuthentic)?;
                if key.has_signed(signed, signature) {
                    Ok(without_release(signed))
                } else {
                    Err(ImageError::NotAuthentic)
                }
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
