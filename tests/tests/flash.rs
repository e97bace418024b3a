//! What flash can do to an image, on the golden images and on one of every kind.

use frikan_runtime::shared::image::decode;
use frikan_tests::fixtures::folder;
use frikan_tests::models::{CELLS, every_kind, image, integer_table};

/// Networks are larger, and no different.
const LARGEST_IMAGE_BYTES: usize = 1200;

/// Names and bytes.
fn images() -> Vec<(&'static str, Vec<u8>)> {
    let golden = ["elbow", "stribeck"];
    let golden = golden.map(|name| (name, std::fs::read(folder().join(name).with_extension("frk")).unwrap()));
    let made = every_kind().into_iter().chain([("integer table", integer_table())]);
    let images = golden.into_iter().chain(made.map(|(name, model)| (name, image(&model))));
    images.filter(|(_, bytes)| bytes.len() <= LARGEST_IMAGE_BYTES).collect()
}

#[test]
fn every_flipped_bit_of_an_image_is_refused() {
    for (name, sound) in images() {
        assert!(decode::<CELLS>(&sound).is_ok(), "{name}");
        for bit in 0..8 * sound.len() {
            let mut damaged = sound.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(decode::<CELLS>(&damaged).is_err(), "{name}, bit {bit}");
        }
    }
}

/// Bursts that a sector's hardware leaves: a run of bytes erased or cleared.
#[test]
fn every_erased_or_cleared_run_of_bytes_is_refused() {
    for (name, sound) in images() {
        for start in 0..sound.len() {
            for (length, fill) in [(1, 0xFF), (1, 0x00), (4, 0xFF), (4, 0x00), (16, 0xFF), (16, 0x00)] {
                let mut damaged = sound.clone();
                let end = (start + length).min(sound.len());
                damaged[start..end].fill(fill);
                assert!(damaged == sound || decode::<CELLS>(&damaged).is_err(), "{name}, {length} bytes at {start}");
            }
        }
    }
}

#[test]
fn every_shortened_image_is_refused() {
    for (name, sound) in images() {
        for length in 0..sound.len() {
            assert!(decode::<CELLS>(&sound[..length]).is_err(), "{name}, {length} bytes");
        }
    }
}
