//! The page of a diagnosis: what is missing, where, how much, how sure and what to do first, then what that rests on.

mod card;
mod changes;
mod content;
mod finding;
mod heat_map;
mod on_the_drive;
mod proof;

use self::finding::section;
use super::ink::Ink;
use super::page::{PARAMETER_HEADER, Page, Plot, Size, parameter_rows};
use crate::diagnose::advice::Plan;
use crate::diagnose::answer::outcome::{Diagnosis, Finding, Verdict};
use crate::diagnose::answer::traces::Traces;
use crate::figures::{digits, quantity};
use crate::physics::names::{capital, plain_name};
use crate::physics::units::Units;
use crate::report::tell::Story;
use crate::report::tell::evidence::{parameters, planned_motion};
use card::card;
pub use content::DiagnosisPage;
use content::{TIME, axis_label};
use heat_map::HeatMap;
use proof::proof;

/// Hypotheses in the chart of rivals.
const MOST_RIVALS: usize = 12;
/// The page as one HTML file.
#[must_use]
pub fn diagnosis(content: &DiagnosisPage<'_>) -> String {
    let DiagnosisPage { diagnosis, story, units, .. } = *content;
    let mut page =
        Page::new(&format!("Diagnosis of {}", content.recording), &format!("Compared with {}.", content.compared_with));
    page.lead(&story.headline);
    story.given.iter().for_each(|sentence| page.paragraph(sentence));
    if diagnosis.verdict == Verdict::BadData {
        measurement(&mut page, story);
    }
    for index in 0..diagnosis.findings.len() {
        card(&mut page, content, index);
    }
    overview(&mut page, diagnosis, units);
    if diagnosis.verdict != Verdict::BadData {
        measurement(&mut page, story);
    }
    if !content.export.is_empty() {
        page.heading("The improved image");
        let told: Vec<String> = content.export.iter().map(|sentence| capital(sentence)).collect();
        page.list(&told, "");
    }
    proof(&mut page, diagnosis, story, units);
    if let Some(plan) = content.plan {
        next(&mut page, plan, units);
    }
    for index in 0..diagnosis.findings.len() {
        section(&mut page, diagnosis, index, units, content.plan);
    }
    maps(&mut page, diagnosis, units);
    rivals(&mut page, diagnosis);
    base(&mut page, diagnosis, units);
    limits(&mut page, diagnosis, story, units);
    page.finish(&content.origin)
}

/// What is wrong with the measurement.
fn measurement(page: &mut Page, story: &Story) {
    if !story.health.is_empty() {
        page.heading("The measurement");
        page.list(&story.health, "findings");
    }
}

/// Everything over time, before and after.
fn overview(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    let traces = &diagnosis.traces;
    if traces.is_empty() {
        return;
    }
    let first = diagnosis.findings.first();
    page.heading(if first.is_some() { "Recording and model, before and after" } else { "Recording and model" });
    let [torque, residual] = ["torque", "residual"].map(|what| format!("{what} ({})", units.actuator));
    let model = |left: &[f64]| traces.torque.iter().zip(left).map(|(torque, left)| torque - left).collect::<Vec<_>>();
    let mut over_time = Plot::new("torque over time", Size::Wide, ["time (s)", &torque]).linked(TIME);
    let mut left = Plot::new("residual over time", Size::Half, ["time (s)", &residual]).linked(TIME);
    let (before, after) = (model(&traces.before), model(&traces.after));
    let mut curves: Vec<(&[f64], Ink, &str)> =
        vec![(&traces.torque, Ink::Data, "recorded"), (&before, Ink::Two, "model before")];
    let mut rest: Vec<(&[f64], Ink, &str)> = vec![(&traces.before, Ink::Two, "model before")];
    if first.is_some() {
        curves.push((&after, Ink::One, "model after"));
        rest.push((&traces.after, Ink::One, "model after"));
    }
    for [from, to] in first.iter().flat_map(|found| &found.location.when_s) {
        over_time.band(*from, *to);
        left.band(*from, *to);
    }
    draw_over_time(&mut over_time, traces, &curves);
    draw_over_time(&mut left, traces, &rest);
    let shaded = if first.is_some() { " Shaded: where the first finding holds most evidence." } else { "" };
    page.plot(
        &over_time,
        &format!(
            "Torque as recorded and as the model has it, its own parameters refitted, behind the common filter.{shaded}"
        ),
    );
    page.plot(&left, "What the model leaves of the recorded torque.");
}

