//! What is named where nothing is missing, as a table.

use std::fmt::Write;

use super::summary::{BASES, Row, base_name, share};
use super::{Case, Hidden};
use frikan_trainer::plant::NoiseKind;

/// False alarms by kind of recording and by base model, and every one of them.
pub fn controls(rows: &[Row], text: &mut String) {
    let controls: Vec<&Row> = rows.iter().filter(|row| row.case.hidden == Hidden::Nothing).collect();
    if controls.is_empty() {
        return;
    }
    let is_alarm = |row: &&&Row| !row.findings.is_empty();
    let bases: Vec<_> = BASES.into_iter().filter(|base| controls.iter().any(|row| row.case.base == *base)).collect();
    let names: Vec<&str> = bases.iter().map(|base| base_name(*base)).collect();
    let _ = writeln!(
        text,
        "## Controls: nothing is missing\n\nFalse alarms by kind of noise, as of `[plant.noise]` of `trainer simulate`, and by the model that the diagnosis starts from.\n\n| kind | {} |\n|---{}|",
        names.join(" | "),
        "|---".repeat(bases.len())
    );
    for kind in NoiseKind::ALL.map(Some).into_iter().chain([None]) {
        let of_kind = || controls.iter().filter(|row| kind.is_none_or(|kind| row.case.noise == kind));
        let alarms = |base| {
            let of_base = || of_kind().filter(|row| row.case.base == base);
            share(of_base().filter(is_alarm).count(), of_base().count())
        };
        let name = kind.map_or("all", NoiseKind::name);
        let _ =
            writeln!(text, "| {name} | {} |", bases.iter().map(|base| alarms(*base)).collect::<Vec<_>>().join(" | "));
    }
    let _ = writeln!(text);
    for alarm in controls.iter().filter(is_alarm) {
        let names: Vec<&str> = alarm.findings.iter().map(|(effect, ..)| effect.name()).collect();
        let Case { noise, base, seed, .. } = &alarm.case;
        let _ = writeln!(text, "* {}, from {}, seed {seed}: {}", noise.name(), base_name(*base), names.join(" + "));
    }
}
