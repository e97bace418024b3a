//! The result of a fit as JSON, schema `frikan.fit/1`.

use frikan_shared::image::image_crc32;
use serde_json::{Value, json};

use super::integers;
use super::simulated::SimulatedMotions;
use crate::fit::Outcome;
use crate::fit::outcome::{Score, Soundness, SplitScore, Trace};
use crate::workflow::recordings::Warning;

/// The object that `--json` writes.
pub(super) fn summary(
    outcome: &Outcome,
    motions: Option<&SimulatedMotions>,
    warnings: &[Warning],
    seconds: f64,
) -> Value {
    let inputs: Vec<&str> = outcome.inputs.iter().map(|input| input.name.as_str()).collect();
    let tests: Vec<Value> = outcome.tests.iter().map(recording).collect();
    let train: Vec<Value> = outcome.train.iter().map(recording).collect();
    json!({
        "schema": "frikan.fit/1",
        "joint": outcome.joint,
        "unit": outcome.unit,
        "inputs": inputs,
        "ranges": outcome.inputs.iter().map(|i| json!({"input": i.name, "unit": i.unit, "low": i.low, "high": i.high})).collect::<Vec<_>>(),
        "filter": outcome.filter,
        "representation": outcome.representation.name(),
        "choice": outcome.choice,
        "integers": outcome.integers.as_ref().map(|integers| integers::to_json(integers, outcome)),
        "held_out": outcome.held_out,
        "expression": outcome.law.expression,
        "latex": outcome.law.latex,
        "expression_nodes": outcome.law.nodes,
        "parameters": outcome.parameters,
        "remarks": outcome.remarks,
        "warnings": warnings.iter().map(Warning::to_json).collect::<Vec<_>>(),
        "sound": match &outcome.sound {
            Soundness::Sound => json!(true),
            Soundness::NotIdentifiable(why) | Soundness::NotConverged(why) | Soundness::NotPhysical(why) => json!({"why": why}),
        },
        "relevance": outcome.relevance.iter().map(|row| json!({
            "input": row.input, "correlation": row.correlation, "explained_variance": row.explained,
            "added_variance": row.added, "picked": row.picked,
        })).collect::<Vec<_>>(),
        "network": {
            "architecture": outcome.network.architecture,
            "edges_trained": outcome.network.before.edges.iter().filter(|edge| edge.active).count(),
            "edges_kept": outcome.network.after.edges.iter().filter(|edge| edge.active).count(),
            "nodes_trained": outcome.network.before.nodes.iter().filter(|node| node.active).count(),
            "nodes_kept": outcome.network.after.nodes.iter().filter(|node| node.active).count(),
            "rmse": outcome.network.rmse,
        },
        "candidates": outcome.candidates.iter().map(|candidate| json!({
            "form": candidate.form.name(), "violation": candidate.violation,
            "representation": candidate.representation.name(), "description": candidate.description,
            "held_out_rmse": candidate.held_out_rmse, "bytes": candidate.bytes, "instructions": candidate.instructions,
            "within_budget": candidate.within_budget, "chosen": candidate.chosen,
        })).collect::<Vec<_>>(),
        "classical": outcome.classical.iter().map(|law| json!({
            "name": law.name, "rmse": law.rmse, "bic": law.bic, "parameters": law.parameters,
        })).collect::<Vec<_>>(),
        "front": outcome.law.front.iter().map(|law| json!({
            "expression": law.expression, "nodes": law.nodes, "rmse": law.rmse, "held_out_rmse": law.held_out_rmse,
        })).collect::<Vec<_>>(),
        "gain": {"recommended": outcome.gain(), "uncertain_share": outcome.uncertain_share()},
        "curve": {"over": "velocity", "points": outcome.law_curve},
        "band": {"level": 0.95, "over": "velocity", "points": outcome.band},
        "train": with_split(score(outcome.train_score), &outcome.train_split),
        "train_recordings": train,
        "test": tests,
        "image": {"bytes": outcome.image.len(), "crc32": image_crc32(&outcome.image).unwrap_or(0)},
        "rollout": motions.map(SimulatedMotions::to_json),
        "seconds": seconds,
        "seed": outcome.seed,
    })
}

pub(in crate::workflow) fn score(score: Score) -> Value {
    json!({"n": score.n, "r2": score.r2, "rmse": score.rmse, "relative_error": score.relative_error})
}

/// Adds the scores of rows in motion and of rows at rest.
pub(in crate::workflow) fn with_split(mut value: Value, split: &SplitScore) -> Value {
    let moving = split.moving;
    value["moving"] = json!({"n": moving.n, "r2": moving.r2, "rmse": moving.rmse});
    value["rest"] = json!({"n": split.rest.n, "inside_breakaway": split.rest.inside_breakaway});
    value
}

fn recording(trace: &Trace) -> Value {
    let mut value = with_split(score(trace.score), &trace.split);
    value["recording"] = json!(trace.label);
    value["at_100_hz"] = score(trace.filtered_score);
    value
}
