//! `--to c`: the exported source, compiled on the host and for the emulated Cortex-M4F, against the runtime.

use std::path::{Path, PathBuf};

use frikan_runtime::evaluate::evaluate;
use frikan_runtime::friction::{FrictionState, Measurement};
use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, IntegerTableInPlace, Units};
use frikan_runtime::shared::expression::{Operation, Program};
use frikan_runtime::shared::model::{Input, Law, MAX_INPUTS};
use frikan_runtime::shared::units::{Quantity, Unit};
use frikan_tests::c::{cortex_m4f_assembly, firmware, floats_through, host_program};
use frikan_tests::cost::UNITS;
use frikan_tests::models::{self, TestModel};
use frikan_tests::vectors::{one_input, space_filling};
use frikan_trainer::compile::integers::steps::{IntegerCall, integer_calls, integer_step};
use frikan_trainer::emulator::{Emulator, Firmware, Mode, Request};
use frikan_trainer::export::source::c::evaluator;
use frikan_trainer::export::source::{integers, python, rust};
use frikan_trainer::fit::model::from_bytes;

const ROWS: usize = 200_000;

/// An expression of two inputs.
fn expression(operations: &[Operation]) -> TestModel {
    let mut model = models::stribeck_expression();
    let load = Input { quantity: Quantity::Load, unit: Unit::NewtonMetre, low: -1.0e9, high: 1.0e9 };
    model.inputs[0].low = -100.0;
    model.inputs[0].high = 1.0e9;
    model.inputs.extend([load]);
    model.output_limit = 1.0e9;
    model.law = Law::Expression(Program { operations: operations.iter().copied().collect() });
    model.validate().unwrap();
    model
}

/// Programs in which every operation occurs.
fn every_operation() -> Vec<(String, TestModel)> {
    use Operation::*;
    let of_one = [
        Scale(-0.3),
        Offset(-1.5),
        PowerOf(0.7),
        PowerOf(-2.0),
        Negate,
        Absolute,
        Square,
        Reciprocal,
        Exp,
        Log,
        Tanh,
        Sin,
        Cos,
        Atan,
        SquareRoot,
        Sign,
    ];
    let of_two = [Add, Subtract, Multiply, Divide, Minimum, Maximum, Power];
    let one = of_one.into_iter().map(|operation| (format!("{operation:?}"), expression(&[Input(0), operation])));
    let two = of_two.into_iter().map(|operation| {
        (format!("{operation:?}"), expression(&[ScaledInput(1, 0.5), Input(0), Constant(-0.25), Add, operation]))
    });
    one.chain(two).collect()
}

/// Every model that has a form in C.
fn exportable() -> Vec<(String, TestModel)> {
    let has_form = |law: &Law| !matches!(law, Law::IntegerTable(_));
    let laws = models::every_law().into_iter().filter(|(_, model)| has_form(&model.law));
    laws.map(|(name, model)| (name.to_owned(), model)).collect()
}

fn rows(model: &TestModel, count: usize) -> Vec<f32> {
    match model.inputs.as_slice() {
        [input] => one_input(count, input.high, 4),
        inputs => {
            let is_network = matches!(model.law, Law::Network(_));
            let ranges: Vec<f32> = inputs.iter().map(|input| 1.5 * input.high).collect();
            let mut values = space_filling(count, if is_network { &ranges } else { &[100.0, 1.0e4] });
            // Any bit pattern in every input.
            let wild = one_input(count, 50.0, 5);
            values[..count].copy_from_slice(&wild);
            values
        }
    }
}

fn expected(model: &TestModel, values: &[f32]) -> Vec<f32> {
    // Velocity, load and temperature, as far as there are so many.
    let step = |row: &[f32]| {
        let [load, temperature] = [1, 2].map(|place| row.get(place).copied().unwrap_or(f32::NAN));
        let measurement = Measurement { velocity: row[0], load, temperature, ..Measurement::MISSING };
        FrictionState::new().step(model, &measurement, 1.0e-3).torque
    };
    values.chunks_exact(model.inputs.len()).map(step).collect()
}

