//! The page of a diagnosis: sentences first, then what they rest on.

use super::axis::{Scale, axis_label};
use super::chart::{Chart, Ink, bars};
use super::finding::section;
use super::heat_map::HeatMap;
use super::page::{PARAMETER_HEADER, Page, parameter_rows};
use crate::diagnose::Motion;
use crate::diagnose::advice::Plan;
use crate::diagnose::answer::outcome::{Diagnosis, Finding};
use crate::diagnose::answer::traces::Traces;
use crate::figures::{digits, quantity};
use crate::physics::names::{capital, plain_name};
use crate::physics::units::Units;
use crate::report::tell::Story;
use crate::report::tell::evidence::{parameters, planned_motion};

/// What goes onto the page.
#[derive(Clone, Copy, Debug)]
pub struct DiagnosisPage<'a> {
    /// Name of the recording.
    pub recording: &'a str,
    /// What it was compared with, a few words.
    pub compared_with: &'a str,
    /// The diagnosis.
    pub diagnosis: &'a Diagnosis,
    /// Its sentences.
    pub story: &'a Story,
    /// Units of the recording.
    pub units: Units,
    /// What to record next, where something cannot be told apart.
    pub plan: Option<&'a Plan>,
    /// What was written into an improved image, and what not; empty where none was asked for.
    pub export: &'a [String],
}

/// Rollouts in the chart of motions: so many can be told apart.
const MOST_MOTIONS: usize = 20;
/// Distance between the begins of two rollouts in that chart, in lengths of one.
const MOTION_PACE: f64 = 1.2;
/// Hypotheses in the chart of rivals.
const MOST_RIVALS: usize = 12;

/// The page as one HTML file.
#[must_use]
pub fn diagnosis(content: &DiagnosisPage<'_>) -> String {
    let DiagnosisPage { diagnosis, story, units, .. } = *content;
    let mut page = Page::new(
        &format!("Diagnosis of {}", content.recording),
        &format!(
            "Compared with {}; {} rows behind a {} Hz filter.",
            content.compared_with,
            diagnosis.rows,
            digits(diagnosis.cut_off_hz)
        ),
    );
    page.lead(&story.headline);
    for sentence in &story.given {
        page.paragraph(sentence);
    }
    page.list(&story.findings, "findings");
    story.rest().for_each(|sentence| page.paragraph(sentence));
    if !story.health.is_empty() {
        page.heading("The measurement");
        page.list(&story.health, "findings");
    }
    overview(&mut page, diagnosis, units);
    for index in 0..diagnosis.findings.len() {
        section(&mut page, diagnosis, index, units, content.plan);
    }
    if let Some(plan) = content.plan {
        next(&mut page, plan, units);
    }
    rivals(&mut page, diagnosis);
    proof(&mut page, diagnosis, units);
    if !diagnosis.base_parameters.is_empty() {
        page.heading(if diagnosis.given.is_some() {
            "What the parameters of the model have to change by"
        } else {
            "Parameters of the base model, refitted"
        });
        page.table(&PARAMETER_HEADER, &parameter_rows(&parameters(&diagnosis.base_parameters, units)));
    }
    limits(&mut page, diagnosis, units);
    if !content.export.is_empty() {
        page.heading("The improved image");
        page.list(content.export, "");
    }
    page.finish()
}

/// Everything over time, before and after.
fn overview(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    let traces = &diagnosis.traces;
    if traces.is_empty() {
        return;
    }
    let first = diagnosis.findings.first();
    let (heading, caption) = match first {
        Some(_) => (
            "What the model leaves, before and after",
            "Residual over time. Shaded: where the first finding holds most evidence.",
        ),
        None => ("What the model leaves", "Residual over time."),
    };
    page.heading(heading);
    page.figure(&over_time(traces, first, units), caption);
    maps(page, traces, first, units);
}

fn over_time(traces: &Traces, first: Option<&Finding>, units: Units) -> String {
    let range = (Scale::over(traces.time.iter().copied()), Scale::over(traces.before.iter().copied()));
    let residual = format!("residual ({})", units.actuator);
    let mut chart = Chart::new((1060.0, 300.0), range.0, range.1, ["time (s)", &residual]);
    for [from, to] in first.iter().flat_map(|found| &found.location.when_s) {
        chart.band(*from, *to);
    }
    chart.line(&broken(traces, &traces.before), Ink::Data, "base model");
    if first.is_some() {
        chart.line(&broken(traces, &traces.after), Ink::One, "with the findings");
    }
    chart.svg()
}

/// Points over time with a break between runs.
fn broken(traces: &Traces, values: &[f64]) -> Vec<[f64; 2]> {
    let mut points = Vec::with_capacity(values.len() + traces.run_starts.len());
    let mut starts = traces.run_starts.iter().peekable();
    for (i, value) in values.iter().enumerate() {
        if starts.next_if(|start| **start <= i).is_some() && i > 0 {
            points.push([traces.time[i], f64::NAN]);
        }
        points.push([traces.time[i], *value]);
    }
    points
}

