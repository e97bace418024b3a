//! The compensator's step on every emulated target against the trainer's reference, for every effect alone and for models full of them.

use frikan_tests::exhaustive;
use frikan_tests::models::{image, with_every_effect};
use frikan_trainer::compile::steps::sequence::sequence;
use frikan_trainer::compile::steps::{ANSWER_WORDS, Answer, CALL_WORDS, Call, compare_answers};
use frikan_trainer::emulator::{Emulator, Firmware, Mode, Request};

/// Steps of a comparison, and with `FRIKAN_EXHAUSTIVE=1`.
const STEPS: usize = 4_000;
const MANY_STEPS: usize = 1_000_000;

/// Steps of one emulation, which starts anew: a target without floating-point unit takes a minute for them.
const STEPS_A_RUN: usize = 100_000;

fn every_effect_agrees_on(target: &str) {
    let emulator = Emulator::with_binary(&Firmware::find().unwrap(), target, "emulate-step").unwrap();
    for (name, model) in with_every_effect() {
        let steps = if exhaustive() { MANY_STEPS } else { STEPS };
        for calls in sequence(&model, steps).chunks(STEPS_A_RUN) {
            let values: Vec<f32> = calls.iter().flat_map(Call::words).collect();
            let request = Request {
                image: &image(&model),
                values: &values,
                inputs: CALL_WORDS,
                outputs: ANSWER_WORDS,
                mode: Mode::Evaluate,
                floating_point_control: 0,
            };
            let answer = emulator.run(&request).unwrap();
            let (answers, _) = answer.outputs.as_chunks::<ANSWER_WORDS>();
            let comparison = compare_answers(&model, calls, answers.iter().copied().map(Answer::from_words));
            assert!(comparison.identical(), "{name} on {target}: {comparison:?}");
            assert_eq!(comparison.compared, calls.len() as u64);
        }
    }
}

#[test]
fn every_effect_agrees_on_cortex_m4f() {
    every_effect_agrees_on("cortex-m4f");
}

#[test]
fn every_effect_agrees_on_cortex_m7() {
    every_effect_agrees_on("cortex-m7");
}

#[test]
fn every_effect_agrees_on_cortex_m33() {
    every_effect_agrees_on("cortex-m33");
}

#[test]
fn every_effect_agrees_on_cortex_m0plus() {
    every_effect_agrees_on("cortex-m0plus");
}

#[test]
fn every_effect_agrees_on_riscv32imac() {
    every_effect_agrees_on("riscv32imac");
}

#[test]
fn every_effect_agrees_on_riscv32imc() {
    every_effect_agrees_on("riscv32imc");
}
