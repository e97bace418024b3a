//! The page of a run in closed loop: the same motion without and with compensation.

use super::axis::Scale;
use super::chart::{Chart, Ink};
use super::page::Page;
use crate::rig::Row;
use frikan_runtime::supervised::adaptation::Correction;

/// Width and height of a chart over time, pixels.
const SIZE: (f64, f64) = (1060.0, 250.0);

/// The page as one HTML file: `lines` are the result in sentences, then the runs without and with compensation.
#[must_use]
pub fn closed_loop(motion: &str, lines: &[String], uncompensated: &[Row], compensated: &[Row]) -> String {
    let (lead, others) = lines.split_first().map_or(("", &[][..]), |(lead, others)| (lead.as_str(), others));
    let mut page = Page::new(&format!("Closed loop: {motion}"), lead);
    page.list(others, "findings");
    let error = |row: &Row| 1e3 * (f64::from(row.reference[0]) - row.position);
    let has_reference = compensated.iter().any(|row| !row.reference[0].is_nan());
    let runs = [(uncompensated, Ink::Data, "without compensation"), (compensated, Ink::One, "with compensation")];
    if has_reference {
        page.heading("Tracking error");
        page.figure(&over_time(&runs, "error, mrad", error), "Reference less position of the joint.");
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
    page.figure(&position, "Position of the joint.");
    page.figure(&over_time(&runs, "velocity, rad/s", |row| row.velocity), "Velocity of the joint.");
    page.heading("Torque");
    page.figure(&over_time(&runs, "torque, N m", |row| f64::from(row.answer.torque)), "Torque of the drive.");
    let compensation = [(compensated, Ink::One, "compensation")];
    let torque = over_time(&compensation, "compensation, N m", |row| f64::from(row.answer.compensation));
    page.figure(&torque, "What of it compensates friction.");
    let share = over_time(&compensation, "share of the gain", |row| f64::from(row.answer.gain_share));
    page.figure(&share, "Share of the gain that the passivity monitor leaves.");
    if compensated.iter().any(|row| row.answer.correction != Correction::NONE) {
        let level = over_time(&compensation, "ratio to the model", |row| f64::from(row.answer.correction.level));
        page.figure(&level, "Level of the friction that the drive has learnt.");
    }
    page.finish()
}

/// A run, its colour and its name.
type Run<'a> = (&'a [Row], Ink, &'a str);

fn over_time(runs: &[Run<'_>], label: &str, value: impl Fn(&Row) -> f64) -> String {
    chart_of(runs, label, |row, _| value(row))
}

fn chart_of(runs: &[Run<'_>], label: &str, value: impl Fn(&Row, Ink) -> f64) -> String {
    let all = || runs.iter().flat_map(|(rows, ink, _)| rows.iter().map(|row| (row.time, value(row, *ink))));
    let x = Scale::over(all().map(|(time, _)| time));
    let y = Scale::over(all().map(|(_, value)| value).filter(|value| value.is_finite()));
    let mut chart = Chart::new(SIZE, x, y, ["time, s", label]);
    for (rows, ink, name) in runs {
        let points: Vec<[f64; 2]> = rows.iter().map(|row| [row.time, value(row, *ink)]).collect();
        chart.line(&points, *ink, name);
    }
    chart.svg()
}
