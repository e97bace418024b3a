//! `trainer show`: nothing that an image holds and nothing that a term remembers is left out, and how sure its constants are.

use frikan_runtime::friction::{FrictionState, Measurement};
use frikan_shared::effect::Effect;
use frikan_tests::command::run;
use frikan_tests::models::{TestModel, image, with_every_effect};
use serde_json::Value;

/// Every number of an effect, those of a table aside.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(number) => number.as_f64().into_iter().collect(),
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        Value::Object(keys) => keys.iter().filter(|(key, _)| *key != "table").flat_map(|(_, v)| numbers(v)).collect(),
        _ => Vec::new(),
    }
}

/// How many numbers of its memory the only effect of a model has written after some motion.
fn remembered(model: &TestModel) -> usize {
    let mut state = FrictionState::new();
    let mut written = [false; 4];
    for step in 0..400u16 {
        let angle = 0.07 * f32::from(step);
        let velocity = if step % 50 < 10 { 0.0 } else { angle.sin() };
        let measurement =
            Measurement { velocity, position: 0.1 * angle.cos(), load: 1.0, temperature: 30.0, ..Measurement::ZERO };
        let _ = state.step(model, &measurement, 1.0e-3);
        // The memory is the drive's own affair, which only its debugging text shows.
        let text = format!("{state:?}");
        let first = text.split_once("[[").unwrap().1.split_once(']').unwrap().0;
        for (written, number) in written.iter_mut().zip(first.split(", ")) {
            *written |= number.parse::<f32>().unwrap() != 0.0;
        }
    }
    written.into_iter().filter(|written| *written).count()
}

#[test]
fn every_parameter_and_every_state_of_every_effect_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (name, model) in with_every_effect() {
        std::fs::write(at.join("m.frk"), image(&model)).unwrap();
        let (text, json) = (run(at, &["show", "m.frk"]), run(at, &["show", "m.frk", "--json", "-"]));
        assert_eq!((text.status, json.status), (0, 0), "{name}: {}", json.messages);
        let json: Value = serde_json::from_str(&json.output).unwrap();
        let (effects, terms) = (json["effects"].as_array().unwrap(), json["terms"].as_array().unwrap());
        assert_eq!(terms.len(), model.effects.len(), "{name}");
        for ((effect, term), of_image) in effects.iter().zip(terms).zip(&model.effects) {
            let shown: Vec<f64> = term["parameters"].as_array().unwrap().iter().flat_map(numbers).collect();
            let is_smoothing = |value: f64| value == f64::from(0.02f32);
            // A smoothed sign that a term does not use is not shown.
            let missing = numbers(effect).into_iter().find(|value| !shown.contains(value) && !is_smoothing(*value));
            assert_eq!(missing, None, "{name}: {term}");
            let units = term["parameters"].as_array().unwrap().iter().chain(term["state"].as_array().unwrap());
            assert!(units.into_iter().all(|part| part["unit"].as_str().is_some_and(|unit| !unit.is_empty())), "{term}");
            let lines =
                format!("effect      {}: {}", term["effect"].as_str().unwrap(), term["equation"].as_str().unwrap());
            assert!(text.output.contains(&lines), "{name}: {}", text.output);
            assert_eq!(matches!(of_image, Effect::PositionTable { .. }), effect.to_string().contains("table"));
        }
        if let [term] = &terms[..] {
            assert_eq!(term["state"].as_array().unwrap().len(), remembered(&model), "{name}: {term}");
        }
        let states: usize = terms.iter().map(|term| term["state"].as_array().unwrap().len()).sum();
        assert_eq!(text.output.matches("remembers the ").count(), states, "{}", text.output);
    }
}

/// The golden image of `fixtures/elbow.toml`: inertia 0.5 kg m^2, gravity 6 N m sin q, no offset.
#[test]
fn a_fitted_rigid_body_is_within_its_errors_and_says_what_makes_up_for_what() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/elbow.frk");
    let (_, image) = frikan_trainer::fit::model::load(path.as_ref()).unwrap();
    let (body, error) = (image.model.rigid_body, image.provenance.rigid_body_error);
    let constants = [body.inertia, body.gravity_sin, body.gravity_cos, body.offset].map(f64::from);
    let covariance =
        |i: usize, j: usize| (0..5).map(|k| f64::from(error.row(k)[i]) * f64::from(error.row(k)[j])).sum::<f64>();
    for (place, (constant, truth)) in constants.into_iter().zip([0.5, 6.0, 0.0, 0.0]).enumerate() {
        let error = covariance(place, place).sqrt();
        assert!(error > 0.0 && (constant - truth).abs() < 2.0 * error, "{place}: {constant} +- {error}");
    }
    assert!(covariance(2, 3) < -0.98 * (covariance(2, 2) * covariance(3, 3)).sqrt());
    let shown = run(env!("CARGO_MANIFEST_DIR").as_ref(), &["show", path]).output;
    assert!(shown.lines().any(|line| line.contains("gravity, cosine 0.115643 +- 0.128335")), "{shown}");
}
