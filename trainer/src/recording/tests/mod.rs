mod dialects;
mod long;

use proptest::prelude::*;

use super::*;
use crate::error::Code;

const ROWS: usize = 60;

/// A good recording with one line, counted from one, replaced.
fn with_line(number: usize, text: &str) -> String {
    let mut lines = vec!["time_s,position_rad,torque_Nm".to_owned()];
    lines.extend((0..ROWS).map(|i| format!("{},{},{}", i as f64 * 0.01, (i as f64 * 0.3).sin(), i)));
    text.clone_into(&mut lines[number - 1]);
    lines.join("\n") + "\n"
}

fn read(text: impl AsRef<[u8]>) -> Result<Recording> {
    parse("arm.csv", text.as_ref(), &Joint::default())
}

#[track_caller]
fn refused(text: impl AsRef<[u8]>, code: &'static Code, row: u64, column: &str, value: &str) {
    let error = read(text).expect_err("this has to be refused");
    let found = (error.code().id, error.row(), error.column().unwrap_or(""), error.value().unwrap_or(""));
    assert_eq!(found, (code.id, Some(row), column, value), "{error}");
    assert_eq!(error.exit_status(), 3);
    assert!(!error.to_string().contains('\n'));
}

#[test]
fn a_good_recording_keeps_its_text_and_gives_si() {
    let recording = read(with_line(1, "time_ms,position_deg,torque_mNm")).unwrap();
    assert_eq!((recording.len(), recording.axis), (ROWS, Axis::Rotary));
    assert!((recording.values(Quantity::Time).unwrap()[1] - 1e-5).abs() < 1e-18);
    let torque = recording.actuator().unwrap();
    assert_eq!((torque.unit, torque.column_unit.as_str(), torque.column.as_str()), ("Nm", "mNm", "torque_mNm"));
    assert!((torque.values[7] - 0.007).abs() < 1e-15 && (torque.si_per_column_unit - 1e-3).abs() < 1e-18);
    assert_eq!(recording.table.row(7).nth(2), Some("7"));
    assert_eq!(recording.table.line(7), 9);
}

#[test]
fn text_in_a_number_names_the_place() {
    refused(with_line(5, "0.03,n/a,3"), &codes::NOT_A_NUMBER, 5, "position_rad", "n/a");
    refused(with_line(5, "0.03,,3"), &codes::NOT_A_NUMBER, 5, "position_rad", "");
}

#[test]
fn values_that_are_not_finite_name_the_place() {
    refused(with_line(7, "0.05,NaN,3"), &codes::NOT_FINITE, 7, "position_rad", "NaN");
    refused(with_line(7, "0.05,0,-inf"), &codes::NOT_FINITE, 7, "torque_Nm", "-inf");
    refused(with_line(7, "0.05,1e999,0"), &codes::NOT_FINITE, 7, "position_rad", "1e999");
}

#[test]
fn time_has_to_increase() {
    refused(with_line(9, "0.01,0,0"), &codes::TIME_NOT_INCREASING, 9, "time_s", "0.01");
    refused(with_line(9, "0.0599,0,0"), &codes::TIME_NOT_INCREASING, 9, "time_s", "0.0599");
    // A stamp that stands twice is left to the checks.
    assert!(read(with_line(9, "0.06,0,0")).is_ok());
}

#[test]
fn broken_tables_are_told_apart() {
    assert_eq!(read("").unwrap_err().code(), &codes::EMPTY_FILE);
    assert_eq!(read("\n\n# only a comment\n").unwrap_err().code(), &codes::EMPTY_FILE);
    refused("time_s,position_rad,torque_Nm\n", &codes::TOO_FEW_ROWS, 1, "", "0");
    let ten: String =
        with_line(1, "time_s,position_rad,torque_Nm").lines().take(11).map(|l| l.to_owned() + "\n").collect();
    refused(ten, &codes::TOO_FEW_ROWS, 11, "", "10");
    refused(with_line(4, "0.02,1"), &codes::RAGGED_ROW, 4, "", "0.021");
    refused(with_line(4, "0.02,1,2,3"), &codes::RAGGED_ROW, 4, "", "0.02123");
    refused(with_line(1, "time_s,torque_Nm,torque_Nm"), &codes::DUPLICATE_COLUMN, 1, "torque_Nm", "");
    refused(with_line(1, "time_s,position_rad,position_deg"), &codes::DUPLICATE_COLUMN, 1, "position_deg", "");
    refused(with_line(1, "time_s,position_rad,velocity_m_s"), &codes::MIXED_AXIS, 1, "velocity_m_s", "");
    refused(with_line(1, "a,b,c"), &codes::NO_KNOWN_COLUMN, 1, "", "a,b,c");
    refused(with_line(1, "0,1,2"), &codes::NO_KNOWN_COLUMN, 1, "", "column[0],column[1],column[2]");
}

