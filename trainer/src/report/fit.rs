//! The page of a fit.

use super::axis::Scale;
use super::chart::{Chart, Ink};
use super::graph;
use super::page::{PARAMETER_HEADER, Page, parameter_rows};
use crate::figures::{digits, quantity};
use crate::fit::outcome::{Outcome, Soundness, Trace};
use crate::recording::Axis;

/// Pictures of activations at most.
const MOST_ACTIVATIONS: usize = 12;

/// The page as one HTML file; `warnings` are those of the checks before the fit, in sentences.
#[must_use]
pub fn fit(outcome: &Outcome, warnings: &[String]) -> String {
    let name = if outcome.joint.is_empty() { "a joint" } else { &outcome.joint };
    let mut page = Page::new(&format!("Friction of {name}"), &format!("{}. Seed {}.", outcome.filter, outcome.seed));
    summary(&mut page, outcome, warnings);
    page.equation(&outcome.law.expression);
    page.paragraph(&outcome.choice);
    page.table(&PARAMETER_HEADER, &parameter_rows(&outcome.parameters));
    scores(&mut page, outcome);
    over_velocity(&mut page, outcome);
    for trace in outcome.train.iter().chain(&outcome.tests) {
        over_time(&mut page, trace, outcome.unit);
    }
    network(&mut page, outcome);
    comparison(&mut page, outcome);
    page.finish()
}

fn summary(page: &mut Page, outcome: &Outcome, warnings: &[String]) {
    page.lead(&format!(
        "The exported {} predicts the training recordings to {} ({} of the variance explained).",
        outcome.representation.name(),
        quantity(outcome.train_score.rmse, outcome.unit),
        digits(outcome.train_score.r2),
    ));
    let mut notes: Vec<String> = warnings.iter().chain(&outcome.remarks).cloned().collect();
    match &outcome.sound {
        Soundness::Sound => {}
        Soundness::NotIdentifiable(what) | Soundness::NotConverged(what) | Soundness::NotPhysical(what) => {
            notes.insert(0, what.clone())
        }
    }
    page.list(&notes, "findings");
}

fn scores(page: &mut Page, outcome: &Outcome) {
    page.heading("Scores of the exported image");
    let row = |kind: &str, trace: &Trace| {
        vec![
            kind.to_string(),
            trace.label.clone(),
            trace.score.n.to_string(),
            format!("{:.5}", trace.score.r2),
            quantity(trace.score.rmse, outcome.unit),
            format!("{:.2} %", 100.0 * trace.filtered_score.relative_error),
        ]
    };
    let rows: Vec<Vec<String>> = outcome
        .train
        .iter()
        .map(|trace| row("training", trace))
        .chain(outcome.tests.iter().map(|trace| row("test", trace)))
        .collect();
    page.table(&["", "recording", "rows", "R2", "error (RMS)", "relative error, filtered"], &rows);
}

fn velocity_label(outcome: &Outcome) -> &'static str {
    match outcome.axis {
        Axis::Rotary => "velocity (rad/s)",
        Axis::Linear => "velocity (m/s)",
    }
}

fn over_velocity(page: &mut Page, outcome: &Outcome) {
    let label = format!("friction ({})", outcome.unit);
    let velocities = outcome.cloud.iter().chain(&outcome.law_curve).map(|p| p[0]);
    let (x, y) = (Scale::over(velocities), Scale::over(outcome.cloud.iter().chain(&outcome.law_curve).map(|p| p[1])));
    page.heading("Friction over velocity");
    let mut law = Chart::new((520.0, 340.0), x, y, [velocity_label(outcome), &label]);
    law.dots(&outcome.cloud, Ink::Data, "measured");
    law.area(&outcome.band, Ink::Two, "95 % band");
    law.line(&outcome.law_curve, Ink::One, "exported law");
    let mut stages = Chart::new((520.0, 340.0), x, y, [velocity_label(outcome), &label]);
    stages.dots(&outcome.cloud, Ink::Data, "");
    for ((share, points), ink) in outcome.network.stages.iter().zip([Ink::Three, Ink::Two, Ink::One]) {
        stages.line(points, ink, &format!("{:.0} % trained", 100.0 * share));
    }
    page.figures(&[
        (
            law.svg(),
            "The law in the image, other inputs at their mean, with the band that the network leaves for it; measured torque less the rigid body."
                .to_string(),
        ),
        (stages.svg(), "The network while it was trained.".to_string()),
    ]);
}

