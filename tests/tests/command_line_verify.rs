//! `trainer verify` on the command line: what it proves and how it says so.

use frikan_tests::command::run;
use frikan_tests::models::{image, with_effects};
use frikan_trainer::compile::steps::LEAST_STEPS;
use serde_json::Value;

#[test]
fn what_is_verified_is_the_step_with_its_effects() {
    let folder = tempfile::tempdir().unwrap();
    let effects: Vec<_> = frikan_tests::models::every_effect().into_iter().map(|(_, effect)| effect).skip(5).collect();
    std::fs::write(folder.path().join("m.frk"), image(&with_effects(&effects[..8]))).unwrap();
    let verified = run(folder.path(), &["verify", "m.frk", "--json"]);
    let json: Value = serde_json::from_str(&verified.output).unwrap();
    assert_eq!(verified.status, 0, "{json}");
    assert_eq!((&json["steps"], &json["compared"]), (&json["steps_equal"], &json["equal"]));
    assert!(json["steps"].as_u64() >= Some(LEAST_STEPS as u64), "{json}");
    assert_eq!(json["law"]["compared"], json["law"]["equal"]);
    let text = run(folder.path(), &["verify", "m.frk"]).output;
    assert!(text.contains("100000 of 100000 steps equal on host: law, effects, memory and limits"), "{text}");
}

#[test]
fn fewer_steps_than_a_proof_takes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.frk"), image(&with_effects(&[]))).unwrap();
    assert_eq!(run(folder.path(), &["verify", "m.frk", "--steps", "99999"]).status, 2);
}