#[test]
fn units_are_checked() {
    refused(with_line(1, "time_s,position_inch,torque_Nm"), &codes::UNKNOWN_UNIT, 1, "position_inch", "inch");
    refused(with_line(1, "time_s,position_rad,torque"), &codes::UNKNOWN_UNIT, 1, "torque", "");
    refused(with_line(1, "time_s,position_rad,torque_rad"), &codes::UNKNOWN_UNIT, 1, "torque_rad", "rad");
    refused(with_line(1, "time_s,position_count,torque_Nm"), &codes::MISSING_PARAMETER, 1, "position_count", "count");
}

#[test]
fn a_missing_column_is_asked_for_by_name() {
    let recording = read(with_line(1, "time_s,position_rad,foo")).unwrap();
    let error = recording.require(&[Quantity::Torque, Quantity::Force], "a fit").unwrap_err();
    assert_eq!(
        (error.code(), error.column(), error.file()),
        (&codes::MISSING_COLUMN, Some("torque_Nm"), Some("arm.csv"))
    );
}

#[test]
fn encodings_line_ends_and_separators_are_understood() {
    let plain = read(with_line(1, "time_s,position_rad,torque_Nm")).unwrap();
    let text = with_line(1, "time_s,position_rad,torque_Nm");
    let variants = [
        format!("\u{feff}{text}"),
        text.replace('\n', "\r\n"),
        text.replace(',', "\t"),
        text.replace(',', ";").replace('.', ","),
        text.replace(',', " , "),
        text.replace("time_s,position_rad", "\"time_s\",\"position_rad\""),
        format!("# made by hand\n{text}\n\n"),
    ];
    for variant in variants {
        let recording = read(&variant).unwrap_or_else(|error| panic!("{error} in {}", &variant[..40]));
        for (a, b) in plain.channels.iter().zip(&recording.channels) {
            assert_eq!((&a.name, &a.values), (&b.name, &b.values));
        }
        assert_ne!(plain.content_hash, recording.content_hash);
    }
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let mut bytes = with_line(6, "0.04,?,1").into_bytes();
    let at = bytes.iter().position(|b| *b == b'?').unwrap();
    bytes[at] = 0xff;
    refused(bytes, &codes::NOT_UTF8, 6, "position_rad", "\u{fffd}");
    let utf16: Vec<u8> =
        with_line(1, "time_s,position_rad,torque_Nm").encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(read([&[0xff, 0xfe][..], &utf16].concat()).unwrap_err().code(), &codes::NOT_UTF8);
}

#[test]
fn an_endless_line_is_refused_with_its_row_and_bounded_memory() {
    let text = with_line(1, "time_s,position_rad,torque_Nm");
    let endless = std::io::Read::chain(text.as_bytes(), std::io::repeat(b'9'));
    let error = parse("endless.csv", endless, &Joint::default()).unwrap_err();
    assert_eq!((error.code(), error.row()), (&codes::LINE_TOO_LONG, Some(ROWS as u64 + 2)));
    let error = parse("endless.csv", std::io::repeat(0), &Joint::default()).unwrap_err();
    assert_eq!(error.code(), &codes::LINE_TOO_LONG);
}

#[test]
fn a_quotation_mark_inside_a_text_does_not_refuse_a_long_recording() {
    let mut text = String::from("# the 3\" wheel\ntime_s,torque_Nm,remark\n");
    let rows = 80_000;
    for row in 0..rows {
        text += &format!("{}e-3,0.5,12\" disc\n", row + 1);
    }
    assert!(text.len() > RECORD_LIMIT_BYTES);
    assert_eq!(read(text).unwrap().len(), rows);
}