/// Writes `law.c` and `law.h`, and returns the path of the source.
fn write(folder: &Path, model: &TestModel) -> PathBuf {
    let files = evaluator("law", "test", &from_bytes(&models::image(model)).unwrap()).unwrap();
    std::fs::write(folder.join("law.h"), files.header).unwrap();
    let source = folder.join("law.c");
    std::fs::write(&source, files.source).unwrap();
    source
}

/// A call of the exported function on the elements of an array.
fn call(model: &TestModel, array: &str) -> String {
    let arguments: Vec<String> = (0..model.inputs.len()).map(|index| format!("{array}[{index}]")).collect();
    format!("law_friction({})", arguments.join(", "))
}

#[track_caller]
fn assert_same_bits(name: &str, values: &[f32], outputs: &[f32], expected: &[f32]) {
    assert_eq!(outputs.len(), expected.len(), "{name}");
    let inputs = values.len() / expected.len();
    let bits = outputs.iter().zip(expected).map(|(output, expected)| (output.to_bits(), expected.to_bits()));
    for (row, (output, expected)) in bits.enumerate() {
        let row = &values[row * inputs..(row + 1) * inputs];
        assert!(output == expected, "{name} at {row:?}: {output:#010x} instead of {expected:#010x}");
    }
}

#[test]
fn the_host_computes_the_bits_of_the_runtime() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (name, model) in exportable().into_iter().chain(every_operation()) {
        let main = at.join("main.c");
        let text = format!(
            "#include \"law.h\"\n#include <stdio.h>\nint main(void) {{\n    float x[{count}];\n    \
             while (fread(x, sizeof x, 1, stdin) == 1) {{\n        const float y = {};\n        \
             fwrite(&y, sizeof y, 1, stdout);\n    }}\n    return 0;\n}}\n",
            call(&model, "x"),
            count = model.inputs.len()
        );
        std::fs::write(&main, text).unwrap();
        let program = at.join("program");
        host_program(&[write(at, &model), main], &program);
        let values = rows(&model, ROWS);
        assert_same_bits(&name, &values, &floats_through(&program, &values), &expected(&model, &values));
    }
}

#[test]
fn the_cortex_m4f_computes_the_bits_of_the_runtime() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let square_root = ("SquareRoot".to_owned(), expression(&[Operation::Input(0), Operation::SquareRoot]));
    for (name, mut model) in exportable().into_iter().chain([square_root]) {
        if matches!(model.law, Law::Network(_)) && model.inputs.len() > 1 {
            continue;
        }
        model.inputs.truncate(1);
        let drive = at.join("drive.c");
        let text = "#include \"drive.h\"\n#include \"law.h\"\n\
            FrikanStatus drive_start(void) { return FRIKAN_STATUS_ACTIVE; }\n\
            float drive_step(const FrikanSample *sample) { return law_friction(sample->measurement.velocity); }\n";
        std::fs::write(&drive, text).unwrap();
        let elf = at.join("drive.elf");
        firmware(&[write(at, &model), drive], &[], &elf);
        let emulator = Emulator::with_elf(Firmware::find().unwrap().target("cortex-m4f").unwrap(), elf).unwrap();
        let values = rows(&model, ROWS / 10);
        let padded: Vec<f32> = values.iter().flat_map(|value| [*value, 0.0, 0.0, 0.0, 0.0, 0.0]).collect();
        let request = Request {
            image: &[],
            values: &padded,
            inputs: 6,
            outputs: 1,
            mode: Mode::Evaluate,
            floating_point_control: 0,
        };
        let answer = emulator.run(&request).unwrap();
        assert_same_bits(&name, &values, &answer.outputs, &expected(&model, &values));
    }
}

