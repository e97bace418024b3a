use super::*;
use crate::test_models::{coulomb_model, image_of};
use frikan_shared::authentication::Key;
use frikan_shared::effect::Effect;
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

const SLOT_BYTES: usize = 512;
const CELLS: usize = 16;
/// An interpreter sees a part of the cuts and bits.
const EVERY: usize = if cfg!(miri) { 397 } else { 1 };
/// And of the lengths and the contents before.
const MOST: usize = if cfg!(miri) { 1 } else { usize::MAX };

/// An image of some length: every spring takes nine bytes.
fn image(coulomb: f32, springs: usize) -> Vec<u8> {
    let springs = vec![Effect::Spring { stiffness: 1.0, rest: 0.5 }; springs];
    image_of(coulomb_model(coulomb, &springs))
}

fn slot(sequence: u32, image: &[u8]) -> Vec<u8> {
    let mut bytes = slot_header(sequence, image).unwrap().to_vec();
    bytes.extend(image);
    bytes.resize(SLOT_BYTES, 0xFF);
    bytes
}

fn loaded(first: &[u8], second: &[u8]) -> Result<Which, ImageError> {
    load::<CELLS>(first, second, Trust::Anyone).map(|(which, _)| which)
}

fn next(first: &[u8], second: &[u8]) -> (Which, u32) {
    next_write::<CELLS>(first, second, Trust::Anyone)
}

#[test]
fn the_newest_valid_slot_wins() {
    let erased = vec![0xFF; SLOT_BYTES];
    let (old, new) = (slot(4, &image(1.0, 0)), slot(5, &image(2.0, 0)));
    assert_eq!(loaded(&erased, &erased), Err(ImageError::NoImage));
    assert_eq!(loaded(&[], &[0xFF]), Err(ImageError::NoImage));
    assert_eq!(loaded(&old, &erased), Ok(Which::First));
    assert_eq!(loaded(&old, &new), Ok(Which::Second));
    assert_eq!(loaded(&new, &old), Ok(Which::First));
    assert_eq!(next(&old, &new), (Which::First, 6));
    assert_eq!(next(&erased, &erased), (Which::First, 1));
    // Numbers run on through zero.
    let (last, wrapped) = (slot(u32::MAX, &image(1.0, 0)), slot(0, &image(2.0, 0)));
    assert_eq!(loaded(&last, &wrapped), Ok(Which::Second));
    assert_eq!(next(&last, &erased), (Which::Second, 0));
}

/// The older slot is then the one in use, and the next write spares it.
#[test]
fn an_intact_slot_that_cannot_be_used_gives_way_to_the_older() {
    let mut later_format = image(2.0, 0);
    later_format[4] = frikan_shared::image::FORMAT_VERSION as u8 + 1;
    let (old, new) = (slot(4, &image(1.0, 0)), slot(5, &later_format));
    assert_eq!((loaded(&old, &new), next(&old, &new)), (Ok(Which::First), (Which::Second, 6)));
    assert_eq!((loaded(&new, &old), next(&new, &old)), (Ok(Which::Second), (Which::First, 6)));
    let erased = vec![0xFF; SLOT_BYTES];
    assert_eq!(loaded(&erased, &new), Err(ImageError::UnsupportedVersion(frikan_shared::image::FORMAT_VERSION + 1)));
}

#[test]
fn a_drive_with_a_key_passes_over_images_without_its_tag() {
    let (key, other) = (Key::new([1; 32]), Key::new([2; 32]));
    let tagged = |key: &Key, image: &[u8]| [image, &key.tag(image)].concat();
    let load = |first: &[u8], second: &[u8]| load::<CELLS>(first, second, Trust::Key(&key)).map(|(which, _)| which);
    let genuine = slot(4, &tagged(&key, &image(1.0, 0)));
    for foreign in [image(2.0, 0), tagged(&other, &image(2.0, 0))] {
        let foreign = slot(5, &foreign);
        assert_eq!(load(&genuine, &foreign), Ok(Which::First));
        assert_eq!(next_write::<CELLS>(&genuine, &foreign, Trust::Key(&key)), (Which::Second, 6));
        assert_eq!(load(&foreign, &foreign), Err(ImageError::NotAuthentic));
    }
    assert_eq!(loaded(&genuine, &[]), Err(ImageError::TrailingBytes));
}