#[test]
fn a_header_of_very_many_columns_is_read_at_once() {
    let columns = 180_000;
    let names: Vec<String> = (0..columns).map(|index| format!("{index:x}")).collect();
    let row = ",1".repeat(columns);
    let text: String = (0..MINIMUM_ROWS).map(|time| format!("{time}{row}\n")).collect();
    let begun = std::time::Instant::now();
    let recording = read(format!("time_s,{}\n{text}", names.join(","))).unwrap();
    assert_eq!(recording.channels.len(), columns + 1);
    // A second beside others; comparing every name with every other takes most of a minute.
    assert!(begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
}

#[test]
fn folders_and_missing_files_are_input_errors() {
    let folder = tempfile::tempdir().unwrap();
    let error = load(folder.path(), &Joint::default()).unwrap_err();
    assert_eq!((error.code(), error.exit_status()), (&codes::IS_A_DIRECTORY, 5));
    let error = load(&folder.path().join("absent.csv"), &Joint::default()).unwrap_err();
    assert_eq!((error.code(), error.exit_status()), (&codes::FILE_NOT_FOUND, 5));
}

#[test]
fn mapped_columns_take_unit_side_and_sign() {
    let joint = Joint::parse(
        "[columns]\nposition = { name = \"q\", unit = \"deg\", side = \"motor\", scale = -1 }\n\
         torque = { name = \"i\", unit = \"N·m\" }\n[drive]\ngear_ratio = 100",
    )
    .unwrap();
    let recording = parse("arm.csv", with_line(1, "time_s,q,i").as_bytes(), &joint).unwrap();
    let position = recording.channel(Quantity::Position).unwrap();
    let expected = -(0.3_f64).sin().to_radians() / 100.0;
    assert!((position.values[1] - expected).abs() < 1e-15, "{}", position.values[1]);
    assert_eq!((position.name.as_str(), position.column.as_str()), ("position", "q"));

    let absent = Joint::parse("[columns]\nvelocity = { name = \"dq\" }").unwrap();
    let error = parse("arm.csv", with_line(1, "time_s,q,torque_Nm").as_bytes(), &absent).unwrap_err();
    assert_eq!((error.code(), error.column()), (&codes::MISSING_COLUMN, Some("dq")));
}

#[test]
fn counts_become_radians_with_the_encoder_of_the_drive() {
    let joint = Joint::parse("[drive]\ncounts_per_turn = 8192").unwrap();
    let recording = parse("arm.csv", with_line(3, "0.01,2048,1").replace("_rad", "_count").as_bytes(), &joint).unwrap();
    let position = &recording.channel(Quantity::Position).unwrap().values;
    assert!((position[1] - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
}

#[test]
fn unknown_columns_are_channels_and_columns_of_text_are_only_copied() {
    let text = with_line(1, "time_s,phase,force_N");
    let recording = read(&text).unwrap();
    assert_eq!(recording.axis, Axis::Linear);
    assert!(recording.named("phase").is_some_and(|channel| channel.quantity.is_none()));
    let recording = read(with_line(5, "0.03,hold,3").replace("position_rad", "phase")).unwrap();
    assert!(recording.named("phase").is_none());
    assert_eq!(recording.table.row(3).nth(1), Some("hold"));
}

#[test]
fn health_states_gaps_resolution_and_clipping() {
    let mut text = String::from("time_s,position_rad,torque_Nm\n");
    for i in 0..200 {
        let time = f64::from(i) * 0.01 + if i >= 100 { 1.0 } else { 0.0 };
        let wave = (f64::from(i) * 0.05).sin();
        text += &format!("{time},{},{}\n", (wave * 100.0).round() / 100.0, (3.0 * wave).clamp(-2.0, 2.0));
    }
    let health = read(text).unwrap().health;
    assert_eq!(health.gaps, [100]);
    assert!((health.period_s.unwrap() - 0.01).abs() < 1e-9 && health.jitter < 1e-9);
    assert!((health.position_resolution.unwrap() - 0.01).abs() < 1e-9);
    assert!(health.clipped_rows > 50, "{}", health.clipped_rows);
}

#[test]
fn rows_that_are_left_out_interrupt_the_motion_where_they_say_so() {
    let recording = read(with_line(1, "time_s,position_rad,torque_Nm")).unwrap();
    let kept: Vec<usize> = (0..ROWS).filter(|row| !matches!(row, 10 | 11 | 40)).collect();
    let bridged = recording.clone().with_rows(&kept, Omission::Bridged);
    assert_eq!((bridged.len(), bridged.health.gaps.len()), (ROWS - 3, 0));
    let interrupted = recording.clone().with_rows(&kept, Omission::Interrupted);
    assert_eq!(interrupted.health.gaps, [10, 38]);
    assert!(interrupted.health.jitter < 1e-9, "the steps across are no jitter");
    assert_eq!((interrupted.table.row(10).nth(2), interrupted.table.line(10)), (Some("12"), 14));
    assert_eq!(interrupted.values(Quantity::Torque).unwrap()[38], 41.0);
    // What was interrupted before stays so, wherever its row has moved to.
    let again = interrupted.with_interruptions(&[20]).with_rows(&(5..57).collect::<Vec<_>>(), Omission::Interrupted);
    assert_eq!(again.health.gaps, [5, 15, 33]);
}

proptest! {
    /// Whatever the bytes, the answer is a recording or an error, never a panic.
    #[test]
    fn any_bytes_give_an_answer(bytes in prop::collection::vec(any::<u8>(), 0..4000)) {
        let _ = read(bytes);
    }

    /// The same with bytes that look like a recording.
    #[test]
    fn any_table_gives_an_answer(
        header in prop::sample::select(vec!["time_s,position_rad,torque_Nm", "time_ms;position_mm;force_N", "velocity_rpm,x,friction_torque_Nm"]),
        body in "([0-9.,;eE+\\-\"a\n\r]{0,12}\n?){0,200}",
    ) {
        let _ = read(format!("{header}\n{body}"));
    }

    /// Numbers survive the way in: what was printed in shortest form is read back to the bit.
    #[test]
    fn numbers_are_read_to_the_bit(values in prop::collection::vec(-1e12_f64..1e12, MINIMUM_ROWS..60)) {
        let mut text = String::from("time_s,torque_Nm\n");
        for (i, value) in values.iter().enumerate() {
            text += &format!("{i},{value}\n");
        }
        let recording = read(text).unwrap();
        prop_assert_eq!(&recording.actuator().unwrap().values, &values);
    }

    /// A broken field is reported in its own row and column, wherever it is.
    #[test]
    fn a_broken_field_is_found_where_it_is(row in 0..ROWS, column in 0..3usize) {
        let mut fields = [format!("{}", row as f64 * 0.01), "0".into(), "0".into()];
        fields[column] = "x".into();
        let error = read(with_line(row + 2, &fields.join(","))).unwrap_err();
        prop_assert_eq!(error.row(), Some(row as u64 + 2));
        prop_assert_eq!(error.column(), Some(["time_s", "position_rad", "torque_Nm"][column]));
    }
}

/// What is kept of a large file says the same as all of it: clocks to the last digit, lines behind comments, cells that are missing.
#[test]
fn without_its_text_a_recording_holds_the_same_numbers() {
    let rows = |header: &str, row: &dyn Fn(u64) -> String| {
        let rows = (0..600).map(|index| row(index) + if index == 300 { "\n# a comment\n" } else { "\n" });
        format!("{header}\n{}", rows.collect::<String>())
    };
    let of = |index: u64| format!("{},{}", index as f64 * 1e-3, (index as f64 * 0.1).sin());
    let plain = |index: u64| format!("{},{}", index as f64 * 0.002, of(index));
    let nanoseconds = |index: u64| format!("{},{}", 1_714_557_600_000_000_123 + index * 2_000_001, of(index));
    let pair = |index: u64| format!("1714557600,{},{}", 123_456_789 + index * 1_000_001, of(index));
    let calendar = |index: u64| format!("2024-05-01T12:00:{:09.6},{}", index as f64 * 0.01, of(index));
    let texts = [
        rows("time_s,position_rad,torque_Nm", &plain),
        rows("timestamp,position_rad,torque_Nm", &nanoseconds),
        rows("sec,nanosec,position_rad,torque_Nm", &pair),
        rows("timestamp,position_rad,torque_Nm", &calendar),
    ];
    for text in texts {
        let whole = parse("joint.csv", text.as_bytes(), &Joint::default()).unwrap();
        let (raw, fingerprint) = super::read(text.as_bytes(), Keep::Numbers(InUse::all())).unwrap();
        let numbers = interpret("joint.csv", raw, fingerprint, &Joint::default()).unwrap();
        assert_eq!((&numbers.channels, &numbers.health), (&whole.channels, &whole.health), "{}", &text[..60]);
        assert_eq!((numbers.len(), numbers.table.line(299), numbers.table.line(301)), (600, 301, 304));
        assert_eq!(numbers.table.line(301), whole.table.line(301));
    }
    let broken =
        rows("time_s,position_rad,torque_Nm", &|index| if index == 500 { "1.0,x,2".into() } else { plain(index) });
    let refused =
        |keep| super::read(broken.as_bytes(), keep).and_then(|(raw, hash)| interpret("", raw, hash, &Joint::default()));
    let [whole, numbers] = [Keep::Text, Keep::Numbers(InUse::all())].map(|keep| refused(keep).unwrap_err().to_string());
    assert_eq!(whole, numbers);
    let backwards = rows("time_s,position_rad,torque_Nm", &|index| plain(if index == 500 { 10 } else { index }));
    let (raw, hash) = super::read(backwards.as_bytes(), Keep::Numbers(InUse::all())).unwrap();
    let error = interpret("", raw, hash, &Joint::default()).unwrap_err().to_string();
    assert!(error.contains("FRK-D011") && error.contains("0.02"), "{error}");
}
