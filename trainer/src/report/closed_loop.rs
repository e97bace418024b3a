//! The page of a run in closed loop: the same motion without and with compensation.

use super::ink::Ink;
use super::page::{Origin, Page, Plot, Size};
use crate::rig::Row;
use frikan_runtime::supervised::adaptation::Correction;

/// Link of the charts over time.
const TIME: &str = "time";

/// The page as one HTML file: `lines` are the result in sentences, then the runs without and with compensation.
#[must_use]
pub fn closed_loop(
    motion: &str,
    lines: &[String],
    uncompensated: &[Row],
    compensated: &[Row],
    origin: &Origin<'_>,
) -> String {
    let (lead, others) = lines.split_first().map_or(("", &[][..]), |(lead, others)| (lead.as_str(), others));
    let mut page = Page::new(&format!("Closed loop: {motion}"), lead);
    page.list(others, "findings");
    let error = |row: &Row| 1e3 * (f64::from(row.reference[0]) - row.position);
    let has_reference = compensated.iter().any(|row| !row.reference[0].is_nan());
    let runs = [(uncompensated, Ink::Data, "without compensation"), (compensated, Ink::One, "with compensation")];
    if has_reference {
        page.heading("Tracking error");
        page.plot(&over_time(&runs, "error, mrad", error), "Reference less position of the joint.");
    }
    page.heading("Motion");
    let mut motions = runs.to_vec();
    if has_reference {
        motions.push((compensated, Ink::Two, "reference"));
    }
    let position = chart_of(&motions, "position, rad", |row, ink| match ink {
        Ink::Two => f64::from(row.reference[0]),
        _ => row.position,
    });
    page.plot(&position, "Position of the joint.");
    page.plot(&over_time(&runs, "velocity, rad/s", |row| row.velocity), "Velocity of the joint.");
    page.heading("Torque");
    page.plot(&over_time(&runs, "torque, N m", Row::torque), "Torque of the motor.");
    let compensation = [(compensated, Ink::One, "compensation")];
    let torque = over_time(&compensation, "compensation, N m", |row| f64::from(row.answer.compensation));
    page.plot(&torque, "What of it compensates friction.");
    let share = over_time(&compensation, "share of the gain", |row| f64::from(row.answer.gain_share));
    page.plot(&share, "Share of the gain that the passivity monitor leaves.");
    if compensated.iter().any(|row| row.answer.correction != Correction::NONE) {
        let level = over_time(&compensation, "ratio to the model", |row| f64::from(row.answer.correction.level));
        page.plot(&level, "Level of the friction that the drive has learnt.");
    }
    page.finish(origin)
}

/// A run, its colour and its name.
type Run<'a> = (&'a [Row], Ink, &'a str);

fn over_time(runs: &[Run<'_>], label: &str, value: impl Fn(&Row) -> f64) -> Plot {
    chart_of(runs, label, |row, _| value(row))
}

fn chart_of(runs: &[Run<'_>], label: &str, value: impl Fn(&Row, Ink) -> f64) -> Plot {
    let mut plot = Plot::new(label, Size::Half, ["time, s", label]).linked(TIME);
    for (rows, ink, name) in runs {
        let time: Vec<f64> = rows.iter().map(|row| row.time).collect();
        let values: Vec<f64> = rows.iter().map(|row| value(row, *ink)).collect();
        plot.lines(&time, &[(&values, *ink, name)]);
    }
    plot
}
