//! Each format gives the numbers that were written; broken files give an error or what is whole, and never a panic.

use std::io::Write;

use proptest::prelude::*;

use crate::error::codes;
use crate::joint::Joint;
use crate::recording::{Quantity, Recording, parse};

const ROWS: usize = 40;

fn time(row: usize) -> f64 {
    0.004 * row as f64
}

fn torque(row: usize) -> f64 {
    (0.3 * row as f64).sin()
}

#[track_caller]
fn holds(bytes: &[u8]) -> Recording {
    let joint = Joint::parse("name = \"elbow\"").unwrap();
    let recording = parse("recording", bytes, &joint).unwrap_or_else(|error| panic!("{error}"));
    for (quantity, expected) in [(Quantity::Time, time as fn(usize) -> f64), (Quantity::Torque, torque)] {
        let values = recording.values(quantity).unwrap_or_else(|| panic!("no {quantity:?}"));
        assert_eq!(values.len(), ROWS);
        assert!(values.iter().enumerate().all(|(row, value)| (value - expected(row)).abs() < 1e-12), "{quantity:?}");
    }
    recording
}

/// An array of NumPy with this description and shape.
fn npy(description: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': {description}, 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

fn doubles(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(f64::to_le_bytes).collect()
}

fn npz() -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    let arrays = [
        ("time_s", npy("'<f8'", "(40,)", &doubles((0..ROWS).map(time)))),
        ("torque_Nm", npy("'<f8'", "(40, 1)", &doubles((0..ROWS).map(torque)))),
        ("q", npy("'>i2'", "(40, 2)", &(0..80_i16).flat_map(i16::to_be_bytes).collect::<Vec<_>>())),
        ("names", npy("'<U5'", "(2,)", &[0; 40])),
        ("gain", npy("'<f4'", "()", &1.5_f32.to_le_bytes())),
    ];
    for (name, bytes) in arrays {
        archive.start_file(format!("{name}.npy"), options).unwrap();
        archive.write_all(&bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

fn structured() -> Vec<u8> {
    let row = |row| doubles([time(row), torque(row)].into_iter()).into_iter().chain([7, 8]).collect::<Vec<u8>>();
    let data: Vec<u8> = (0..ROWS).flat_map(row).collect();
    npy("[('time_s', '<f8'), ('torque_Nm', '<f8'), ('flags', '|u1', (2,))]", "(40,)", &data)
}

#[test]
fn arrays_of_numpy_are_columns() {
    let recording = holds(&npz());
    assert_eq!(recording.named("q[1]").unwrap().values[3], 7.0);
    assert_eq!(holds(&structured()).named("flags[1]").unwrap().values[0], 8.0);
    let plain = npy("'<f8'", "(40, 2)", &doubles((0..ROWS).flat_map(|row| [time(row), torque(row)])));
    let joint = Joint::parse("[columns]\ntime = \"column[0]\"\ntorque = \"column[1]\"").unwrap();
    assert_eq!(parse("a.npy", &plain[..], &joint).unwrap().len(), ROWS);
    let cut = parse("a.npy", &plain[..plain.len() - 20], &joint).unwrap();
    assert_eq!((cut.len(), cut.health.notes.len()), (ROWS - 2, 1));
    let huge = npy("'<f8'", "(18446744073709551615, 2)", &[]);
    assert_eq!(parse("a.npy", &huge[..], &joint).unwrap_err().code(), &codes::DAMAGED);
}

/// An element of a `.mat`.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_le_bytes(), u32::try_from(data.len()).unwrap().to_le_bytes()].concat();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn matrix(class: u32, (rows, columns): (i32, i32), name: &str, inner: &[u8]) -> Vec<u8> {
    let flags = element(6, &[class.to_le_bytes(), [0; 4]].concat());
    let sides = element(5, &[rows.to_le_bytes(), columns.to_le_bytes()].concat());
    element(14, &[flags, sides, element(1, name.as_bytes()), inner.to_vec()].concat())
}

/// A file with a structure of two signals, one of them compressed beside it, and a scalar.
fn mat(compressed: bool) -> Vec<u8> {
    let signal =
        |name: &str, value: fn(usize) -> f64| matrix(6, (40, 1), name, &element(9, &doubles((0..ROWS).map(value))));
    let mut fields = [0_u8; 32];
    fields[..6].copy_from_slice(b"time_s");
    fields[16..25].copy_from_slice(b"torque_Nm");
    let inner = [element(5, &16_i32.to_le_bytes()), element(1, &fields), signal("", time), signal("", torque)].concat();
    let structure = matrix(2, (1, 1), "log", &inner);
    let mut bytes = b"MATLAB 5.0 MAT-file, made by a test".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    if compressed {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(&structure).unwrap();
        let data = encoder.finish().unwrap();
        bytes.extend(15_u32.to_le_bytes());
        bytes.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
        bytes.extend(data);
    } else {
        bytes.extend(structure);
    }
    bytes
}

#[test]
fn structures_of_matlab_are_columns() {
    for compressed in [false, true] {
        let bytes = mat(compressed);
        holds(&bytes);
        let error = parse("a.mat", &bytes[..bytes.len() - 30], &Joint::default()).unwrap_err();
        assert!([codes::CUT_SHORT.id, codes::DAMAGED.id].contains(&error.code().id), "{error}");
    }
}

#[test]
fn json_of_rows_and_of_columns_is_read() {
    let object = |row: usize| {
        format!(
            "{{\"time_s\": {}, \"state\": {{\"q\": [1, {row}]}}, \"torque_Nm\": {}, \"on\": true}}",
            time(row),
            torque(row)
        )
    };
    let lines: String = (0..ROWS).map(|row| object(row) + "\n").collect();
    assert_eq!(holds(lines.as_bytes()).named("state.q[1]").unwrap().values[5], 5.0);
    let list = format!("[{}]", (0..ROWS).map(object).collect::<Vec<_>>().join(",\n"));
    assert_eq!(holds(list.as_bytes()).named("on").unwrap().values[5], 1.0);
    let numbers = |value: fn(usize) -> f64| (0..ROWS).map(|row| value(row).to_string()).collect::<Vec<_>>().join(",");
    holds(
        format!("{{\"rate\": 250, \"time_s\": [{}], \"torque_Nm\": [{}]}}", numbers(time), numbers(torque)).as_bytes(),
    );
    let cut = parse("a.jsonl", &lines.as_bytes()[..lines.len() - 20], &Joint::default()).unwrap();
    assert_eq!((cut.len(), cut.health.notes.len()), (ROWS - 1, 1));
    let error = parse("a.jsonl", lines.replace("true", "maybe").as_bytes(), &Joint::default()).unwrap_err();
    assert_eq!((error.code(), error.row()), (&codes::DAMAGED, Some(1)));
}

#[cfg(feature = "mcap")]
mod bags {
    use super::*;
    use std::borrow::Cow;
    use std::collections::BTreeMap;
    use std::sync::Arc;

    /// A joint state in CDR: elbow and wrist, the wrist without effort.
    fn message(row: usize) -> Vec<u8> {
        let mut bytes = vec![0, 1, 0, 0];
        let mut put = |size: usize, data: &[u8]| {
            let start = (bytes.len() - 4).next_multiple_of(size) + 4;
            bytes.resize(start, 0);
            bytes.extend(data);
        };
        put(4, &1_714_557_600_i32.to_le_bytes());
        put(4, &(4_000_000 * row as u32).to_le_bytes());
        put(4, &1_u32.to_le_bytes());
        put(1, b"\0");
        put(4, &2_u32.to_le_bytes());
        for name in [b"wrist\0", b"elbow\0"] {
            put(4, &6_u32.to_le_bytes());
            put(1, name);
        }
        for values in [[0.5, time(row)], [0.0, 1.0], [f64::NAN, torque(row)]] {
            put(4, &2_u32.to_le_bytes());
            values.iter().for_each(|value| put(8, &value.to_le_bytes()));
        }
        bytes
    }

    fn bag() -> Vec<u8> {
        packed(None)
    }

    fn packed(compression: Option<mcap::Compression>) -> Vec<u8> {
        let mut file = std::io::Cursor::new(Vec::new());
        let options = mcap::WriteOptions::new().compression(compression).chunk_size(Some(2000));
        let mut writer = options.create(&mut file).unwrap();
        let schema = |name: &str| {
            Some(Arc::new(mcap::Schema {
                id: 1,
                name: name.to_owned(),
                encoding: "ros2msg".to_owned(),
                data: Cow::Borrowed(b"x"),
            }))
        };
        let channel = mcap::Channel {
            id: 1,
            topic: "/joint_states".to_owned(),
            schema: schema("sensor_msgs/msg/JointState"),
            message_encoding: "cdr".to_owned(),
            metadata: BTreeMap::new(),
        };
        let channel = Arc::new(channel);
        for row in 0..ROWS {
            let (sequence, log_time) = (row as u32, 1000 * row as u64);
            let data = Cow::Owned(message(row));
            writer
                .write(&mcap::Message { channel: channel.clone(), sequence, log_time, publish_time: log_time, data })
                .unwrap();
        }
        writer.finish().unwrap();
        drop(writer);
        file.into_inner()
    }

    #[test]
    fn a_compressed_bag_holds_the_same() {
        for compression in [mcap::Compression::Lz4, mcap::Compression::Zstd] {
            assert_eq!(
                holds(&packed(Some(compression))).values(Quantity::Position),
                holds(&bag()).values(Quantity::Position)
            );
        }
    }

    #[test]
    fn joint_states_of_a_bag_are_columns() {
        let bytes = bag();
        let recording = holds(&bytes);
        assert_eq!(recording.values(Quantity::Position).unwrap()[5], time(5));
        assert!(recording.named("/joint_states/wrist/effort").is_none());
        let elbow = Joint::parse("name = \"elbow\"").unwrap();
        let cut = parse("a.mcap", &bytes[..bytes.len() * 2 / 3], &elbow).unwrap();
        assert!((20..ROWS).contains(&cut.len()) && cut.health.notes.iter().any(|note| note.contains("cut short")));
        assert_eq!(parse("a.mcap", &bytes[..40], &elbow).unwrap_err().exit_status(), 3);
        // A record that ends behind its chunk, which is not compressed: 40 bytes of header, then a record of 100 bytes in a chunk of 20.
        let mut chunk = [0_u8; 60];
        chunk[32] = 20;
        chunk[40] = 5;
        chunk[41] = 100;
        let long = [b"\x89MCAP0\r\n\x06", &60_u64.to_le_bytes()[..], &chunk, &[0; 200]].concat();
        assert_eq!(parse("a.mcap", &long[..], &elbow).unwrap_err().exit_status(), 3);
        // A length that no file has. Both were found by a fuzzer.
        for length in [u64::MAX, u64::MAX - 8, 1 << 40] {
            let long = [b"\x89MCAP0\r\n\x01", &length.to_le_bytes()[..], b"\x8e\xb6"].concat();
            assert_eq!(parse("a.mcap", &long[..], &elbow).unwrap_err().exit_status(), 3);
        }
    }

    proptest! {
        #[test]
        fn broken_bags_give_an_answer(at in 0_usize..6000, byte: u8, cut in 0_usize..6000) {
            broken(bag(), at, byte, cut);
        }
    }
}

#[cfg(feature = "parquet")]
mod tables {
    use super::*;
    use crate::recording::silence_readers_panics;
    use parquet::data_type::{DoubleType, Int64Type};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn table() -> Vec<u8> {
        table_of("repeated", 2)
    }

    /// Lists of `values` numbers under a group that is `repetition`.
    fn table_of(repetition: &str, values: usize) -> Vec<u8> {
        let schema = format!(
            "message schema {{ required int64 timestamp; required double torque_Nm; optional group observation.state (LIST) {{ \
             {repetition} group list {{ optional double element; }} }} }}"
        );
        let schema = Arc::new(parse_message_type(&schema).unwrap());
        let properties = WriterProperties::builder().set_compression(parquet::basic::Compression::SNAPPY).build();
        let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties)).unwrap();
        let mut group = writer.next_row_group().unwrap();
        let stamps: Vec<i64> = (0..ROWS as i64).map(|row| 1_714_557_600_000_000_000 + 4_000_000 * row).collect();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<Int64Type>().write_batch(&stamps, None, None).unwrap();
        column.close().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<DoubleType>().write_batch(&(0..ROWS).map(torque).collect::<Vec<_>>(), None, None).unwrap();
        column.close().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        let states: Vec<f64> = (0..values * ROWS).map(|value| value as f64).collect();
        let repeated: Vec<i16> = (0..states.len()).map(|place| (place % values) as i16).collect();
        let defined = vec![if repetition == "repeated" { 3 } else { 2 }; states.len()];
        column.typed::<DoubleType>().write_batch(&states, Some(&defined), Some(&repeated)).unwrap();
        column.close().unwrap();
        group.close().unwrap();
        writer.into_inner().unwrap()
    }

    #[test]
    fn columns_and_lists_of_parquet_are_read() {
        let bytes = table();
        let recording = holds(&bytes);
        assert_eq!(recording.named("observation.state[1]").unwrap().values[3], 7.0);
        let cut = parse("a.parquet", &bytes[..bytes.len() - 5], &Joint::default()).unwrap_err();
        assert_eq!(cut.code(), &codes::CUT_SHORT);
    }

    /// Over a list whose group does not repeat the library panics.
    #[test]
    fn a_panic_of_a_library_is_an_error_of_the_file_and_nothing_else() {
        static TOLD: AtomicUsize = AtomicUsize::new(0);
        let bytes = table_of("required", 1);
        std::panic::set_hook(Box::new(|_| _ = TOLD.fetch_add(1, Ordering::Relaxed)));
        let read = || parse("a.parquet", &bytes[..], &Joint::default()).unwrap_err();
        assert_eq!(read().code(), &codes::DAMAGED);
        let before = TOLD.swap(0, Ordering::Relaxed);
        silence_readers_panics();
        assert_eq!(read().code(), &codes::DAMAGED);
        assert_eq!((before, TOLD.load(Ordering::Relaxed)), (1, 0));
        assert!(std::panic::catch_unwind(|| panic!("elsewhere")).is_err());
        assert_eq!(TOLD.load(Ordering::Relaxed), 1);
        let _ = std::panic::take_hook();
    }

    proptest! {
        #[test]
        fn broken_tables_give_an_answer(at in 0_usize..3000, byte: u8, cut in 0_usize..3000) {
            broken(table(), at, byte, cut);
        }
    }
}

