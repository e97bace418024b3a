use super::*;
use crate::authentication::{Trust, release_block};
use crate::image::{HEADER_BYTES, ImageError};

/// The first test of RFC 8032, 7.1.
const SEED: [u8; 32] = [
    0x9d, 0x61, 0xb1, 0x9d, 0xef, 0xfd, 0x5a, 0x60, 0xba, 0x84, 0x4a, 0xf4, 0x92, 0xec, 0x2c, 0xc4, 0x44, 0x49, 0xc5,
    0x69, 0x7b, 0x32, 0x69, 0x19, 0x70, 0x3b, 0xac, 0x03, 0x1c, 0xae, 0x7f, 0x60,
];
const PUBLIC: [u8; 32] = [
    0xd7, 0x5a, 0x98, 0x01, 0x82, 0xb1, 0x0a, 0xb7, 0xd5, 0x4b, 0xfe, 0xd3, 0xc9, 0x64, 0x07, 0x3a, 0x0e, 0xe1, 0x72,
    0xf3, 0xda, 0xa6, 0x23, 0x25, 0xaf, 0x02, 0x1a, 0x68, 0xf7, 0x07, 0x51, 0x1a,
];
const OF_NOTHING: [u8; 4] = [0xe5, 0x56, 0x43, 0x00];

/// A header that says how long the image is, and a payload.
fn image() -> std::vec::Vec<u8> {
    let mut bytes = std::vec![0; HEADER_BYTES + 5];
    bytes[..4].copy_from_slice(b"FRKN");
    bytes[4] = 6;
    bytes[8] = 5;
    bytes
}

#[test]
fn a_signature_is_that_of_the_standard() {
    let signer = Signer::new(SEED);
    assert_eq!(signer.public_key(), PUBLIC);
    assert_eq!(signer.sign(&[])[..4], OF_NOTHING);
}

#[test]
fn only_what_was_signed_is_taken() {
    let signer = Signer::new(SEED);
    let key = PublicKey::new(PUBLIC);
    let trust = Trust::Signed(&key);
    let image = image();
    let mut signed = image.clone();
    signed.extend(signer.sign(&image));
    assert_eq!(trust.released(&signed), Ok((&image[..], 0)));
    let flash = [&signed[..], &[0xFF; 30]].concat();
    assert_eq!(trust.stored(&flash), Ok(&signed[..]));
    let refused = Err(ImageError::NotAuthentic);
    for byte in 0..signed.len() {
        let mut forged = signed.clone();
        forged[byte] ^= 1;
        assert_eq!(trust.released(&forged), refused, "byte {byte}");
    }
    assert_eq!(trust.released(&image), refused);
    let mut other = image.clone();
    other.extend(Signer::new([7; 32]).sign(&image));
    assert_eq!(trust.released(&other), refused);
    // A key of zeros, a point of small order, signs nothing, though what it is asked is easily made.
    let zeros = PublicKey::new([0; 32]);
    let mut forged = image.clone();
    forged.extend([0; 64]);
    assert_eq!(Trust::Signed(&zeros).released(&forged), refused);
}

#[test]
fn the_number_of_a_release_is_signed_too() {
    let (signer, key) = (Signer::new(SEED), PublicKey::new(PUBLIC));
    let mut release = image();
    release.extend(release_block(9));
    let signature = signer.sign(&release);
    release.extend(signature);
    assert_eq!(Trust::Signed(&key).released(&release), Ok((&image()[..], 9)));
    release[HEADER_BYTES + 5 + 4] = 10;
    assert_eq!(Trust::Signed(&key).released(&release), Err(ImageError::NotAuthentic));
}
