//! What one accepted effect tells its reader: name, probability, parameters with units and intervals, place, evidence.

use crate::diagnose::answer::formula;
use crate::diagnose::answer::location::{Location, locate};
use crate::diagnose::answer::nearest_named::nearest;
use crate::diagnose::answer::outcome::{Advice, Finding};
use crate::diagnose::answer::region::{Region, Side};
use crate::diagnose::answer::stated_probability::{alternatives, probability};
use crate::diagnose::answer::traces::{Traces, WorstLocked};
use crate::diagnose::checks::note::HealthNote;
use crate::diagnose::comparison::base::Base;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::proof::locked_rows::prove_alone;
use crate::diagnose::proof::refit::Refit;
use crate::diagnose::search::accepted::Accepted;
use crate::figures::{digits, quantity};
use crate::parameter::Parameter;
use crate::physics::separation::separation;
use crate::physics::units::unit_text;
use crate::physics::{Action, Dimension, EffectId};

/// An accepted effect, the `index`th of `all`, after the joint refit.
pub(crate) fn finding(
    workbench: &Workbench,
    found: &Accepted,
    all: &[Accepted],
    index: usize,
    improved: &Refit,
    actuator: &str,
) -> Finding {
    let effect = found.effect();
    let fitted = improved.effects[index].clone();
    let location = locate(workbench, improved, index);
    let equation = match &found.label {
        Label::Named(id) => workbench.hypothesis(*id).map(|h| h.equation().to_string()).unwrap_or_default(),
        Label::Generic(rival) => formula::equation(workbench, all, index, *rival, &improved.noise),
    };
    let others: Vec<EffectId> = found.rivals.iter().map(|(rival, _)| *rival).collect();
    let advice = std::iter::once(effect).chain(others).map(separation).collect::<Vec<_>>().join("; ");
    let locked = prove_alone(workbench, all, index, improved).map(|proof| proof.gain_nats);
    let of_locked = locked.map(|gain| format!("; locked rows {gain:+.1} more")).unwrap_or_default();
    let evidence = format!(
        "{:.1} nats in favour (held-out folds {:+.1}{of_locked}), family-wise p {}, {} rival{} within reach",
        found.score,
        found.fold_gain.iter().sum::<f64>(),
        probability_text(found.family_wise),
        found.rivals.len(),
        if found.rivals.len() == 1 { "" } else { "s" },
    );
    let nearest = nearest(workbench, &fitted, all, index);
    Finding {
        effect,
        probability: probability(found),
        alternatives: alternatives(found),
        action: effect.action(),
        equation,
        parameters: parameters(workbench, &fitted, actuator),
        location,
        evidence,
        separate_by: Advice { sentence: advice },
        fitted,
        score: found.score,
        margin: found.margin,
        standings: found.standings.clone(),
        channels: found.channels.clone(),
        nearest,
        locked_gain_nats: locked,
    }
}

/// A small probability; what a double cannot hold is bounded.
fn probability_text(probability: f64) -> String {
    if probability < 1e-99 { "below 1e-99".to_string() } else { format!("{probability:.1e}") }
}

/// Coefficients, then free shapes, with units and 95 % intervals.
fn parameters(workbench: &Workbench, fitted: &Fitted, actuator: &str) -> Vec<Parameter> {
    let Label::Named(effect) = fitted.label else { return Vec::new() };
    let Some(hypothesis) = workbench.hypothesis(effect) else { return Vec::new() };
    let rotary = workbench.prepared.state.rotary;
    let parameter = |name: &str, symbol: &str, dimension: Dimension, value: f64, deviation: f64| Parameter {
        name: name.to_string(),
        symbol: symbol.to_string(),
        value,
        unit: unit_text(dimension, rotary, actuator),
        ci95: [value - 1.96 * deviation, value + 1.96 * deviation],
    };
    let linear =
        hypothesis.coefficients(&fitted.shape).into_iter().zip(fitted.coefficients.iter().zip(&fitted.deviation)).map(
            |((name, symbol, dimension), (value, deviation))| parameter(name, symbol, dimension, *value, *deviation),
        );
    let shapes = hypothesis
        .shape_names()
        .into_iter()
        .zip(fitted.shape.iter().zip(&fitted.shape_deviation))
        .filter(|(shape, _)| shape.name != "variant")
        .map(|(shape, (value, deviation))| {
            parameter(shape.name, shape.symbol, shape.dimension, *value, deviation.unwrap_or(0.0))
        });
    linear.chain(shapes).collect()
}