/// The second side of an array whose first row is cut short is no number of rows, and of no rows there are no columns.
#[test]
fn an_array_that_claims_more_than_there_is_ends_at_once() {
    for (description, shape) in
        [("'<f8'", "(2, 100000000000000000)"), ("[('time_s', '<f8', (1000000000,))]", "(0, 290)")]
    {
        let bytes = npy(description, shape, &doubles((0..9).map(time)));
        assert_eq!(parse("a.npy", &bytes[..], &Joint::default()).unwrap_err().code(), &codes::EMPTY_FILE);
    }
}

#[test]
fn formats_that_are_not_read_say_what_to_do() {
    for (start, advice) in [
        (&b"SQLite format 3\0"[..], "ros2 bag convert"),
        (b"#ROSBAG V2.0\n", "mcap convert"),
        (b"\x89HDF\r\n\x1a\n", "'-v7'"),
        (b"MATLAB 7.3 MAT-file", "'-v7'"),
        (b"\x28\xb5\x2f\xfd", "unzstd"),
        (b"PK\x05\x06\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", "saved as CSV"),
    ] {
        let error = parse("x", start, &Joint::default()).unwrap_err();
        assert_eq!((error.code(), error.exit_status()), (&codes::FORMAT_NOT_READ, 3));
        assert!(error.message().contains(advice), "{error}");
    }
}

/// Changes a byte, or cuts what follows another.
fn broken(mut bytes: Vec<u8>, at: usize, byte: u8, cut: usize) {
    if let Some(place) = bytes.get_mut(at) {
        *place = byte;
    } else {
        bytes.truncate(cut);
    }
    let _ = parse("broken", &bytes[..], &Joint::default());
}

proptest! {
    /// One byte changed anywhere, or the end cut off: an answer, whatever the format.
    #[test]
    fn broken_files_give_an_answer(kind in 0..4_usize, at in 0_usize..3000, byte: u8, cut in 0_usize..3000) {
        broken([npz, structured, || mat(false), || mat(true)][kind](), at, byte, cut);
    }

    /// Anything behind the first bytes of a format.
    #[test]
    fn any_bytes_of_a_format_give_an_answer(
        start in prop::sample::select(vec![&b"\x93NUMPY\x01\x00"[..], b"PK\x03\x04", b"{\"a\": [", b"PAR1", b"\x89MCAP0\r\n", b"MATLAB 5.0 MAT-file"]),
        rest in prop::collection::vec(any::<u8>(), 0..600),
    ) {
        let _ = parse("any", &[start, &rest].concat()[..], &Joint::default());
    }
}