fn over_time(page: &mut Page, trace: &Trace, unit: &str) {
    page.heading(&format!("{} over time", trace.label));
    let pairs =
        |series: &[f64]| -> Vec<[f64; 2]> { trace.time.iter().zip(series).map(|(t, value)| [*t, *value]).collect() };
    let time = Scale::over(trace.time.iter().copied());
    let values = Scale::over(trace.measured.iter().chain(&trace.predicted).copied());
    let mut chart = Chart::new((1060.0, 300.0), time, values, ["time (s)", &format!("actuator ({unit})")]);
    chart.line(&pairs(&trace.measured), Ink::Data, "measured");
    chart.line(&pairs(&trace.predicted), Ink::One, "predicted");
    page.figure(&chart.svg(), "Actuator as recorded and as the exported image predicts it, rigid body included.");
    let residual: Vec<f64> = trace.measured.iter().zip(&trace.predicted).map(|(m, p)| m - p).collect();
    let label = format!("residual ({unit})");
    let range = Scale::over(residual.iter().copied());
    let mut over_time = Chart::new((520.0, 260.0), time, range, ["time (s)", &label]);
    over_time.line(&pairs(&residual), Ink::Two, "");
    let mut pictures = vec![(over_time.svg(), "Measured less predicted, over time.".to_string())];
    if trace.velocity.len() == residual.len() && !residual.is_empty() {
        let points: Vec<[f64; 2]> = trace.velocity.iter().zip(&residual).map(|(v, r)| [*v, *r]).collect();
        let velocity = Scale::over(trace.velocity.iter().copied());
        let mut over_velocity = Chart::new((520.0, 260.0), velocity, range, ["velocity", &label]);
        over_velocity.dots(&points, Ink::Two, "");
        pictures.push((over_velocity.svg(), "The same over velocity.".to_string()));
    }
    page.figures(&pictures);
}

fn network(page: &mut Page, outcome: &Outcome) {
    page.heading("The network");
    let names: Vec<String> = outcome.inputs.iter().map(|input| input.name.clone()).collect();
    let story = &outcome.network;
    page.figures(&[
        (
            graph::network(&story.before, &names),
            format!("As trained, {}: an edge is as dark as its attribution score.", story.architecture),
        ),
        (graph::network(&story.after, &names), "After pruning and refitting.".to_string()),
    ]);
    let edges =
        story.after.edges.iter().zip(&story.activations).filter(|(edge, points)| edge.active && !points.is_empty());
    let pictures: Vec<(String, String)> = edges
        .take(MOST_ACTIVATIONS)
        .map(|(edge, points)| {
            let (x, y) = (Scale::over(points.iter().map(|p| p[0])), Scale::over(points.iter().map(|p| p[1])));
            let mut chart = Chart::new((520.0, 240.0), x, y, ["in", "out"]);
            chart.line(points, Ink::One, "");
            let place = format!("layer {}, {} to {}", edge.layer, edge.from, edge.to);
            (chart.svg(), format!("Activation of {place}, attribution {}.", digits(edge.score)))
        })
        .collect();
    page.subheading("Activations that are left");
    page.figures(&pictures);
}

fn comparison(page: &mut Page, outcome: &Outcome) {
    page.heading("Relevance of the inputs");
    let rows: Vec<Vec<String>> = outcome
        .relevance
        .iter()
        .map(|row| {
            let picked = if row.picked { "picked" } else { "" };
            vec![
                row.input.clone(),
                digits(row.correlation),
                digits(row.explained),
                digits(row.added),
                picked.to_string(),
            ]
        })
        .collect();
    page.table(&["input", "correlation", "variance explained alone", "of what velocity leaves", ""], &rows);
    page.heading("What was compared");
    let rows: Vec<Vec<String>> = outcome
        .candidates
        .iter()
        .map(|candidate| {
            vec![
                candidate.representation.name().to_string(),
                candidate.description.clone(),
                quantity(candidate.held_out_rmse, outcome.unit),
                format!("{} bytes", candidate.bytes),
                format!("{} instructions", candidate.instructions),
                if candidate.chosen { "in the image" } else { "" }.to_string(),
            ]
        })
        .collect();
    page.table(&["form", "", "held-out error", "size", "Cortex-M4F", ""], &rows);
    let rows: Vec<Vec<String>> = outcome
        .classical
        .iter()
        .map(|law| vec![law.name.to_string(), quantity(law.rmse, outcome.unit), digits(law.bic)])
        .collect();
    page.subheading("Classical laws on the same samples");
    page.table(&["law", "error (RMS)", "BIC"], &rows);
    let rows: Vec<Vec<String>> = outcome
        .law
        .front
        .iter()
        .map(|law| {
            let errors = [law.rmse, law.held_out_rmse].map(|error| quantity(error, outcome.unit));
            vec![law.nodes.to_string(), errors[0].clone(), errors[1].clone(), law.expression.clone()]
        })
        .collect();
    page.subheading("Formulas that no simpler one equals");
    page.table(&["nodes", "error (RMS)", "held out", "formula"], &rows);
}
