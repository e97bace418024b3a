//! The page of a diagnosis: sentences first, then what they rest on.

use super::axis::Scale;
use super::chart::{Chart, Ink, bars};
use super::heat_map::HeatMap;
use super::page::{PARAMETER_HEADER, Page, parameter_rows};
use crate::diagnose::sentence::{Story, Units, digits, plain_name, quantity};
use crate::diagnose::{Diagnosis, Finding, Label, Traces};
use crate::physics::{Action, EffectId};

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
    /// What was written into an improved image, and what not; empty where none was asked for.
    pub export: &'a [String],
}

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
    page.list(&story.findings, "findings");
    for sentence in [&story.proof, &story.withdrawn, &story.limits].into_iter().flatten() {
        page.paragraph(sentence);
    }
    if !story.health.is_empty() {
        page.heading("The measurement");
        page.list(&story.health, "findings");
    }
    overview(&mut page, diagnosis, units);
    for (index, found) in diagnosis.findings.iter().enumerate() {
        evidence(&mut page, diagnosis, found, index, units);
    }
    rivals(&mut page, diagnosis);
    proof(&mut page, diagnosis, units);
    if !diagnosis.base_parameters.is_empty() {
        page.heading("Parameters of the base model, refitted");
        page.table(&PARAMETER_HEADER, &parameter_rows(&diagnosis.base_parameters));
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
    page.heading("What the model leaves, before and after");
    let when: Vec<[f64; 2]> = diagnosis.findings.first().map(|f| f.location.when_s.clone()).unwrap_or_default();
    page.figure(
        &over_time(traces, &when, units),
        "Residual over time. Shaded: where the first finding holds most evidence.",
    );
    let channel = diagnosis.findings.first().map_or("position", |found| second_axis(traces, found));
    maps(page, traces, channel, units);
}

fn over_time(traces: &Traces, shaded: &[[f64; 2]], units: Units) -> String {
    let range = (Scale::over(traces.time.iter().copied()), Scale::over(traces.before.iter().copied()));
    let residual = format!("residual ({})", units.actuator);
    let mut chart = Chart::new((1060.0, 300.0), range.0, range.1, ["time (s)", &residual]);
    for [from, to] in shaded {
        chart.band(*from, *to);
    }
    chart.line(&broken(traces, &traces.before), Ink::Data, "base model");
    chart.line(&broken(traces, &traces.after), Ink::One, "with the findings");
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
fn maps(page: &mut Page, traces: &Traces, channel: &str, units: Units) {
    let Some(values) = traces.channel(channel) else { return };
    let before = HeatMap::of(&traces.velocity, values, &traces.before);
    let after = HeatMap::of(&traces.velocity, values, &traces.after);
    let reach = before.reach();
    let label = axis_label(channel, units);
    let velocity = axis_label("velocity", units);
    let full = quantity(reach, units.actuator);
    page.figures(&[
        (
            before.svg(reach, [&velocity, &label]),
            format!("Before: mean residual, orange where the real joint needs more torque, blue where less; full colour is {full}."),
        ),
        (after.svg(reach, [&velocity, &label]), "After, in the same colours.".to_string()),
    ]);
}

/// The channel beside velocity along which a finding is located best.
fn second_axis(traces: &Traces, found: &Finding) -> &'static str {
    found
        .location
        .regions
        .iter()
        .map(|region| region.channel)
        .find(|channel| *channel != "velocity" && traces.channel(channel).is_some())
        .unwrap_or("position")
}

fn axis_label(channel: &str, units: Units) -> String {
    format!("{} ({})", channel.replace('_', " "), units.of_channel(channel))
}

