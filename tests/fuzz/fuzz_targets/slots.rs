//! Arbitrary bytes as two slots of flash.
#![no_main]

use frikan_runtime::slots::{Which, load, next_write, slot_header, valid_slots};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (&[u8], &[u8], u32, bool)| {
    let (first, second, sequence, dress) = input;
    // A right header reaches what lies behind the checksum.
    let dressed = slot_header(sequence, second).map(|header| [&header[..], second].concat());
    let second = match &dressed {
        Some(dressed) if dress => dressed.as_slice(),
        _ => second,
    };
    let (next, number) = next_write(first, second);
    match valid_slots(first, second) {
        [Some(newest), older] => {
            assert_eq!(next, newest.which.other());
            assert_eq!(number, newest.sequence.wrapping_add(1));
            assert!(older.is_none_or(|older| older.which == newest.which.other()));
        }
        [None, older] => assert!(older.is_none() && next == Which::First),
    }
    let _ = load::<16>(first, second);
});
