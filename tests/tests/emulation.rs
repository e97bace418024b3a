//! The bits of every emulated target against those of the host, for every kind of model.

use frikan_runtime::evaluate::evaluate;
use frikan_runtime::integer_table::evaluate_integer;
use frikan_runtime::shared::integer_table::REACH_BITS;
use frikan_runtime::shared::model::Law;
use frikan_tests::exhaustive;
use frikan_tests::models::{self, TestModel};
use frikan_tests::vectors::{counts, one_input, space_filling};
use frikan_trainer::emulator::{Emulator, Firmware, Mode, Request};

/// Inputs of the comparison of a one-input table, in floating point and in integers; of every model with `FRIKAN_EXHAUSTIVE=1`.
const TABLE_ROWS: usize = 1_000_000;

/// Rows of every other comparison.
const ROWS: usize = 100_000;

/// Compares `rows` rows; panics with the first difference.
fn compare(emulator: &Emulator, name: &str, model: &TestModel, rows: usize, floating_point_control: u32) {
    let inputs = model.inputs.len();
    let values = if inputs == 1 {
        one_input(rows, model.inputs[0].high, 1)
    } else {
        space_filling(rows, &model.inputs.iter().map(|input| input.high).collect::<Vec<_>>())
    };
    let image = models::image(model);
    let request =
        Request { image: &image, values: &values, inputs, outputs: 1, mode: Mode::Evaluate, floating_point_control };
    let answer = emulator.run(&request).unwrap();
    assert_eq!(answer.outputs.len(), rows);
    for (index, (row, output)) in values.chunks_exact(inputs).zip(&answer.outputs).enumerate() {
        let mut padded = [0.0; 4];
        padded[..inputs].copy_from_slice(row);
        let expected = evaluate(model, &padded);
        assert!(
            expected.to_bits() == output.to_bits(),
            "{name} on {}, row {index} {row:?}: {output:e} instead of {expected:e}",
            emulator.target().name
        );
    }
}

fn every_law_agrees_on(target: &str) {
    let emulator = Emulator::new(target).unwrap();
    for (name, model) in models::every_law() {
        let rows = if exhaustive() || name == "symmetric table" { TABLE_ROWS } else { ROWS };
        compare(&emulator, name, &model, rows, 0);
    }
}

/// The integer table as a drive without floating-point unit calls it: counts in, counts out.
fn integer_table_agrees_on(target: &str) {
    let emulator = Emulator::with_binary(&Firmware::find().unwrap(), target, "emulate-integer").unwrap();
    let model = models::integer_table();
    let Law::IntegerTable(table) = &model.law else { unreachable!() };
    let steps = counts(TABLE_ROWS, 1 << REACH_BITS, 3);
    let values: Vec<f32> = steps.iter().map(|count| f32::from_bits(*count as u32)).collect();
    let image = models::image(&model);
    let request = Request {
        image: &image,
        values: &values,
        inputs: 1,
        outputs: 1,
        mode: Mode::Evaluate,
        floating_point_control: 0,
    };
    let answer = emulator.run(&request).unwrap();
    for (count, output) in steps.iter().zip(&answer.outputs) {
        let expected = evaluate_integer(table, &model.cells, *count);
        assert_eq!(output.to_bits() as i32, expected, "integer table on {target} at {count}");
    }
}

#[test]
fn cortex_m4f_computes_the_bits_of_the_host() {
    every_law_agrees_on("cortex-m4f");
}

#[test]
fn cortex_m7_computes_the_bits_of_the_host() {
    every_law_agrees_on("cortex-m7");
}

#[test]
fn cortex_m33_computes_the_bits_of_the_host() {
    every_law_agrees_on("cortex-m33");
}

#[test]
fn cortex_m0plus_computes_the_bits_of_the_host() {
    every_law_agrees_on("cortex-m0plus");
    integer_table_agrees_on("cortex-m0plus");
}

#[test]
fn riscv32imac_computes_the_bits_of_the_host() {
    every_law_agrees_on("riscv32imac");
    integer_table_agrees_on("riscv32imac");
}

#[test]
fn riscv32imc_computes_the_bits_of_the_host() {
    every_law_agrees_on("riscv32imc");
    integer_table_agrees_on("riscv32imc");
}

/// Some drive firmware flushes subnormals to zero or asks for the default NaN; a table must not notice.
#[test]
fn flush_to_zero_and_default_nan_do_not_change_tables() {
    let emulator = Emulator::new("cortex-m4f").unwrap();
    for control in [1 << 24, 1 << 25, 3 << 24] {
        compare(&emulator, "symmetric table", &models::symmetric_table(), ROWS, control);
        compare(&emulator, "sided table", &models::sided_table(), ROWS, control);
        compare(&emulator, "uniform table", &models::uniform(), ROWS, control);
        compare(&emulator, "network [1,5,1]", &models::network_1_5_1(), ROWS, control);
    }
}

/// What a damaged image does to a drive: it is refused, and nothing is evaluated.
#[test]
fn a_damaged_image_is_refused_on_the_target() {
    let emulator = Emulator::new("cortex-m4f").unwrap();
    let sound = models::image(&models::symmetric_table());
    let run = |image: &[u8]| {
        let request =
            Request { image, values: &[0.1], inputs: 1, outputs: 1, mode: Mode::Evaluate, floating_point_control: 0 };
        emulator.run(&request)
    };
    run(&sound).unwrap();
    for byte in (0..sound.len()).step_by(7) {
        let mut damaged = sound.clone();
        damaged[byte] ^= 0x10;
        let error = run(&damaged).unwrap_err();
        assert_eq!(error.code().id, "FRK-I008", "byte {byte}: {error}");
        assert!(error.to_string().contains("refuses the image"), "byte {byte}: {error}");
    }
    run(&sound[..sound.len() - 1]).unwrap_err();
}

#[test]
fn an_unknown_target_is_told_with_the_known_ones() {
    let error = Emulator::new("cortex-m85").unwrap_err();
    assert_eq!(error.code().id, "FRK-U004");
    assert!(error.to_string().contains("cortex-m4f"), "{error}");
}
