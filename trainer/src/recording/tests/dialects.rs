//! One motion as many loggers write it: every file gives the same numbers.

use std::fmt::Write as _;
use std::io::Write as _;

use super::{Axis, Joint, Quantity, Recording, Result, codes, parse, read};

const ROWS: usize = 60;

fn time(row: usize) -> f64 {
    row as f64 * 0.004
}

fn position(row: usize) -> f64 {
    (row as f64 * 0.3).sin()
}

fn torque(row: usize) -> f64 {
    2.0 * (row as f64 * 0.3).cos()
}

/// A file with this head and a line a row.
fn file(head: &str, line: impl Fn(usize) -> String) -> String {
    let mut text = String::from(head);
    for row in 0..ROWS {
        writeln!(text, "{}", line(row)).unwrap();
    }
    text
}

fn plain(row: usize) -> String {
    format!("{},{},{}", time(row), position(row), torque(row))
}

#[track_caller]
fn holds_the_motion(recording: Result<Recording>) -> Recording {
    let recording = recording.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((recording.len(), recording.axis), (ROWS, Axis::Rotary));
    for (quantity, expected) in
        [(Quantity::Time, time as fn(usize) -> f64), (Quantity::Position, position), (Quantity::Torque, torque)]
    {
        let values = recording.values(quantity).unwrap_or_else(|| panic!("no {quantity:?}"));
        for (row, value) in values.iter().enumerate() {
            assert!((value - expected(row)).abs() < 1e-12, "{quantity:?} in row {row}: {value} {}", expected(row));
        }
    }
    recording
}

#[test]
fn preambles_unit_rows_and_bracketed_units_are_understood() {
    for head in [
        "time_s,position_rad,torque_Nm\n",
        "Time (s),Position (rad),Torque (Nm)\n",
        "time [s],position [rad],Torque [N·m]\n",
        "time,position,torque\ns,rad,Nm\n",
        "Time,Position,Torque\n[s],[rad],[N m]\n",
        "Drive log of the elbow\nRate,250\n\ntime_s,position_rad,torque_Nm\n",
        "Name,elbow\nRate,250\nAxis,2\ntime,position,torque\ns,rad,Nm\n",
        "# time_s,position_rad,torque_Nm\n",
        "# rate 250\n# time_s position_rad torque_Nm\n",
        "%time_s,position_rad,torque_Nm\n",
        "\u{feff}time_s,position_rad,torque_Nm\n",
    ] {
        holds_the_motion(read(file(head, plain)));
        let semicolons = file(&head.replace(',', ";"), |row| plain(row).replace(',', ";").replace('.', ","));
        holds_the_motion(read(semicolons));
        holds_the_motion(read(file(&head.replace(',', "\t"), |row| plain(row).replace(',', "\t"))));
    }
}

#[test]
fn a_compressed_recording_is_that_of_its_text() {
    let text = file("time_s,position_rad,torque_Nm\n", plain);
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(text.as_bytes()).unwrap();
    let compressed = encoder.finish().unwrap();
    holds_the_motion(read(&compressed));
    let cut = read(&compressed[..compressed.len() / 2]).unwrap_err();
    assert_eq!((cut.code(), cut.exit_status()), (&codes::CUT_SHORT, 3));
}

#[test]
fn clocks_of_all_kinds_are_counted_without_losing_digits() {
    // 4 ms a row from a date of our days, in nanoseconds.
    let stamp = |row: usize| 1_714_557_600_000_000_000_u64 + 4_000_000 * row as u64;
    let rest = |row: usize| format!("{},{}", position(row), torque(row));
    let clock = |head: &str, time: &dyn Fn(usize) -> String| {
        let recording = holds_the_motion(read(file(head, |row| format!("{},{}", time(row), rest(row)))));
        assert!(recording.health.jitter < 1e-9, "{}", recording.health.jitter);
    };
    let rest_of_head = "position_rad,torque_Nm\n";
    for name in ["timestamp", "time", "Timestamp", "__time", "/joint_states/header/stamp", "time_ns"] {
        clock(&format!("{name},{rest_of_head}"), &|row| stamp(row).to_string());
    }
    clock(&format!("timestamp,{rest_of_head}"), &|row| (stamp(row) / 1000).to_string());
    clock(&format!("timestamp,{rest_of_head}"), &|row| (stamp(row) / 1_000_000).to_string());
    for name in ["time_s", "t", "__time"] {
        clock(&format!("{name},{rest_of_head}"), &|row| {
            format!("{}.{:09}", stamp(row) / 1_000_000_000, stamp(row) % 1_000_000_000)
        });
    }
    clock(&format!("__time,{rest_of_head}"), &|row| format!("{}", time(row)));
    for (seconds, nanoseconds) in [("sec", "nanosec"), ("header.stamp.sec", "header.stamp.nanosec"), ("secs", "nsecs")]
    {
        clock(&format!("{seconds},{nanoseconds},{rest_of_head}"), &|row| {
            format!("{},{}", stamp(row) / 1_000_000_000, stamp(row) % 1_000_000_000)
        });
    }
    for (start, end) in
        [("2024-05-01T12:00:00.", "Z"), ("2024-05-01 12:00:00.", ""), ("2024/05/01 12:00:00.", "+02:00")]
    {
        clock(&format!("time,{rest_of_head}"), &|row| format!("{start}{:03}{end}", 4 * row));
    }
    let broken = file("time,position_rad,torque_Nm\n", |row| {
        let time = if row == 7 { "soon".to_owned() } else { format!("2024-05-01T12:00:00.{:03}Z", 4 * row) };
        format!("{time},{}", rest(row))
    });
    let error = read(broken).unwrap_err();
    assert_eq!((error.code(), error.row(), error.value()), (&codes::NOT_A_NUMBER, Some(9), Some("soon")));
}

