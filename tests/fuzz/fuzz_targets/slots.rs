//! Two slots of flash: arbitrary bytes, arbitrary bytes behind a right header, or a genuine image, and then perhaps damage.
#![no_main]

use frikan_runtime::shared::authentication::{Key, Trust};
use frikan_runtime::slots::{Which, load, next_write, slot_header, valid_slots};
use libfuzzer_sys::fuzz_target;

const CELLS: usize = 64;
const GENUINE: &[u8] = include_bytes!("../../../fixtures/stribeck.frk");
const KEY: Key = Key::new([7; 32]);

/// What is in a slot: kind, bytes, sequence number, place and bits of the damage.
type Content<'a> = (u8, &'a [u8], u32, u16, u8);

fn slot((kind, bytes, sequence, place, damage): Content<'_>) -> Vec<u8> {
    let with_header = |image: &[u8]| [&slot_header(sequence, image).unwrap()[..], image].concat();
    let mut slot = match kind % 4 {
        0 => bytes.to_vec(),
        1 => with_header(bytes),
        2 => with_header(GENUINE),
        _ => with_header(&[GENUINE, &KEY.tag(GENUINE)].concat()),
    };
    if let Some(byte) = slot.get_mut(usize::from(place)) {
        *byte ^= damage;
    }
    slot
}

fuzz_target!(|input: (Content<'_>, Content<'_>, bool)| {
    let (first, second) = (slot(input.0), slot(input.1));
    let trust = if input.2 { Trust::Key(&KEY) } else { Trust::Anyone };
    let loaded = load::<CELLS>(&first, &second, trust).map(|(which, _)| which);
    let (next, number) = next_write::<CELLS>(&first, &second, trust);
    match valid_slots(&first, &second) {
        [Some(newest), older] => {
            assert_eq!(number, newest.sequence.wrapping_add(1));
            assert_eq!(next, loaded.unwrap_or(newest.which).other());
            assert!(older.is_none_or(|older| older.which == newest.which.other()));
        }
        [None, older] => assert!(older.is_none() && next == Which::First && loaded.is_err()),
    }
});
