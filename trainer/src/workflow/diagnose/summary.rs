//! A diagnosis as JSON, schema `frikan.diagnose/1`.

use super::sealed::to_json;
use crate::diagnose::advice::Plan;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::answer::region::{Region, Side};
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::checks::note::{HealthNote, Observation};
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::search::scored::Scored;
use crate::physics::EffectId;
use crate::physics::units::Units;
use crate::report::tell::Story;
use crate::report::tell::evidence::{evidence, parameters, separate_by};
use crate::report::tell::measurement::observation;
use serde_json::{Value, json};

/// Rivals listed with a finding, nearest first.
const STANDINGS: usize = 8;

/// A diagnosis and how it is told.
pub(super) struct Summarised<'a> {
    pub diagnosis: &'a Diagnosis,
    pub story: &'a Story,
    pub plan: Option<&'a Plan>,
    pub sealed: Option<&'a SealedScore>,
    pub units: Units,
}

/// The whole summary.
pub(super) fn summary(told: &Summarised, seconds: f64, seed: u64) -> Value {
    let Summarised { diagnosis, story, plan, sealed, units } = *told;
    let held_out = diagnosis.proof.as_ref().map(|proof| {
        json!({
            "baseline_rmse": proof.baseline_rmse,
            "improved_rmse": proof.improved_rmse,
            "ratio": proof.improved_rmse / proof.baseline_rmse.max(f64::MIN_POSITIVE),
            "ci95": proof.ratio_ci95,
            "gain_nats": proof.gain_nats,
            "n": proof.rows,
        })
    });
    let (excess, excess_when) = diagnosis.traces.excess();
    json!({
        "schema": "frikan.diagnose/1",
        "verdict": diagnosis.verdict,
        "headline": story.headline,
        "health": diagnosis.health.iter().map(|note| health_json(note, units)).collect::<Vec<_>>(),
        "findings": (0..diagnosis.findings.len()).map(|index| finding_json(told, index)).collect::<Vec<_>>(),
        "minor": diagnosis.discarded.minor.iter().map(|(effect, share)| json!({ "effect": effect, "share": share })).collect::<Vec<_>>(),
        "doubtful": explaining(&diagnosis.discarded.doubtful),
        "negligible": explaining(&diagnosis.discarded.negligible),
        "withdrawn": diagnosis.discarded.withdrawn,
        "undetermined": diagnosis.discarded.undetermined,
        "localisation": { "where": excess.iter().map(region_json).collect::<Vec<_>>(), "when_s": excess_when },
        "detection_limits": diagnosis.limits,
        "sets": diagnosis.sets,
        "rest": 1.0 - diagnosis.sets.iter().map(|set| set.probability).sum::<f64>(),
        "rivals": diagnosis.rivals.iter().map(rival_json).collect::<Vec<_>>(),
        "base": match diagnosis.base {
            BaseKind::CoulombViscous => "coulomb_viscous",
            BaseKind::Spline => "spline",
            BaseKind::Reference => "reference",
        },
        "given": diagnosis.given,
        "base_parameters": parameters(&diagnosis.base_parameters, units),
        "fit": {
            "noise_rmse": diagnosis.noise_rmse,
            "baseline": diagnosis.baseline,
            "improved": diagnosis.improved,
            "held_out": held_out,
            "rollout": diagnosis.rollout,
            "cut_off_Hz": diagnosis.cut_off_hz,
            "n": diagnosis.rows,
        },
        "sealed": sealed.map(to_json),
        "advice": plan.map(plan_json),
        "seconds": seconds,
        "seed": seed,
    })
}

fn plan_json(plan: &Plan) -> Value {
    json!({
        "pairs": plan.pairs,
        "left_open": plan.left_open,
        "excitation": plan.words,
        "duration_s": plan.duration_s(),
        "rest_before_s": plan.rest_before_s,
        "expected_margin_nats": plan.expected_nats,
        "present_margin_nats": plan.present_nats,
    })
}

fn health_json(note: &HealthNote, units: Units) -> Value {
    let (code, when_s) = match &note.observation {
        Observation::Recording(found) => (found.note.fault.code().id, found.note.when_s.clone()),
        Observation::LockedEvent { when_s, .. } => (note.effect.code(), vec![*when_s]),
        _ => (note.effect.code(), Vec::new()),
    };
    let sentence = observation(&note.observation, units);
    json!({ "code": code, "effect": note.effect, "blocking": note.blocking, "sentence": sentence, "when_s": when_s })
}

fn finding_json(told: &Summarised, index: usize) -> Value {
    let Summarised { plan, units, .. } = *told;
    let (found, sentence) = (&told.diagnosis.findings[index], &told.story.findings[index]);
    json!({
        "effect": found.effect,
        "probability": found.probability,
        "alternatives": found.alternatives.iter()
            .map(|(effect, probability)| json!({"effect": effect, "probability": probability}))
            .collect::<Vec<_>>(),
        "channels": found.channels.iter().map(|channel| channel.name()).collect::<Vec<_>>(),
        "nearest": found.nearest.map(|(effect, share)| json!({"effect": effect, "share": share})),
        "action": found.action,
        "equation": found.equation,
        "parameters": parameters(&found.parameters, units),
        "where": found.location.regions.iter().map(region_json).collect::<Vec<_>>(),
        "when_s": found.location.when_s,
        "evidence": evidence(found, units),
        "separate_by": separate_by(found, plan),
        "sentence": sentence,
        "score_nats": found.score,
        "margin_nats": found.margin,
        "standings": found.standings.iter().take(STANDINGS)
            .map(|(effect, nats)| json!({"effect": effect, "distance_nats": nats}))
            .collect::<Vec<_>>(),
        "locked_gain_nats": found.locked_gain_nats,
    })
}

/// `and` stands only where two channels together are sharper than one.
fn region_json(region: &Region) -> Value {
    let side_json = |side: &Side| json!({ "channel": side.channel, "from": side.from, "to": side.to });
    let mut json = side_json(&region.side);
    json["share_of_excess"] = region.share_of_excess.into();
    json["share_of_samples"] = region.share_of_samples.into();
    if let Some(and) = &region.and {
        json["and"] = side_json(and);
    }
    json
}

fn rival_json(rival: &Scored) -> Value {
    json!({ "name": rival.label.to_string(), "score_nats": rival.score, "family_wise_p": rival.family_wise })
}

/// Effects with the root mean square of what each explains.
fn explaining(effects: &[(EffectId, f64)]) -> Vec<Value> {
    effects.iter().map(|(effect, rms)| json!({ "effect": effect, "torque_rms": rms })).collect()
}