/// One finding: equation, parameters, torque over its channel and time, regions.
fn evidence(page: &mut Page, diagnosis: &Diagnosis, found: &Finding, index: usize, units: Units) {
    let code = if found.effect == EffectId::Unknown { "" } else { found.effect.code() };
    let name = format!("{code} {}", found.effect.name());
    page.heading(&format!("{}. {} ({})", index + 1, sentence_case(plain_name(found.effect)), name.trim()));
    page.paragraph(&format!("{}.", sentence_case(&found.evidence)));
    page.equation(&found.equation);
    page.table(&PARAMETER_HEADER, &parameter_rows(&found.parameters));
    figures(page, diagnosis, found, index, units);
    let regions: Vec<Vec<String>> = found
        .location
        .regions
        .iter()
        .take(5)
        .map(|region| {
            vec![
                region.channel.replace('_', " "),
                digits(region.from),
                digits(region.to),
                units.of_channel(region.channel),
                format!("{:.0} %", 100.0 * region.share_of_excess),
                format!("{:.0} %", 100.0 * region.share_of_samples),
            ]
        })
        .collect();
    page.subheading("Where it sits");
    page.table(&["channel", "from", "to", "unit", "of the evidence", "of the samples"], &regions);
    page.subheading("On the drive");
    page.paragraph(on_the_drive(found.effect));
    if !found.alternatives.is_empty() {
        page.subheading("What would tell the alternatives apart");
        page.paragraph(&format!("{}.", sentence_case(&found.separate_by.sentence)));
    }
}

/// Residual without this effect and its torque, over its best channel and over the time where it is densest.
fn figures(page: &mut Page, diagnosis: &Diagnosis, found: &Finding, index: usize, units: Units) {
    let traces = &diagnosis.traces;
    let Some(torque) = traces.effects.get(index) else { return };
    let without: Vec<f64> = traces.after.iter().zip(torque).map(|(rest, effect)| rest + effect).collect();
    let label = format!("torque ({})", units.actuator);
    let range = Scale::over(without.iter().copied());
    let mut pictures = Vec::new();
    if let Some(region) = found.location.regions.first()
        && let Some(values) = traces.channel(region.channel)
    {
        let pairs = |series: &[f64]| -> Vec<[f64; 2]> { values.iter().zip(series).map(|(x, y)| [*x, *y]).collect() };
        let over = Scale::over(values.iter().copied());
        let mut chart = Chart::new((520.0, 320.0), over, range, [&axis_label(region.channel, units), &label]);
        chart.band(region.from, region.to);
        chart.dots(&pairs(&without), Ink::Data, "residual without it");
        chart.dots(&pairs(torque), Ink::Two, "its torque");
        pictures.push((
            chart.svg(),
            "Residual of all other terms and the torque of this one, over the channel that locates it.".to_string(),
        ));
    }
    let (from, to) = window(traces, found);
    let inside: Vec<usize> = (0..traces.len()).filter(|&i| traces.time[i] >= from && traces.time[i] <= to).collect();
    if inside.len() > 4 {
        let pairs = |series: &[f64]| -> Vec<[f64; 2]> { inside.iter().map(|&i| [traces.time[i], series[i]]).collect() };
        let mut chart = Chart::new(
            (520.0, 320.0),
            (from, to),
            Scale::over(inside.iter().map(|&i| without[i])),
            ["time (s)", &label],
        );
        for [begin, end] in &found.location.when_s {
            if *end > from && *begin < to {
                chart.band(*begin, *end);
            }
        }
        chart.line(&pairs(&without), Ink::Data, "residual without it");
        chart.line(&pairs(torque), Ink::Two, "its torque");
        pictures.push((chart.svg(), "The same over the stretch of time with the densest evidence.".to_string()));
    }
    page.figures(&pictures);
}

/// A stretch of time around the densest evidence, at most a tenth of the recording.
fn window(traces: &Traces, found: &Finding) -> (f64, f64) {
    let (Some(&first), Some(&last)) = (traces.time.first(), traces.time.last()) else { return (0.0, 0.0) };
    let width = (0.1 * (last - first)).max(1.0).min(last - first);
    let centre = found.location.when_s.first().map_or(0.5 * (first + last), |w| 0.5 * (w[0] + w[1]));
    let from = (centre - 0.5 * width).clamp(first, last - width);
    (from, from + width)
}

