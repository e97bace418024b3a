//! Everything that an image says, as JSON.

use frikan_shared::image::{Image, image_crc32};
use serde_json::json;

use super::terms::terms;
use crate::fit::CELLS;

/// `frikan.image/1`.
#[must_use]
pub fn readable(bytes: &[u8], image: &Image<CELLS>) -> String {
    let (model, provenance) = (&image.model, &image.provenance);
    let inputs: Vec<_> = model
        .inputs
        .iter()
        .map(|input| {
            json!({"input": input.quantity.name(), "unit": input.unit.symbol(), "low": input.low, "high": input.high})
        })
        .collect();
    let cells: Vec<[f32; 4]> = model.cells.iter().map(|cell| cell.floats()).collect();
    let body = model.rigid_body;
    let object = json!({
        "schema": "frikan.image/1",
        "joint": provenance.joint.as_str(),
        "trainer_version": provenance.trainer_version.as_str(),
        "recordings_hash": format!("{:016x}", provenance.recordings_hash),
        "seed": provenance.seed,
        "law_error": { "slow": f64::from(provenance.law_error.slow), "sliding": f64::from(provenance.law_error.sliding) },
        "rigid_body_error": provenance.rigid_body_error.factor.map(f64::from),
        "bytes": bytes.len(),
        "crc32": image_crc32(bytes).unwrap_or(0),
        "inputs": inputs,
        "output_unit": model.output_unit.symbol(),
        "output_limit": model.output_limit,
        "rigid_body": {
            "inertia": body.inertia, "gravity_sin": body.gravity_sin, "gravity_cos": body.gravity_cos,
            "offset": body.offset, "given_scale": body.given_scale,
        },
        "law": model.law,
        "effects": model.effects.as_slice(),
        "terms": terms(model),
        "cells": cells,
    });
    format!("{object:#}\n")
}
