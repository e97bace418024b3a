//! A diagnosis as JSON, schema `frikan.diagnose/1`.

use crate::commands::measurement::Warning;
use crate::diagnose::sentence::Story;
use crate::diagnose::{BaseKind, Diagnosis, Finding, HealthNote, Plan, Region, Scored, Side};
use crate::physics::EffectId;
use serde_json::{Value, json};

/// Rivals listed with a finding, nearest first.
const STANDINGS: usize = 8;

/// The whole summary.
pub(super) fn summary(
    diagnosis: &Diagnosis,
    story: &Story,
    (warnings, plan): (&[Warning], Option<&Plan>),
    seconds: f64,
    seed: u64,
) -> Value {
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
        "health": health(diagnosis, warnings),
        "findings": diagnosis.findings.iter().zip(&story.findings).map(finding_json).collect::<Vec<_>>(),
        "minor": diagnosis.minor.iter().map(|(effect, share)| json!({ "effect": effect, "share": share })).collect::<Vec<_>>(),
        "doubtful": explaining(&diagnosis.doubtful),
        "negligible": explaining(&diagnosis.negligible),
        "withdrawn": diagnosis.withdrawn,
        "localisation": { "where": excess.iter().map(region_json).collect::<Vec<_>>(), "when_s": excess_when },
        "detection_limits": diagnosis.limits,
        "rivals": diagnosis.rivals.iter().map(rival_json).collect::<Vec<_>>(),
        "base": match diagnosis.base {
            BaseKind::CoulombViscous => "coulomb_viscous",
            BaseKind::Spline => "spline",
            BaseKind::Reference => "reference",
        },
        "given": diagnosis.given,
        "base_parameters": diagnosis.base_parameters,
        "fit": {
            "noise_rmse": diagnosis.noise_rmse,
            "baseline": diagnosis.baseline,
            "improved": diagnosis.improved,
            "held_out": held_out,
            "rollout": diagnosis.rollout,
            "cut_off_Hz": diagnosis.cut_off_hz,
            "n": diagnosis.rows,
        },
        "advice": plan.map(plan_json),
        "seconds": seconds,
        "seed": seed,
    })
}

/// Notes on the measurement; the first ones are those of the checks, which know code and times.
fn health(diagnosis: &Diagnosis, warnings: &[Warning]) -> Vec<Value> {
    let note = |(index, note): (usize, &HealthNote)| {
        let mut json = json!(note);
        json["code"] = warnings.get(index).map_or(note.effect.code(), Warning::code).into();
        json["when_s"] = json!(warnings.get(index).map_or(&[][..], Warning::when_s));
        json
    };
    diagnosis.health.iter().enumerate().map(note).collect()
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

fn finding_json((found, sentence): (&Finding, &String)) -> Value {
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
        "parameters": found.parameters,
        "where": found.location.regions.iter().map(region_json).collect::<Vec<_>>(),
        "when_s": found.location.when_s,
        "evidence": found.evidence,
        "separate_by": found.separate_by.sentence,
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
