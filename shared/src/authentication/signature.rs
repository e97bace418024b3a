//! Signatures behind images, by Ed25519 (RFC 8032): who makes images keeps a secret, and the drives of a fleet hold a public key that makes none, so that one
//! drive that is opened does not open the others.
//!
//! The arithmetic is that of the crate ed25519-compact, whose bounds checks a linker keeps: with this feature alone a firmware holds code that could
//! panic, though no input is known that gets there. It takes 20.7 kB of flash on a Cortex-M4F.

#[cfg(feature = "signature")]
use ed25519_compact as ed25519;

/// Bytes of a public key, and of the seed from which a secret one is made.
pub const PUBLIC_KEY_BYTES: usize = 32;

/// Bytes of a signature.
pub const SIGNATURE_BYTES: usize = 64;

/// The public key of whoever makes images.
#[cfg(feature = "signature")]
#[derive(Clone, Debug)]
pub struct PublicKey(ed25519::PublicKey);

/// A public key that nobody has: this firmware was built without the feature `signature`.
#[cfg(not(feature = "signature"))]
#[derive(Clone, Debug)]
pub enum PublicKey {}

#[cfg(feature = "signature")]
impl PublicKey {
    /// The key of these bytes. One that is no key signs nothing.
    #[must_use]
    pub fn new(bytes: [u8; PUBLIC_KEY_BYTES]) -> Self {
        Self(ed25519::PublicKey::new(bytes))
    }

    /// Whether a signature is that of an image.
    pub(super) fn has_signed(&self, image: &[u8], signature: &[u8; SIGNATURE_BYTES]) -> bool {
        self.0.verify(image, &ed25519::Signature::new(*signature)).is_ok()
    }
}

#[cfg(not(feature = "signature"))]
impl PublicKey {
    pub(super) fn has_signed(&self, _: &[u8], _: &[u8; SIGNATURE_BYTES]) -> bool {
        match *self {}
    }
}

/// The secret of whoever makes images; no drive needs it.
#[cfg(feature = "signature")]
#[derive(Clone)]
pub struct Signer(ed25519::KeyPair);

#[cfg(feature = "signature")]
impl Signer {
    /// The secret of a seed, which comes from a source of randomness.
    #[must_use]
    pub fn new(seed: [u8; PUBLIC_KEY_BYTES]) -> Self {
        Self(ed25519::KeyPair::from_seed(ed25519::Seed::new(seed)))
    }

    /// What the drives hold.
    #[must_use]
    pub fn public_key(&self) -> [u8; PUBLIC_KEY_BYTES] {
        *self.0.pk
    }

    /// The signature of an image, with the number of its release where it has one.
    #[must_use]
    pub fn sign(&self, image: &[u8]) -> [u8; SIGNATURE_BYTES] {
        *self.0.sk.sign(image, None)
    }
}

/// A secret is never printed.
#[cfg(feature = "signature")]
impl core::fmt::Debug for Signer {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Signer(..)")
    }
}

#[cfg(all(test, feature = "signature", feature = "models"))]
mod tests;
