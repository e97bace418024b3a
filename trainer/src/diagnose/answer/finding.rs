//! What one accepted effect tells its reader: name, probability, parameters with units and intervals, place, evidence.

use crate::diagnose::answer::formula;
use crate::diagnose::answer::location::{Location, locate};
use crate::diagnose::answer::nearest_named::nearest;
use crate::diagnose::answer::outcome::{Diagnosis, Estimate, Evidence, Finding};
use crate::diagnose::answer::region::{Region, Side};
use crate::diagnose::answer::stated_probability::{WITHOUT_RIVAL, WITHOUT_SHOWN_GAIN, alternatives, probability};
use crate::diagnose::answer::traces::{Traces, WorstLocked};
use crate::diagnose::checks::note::{HealthNote, Observation};
use crate::diagnose::comparison::base::Base;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::infer::delay::TorqueDelay;
use crate::diagnose::proof::locked_rows::prove_alone;
use crate::diagnose::proof::refit::Refit;
use crate::diagnose::search::accepted::Accepted;
use crate::physics::{Action, Dimension, EffectId};

/// An accepted effect, the `index`th of `all`, after the joint refit.
pub(crate) fn finding(
    workbench: &Workbench,
    found: &Accepted,
    all: &[Accepted],
    index: usize,
    improved: &Refit,
) -> Finding {
    let effect = found.effect();
    let fitted = improved.effects[index].clone();
    let location = locate(workbench, improved, index);
    let equation = match &found.label {
        Label::Named(id) => workbench.hypothesis(*id).map(|h| h.equation().to_string()).unwrap_or_default(),
        Label::Generic(rival) => formula::equation(workbench, all, index, *rival, &improved.noise),
    };
    let locked = prove_alone(workbench, all, index, improved).map(|proof| proof.gain_nats);
    let evidence = Evidence::Rows {
        held_out_gain_nats: found.fold_gain.iter().sum(),
        family_wise: found.family_wise,
        rivals: found.rivals.len(),
    };
    let nearest = nearest(workbench, &fitted, all, index);
    Finding {
        effect,
        probability: probability(found, index == 0),
        alternatives: alternatives(found),
        action: effect.action(),
        equation,
        parameters: parameters(workbench, &fitted),
        location,
        evidence,
        fitted,
        score: found.score,
        margin: found.margin,
        standings: found.standings.clone(),
        channels: found.channels.clone(),
        nearest,
        locked_gain_nats: locked,
    }
}

/// Coefficients, then free shapes, with units and 95 % intervals.
fn parameters(workbench: &Workbench, fitted: &Fitted) -> Vec<Estimate> {
    let Label::Named(effect) = fitted.label else { return Vec::new() };
    let Some(hypothesis) = workbench.hypothesis(effect) else { return Vec::new() };
    let linear =
        hypothesis.coefficients(&fitted.shape).into_iter().zip(fitted.coefficients.iter().zip(&fitted.deviation)).map(
            |((name, symbol, dimension), (value, deviation))| Estimate::of(name, symbol, dimension, *value, *deviation),
        );
    let shapes = hypothesis
        .shape_names(&fitted.shape)
        .into_iter()
        .zip(fitted.shape.iter().zip(&fitted.shape_deviation))
        .filter(|(shape, _)| shape.name != "variant")
        .map(|(shape, (value, deviation))| {
            Estimate::of(shape.name, shape.symbol, shape.dimension, *value, deviation.unwrap_or(0.0))
        });
    linear.chain(shapes).collect()
}

pub(crate) fn base_parameters(base: &Base, refit: &Refit) -> Vec<Estimate> {
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
            let symbol = match *name {
                "coulomb_torque" => "F_c",
                "viscous_coefficient" => "F_v",
                "coulomb_torque_change" => "dF_c",
                "viscous_coefficient_change" => "dF_v",
                _ => "J",
            };
            Estimate::of(name, symbol, dimension(name), refit.base[i], refit.base_deviation[i])
        })
        .collect()
}

