//! The result of an arm as JSON, schema `frikan.arm/1`.

use serde_json::{Value, json};

use super::fitted::{FittedArm, beyond_trained, joint_doubt};
use crate::arm::fit::{BaseEstimate, JointOutcome};
use crate::fit::outcome::{Outcome, Score, SplitScore, Trace};
use crate::workflow::fit::json::{score, with_split};
use crate::workflow::recordings::Warning;

/// The object that is written to `arm.json`.
pub(super) fn summary(arm: &FittedArm, images: &[Option<String>]) -> Value {
    let joints = arm.outcome.joints.iter().zip(images).map(|(one, image)| joint(one, image.as_deref()));
    json!({
        "schema": "frikan.arm/1",
        "joints": joints.collect::<Vec<_>>(),
        "base_parameters": arm.outcome.parameters.iter().map(parameter).collect::<Vec<_>>(),
        "filter": arm.outcome.filter,
        "warnings": arm.warnings.iter().map(Warning::to_json).collect::<Vec<_>>(),
        "seconds": arm.seconds,
        "seed": arm.seed,
    })
}

fn joint(joint: &JointOutcome, image: Option<&str>) -> Value {
    let law = joint.law.as_deref().ok();
    let of = |value: &dyn Fn(&Outcome) -> Value| law.map_or(Value::Null, value);
    json!({
        "name": joint.name,
        "image": image,
        "inputs": of(&|law| law.inputs.iter().map(|input| input.name.as_str()).collect()),
        "law": of(&|law| json!(law.law.expression)),
        "parameters": of(&|law| json!(law.parameters)),
        "unit": of(&|law| json!(law.unit)),
        "sound": joint_doubt(joint).map_or(json!(true), |why| json!({"code": why.code().id, "why": why.message()})),
        "load_friction": joint.load_friction.map(|load| json!({"value": load.value, "ci95": load.ci95})),
        "torque_constant": joint.torque_constant.map(|constant| json!({"value": constant.value, "ci95": constant.ci95, "unit": "N m/A"})),
        "train": of(&|law| scores(law.train_score, &law.train_split)),
        "test": of(&|law| law.tests.iter().map(|trace| test(law, trace)).collect()),
    })
}

fn test(law: &Outcome, trace: &Trace) -> Value {
    let mut value = scores(trace.score, &trace.split);
    value["recording"] = json!(trace.label);
    value["beyond_trained_velocity"] = json!(beyond_trained(law, trace));
    value
}

fn scores(of_all: Score, split: &SplitScore) -> Value {
    let mut value = with_split(score(of_all), split);
    value["moving"] = score(split.moving);
    value["moving_relative_error"] = json!(split.moving.relative_error);
    value
}

fn parameter(parameter: &BaseEstimate) -> Value {
    let BaseEstimate { expression, unit, estimate } = parameter;
    json!({
        "expression": expression,
        "value": estimate.value,
        "ci95": estimate.ci95,
        "unit": unit,
        "determined": estimate.ci95.is_some(),
        "standard_error": estimate.standard_error,
    })
}
