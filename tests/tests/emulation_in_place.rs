//! Tables read in place on the emulated targets: the bits of the reference, and what they cost.

use frikan_tests::cost::{Documented, count_steps};
use frikan_tests::models::{TestModel, image, sided_table, symmetric_table};
use frikan_trainer::compile::steps::sequence::sequence;
use frikan_trainer::compile::steps::{ANSWER_WORDS, Answer, CALL_WORDS, Call, compare_answers};
use frikan_trainer::emulator::{Emulator, Firmware, Mode, Request, footprint, forbidden_symbols};

const STEPS: usize = 4_000;

/// Most that a table in place may take on a Cortex-M4F: bytes of flash beside a program that does nothing, of stack at start and in a
/// step, and instructions of a step.
const FLASH_BYTES: u64 = 1_600;
const START_STACK_BYTES: u32 = 160;
const STEP_STACK_BYTES: u32 = 32;
const STEP_INSTRUCTIONS: u32 = 92;

fn tables() -> [(&'static str, TestModel); 2] {
    [("symmetric table", symmetric_table()), ("sided table", sided_table())]
}

fn table_firmware() -> Firmware {
    Firmware::find().unwrap().with_features("table")
}

fn tables_agree_on(target: &str) {
    let emulator = Emulator::with_binary(&table_firmware(), target, "emulate-step").unwrap();
    for (name, model) in tables() {
        let calls = sequence(&model, STEPS);
        let request = Request {
            image: &image(&model),
            values: &calls.iter().flat_map(Call::words).collect::<Vec<f32>>(),
            inputs: CALL_WORDS,
            outputs: ANSWER_WORDS,
            mode: Mode::Evaluate,
            floating_point_control: 0,
        };
        let answer = emulator.run(&request).unwrap();
        let (answers, _) = answer.outputs.as_chunks::<ANSWER_WORDS>();
        let comparison = compare_answers(&model, &calls, answers.iter().copied().map(Answer::from_words));
        assert!(comparison.identical(), "{name} on {target}: {comparison:?}");
        assert_eq!(comparison.compared, calls.len() as u64);
    }
}

#[test]
fn a_table_in_place_agrees_with_floating_point_unit_and_without() {
    for target in ["cortex-m4f", "cortex-m0plus", "riscv32imc"] {
        tables_agree_on(target);
    }
}

#[test]
fn a_table_in_place_is_small_and_constant() {
    let firmware = table_firmware();
    let target = firmware.target("cortex-m4f").unwrap();
    let [drive, bare] = ["drive", "bare"].map(|binary| firmware.build(&target, binary).unwrap());
    assert_eq!(forbidden_symbols(&drive).unwrap(), [""; 0]);
    let flash = footprint(&drive).unwrap().beyond(footprint(&bare).unwrap()).flash_bytes;
    assert!(flash <= FLASH_BYTES, "{flash} bytes of flash");
    let documented = Documented::of("Features on cortex-m4f", "table");
    documented.holds("flash B", flash);
    let emulator = Emulator::with_binary(&firmware, "cortex-m4f", "emulate-step").unwrap();
    for (name, model) in tables() {
        let answer = count_steps(&emulator, &model).unwrap();
        let (fewest, most) = answer.instruction_range().unwrap();
        assert!(fewest == most && most <= STEP_INSTRUCTIONS, "{name}: {fewest} to {most} instructions");
        let stack = [answer.decode_stack_bytes, answer.evaluate_stack_bytes];
        assert!(stack[0] <= START_STACK_BYTES && stack[1] <= STEP_STACK_BYTES, "{name}: {stack:?} bytes of stack");
        documented.holds("step, instructions", most.into());
        documented.holds("stack, start B", stack[0].into());
    }
}
