use super::*;
use crate::expression::{Operation, Program};
use crate::image::encode;
use crate::model::{Input, Law, Model, Provenance, RigidBody};
use crate::pool::Pool;
use crate::units::{Quantity, Unit};
use std::vec::Vec;

const KEY: Key = Key::new([0x5A; KEY_BYTES]);
const OTHER: Key = Key::new([0x5B; KEY_BYTES]);

/// An interpreter sees a part of the bits.
const EVERY: usize = if cfg!(miri) { 97 } else { 1 };

/// The image of a viscous law.
fn plain() -> Vec<u8> {
    let operations = [Operation::ScaledInput(0, 2.0)];
    let input = Input { quantity: Quantity::Velocity, unit: Unit::RadianPerSecond, low: -1.0, high: 1.0 };
    let model = Model::<1> {
        law: Law::Expression(Program { operations: heapless::Vec::from_slice(&operations).unwrap() }),
        cells: Pool::new(),
        inputs: heapless::Vec::from_slice(&[input]).unwrap(),
        output_unit: Unit::NewtonMetre,
        output_limit: 10.0,
        rigid_body: RigidBody::default(),
        effects: heapless::Vec::new(),
    };
    let mut buffer = [0; 512];
    encode(&Image { provenance: Provenance::default(), model }, &mut buffer).unwrap().to_vec()
}

fn tagged(key: &Key) -> Vec<u8> {
    let image = plain();
    [&image[..], &key.tag(&image)].concat()
}

fn refusal(trust: Trust<'_>, bytes: &[u8]) -> Option<ImageError> {
    trust.decode::<1>(bytes).err()
}

/// Test case 1 of RFC 4231, whose key of 20 bytes is padded with zeros as every key is.
#[test]
fn the_tag_is_hmac_sha_256() {
    let mut key = [0; KEY_BYTES];
    key[..20].fill(0x0B);
    let expected = [
        0xB0, 0x34, 0x4C, 0x61, 0xD8, 0xDB, 0x38, 0x53, 0x5C, 0xA8, 0xAF, 0xCE, 0xAF, 0x0B, 0xF1, 0x2B, 0x88, 0x1D,
        0xC2, 0x00, 0xC9, 0x83, 0x3D, 0xA7, 0x26, 0xE9, 0x37, 0x6C, 0x2E, 0x32, 0xCF, 0xF7,
    ];
    assert_eq!(Key::new(key).tag(b"Hi There"), expected);
}

#[test]
fn only_the_holder_of_the_key_is_trusted() {
    assert_eq!(refusal(Trust::Key(&KEY), &tagged(&KEY)), None);
    assert_eq!(refusal(Trust::Key(&KEY), &tagged(&OTHER)), Some(ImageError::NotAuthentic));
    assert_eq!(refusal(Trust::Key(&KEY), &plain()), Some(ImageError::NotAuthentic));
    assert_eq!(refusal(Trust::Key(&KEY), &[]), Some(ImageError::NotAuthentic));
    assert_eq!(refusal(Trust::Anyone, &plain()), None);
    assert_eq!(refusal(Trust::Anyone, &tagged(&KEY)), Some(ImageError::TrailingBytes));
}

#[test]
fn every_flipped_bit_of_image_and_tag_is_refused() {
    let sound = tagged(&KEY);
    for bit in (0..8 * sound.len()).step_by(EVERY) {
        let mut forged = sound.clone();
        forged[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(refusal(Trust::Key(&KEY), &forged), Some(ImageError::NotAuthentic), "bit {bit}");
    }
    // The tag is over the image and nothing else: a forger who makes the CRC right gets no further.
    let mut forged = sound.clone();
    let end = forged.len() - TAG_BYTES;
    forged[end - 1] ^= 1;
    let crc32 = crate::image::checksum(&[&forged[..12], &forged[16..end]]);
    forged[12..16].copy_from_slice(&crc32.to_le_bytes());
    assert!(decode::<1>(&forged[..end]).err() != Some(ImageError::CrcMismatch));
    assert_eq!(refusal(Trust::Key(&KEY), &forged), Some(ImageError::NotAuthentic));
}

#[test]
fn what_is_stored_ends_with_the_image_or_its_tag() {
    let flash = [&tagged(&KEY)[..], &[0xFF; 100]].concat();
    assert_eq!(Trust::Anyone.stored(&flash), Ok(&plain()[..]));
    assert_eq!(Trust::Key(&KEY).stored(&flash), Ok(&tagged(&KEY)[..]));
    assert_eq!(Trust::Key(&KEY).stored(&plain()), Err(ImageError::Truncated));
    assert_eq!(Trust::Anyone.stored(&[0xFF; 100]), Err(ImageError::BadMagic));
}

#[test]
fn a_key_is_not_printed() {
    assert_eq!(std::format!("{KEY:?}"), "Key(..)");
}