/// No option, and none of the levels of optimisation, makes a product and a sum into one operation.
#[test]
fn nothing_is_contracted_on_a_processor_that_could() {
    let folder = tempfile::tempdir().unwrap();
    let models =
        [models::symmetric_table(), models::uniform(), models::stribeck_expression(), models::every_operation()];
    for model in models {
        let source = write(folder.path(), &model);
        for level in ["-O1", "-O2", "-O3", "-Os"] {
            let assembly = cortex_m4f_assembly(&source, &[level]).unwrap();
            // A `vmla` rounds its product as a `vmul` does, a `vfma` does not.
            assert!(["vmul.f32", "vmla.f32"].iter().any(|multiply| assembly.contains(multiply)), "{level}");
            let contracted = assembly.lines().filter(|line| line.contains("vfm") || line.contains("vfnm"));
            assert_eq!(contracted.collect::<Vec<_>>(), Vec::<&str>::new(), "{level}");
        }
    }
}

/// An exported law does at rest and for what is no number what the drive does.
#[test]
fn rest_and_what_is_not_finite_are_none_of_the_law() {
    let model = expression(&[Operation::Input(0), Operation::Offset(-1.5)]);
    let specials = [0.0, -0.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MIN_POSITIVE];
    let expected = expected(&model, specials.map(|velocity| [velocity, 1.0]).as_flattened());
    assert_eq!(expected, [0.0, 0.0, 0.0, 0.0, 0.0, -1.5]);
    assert_eq!(evaluate(&model, &[0.0; MAX_INPUTS]), -1.5, "the test is idle");
}

/// Processors with half precision compute floats as floats.
#[test]
fn half_precision_is_no_reason_to_refuse() {
    let folder = tempfile::tempdir().unwrap();
    let source = write(folder.path(), &models::symmetric_table());
    let method = folder.path().join("method.c");
    std::fs::write(&method, "#include <float.h>\n#if FLT_EVAL_METHOD != 16\n#error \"not that\"\n#endif\n").unwrap();
    let cortex_m55 = ["-O2", "-mcpu=cortex-m55", "-mfpu=auto"];
    cortex_m4f_assembly(&method, &cortex_m55).unwrap();
    let assembly = cortex_m4f_assembly(&source, &cortex_m55).unwrap();
    assert!(!assembly.contains("vfma.f32") && !assembly.contains("vfms.f32"));
}

/// Options under which the source would compute something else are refused by it.
#[test]
fn options_that_change_the_arithmetic_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let source = write(folder.path(), &models::symmetric_table());
    assert!(cortex_m4f_assembly(&source, &["-O2"]).is_ok());
    for options in [
        &["-ffast-math"][..],
        &["-Ofast"],
        &["-ffinite-math-only"],
        &["-freciprocal-math"],
        &["-funsafe-math-optimizations"],
        &["-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"],
    ] {
        let refusal = cortex_m4f_assembly(&source, options).unwrap_err();
        assert!(refusal.contains("#error"), "{options:?}: {refusal}");
    }
}

/// From counts to counts: every count of the range, odd and sided, finer and coarser than the steps of the table, with limits that bind.
#[test]
fn an_integer_table_computes_the_counts_of_the_integer_compensator() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let main = at.join("main.c");
    let text = "#include \"law.h\"\n#include <stdio.h>\nint main(void) {\n    int32_t x[5], torque = 0;\n    \
        while (fread(x, sizeof x, 1, stdin) == 1) {\n        \
        torque = law_step(x[0] ? 0 : torque, x[4], (uint16_t)x[1], (uint16_t)x[2], (uint16_t)x[3]);\n        \
        fwrite(&torque, sizeof torque, 1, stdout);\n    }\n    return 0;\n}\n";
    std::fs::write(&main, text).unwrap();
    let units =
        [UNITS, Units { velocity: 1.0 / 1_048_576.0, torque: 1.0e-3 * 64.0 }, Units { torque: 1.0e-3, ..UNITS }];
    for (name, mut model) in [("odd", models::integer_table()), ("sided", models::sided_integer_table())] {
        // Ranges that end before the table does, on either side elsewhere.
        model.inputs[0].low = -1.5;
        let image = models::image(&model);
        for units in units {
            let files = integers::evaluator("law", "test", &from_bytes(&image).unwrap().model, units).unwrap();
            std::fs::write(at.join("law.h"), files.header).unwrap();
            std::fs::write(at.join("law.c"), files.source).unwrap();
            let program = at.join("program");
            host_program(&[at.join("law.c"), main.clone()], &program);
            let calls = integer_calls(&model, units, 1 << 18).unwrap();
            let word = |number: i32| f32::from_bits(number.cast_unsigned());
            let words = |call: &IntegerCall| {
                let [gain, torque, slew] = call.limits.map(i32::from);
                [i32::from(call.reset), gain, torque, slew, call.velocity].map(word)
            };
            let values: Vec<f32> = calls.iter().flat_map(words).collect();
            let answers = floats_through(&program, &values).into_iter().map(|torque| torque.to_bits().cast_signed());
            let table = IntegerTableInPlace::new(&image, units).unwrap();
            let mut drive = IntegerCompensator::new(Ok(table), IntegerLimits::OFF);
            let mut moved = 0;
            for (call, answer) in calls.iter().zip(answers) {
                let expected = integer_step(&mut drive, call);
                assert_eq!(answer, expected, "{name} in {units:?}: {call:?}");
                moved += usize::from(expected != 0);
            }
            assert!(moved > calls.len() / 2, "{name} in {units:?}: {moved}");
        }
    }
}

