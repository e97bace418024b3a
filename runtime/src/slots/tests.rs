use super::*;
use crate::test_models::{coulomb_model, image_of};
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

const SLOT_BYTES: usize = 512;

fn image(coulomb: f32) -> Vec<u8> {
    image_of(coulomb_model(coulomb, &[]))
}

fn slot(sequence: u32, image: &[u8]) -> Vec<u8> {
    let mut bytes = slot_header(sequence, image).unwrap().to_vec();
    bytes.extend(image);
    bytes.resize(SLOT_BYTES, 0xFF);
    bytes
}

fn loaded(first: &[u8], second: &[u8]) -> Result<Which, SlotError> {
    load::<16>(first, second).map(|(which, _)| which)
}

#[test]
fn the_newest_valid_slot_wins() {
    let erased = vec![0xFF; SLOT_BYTES];
    let (old, new) = (slot(4, &image(1.0)), slot(5, &image(2.0)));
    assert_eq!(loaded(&erased, &erased), Err(SlotError::Empty));
    assert_eq!(loaded(&[], &[0xFF]), Err(SlotError::Empty));
    assert_eq!(loaded(&old, &erased), Ok(Which::First));
    assert_eq!(loaded(&old, &new), Ok(Which::Second));
    assert_eq!(loaded(&new, &old), Ok(Which::First));
    assert_eq!(next_write(&old, &new), (Which::First, 6));
    assert_eq!(next_write(&erased, &erased), (Which::First, 1));
    // Numbers run on through zero.
    assert_eq!(loaded(&slot(u32::MAX, &image(1.0)), &slot(0, &image(2.0))), Ok(Which::Second));
    assert_eq!(next_write(&slot(u32::MAX, &image(1.0)), &erased), (Which::Second, 0));
}

#[test]
fn an_intact_slot_that_cannot_be_used_gives_way_to_the_older() {
    let mut later_format = image(2.0);
    later_format[4] = 2;
    let (old, new) = (slot(4, &image(1.0)), slot(5, &later_format));
    assert_eq!(loaded(&old, &new), Ok(Which::First));
    let erased = vec![0xFF; SLOT_BYTES];
    assert_eq!(loaded(&erased, &new), Err(SlotError::Image(ImageError::UnsupportedVersion(2))));
}

/// Every state that a cut can leave: erased up to a byte, or programmed up to a byte over an erased slot.
#[test]
fn a_cut_write_at_any_byte_leaves_the_slot_before() {
    let erased = vec![0xFF; SLOT_BYTES];
    let current = slot(8, &image(1.0));
    let stale = slot(7, &image(3.0));
    for previous in [&erased, &stale] {
        let (which, sequence) = next_write(&current, previous);
        assert_eq!((which, sequence), (Which::Second, 9));
        let next = slot(sequence, &image(2.0));
        let written = SLOT_HEADER_BYTES + image(2.0).len();
        for cut in 0..=SLOT_BYTES {
            let mut erasing = previous.clone();
            erasing[..cut].fill(0xFF);
            assert_eq!(loaded(&current, &erasing), Ok(Which::First), "erase cut at {cut}");
            // In the order of addresses, in the order recommended, and without an erase in between.
            for base in [&erased, previous] {
                let mut by_address = base.clone();
                by_address[..cut].copy_from_slice(&next[..cut]);
                let mut header_last = base.clone();
                let body = cut.min(SLOT_BYTES - SLOT_HEADER_BYTES);
                header_last[SLOT_HEADER_BYTES..SLOT_HEADER_BYTES + body]
                    .copy_from_slice(&next[SLOT_HEADER_BYTES..SLOT_HEADER_BYTES + body]);
                let head = cut - body;
                header_last[..head].copy_from_slice(&next[..head]);
                for (bytes, complete) in [(&by_address, cut >= written), (&header_last, cut >= SLOT_BYTES)] {
                    let winner = loaded(&current, bytes);
                    let whole = bytes[..written] == next[..written];
                    assert!(whole || !complete);
                    let expected = if whole { Which::Second } else { Which::First };
                    assert_eq!(winner, Ok(expected), "cut at {cut}");
                }
            }
        }
    }
}

#[test]
fn a_flipped_bit_anywhere_leaves_the_other_slot_or_nothing() {
    let (old, new) = (slot(4, &image(1.0)), slot(5, &image(2.0)));
    let erased = vec![0xFF; SLOT_BYTES];
    for bit in 0..8 * (SLOT_HEADER_BYTES + image(2.0).len()) {
        let mut damaged = new.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(loaded(&old, &damaged), Ok(Which::First), "bit {bit}");
        assert_eq!(loaded(&erased, &damaged), Err(SlotError::Empty), "bit {bit}");
    }
}

proptest! {
    #[test]
    fn arbitrary_flash_never_panics(first in proptest::collection::vec(any::<u8>(), 0..200), second in proptest::collection::vec(any::<u8>(), 0..200)) {
        prop_assert_eq!(loaded(&first, &second), Err(SlotError::Empty));
        prop_assert_eq!(next_write(&first, &second), (Which::First, 1));
    }
}