/// Lines over the time of the recording, broken between its runs.
fn draw_over_time(plot: &mut Plot, traces: &Traces, series: &[(&[f64], Ink, &str)]) {
    let mut rows: Vec<Option<usize>> = Vec::with_capacity(traces.len() + traces.run_starts.len());
    for row in 0..traces.len() {
        if row > 0 && traces.run_starts.binary_search(&row).is_ok() {
            rows.push(None);
        }
        rows.push(Some(row));
    }
    let mut last = 0;
    let time: Vec<f64> = rows.iter().map(|row| traces.time[row.inspect(|row| last = *row).unwrap_or(last)]).collect();
    let broken = |values: &[f64]| rows.iter().map(|row| row.map_or(f64::NAN, |row| values[row])).collect::<Vec<_>>();
    let series: Vec<(Vec<f64>, Ink, &str)> = series.iter().map(|(y, ink, label)| (broken(y), *ink, *label)).collect();
    let series: Vec<(&[f64], Ink, &str)> = series.iter().map(|(y, ink, label)| (y.as_slice(), *ink, *label)).collect();
    plot.lines(&time, &series);
}

/// Residual over velocity and a channel, before and after, in one scale of colour.
fn maps(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    let traces = &diagnosis.traces;
    let first = diagnosis.findings.first();
    let channel = first.map_or("position", |found| second_axis(traces, found));
    let Some(values) = traces.channel(channel) else { return };
    let before = HeatMap::of(&traces.velocity, values, &traces.before);
    let reach = before.reach();
    let labels = [axis_label("velocity", units), axis_label(channel, units)];
    let labels = [labels[0].as_str(), labels[1].as_str()];
    let full = quantity(reach, units.actuator);
    let mut maps = vec![(
        before.plot("residual before", reach, labels, units.actuator),
        format!(
            "Mean residual of the model, orange where the real joint needs more torque, blue where less; full colour is {full}."
        ),
    )];
    if first.is_some() {
        let after = HeatMap::of(&traces.velocity, values, &traces.after);
        let plot = after.plot("residual after", reach, labels, units.actuator);
        maps.push((plot, "The same with the findings, in the same colours.".to_string()));
    }
    page.folded(&format!("Residual over velocity and {}", channel.replace('_', " ")), |page| page.plots(&maps));
}

/// The channel beside velocity along which a finding is located best.
fn second_axis(traces: &Traces, found: &Finding) -> &'static str {
    found
        .location
        .regions
        .iter()
        .map(|region| region.side.channel)
        .find(|channel| *channel != "velocity" && traces.channel(channel).is_some())
        .unwrap_or("position")
}

/// The motion that is proposed, over time.
fn next(page: &mut Page, plan: &Plan, units: Units) {
    page.heading("What to record next");
    page.paragraph(&format!("{}.", capital(&planned_motion(plan))));
    let time: Vec<f64> = (0..plan.position.len()).map(|k| k as f64 * plan.period).collect();
    let mut plot = Plot::new("motion to record", Size::Half, ["time (s)", &axis_label("position", units)]);
    plot.lines(&time, &[(&plan.position, Ink::One, "position")]);
    page.plot(&plot, "The motion, as --advise FILE.csv writes it.");
}

fn rivals(page: &mut Page, diagnosis: &Diagnosis) {
    let mut rows: Vec<(String, f64, bool)> =
        diagnosis.findings.iter().map(|found| (found.effect.name().to_string(), found.score, true)).collect();
    rows.extend(
        diagnosis
            .rivals
            .iter()
            .filter(|rival| rival.score > 0.0)
            .take(MOST_RIVALS)
            .map(|rival| (rival.label.to_string(), rival.score, false)),
    );
    if rows.is_empty() {
        return;
    }
    let caption = if diagnosis.findings.is_empty() {
        "The candidates with the highest scores; none was accepted. Nats: natural logarithm of a likelihood ratio."
    } else {
        "Orange: accepted, with the score at that time. Grey: not accepted, with the score beside the findings. Nats: natural logarithm \
         of a likelihood ratio."
    };
    page.folded("The rivals and their evidence", |page| page.bars(&rows, "nats", caption));
}

fn base(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    if diagnosis.base_parameters.is_empty() {
        return;
    }
    let heading = match diagnosis.given {
        Some(_) => "What the parameters of the model have to change by",
        None => "Parameters of the base model, refitted",
    };
    page.folded(heading, |page| {
        page.table(&PARAMETER_HEADER, &parameter_rows(&parameters(&diagnosis.base_parameters, units), "fixed"));
    });
}

fn limits(page: &mut Page, diagnosis: &Diagnosis, story: &Story, units: Units) {
    let mut limits = diagnosis.limits.clone();
    limits.sort_by(|a, b| a.torque_rms.total_cmp(&b.torque_rms));
    let rows: Vec<Vec<String>> = limits
        .iter()
        .map(|limit| vec![capital(plain_name(limit.effect)), quantity(limit.torque_rms, units.actuator)])
        .collect();
    page.folded("What else was looked for", |page| {
        story.beside().for_each(|sentence| page.paragraph(sentence));
        page.paragraph(&format!(
            "Weighed on {} rows behind a {} Hz filter.",
            diagnosis.rows,
            digits(diagnosis.cut_off_hz)
        ));
        if !rows.is_empty() {
            page.paragraph(
                "Root mean square torque at which each effect would have been found with a probability of 90 %:",
            );
            page.table(&["effect", "torque (root mean square)"], &rows);
        }
    });
}
