//! The integer compensator on the emulated drives without floating-point unit: the bits of the reference at every count, and what it costs.

use frikan_runtime::integer::Units;
use frikan_tests::cost::{Documented, UNITS, count_integer_steps, run_integer_steps};
use frikan_tests::models::{integer_table, sided_integer_table};
use frikan_trainer::compile::cost::integer_step;
use frikan_trainer::compile::integers::steps::{compare_integer_answers, integer_calls};
use frikan_trainer::emulator::{Emulator, Firmware, Mode, footprint, forbidden_symbols};

/// Counts of 24 bits: they are cut to steps of the table.
const FINE_UNITS: Units = Units { velocity: 1.0 / 1_048_576.0, torque: 4.0e-3 };

/// Most that a drive without floating-point unit may take: bytes of stack at start and in a step, instructions of a step.
const START_STACK_BYTES: u32 = 300;
const STEP_STACK_BYTES: u32 = 64;
const STEP_INSTRUCTIONS: u32 = 150;

fn integer_firmware() -> Firmware {
    Firmware::find().unwrap().with_features("integer")
}

fn every_count_agrees_on(target: &str) {
    let emulator = Emulator::with_binary(&integer_firmware(), target, "emulate-integer-step").unwrap();
    for (name, model) in [("odd", integer_table()), ("sided", sided_integer_table())] {
        for (units, counts) in [(UNITS, 1 << 16), (FINE_UNITS, 1 << 14)] {
            let calls = integer_calls(&model, units, counts).unwrap();
            let answer = run_integer_steps(&emulator, &model, (units, &calls), Mode::Evaluate).unwrap();
            let answers = answer.outputs.iter().map(|output| output.to_bits() as i32);
            let comparison = compare_integer_answers(&model, units, &calls, answers).unwrap();
            assert!(comparison.identical() && comparison.compared > 8192, "{name} on {target}: {comparison:?}");
        }
    }
}

/// `flash_bytes`: most of the drive beside a program that does nothing, and beside its image.
fn small_and_constant_on(target: &str, flash_bytes: u64) {
    let firmware = integer_firmware();
    let emulator = Emulator::with_binary(&firmware, target, "emulate-integer-step").unwrap();
    let [drive, bare] = ["drive-integer", "bare"].map(|binary| firmware.build(emulator.target(), binary).unwrap());
    assert_eq!(forbidden_symbols(&drive).unwrap(), [""; 0]);
    let flash = footprint(&drive).unwrap().beyond(footprint(&bare).unwrap()).flash_bytes;
    for (name, model) in [("odd", integer_table()), ("sided", sided_integer_table())] {
        let answer = count_integer_steps(&emulator, &model).unwrap();
        let (fewest, most) = answer.instruction_range().unwrap();
        let stack = [answer.decode_stack_bytes, answer.evaluate_stack_bytes];
        assert!(fewest == most && most <= STEP_INSTRUCTIONS, "{name} on {target}: {fewest} to {most} instructions");
        // What `fit` and `verify` say.
        assert_eq!(integer_step(target), Some(most), "{name} on {target}");
        assert!(stack[0] <= START_STACK_BYTES && stack[1] <= STEP_STACK_BYTES, "{name}: {stack:?} bytes of stack");
        let documented = Documented::of(target, "integer compensator, its table in flash");
        documented.holds("step, instructions", most.into());
        documented.holds("stack, decode B", stack[0].into());
    }
    assert!(flash <= flash_bytes, "{flash} bytes of flash on {target}");
}

#[test]
fn cortex_m0plus_steps_as_the_reference() {
    every_count_agrees_on("cortex-m0plus");
}

#[test]
fn riscv32imc_steps_as_the_reference() {
    every_count_agrees_on("riscv32imc");
}

#[test]
fn an_integer_step_is_small_and_constant_on_cortex_m0plus() {
    small_and_constant_on("cortex-m0plus", 2_048);
}

#[test]
fn an_integer_step_is_small_and_constant_on_riscv32imc() {
    small_and_constant_on("riscv32imc", 2_464);
}