fn rivals(page: &mut Page, diagnosis: &Diagnosis) {
    let named = |label: &Label| match label {
        Label::Named(effect) => effect.name().to_string(),
        Label::Generic(_) => label.to_string(),
    };
    let mut rows: Vec<(String, f64, bool)> =
        diagnosis.findings.iter().map(|found| (found.effect.name().to_string(), found.score, true)).collect();
    rows.extend(
        diagnosis
            .rivals
            .iter()
            .filter(|rival| rival.score > 0.0)
            .take(MOST_RIVALS)
            .map(|rival| (named(&rival.label), rival.score, false)),
    );
    if rows.is_empty() {
        return;
    }
    page.heading("The rivals and their evidence");
    page.figure(
        &bars(&rows, "nats"),
        "Orange: accepted, with the score at that time. Grey: what was still left over and not accepted, after the findings were taken into the model.",
    );
}

fn proof(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    page.heading("Proof");
    let row = |name: &str, before: f64, after: f64, rows: usize| {
        vec![name.to_string(), quantity(before, units.actuator), quantity(after, units.actuator), rows.to_string()]
    };
    let mut rows = vec![row("all rows", diagnosis.baseline.rmse, diagnosis.improved.rmse, diagnosis.traces.len())];
    if let Some(proof) = &diagnosis.proof {
        rows.push(row("locked rows, opened once", proof.baseline_rmse, proof.improved_rmse, proof.rows));
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
    }
    page.paragraph(&format!(
        "Share of the recorded torque's variance that is explained: {:.4} before, {:.4} after.",
        diagnosis.baseline.r2, diagnosis.improved.r2
    ));
}

fn limits(page: &mut Page, diagnosis: &Diagnosis, units: Units) {
    let mut limits = diagnosis.limits.clone();
    limits.sort_by(|a, b| a.torque_rms.total_cmp(&b.torque_rms));
    let rows: Vec<Vec<String>> = limits
        .iter()
        .map(|limit| vec![sentence_case(plain_name(limit.effect)), quantity(limit.torque_rms, units.actuator)])
        .collect();
    if rows.is_empty() {
        return;
    }
    page.heading("What would have been seen");
    page.paragraph(
        "Each of these, had its torque reached the stated root mean square, would have been found nine times in ten.",
    );
    page.table(&["effect", "torque (root mean square)"], &rows);
}

/// How a term is run on the drive and what it keeps between samples.
fn on_the_drive(effect: EffectId) -> &'static str {
    use EffectId::*;
    match effect {
        Unknown => "Not run on the drive: nothing is known of it beyond the recorded range.",
        Presliding => {
            "A bristle, stepped by the exact exponential over the distance of a sample: one exponential, one state, no stability limit on the sample time."
        }
        FrictionalLag => "One first-order lag on the velocity that the law sees: one state.",
        DwellBreakaway => "A clock of the stop and the distance since: two exponentials, three states.",
        WarmUp => "One thermal state driven by the dissipated power.",
        Backlash => {
            "The play operator on position: two comparisons, one state; it corrects the position, not the torque."
        }
        PositionRipple => "A sine and a cosine of the order times position: no state.",
        KinematicError => "A correction of position, sine and cosine of the order: no state, no torque.",
        PositionFriction => "A table over position times the sign of velocity: no state.",
        Stribeck | ViscousNonlinearity | DirectionAsymmetry => "A function of velocity alone: no state.",
        Temperature | LoadFriction | DriveBackdrive => "A product with one measured channel: no state.",
        Spring => "One product with position: no state.",
        GravityError | InertiaError | TorqueScale | TorqueOffset => {
            "Nothing to run: the rigid-body parameters of the model are corrected."
        }
        SlowDrift => "Frozen at its value at the end of the recording; fit again when it has moved on.",
        _ => match effect.action() {
            Action::Maintenance => "Not compensated: a fault is to be repaired, and compensating it would hide it.",
            Action::Measurement => "Not compensated: the measurement is to be repaired.",
            _ => "Not run on the drive: the image has no term for it.",
        },
    }
}

fn sentence_case(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}