/// The program around a law in Rust: floats in, as many as the model has inputs, and one out.
fn filter_in_rust(model: &TestModel) -> String {
    format!(
        "use std::io::{{Read, Write}};\nfn main() {{\n    let (mut bytes, mut out) = (Vec::new(), Vec::new());\n    \
         std::io::stdin().read_to_end(&mut bytes).unwrap();\n    \
         let values: Vec<f32> = bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();\n    \
         for x in values.chunks_exact({}) {{ out.extend({}.to_le_bytes()); }}\n    \
         std::io::stdout().write_all(&out).unwrap();\n}}\n",
        model.inputs.len(),
        call(model, "x").trim_start_matches("law_")
    )
}

/// The same in Python.
fn filter_in_python(model: &TestModel) -> String {
    let count = model.inputs.len();
    format!(
        "import sys\nfor x in struct.iter_unpack('<{count}f', sys.stdin.buffer.read()):\n    sys.stdout.buffer.write(struct.pack('<f', {}))\n",
        call(model, "x").trim_start_matches("law_")
    )
}

/// A network is integers, and Python has those.
#[test]
fn networks_compute_the_bits_of_the_runtime_in_rust_and_python() {
    let folder = tempfile::tempdir().unwrap();
    let (source, program, script) =
        (folder.path().join("law.rs"), folder.path().join("law"), folder.path().join("law.py"));
    for (name, model) in exportable().into_iter().filter(|(_, model)| matches!(model.law, Law::Network(_))) {
        let image = from_bytes(&models::image(&model)).unwrap();
        let module = rust::module("test", &image).unwrap();
        std::fs::write(&source, format!("{module}\n{}", filter_in_rust(&model))).unwrap();
        let mut rustc = std::process::Command::new("rustc");
        let rustc =
            rustc.args(["--edition", "2024", "-D", "warnings", "-C", "opt-level=1", "-o"]).arg(&program).arg(&source);
        assert!(rustc.status().unwrap().success(), "{name}");
        let values = rows(&model, ROWS);
        assert_same_bits(&name, &values, &floats_through(&program, &values), &expected(&model, &values));

        let module = python::module("test", &image).unwrap();
        let text = format!("#!/usr/bin/env python3\n{module}\n\n{}", filter_in_python(&model));
        std::fs::write(&script, text).unwrap();
        std::fs::set_permissions(&script, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
        let values = rows(&model, ROWS / 50);
        assert_same_bits(&name, &values, &floats_through(&script, &values), &expected(&model, &values));
    }
}

/// What has no form in a language is refused, and says where to turn.
#[test]
fn integer_tables_have_a_form_in_c_alone() {
    let image = from_bytes(&models::image(&models::integer_table())).unwrap();
    for refused in [rust::module("test", &image), python::module("test", &image)] {
        let error = refused.unwrap_err();
        assert_eq!(error.code().id, "FRK-U005");
        assert!(error.to_string().contains("export --to c"), "{error}");
    }
}
