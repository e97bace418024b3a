//! The page of a fit.

use super::graph;
use super::ink::Ink;
use super::page::{Origin, PARAMETER_HEADER, Page, Plot, Size, columns, parameter_rows};
use crate::figures::{digits, quantity};
use crate::fit::outcome::{Outcome, Soundness, Trace};
use crate::parameter::NOT_DETERMINED;
use crate::physics::names::capital;
use crate::recording::Axis;

/// Pictures of activations at most.
const MOST_ACTIVATIONS: usize = 12;

/// Link of the charts over the time of one recording.
const TIME: &str = "time";

/// The page as one HTML file; `warnings` are those of the checks before the fit, in sentences.
#[must_use]
pub fn fit(outcome: &Outcome, warnings: &[String], origin: &Origin<'_>) -> String {
    let name = if outcome.joint.is_empty() { "a joint" } else { &outcome.joint };
    let labels = |traces: &[Trace]| traces.iter().map(|trace| trace.label.as_str()).collect::<Vec<_>>().join(", ");
    let tested =
        if outcome.tests.is_empty() { String::new() } else { format!("; tested on {}", labels(&outcome.tests)) };
    let mut page = Page::new(&format!("Friction of {name}"), &format!("Fitted to {}{tested}.", labels(&outcome.train)));
    summary(&mut page, outcome, warnings);
    page.equation(&format!("friction = {}", outcome.law.expression));
    page.html("<div class=\"split\"><div>");
    page.table(&PARAMETER_HEADER, &parameter_rows(&outcome.parameters, NOT_DETERMINED));
    page.html("</div>");
    law(&mut page, outcome);
    page.html("</div>");
    scores(&mut page, outcome);
    integers(&mut page, outcome);
    for trace in outcome.train.iter().chain(&outcome.tests) {
        over_time(&mut page, trace, outcome.unit);
    }
    network(&mut page, outcome);
    comparison(&mut page, outcome);
    page.finish(origin)
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
    page.table(&["use", "recording", "rows", "R2", "error (RMS)", "relative error, filtered"], &rows);
}

/// The table of integers, where the image holds one.
fn integers(page: &mut Page, outcome: &Outcome) {
    if let Some(integers) = &outcome.integers {
        page.heading(&format!("In integers on {}", integers.target));
        let of_velocity = outcome.inputs.first().map_or("", |velocity| velocity.unit);
        let sentences = integers.told([of_velocity, outcome.unit]).map(|told| format!("{}.", capital(&told)));
        page.list(&sentences, "facts");
    }
}

fn velocity_label(outcome: &Outcome) -> &'static str {
    match outcome.axis {
        Axis::Rotary => "velocity (rad/s)",
        Axis::Linear => "velocity (m/s)",
    }
}

/// The exported law among the measured friction.
fn law(page: &mut Page, outcome: &Outcome) {
    let mut plot = over_velocity(outcome, "friction over velocity");
    let mut caption = "The law in the image, other inputs at their mean; measured torque less the rigid body.";
    if !outcome.band.is_empty() {
        plot.area(&outcome.band, Ink::Two, "95 % band");
        caption = "The law in the image, other inputs at their mean, with the band that the network leaves for it; measured torque less the rigid body.";
    }
    let (velocity, friction) = columns(&outcome.law_curve);
    plot.lines(&velocity, &[(&friction, Ink::One, "exported law")]);
    page.plot(&plot, caption);
}

/// The measured friction over velocity.
fn over_velocity(outcome: &Outcome, name: &str) -> Plot {
    let mut plot = Plot::new(name, Size::Half, [velocity_label(outcome), &format!("friction ({})", outcome.unit)]);
    let (velocity, friction) = columns(&outcome.cloud);
    plot.dots(&velocity, &[(&friction, Ink::Data, "measured")]);
    plot
}

/// The network in training.
fn stages(page: &mut Page, outcome: &Outcome) {
    let mut plot = over_velocity(outcome, "network in training");
    for ((share, points), ink) in outcome.network.stages.iter().zip([Ink::Three, Ink::Two, Ink::One]) {
        let (velocity, friction) = columns(points);
        plot.lines(&velocity, &[(&friction, ink, &format!("{:.0} % trained", 100.0 * share))]);
    }
    page.plot(&plot, "The network while it was trained.");
}

fn over_time(page: &mut Page, trace: &Trace, unit: &str) {
    page.heading(&format!("{} over time", trace.label));
    let residual: Vec<f64> = trace.measured.iter().zip(&trace.predicted).map(|(m, p)| m - p).collect();
    let named = |what: &str| format!("{} {what}", trace.label);
    let [actuator, left] = ["actuator", "residual"].map(|what| format!("{what} ({unit})"));
    let mut over_time = Plot::new(&named("over time"), Size::Wide, ["time (s)", &actuator]).linked(TIME);
    over_time
        .lines(&trace.time, &[(&trace.measured, Ink::Data, "measured"), (&trace.predicted, Ink::One, "predicted")]);
    page.plot(&over_time, "Actuator as recorded and as the exported image predicts it, rigid body included.");
    let mut rest = Plot::new(&named("residual over time"), Size::Low, ["time (s)", &left]).linked(TIME);
    rest.lines(&trace.time, &[(&residual, Ink::Two, "residual")]);
    let mut plots = vec![(rest, "Measured less predicted, over time.".to_string())];
    if trace.velocity.len() == residual.len() && !residual.is_empty() {
        let mut over_velocity = Plot::new(&named("residual over velocity"), Size::Low, ["velocity", &left]);
        over_velocity.dots(&trace.velocity, &[(&residual, Ink::Two, "residual")]);
        plots.push((over_velocity, "The same over velocity.".to_string()));
    }
    page.plots(&plots);
}

fn network(page: &mut Page, outcome: &Outcome) {
    page.folded("The network", |page| graphs(page, outcome));
}

fn graphs(page: &mut Page, outcome: &Outcome) {
    stages(page, outcome);
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
    let plots: Vec<(Plot, String)> = edges
        .take(MOST_ACTIVATIONS)
        .map(|(edge, points)| {
            let (x, y) = columns(points);
            let place = format!("layer {}, {} to {}", edge.layer, edge.from, edge.to);
            let mut plot = Plot::new(&format!("activation {place}"), Size::Low, ["in", "out"]);
            plot.lines(&x, &[(&y, Ink::One, "activation")]);
            (plot, format!("Activation of {place}, attribution {}.", digits(edge.score)))
        })
        .collect();
    page.subheading("Activations that are left");
    page.plots(&plots);
}

fn comparison(page: &mut Page, outcome: &Outcome) {
    page.folded("Relevance of the inputs", |page| relevance(page, outcome));
    page.folded("What was compared", |page| candidates(page, outcome));
}

fn relevance(page: &mut Page, outcome: &Outcome) {
    let rows: Vec<Vec<String>> = outcome
        .relevance
        .iter()
        .map(|row| {
            let picked = if row.picked { "yes" } else { "" };
            vec![
                row.input.clone(),
                digits(row.correlation),
                digits(row.explained),
                digits(row.added),
                picked.to_string(),
            ]
        })
        .collect();
    page.table(&["input", "correlation", "variance explained alone", "of what velocity leaves", "picked"], &rows);
}

fn candidates(page: &mut Page, outcome: &Outcome) {
    page.paragraph(&format!("{}.", outcome.choice));
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
    page.table(&["form", "law", "held-out error", "size", "Cortex-M4F", "chosen"], &rows);
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