pub(crate) fn base_parameters(base: &Base, refit: &Refit, signals: &Signals, actuator: &str) -> Vec<Parameter> {
    let dimension = |name: &str| match name {
        "viscous_coefficient" | "viscous_coefficient_change" => Dimension::TorquePerVelocity,
        "inertia" => Dimension::Inertia,
        _ => Dimension::Torque,
    };
    base.names
        .iter()
        .enumerate()
        .filter(|(_, name)| !matches!(**name, "model_parameter" | "friction_knot"))
        .map(|(i, name)| {
            let (value, deviation) = (refit.base[i], refit.base_deviation[i]);
            Parameter {
                name: (*name).to_string(),
                symbol: match *name {
                    "coulomb_torque" => "F_c",
                    "viscous_coefficient" => "F_v",
                    "coulomb_torque_change" => "dF_c",
                    "viscous_coefficient_change" => "dF_v",
                    _ => "J",
                }
                .to_string(),
                value,
                unit: unit_text(dimension(name), signals.rotary, actuator),
                ci95: [value - 1.96 * deviation, value + 1.96 * deviation],
            }
        })
        .collect()
}

/// Probability of a fault that the signals show by themselves.
const AS_GOOD_AS_CERTAIN: f64 = 0.99;

/// A fault of the measurement as a finding.
pub(crate) fn measurement_finding(note: &HealthNote) -> Finding {
    unfitted(note.effect, AS_GOOD_AS_CERTAIN, Action::Measurement, note.sentence.clone())
}

/// Something that happened once, in rows that were locked away.
pub(crate) fn unexplained_event(worst: WorstLocked, actuator: &str) -> HealthNote {
    let ([from, to], rms) = (worst.when_s.map(digits), quantity(worst.rms, actuator));
    HealthNote {
        effect: EffectId::TransientEvent,
        blocking: false,
        sentence: format!(
            "between {from} and {to} s the model is wrong by {rms} (root mean square), which nothing in the other rows is like"
        ),
    }
}

/// What happened once in rows that were locked away, where no row that might name it shows it.
pub(crate) fn unexplained_finding(worst: WorstLocked, traces: &Traces, actuator: &str) -> Finding {
    let energy = |left: Vec<f64>| left.iter().map(|left| left * left).sum::<f64>();
    let [from, to] = worst.when_s;
    let rows = traces.time.iter().filter(|time| (from..=to).contains(*time)).count();
    let region = Region {
        side: Side { channel: "time", from, to },
        and: None,
        share_of_excess: energy(traces.left_within(worst.when_s)) / energy(traces.after.clone()),
        share_of_samples: rows as f64 / traces.len() as f64,
    };
    let effect = EffectId::Unknown;
    let note = unexplained_event(worst, actuator);
    Finding {
        equation: "dF = c(time)".to_string(),
        location: Location { regions: vec![region], when_s: vec![worst.when_s] },
        ..unfitted(effect, CLEARLY_NO_NOISE, effect.action(), note.sentence)
    }
}

/// Probability of what leaves some stretch with several times of what any other is left with.
const CLEARLY_NO_NOISE: f64 = 0.98;

/// A finding without a fitted term.
fn unfitted(effect: EffectId, probability: f64, action: Action, evidence: String) -> Finding {
    Finding {
        effect,
        probability,
        alternatives: Vec::new(),
        action,
        equation: String::new(),
        parameters: Vec::new(),
        location: Location::default(),
        evidence,
        separate_by: Advice { sentence: separation(effect).to_string() },
        fitted: Fitted {
            label: Label::Named(effect),
            shape: Vec::new(),
            shape_deviation: Vec::new(),
            coefficients: Vec::new(),
            deviation: Vec::new(),
        },
        score: 0.0,
        margin: f64::INFINITY,
        standings: Vec::new(),
        channels: Vec::new(),
        nearest: None,
        locked_gain_nats: None,
    }
}
