//! A recording of any format: a table whose channels are whole, or an error; never a panic, never memory beyond the file's size.
#![no_main]

use frikan_trainer::joint::Joint;
use frikan_trainer::recording::{Quantity, parse};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

/// First bytes of the formats, so that every reader is reached without being guessed.
const STARTS: [&[u8]; 8] = [
    b"",
    b"\x93NUMPY\x01\x00",
    b"PK\x03\x04",
    b"MATLAB 5.0 MAT-file",
    b"{\"time_s\": ",
    b"PAR1",
    b"\x89MCAP0\r\n",
    b"\x1f\x8b\x08",
];

/// The only format that is looked at, if `FRIKAN_FUZZ_FORMAT` is the place of one in `STARTS`; else the first byte of an input chooses.
static FORMAT: LazyLock<Option<u8>> =
    LazyLock::new(|| Some(std::env::var("FRIKAN_FUZZ_FORMAT").ok()?.parse().expect("a number from 0 to 7")));

/// A panic of a library is caught by `parse` and told as damage; one of this project ends the run, wherever it is caught.
fn abort_on_own_panics() {
    let abort = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let is_own = |file: &str| file.contains("trainer/src") || file.contains("fuzz_targets");
        if panic.location().is_none_or(|location| is_own(location.file())) {
            abort(panic);
        }
    }));
}

fuzz_target!(init: abort_on_own_panics(), |data: &[u8]| {
    let Some((choice, rest)) = data.split_first() else { return };
    let choice = FORMAT.unwrap_or(*choice);
    let bytes = [STARTS[usize::from(choice) % STARTS.len()], rest].concat();
    let Ok(recording) = parse("fuzz", &bytes[..], &Joint::default()) else { return };
    for channel in &recording.channels {
        assert_eq!(channel.values.len(), recording.len());
        assert!(channel.quantity.is_none() || channel.values.iter().all(|value| !value.is_nan()));
    }
    if let Some(time) = recording.values(Quantity::Time) {
        assert!(time.windows(2).all(|pair| pair[0] <= pair[1]));
    }
});
