//! A recording of any format: a table whose channels are whole, or an error; never a panic, never memory beyond the file's size.
#![no_main]

use frikan_trainer::joint::Joint;
use frikan_trainer::recording::{Quantity, parse};
use libfuzzer_sys::fuzz_target;

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

fuzz_target!(|data: &[u8]| {
    let Some((choice, rest)) = data.split_first() else { return };
    let bytes = [STARTS[usize::from(*choice) % STARTS.len()], rest].concat();
    let Ok(recording) = parse("fuzz", &bytes[..], &Joint::default()) else { return };
    for channel in &recording.channels {
        assert_eq!(channel.values.len(), recording.len());
        assert!(channel.quantity.is_none() || channel.values.iter().all(|value| !value.is_nan()));
    }
    if let Some(time) = recording.values(Quantity::Time) {
        assert!(time.windows(2).all(|pair| pair[0] <= pair[1]));
    }
});