#[test]
fn a_unit_that_cannot_be_told_is_asked_for_with_what_to_write() {
    for (head, asked) in [
        ("time,position_rad,torque_Nm\n", "[columns] of joint.toml: time = { name = \"time\", unit = \"s\" }"),
        ("time_s,Position (inch),torque_Nm\n", "position = { name = \"Position (inch)\", unit = \"rad\" }"),
        ("a,b,c\n", "position = { name = \"a\", unit = \"rad\" }"),
        ("", "position = { name = \"column[0]\", unit = \"rad\" }"),
    ] {
        let error = read(file(head, plain)).unwrap_err();
        assert!(error.message().contains(asked), "{error}");
    }
    let joint =
        Joint::parse("[columns]\ntime = \"column[0]\"\nposition = \"column[1]\"\ntorque = \"column[2]\"").unwrap();
    holds_the_motion(parse("arm.csv", file("", plain).as_bytes(), &joint));
}

#[test]
fn lists_in_cells_are_columns_of_their_elements() {
    let joint = Joint::parse("[columns]\nposition = \"q[1]\"\ntorque = \"tau[1]\"").unwrap();
    let lists = |row: usize| format!("{},\"[0.5, {}]\",\"[7 {}]\"", time(row), position(row), torque(row));
    holds_the_motion(parse("arm.csv", file("time_s,q,tau\n", lists).as_bytes(), &joint));
    let longer = file("time_s,q,tau\n", |row| lists(row).replace("[7 ", if row == 5 { "[7 8 " } else { "[7 " }));
    let error = parse("arm.csv", longer.as_bytes(), &joint).unwrap_err();
    assert_eq!((error.code(), error.row(), error.column()), (&codes::RAGGED_ROW, Some(7), Some("tau")));
}

#[test]
fn joint_states_are_taken_by_the_name_of_the_joint() {
    let head = "__time,/joint_states/elbow/position,/joint_states/elbow/effort,/joint_states/wrist/position\n";
    let text = file(head, |row| format!("{},1", plain(row)));
    let error = read(&text).unwrap_err();
    assert_eq!(error.code(), &codes::SEVERAL_JOINTS);
    assert!(error.message().contains("elbow, wrist") && error.message().contains("name = \"elbow\""), "{error}");
    let elbow = Joint::parse("name = \"elbow\"").unwrap();
    let recording = holds_the_motion(parse("arm.csv", text.as_bytes(), &elbow));
    assert!(recording.named("/joint_states/wrist/position").is_some());
    holds_the_motion(read(file(&head.replace(",/joint_states/wrist/position", ""), plain)));
    let message = |row: usize| {
        format!("{},\"['wrist', 'elbow']\",\"[1, {}]\",\"[1, {}]\"", time(row), position(row), torque(row))
    };
    holds_the_motion(parse("arm.csv", file("time_s,name,position,effort\n", message).as_bytes(), &elbow));
}

/// Position at 500 Hz, torque at 250 Hz half a millisecond later, temperature now and then.
#[test]
fn topics_of_different_times_are_brought_to_one_clock() {
    let mut text = String::from("time_s,position_rad,torque_Nm,temperature_C,kp\n");
    for row in 0..400 {
        let time = 0.002 * f64::from(row);
        writeln!(text, "{time},{},,,", 3.0 * time).unwrap();
        if row % 2 == 0 {
            writeln!(text, "{},,{},,", time + 0.0005, 5.0 * time).unwrap();
        }
        if row == 100 {
            writeln!(text, "{},,,31.5,80", time + 0.001).unwrap();
        }
    }
    let recording = read(&text).unwrap();
    // Behind the last position nothing is known of it: 199 of 200 would be left where the last torque lay behind it.
    assert_eq!((recording.len(), recording.table.len()), (200, 200));
    assert!((recording.health.period_s.unwrap() - 0.004).abs() < 1e-12);
    let time = recording.values(Quantity::Time).unwrap();
    let position = recording.values(Quantity::Position).unwrap();
    assert!(time.iter().zip(position).all(|(time, position)| (position - 3.0 * time).abs() < 1e-12));
    assert!(recording.values(Quantity::Temperature).unwrap().iter().all(|value| *value == 31.5));
    assert!(recording.named("kp").unwrap().values.iter().all(|value| *value == 80.0));
    // A single hole is not a topic of its own.
    let hole = text.lines().next().unwrap().to_owned() + "\n" + &"0,1,2,3,4\n".repeat(30) + "0,,2,3,4\n";
    assert_eq!(read(hole).unwrap_err().code(), &codes::NOT_A_NUMBER);
}

#[test]
fn a_column_that_nearly_has_a_known_name_is_noted() {
    let recording = read(file("time_s,postion_rad,torque_Nm\n", plain)).unwrap();
    assert_eq!(recording.nearly_named, [("postion_rad".to_owned(), "position_rad".to_owned())]);
    let recording = read(file("time_s,position_rad,Torque_Nm\n", plain)).unwrap();
    assert_eq!(recording.nearly_named, [("Torque_Nm".to_owned(), "torque_Nm".to_owned())]);
}
