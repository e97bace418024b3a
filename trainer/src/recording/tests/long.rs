//! Recordings that are longer than what is kept of them.

use super::super::keep::{InUse, Keep};
use super::super::{Recording, interpret};
use crate::joint::Joint;

#[test]
fn a_long_recording_is_read_without_columns_that_nothing_reads() {
    let row = |i: u32| format!("{},{},{},{i},text,7\n", 0.001 * f64::from(i), f64::from(i % 50), i % 3);
    let rows: String = (0..500).map(row).collect();
    let text = format!("time_s,position_rad,torque_Nm,counter,state,asked\n{rows}");
    let joint = Joint::default();
    let asked = ["asked".to_owned()];
    let read = |from_rows| {
        let keep = Keep::Numbers(InUse::of(&joint, &asked, 1e9).from(from_rows));
        let (raw, hash) = super::super::read(text.as_bytes(), keep).unwrap();
        interpret("long.csv", raw, hash, &joint).unwrap()
    };
    let names = |recording: &Recording| recording.channels.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    let (short, long) = (read(501), read(400));
    assert_eq!(names(&short), ["time", "position", "torque", "counter", "asked"]);
    assert_eq!(names(&long), ["time", "position", "torque", "asked"]);
    assert!(long.channels.iter().all(|channel| *channel == *short.named(&channel.name).unwrap()));
    assert!(short.health.notes.is_empty());
    assert_eq!(long.health.notes, ["too long for columns that nothing reads: counter, state left out"]);
}

#[test]
fn of_a_recording_that_no_memory_holds_stretches_over_all_of_it_are_read() {
    let rows = 300_000;
    let row = |i: u32| format!("{},{},{}\n", 0.001 * f64::from(i), f64::from(i % 50), i % 3);
    let text = format!("time_s,position_rad,torque_Nm\n{}", (0..rows).map(row).collect::<String>());
    let joint = Joint::default();
    let read = |memory_bytes| {
        let keep = Keep::Numbers(InUse::of(&joint, &[], memory_bytes));
        let (raw, hash) = super::super::read(text.as_bytes(), keep).unwrap();
        interpret("long.csv", raw, hash, &joint).unwrap()
    };
    let (whole, thin) = (read(1e9), read(1.05e8));
    assert!(!whole.is_excerpt && whole.len() == rows as usize && whole.health.notes.is_empty());
    assert!(
        thin.is_excerpt && thin.len() < 80_000 && thin.health.notes[0].starts_with("longer than the memory allows")
    );
    assert_eq!((thin.health.gaps.len(), thin.content_hash), (1, whole.content_hash));
    for row in [0, 32_768, 65_535] {
        let place = (thin.channels[0].values[row] * 1e3).round() as usize;
        assert_eq!(place, row / 32_768 * 8 * 32_768 + row % 32_768, "every eighth stretch");
        assert!(thin.channels.iter().zip(&whole.channels).all(|(thin, all)| thin.values[row] == all.values[place]));
        assert_eq!(thin.table.line(row), whole.table.line(place));
    }
}