/// Residual over velocity and a channel, before and after, in one scale of colour.
fn maps(page: &mut Page, traces: &Traces, first: Option<&Finding>, units: Units) {
    let channel = first.map_or("position", |found| second_axis(traces, found));
    let Some(values) = traces.channel(channel) else { return };
    let before = HeatMap::of(&traces.velocity, values, &traces.before);
    let reach = before.reach();
    let (velocity, label) = (axis_label("velocity", units), axis_label(channel, units));
    let full = quantity(reach, units.actuator);
    let mut pictures = vec![(
        before.svg(reach, [&velocity, &label]),
        format!(
            "Mean residual of the base model, orange where the real joint needs more torque, blue where less; full colour is {full}."
        ),
    )];
    if first.is_some() {
        let after = HeatMap::of(&traces.velocity, values, &traces.after);
        pictures.push((
            after.svg(reach, [&velocity, &label]),
            "The same with the findings, in the same colours.".to_string(),
        ));
    }
    page.figures(&pictures);
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
    let points: Vec<[f64; 2]> =
        plan.position.iter().enumerate().map(|(k, position)| [k as f64 * plan.period, *position]).collect();
    let (time, position) = ((0.0, plan.duration_s()), Scale::over(plan.position.iter().copied()));
    let mut chart = Chart::new((1060.0, 240.0), time, position, ["time (s)", &axis_label("position", units)]);
    chart.line(&points, Ink::One, "position");
    page.figure(&chart.svg(), "The motion, as --advise FILE.csv writes it.");
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
    page.heading("The rivals and their evidence");
    let caption = if diagnosis.findings.is_empty() {
        "The candidates with the highest scores; none was accepted. Nats: natural logarithm of a likelihood ratio."
    } else {
        "Orange: accepted, with the score at that time. Grey: not accepted, with the score beside the findings. Nats: natural logarithm \
         of a likelihood ratio."
    };
    page.figure(&bars(&rows, "nats"), caption);
}

fn proof(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    page.heading("Proof");
    let row = |name: &str, before: f64, after: f64, rows: usize| {
        vec![name.to_string(), quantity(before, units.actuator), quantity(after, units.actuator), rows.to_string()]
    };
    let mut rows = vec![row("all rows", diagnosis.baseline.rmse, diagnosis.improved.rmse, diagnosis.traces.len())];
    if let Some(proof) = &diagnosis.proof {
        rows.push(row("locked rows, which no fit has seen", proof.baseline_rmse, proof.improved_rmse, proof.rows));
    }
    page.table(&["rows", "before", "after", "number"], &rows);
    if let Some(rollout) = &diagnosis.rollout {
        let position = units.of_channel("position");
        page.paragraph(&format!(
            "Open-loop rollout: driven by the recorded torque alone from {} recorded states, the model strays from the \
             recorded position by {} before and {} after, root mean square over {} s.",
            rollout.starts,
            quantity(rollout.baseline_rmse, &position),
            quantity(rollout.improved_rmse, &position),
            digits(rollout.horizon_s)
        ));
        let caption = "The recorded motion and that of the model from the state at the begin of each stretch on, before and after; the \
                       stretches stand one behind the other.";
        page.figure(&motions(&rollout.motions, rollout.horizon_s, units), caption);
    }
    page.paragraph(&format!(
        "Share of the recorded torque's variance that is explained: {:.4} before, {:.4} after.",
        diagnosis.baseline.r2, diagnosis.improved.r2
    ));
}

/// Positions over time, one rollout behind the other with a break between.
fn motions(motions: &[Motion], horizon_s: f64, units: Units) -> String {
    let motions = &motions[..motions.len().min(MOST_MOTIONS)];
    let all = |of: fn(&Motion) -> &Vec<f64>| motions.iter().flat_map(move |motion| of(motion).iter().copied());
    let position = Scale::over(all(|motion| &motion.recorded).chain(all(|motion| &motion.before)));
    let pace_s = MOTION_PACE * horizon_s;
    let time = Scale::over([0.0, pace_s * motions.len() as f64].into_iter());
    let mut chart = Chart::new((1060.0, 300.0), time, position, ["time (s)", &axis_label("position", units)]);
    let mut line = |of: fn(&Motion) -> &Vec<f64>, ink: Ink, name: &str| {
        let points = motions.iter().enumerate().flat_map(|(index, motion)| {
            let begin = pace_s * index as f64;
            let behind = begin - motion.time[0];
            let points = motion.time.iter().zip(of(motion)).map(move |(time, position)| [time + behind, *position]);
            points.chain([[begin, f64::NAN]])
        });
        chart.line(&points.collect::<Vec<_>>(), ink, name);
    };
    line(|motion| &motion.recorded, Ink::Data, "recorded");
    line(|motion| &motion.before, Ink::Two, "base model");
    line(|motion| &motion.after, Ink::One, "with the findings");
    chart.svg()
}

fn limits(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    let mut limits = diagnosis.limits.clone();
    limits.sort_by(|a, b| a.torque_rms.total_cmp(&b.torque_rms));
    let rows: Vec<Vec<String>> = limits
        .iter()
        .map(|limit| vec![capital(plain_name(limit.effect)), quantity(limit.torque_rms, units.actuator)])
        .collect();
    if rows.is_empty() {
        return;
    }
    page.heading("Detection limits");
    page.paragraph("Root mean square torque at which each effect would have been found with a probability of 90 %.");
    page.table(&["effect", "torque (root mean square)"], &rows);
}