impl Finding {
    /// Whether an improved image holds it: neither a fault nor a constant of the actuator.
    #[must_use]
    pub(crate) fn is_of_the_image(&self) -> bool {
        matches!(self.action, Action::FeedForward | Action::Parameter) && !self.effect.is_of_actuator()
    }

    /// The finding where held-out rows do not show by their interval that the error falls with it: less certain, but for an event, which lies
    /// in rows that no others can speak for.
    #[must_use]
    pub(crate) fn without_shown_gain(mut self) -> Self {
        if self.effect != EffectId::TransientEvent {
            self.probability = self.probability.min(WITHOUT_SHOWN_GAIN);
        }
        self
    }
}

/// Stated probability of a fault that the signals show by themselves, such as a torque beyond the drive's limit. Chosen
/// by judgement: no frequency was measured; the checks that state it compare two recorded values and weigh no evidence.
const MEASUREMENT_FAULT_PROBABILITY: f64 = 0.99;

/// Puts a note on the measurement before all others; as a finding too, where it is one and no other finding is the same effect.
pub(crate) fn tell_first(diagnosis: &mut Diagnosis, note: HealthNote, is_finding: bool) {
    let is_found = |found: &Finding| found.effect == note.effect && found.action == Action::Measurement;
    let finding = (is_finding && !diagnosis.findings.iter().any(is_found)).then(|| measurement_finding(&note));
    diagnosis.health.insert(0, note);
    if let Some(finding) = finding {
        diagnosis.put_first(finding, Vec::new());
    }
}

/// A fault of the measurement as a finding.
pub(crate) fn measurement_finding(note: &HealthNote) -> Finding {
    unfitted(note.effect, MEASUREMENT_FAULT_PROBABILITY, Action::Measurement, note.clone())
}

/// Something that happened once, in rows that were locked away.
pub(crate) fn unexplained_event(worst: WorstLocked) -> HealthNote {
    let observation = Observation::LockedEvent { when_s: worst.when_s, rms: worst.rms };
    HealthNote { effect: EffectId::TransientEvent, blocking: false, observation }
}

/// What happened once in rows that were locked away, where no row that might name it shows it.
pub(crate) fn unexplained_finding(worst: WorstLocked, traces: &Traces) -> Finding {
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
    Finding {
        equation: "dF = c(time)".to_string(),
        location: Location { regions: vec![region], is_named: true, when_s: vec![worst.when_s] },
        ..unfitted(effect, WITHOUT_RIVAL, effect.action(), unexplained_event(worst))
    }
}

/// A torque that was recorded at another time than the motion.
pub(crate) fn misalignment(late: &TorqueDelay) -> Finding {
    let effect = EffectId::TimeMisalignment;
    let nothing = HealthNote {
        effect,
        blocking: false,
        observation: Observation::RealignedTorque { delay_s: late.delay_s, period_s: 0.0 },
    };
    let unfitted = unfitted(effect, 1.0 / (1.0 + (-late.gain_nats).exp()), effect.action(), nothing);
    Finding {
        equation: "dF = -d dtau/dt".to_string(),
        parameters: vec![Estimate::of("torque_delay", "d", Dimension::Second, late.delay_s, late.deviation_s)],
        evidence: Evidence::Rows {
            held_out_gain_nats: late.gain_nats,
            family_wise: (-late.gain_nats).exp(),
            rivals: 0,
        },
        fitted: Fitted {
            coefficients: vec![late.delay_s],
            deviation: vec![late.deviation_s],
            ..unfitted.fitted.clone()
        },
        score: late.gain_nats,
        margin: late.gain_nats,
        ..unfitted
    }
}

/// A finding without a fitted term.
fn unfitted(effect: EffectId, probability: f64, action: Action, note: HealthNote) -> Finding {
    Finding {
        effect,
        probability,
        alternatives: Vec::new(),
        action,
        equation: String::new(),
        parameters: Vec::new(),
        location: Location::default(),
        evidence: Evidence::Measurement(note.observation),
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
