//! Arbitrary bytes as an image, and as a payload behind a right header: refused, or a model that cannot fail.
#![no_main]

use frikan_runtime::compensator::{Compensator, Limits};
use frikan_runtime::evaluate::evaluate;
use frikan_runtime::friction::Measurement;
use frikan_shared::image::{FORMAT_VERSION, MAGIC, checksum, decode, encode};
use libfuzzer_sys::fuzz_target;

const CELLS: usize = 64;

/// The bytes as a payload, its header and checksum made right; the first two bytes are the number of cells.
fn dressed(data: &[u8]) -> Option<Vec<u8>> {
    let (cells, payload) = data.split_first_chunk::<2>()?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend(FORMAT_VERSION.to_le_bytes());
    bytes.extend(cells);
    bytes.extend((payload.len() as u32).to_le_bytes());
    let crc32 = checksum(&[&bytes, payload]);
    bytes.extend(crc32.to_le_bytes());
    bytes.extend(payload);
    Some(bytes)
}

fn check(bytes: &[u8], data: &[u8]) {
    let Ok(image) = decode::<CELLS>(bytes) else { return };
    let mut buffer = vec![0; bytes.len() + 4096];
    let again = encode(&image, &mut buffer).expect("what was decoded is encoded");
    assert_eq!(decode::<CELLS>(again).as_ref(), Ok(&image));

    let limit = image.model.output_limit;
    let mut compensator = Compensator::<CELLS>::new(bytes, Limits::new(1.0, limit, f32::MAX).expect("a model is valid"));
    let specials = [0.0, 1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE];
    let from_data = data.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes));
    for x in specials.into_iter().chain(from_data) {
        let value = evaluate(&image.model, &[x, -x, x * 0.5, 1.0]);
        assert!(value.is_finite() && value.abs() <= limit);
        let measurement =
            Measurement { velocity: x, position: -x, load: x, temperature: 20.0, ..Measurement::default() };
        let answer = compensator.step(&measurement, 1.0e-3);
        assert!(answer.torque.is_finite() && answer.torque.abs() <= limit && answer.position.is_finite());
    }
}

fuzz_target!(|data: &[u8]| {
    check(data, data);
    if let Some(bytes) = dressed(data) {
        check(&bytes, data);
    }
});