/// Every content that a cut can leave in the slot that is being written: erased up to a byte, or programmed up to a byte, that byte
/// half done, in the order of addresses or in the one that is recommended (header last), over an erased slot or over what was there.
fn cut_writes(previous: &[u8], next: &[u8]) -> Vec<Vec<u8>> {
    let erased = vec![0xFF; previous.len()];
    let by_address: Vec<usize> = (0..previous.len()).collect();
    let header_last: Vec<usize> = (SLOT_HEADER_BYTES..previous.len()).chain(0..SLOT_HEADER_BYTES).collect();
    let mut states = Vec::new();
    for (base, target, order) in [
        (previous, &erased[..], &by_address),
        (&erased, next, &by_address),
        (&erased, next, &header_last),
        (previous, next, &by_address),
        (previous, next, &header_last),
    ] {
        let mut state = base.to_vec();
        states.push(state.clone());
        for &at in order {
            for half in [0x0F, 0xAA] {
                state[at] = (target[at] & half) | (base[at] & !half);
                states.push(state.clone());
            }
            state[at] = target[at];
            states.push(state.clone());
        }
    }
    states
}

/// Whether a reader finds, after every cut, the model before the write or the whole one that is written.
fn survives_every_cut(reader: impl Fn(&[u8], &[u8]) -> Option<Vec<u8>>) -> bool {
    let current_image = image(1.0, 2);
    let current = slot(8, &current_image);
    let mut survives = true;
    for springs in [0, 1, 4, 8].into_iter().take(MOST) {
        let next_image = image(2.0, springs);
        let written = slot(9, &next_image);
        let before = [vec![0xFF; SLOT_BYTES], slot(7, &image(3.0, 3)), vec![0; SLOT_BYTES]];
        for previous in before.into_iter().take(MOST) {
            for state in cut_writes(&previous, &written).into_iter().step_by(EVERY) {
                let whole =
                    state[..SLOT_HEADER_BYTES + next_image.len()] == written[..SLOT_HEADER_BYTES + next_image.len()];
                let expected = Some(if whole { &next_image } else { &current_image });
                survives &= reader(&current, &state).as_ref() == expected;
                survives &= reader(&state, &current).as_ref() == expected;
            }
        }
    }
    survives
}

#[test]
fn a_cut_write_at_any_byte_leaves_the_slot_before() {
    assert!(survives_every_cut(|first, second| {
        let [newest, _] = valid_slots(first, second);
        let usable = loaded(first, second).is_ok_and(|which| newest.is_some_and(|slot| slot.which == which));
        newest.filter(|_| usable).map(|slot| slot.image.to_vec())
    }));
}

/// The same cuts kill a reader that believes the header: the test above is not idle.
#[test]
fn a_reader_without_checksum_does_not_survive() {
    let believe = |bytes: &[u8]| {
        let length = u32::from_le_bytes(bytes[8..12].try_into().ok()?) as usize;
        let image = bytes[SLOT_HEADER_BYTES..].get(..length)?;
        (bytes[..4] == SLOT_MAGIC).then(|| (u32::from_le_bytes(bytes[4..8].try_into().unwrap()), image.to_vec()))
    };
    assert!(!survives_every_cut(|first, second| {
        [believe(first), believe(second)].into_iter().flatten().max_by_key(|slot| slot.0).map(|slot| slot.1)
    }));
}

/// Nothing to fall back to: the first write ever, cut anywhere, leaves compensation off.
#[test]
fn a_cut_first_write_leaves_compensation_off() {
    let erased = vec![0xFF; SLOT_BYTES];
    let first_image = image(2.0, 1);
    let written = slot(1, &first_image);
    for state in cut_writes(&erased, &written).into_iter().step_by(EVERY) {
        let whole = state[..SLOT_HEADER_BYTES + first_image.len()] == written[..SLOT_HEADER_BYTES + first_image.len()];
        assert_eq!(loaded(&state, &erased), if whole { Ok(Which::First) } else { Err(ImageError::NoImage) });
    }
}

#[test]
fn a_flipped_bit_anywhere_leaves_the_other_slot_or_nothing() {
    let erased = vec![0xFF; SLOT_BYTES];
    for springs in [0, 8] {
        let (old, new) = (slot(4, &image(1.0, 0)), slot(5, &image(2.0, springs)));
        for bit in (0..8 * (SLOT_HEADER_BYTES + image(2.0, springs).len())).step_by(EVERY) {
            let mut damaged = new.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(loaded(&old, &damaged), Ok(Which::First), "bit {bit}");
            assert_eq!(loaded(&damaged, &old), Ok(Which::Second), "bit {bit}");
            assert_eq!(loaded(&erased, &damaged), Err(ImageError::NoImage), "bit {bit}");
        }
    }
}

proptest! {
    #[test]
    fn arbitrary_flash_never_panics(first in proptest::collection::vec(any::<u8>(), 0..200), second in proptest::collection::vec(any::<u8>(), 0..200)) {
        prop_assert_eq!(loaded(&first, &second), Err(ImageError::NoImage));
        prop_assert_eq!(next(&first, &second), (Which::First, 1));
    }
}
