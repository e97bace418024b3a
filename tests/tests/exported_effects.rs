//! `--to c`, `--to rust` and `--to python` of images with correction terms: the exported step, run over a sequence, against the runtime.

use std::path::Path;
use std::process::Command;

use frikan_runtime::compensator::{Decoded, FrictionModel};
use frikan_runtime::friction::Measurement;
use frikan_runtime::usable::above_0_to;
use frikan_shared::model::MAX_INPUTS;
use frikan_tests::c::{floats_through, host_program};
use frikan_tests::models::{TestModel, by_velocity, image, with_every_effect};
use frikan_tests::vectors::space_filling;
use frikan_trainer::export::source::{c, python, rust};
use frikan_trainer::fit::model::from_bytes;

/// Numbers of a row: sample period, velocity, position, load, temperature.
const ROW: usize = 1 + MAX_INPUTS;

/// Samples of motion: strokes, dwells, a crawl, positions and velocities beyond the trained ranges, and now and then a channel or a period
/// that is none.
fn samples(count: usize) -> Vec<[f32; ROW]> {
    let noise = space_filling(count, &[1.0, 1.0, 1.0]);
    let mut position = 0.0f32;
    let row = |(index, noise): (usize, &[f32])| {
        let time = index as f32 * 1.0e-3;
        let stroke = (9.0 * time).sin() + 0.4 * (23.0 * time).sin();
        let velocity = match index / 700 % 5 {
            1 => 0.0,
            2 => 5.0e-4 * stroke,
            3 => 6.0 * stroke,
            _ => 0.5 * stroke,
        };
        position += velocity * 1.0e-3;
        let dt = 1.0e-3 * (1.0 + 0.2 * noise[0]);
        let mut row = [dt, velocity, position, 30.0 * noise[1] * stroke, 20.0 + 60.0 * noise[2]];
        if index % 97 == 96 {
            let values = [f32::NAN, f32::INFINITY, -1.0, -0.0, f32::NEG_INFINITY, f32::MIN_POSITIVE, 0.0, 1.5];
            row[index / 97 % ROW] = values[index / 97 % values.len()];
        }
        row
    };
    noise.chunks_exact(3).enumerate().map(row).collect()
}

/// Torque and position of each sample by the runtime.
fn expected(model: &TestModel, samples: &[[f32; ROW]]) -> Vec<[f32; 2]> {
    let mut state = Decoded::new(model.clone()).unwrap();
    let mut step = |[dt, velocity, position, load, temperature]: &[f32; ROW]| {
        let [velocity, position, load, temperature] = [*velocity, *position, *load, *temperature];
        let measurement = Measurement { velocity, position, load, temperature, ..Measurement::MISSING };
        let friction = state.friction(&measurement, *dt, above_0_to(1.0, *dt), f32::MAX);
        // What is not usable means nothing.
        if friction.usable.is_usable() { [friction.torque, friction.position] } else { [0.0; 2] }
    };
    samples.iter().map(&mut step).collect()
}

/// The numbers of a row that the model reads, as arguments; `x` is the row.
fn arguments(model: &TestModel) -> String {
    (0..=model.inputs.len()).map(|place| format!("x[{place}]")).collect::<Vec<_>>().join(", ")
}

#[track_caller]
fn assert_same_bits(name: &str, model: &TestModel, program: &Path) {
    let samples = samples(20_000);
    let outputs = floats_through(program, samples.as_flattened());
    let expected = expected(model, &samples);
    assert_eq!(outputs.len(), 2 * expected.len(), "{name}");
    for (row, (got, expected)) in outputs.as_chunks::<2>().0.iter().zip(&expected).enumerate() {
        let same = got.map(f32::to_bits) == expected.map(f32::to_bits);
        assert!(same, "{name}, sample {row} {:?}: {got:?} instead of {expected:?}", samples[row]);
    }
    assert!(expected.iter().any(|[torque, _]| *torque != 0.0), "{name}");
}

#[test]
fn c_computes_the_bits_of_the_step() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (name, model) in with_every_effect() {
        let files = c::evaluator("law", "test", &from_bytes(&image(&model)).unwrap()).unwrap();
        std::fs::write(at.join("law.h"), files.header).unwrap();
        std::fs::write(at.join("law.c"), files.source).unwrap();
        let main = format!(
            "#include \"law.h\"\n#include <stdio.h>\nint main(void) {{\n    float x[{ROW}];\n    static law_state state;\n    \
             while (fread(x, sizeof x, 1, stdin) == 1) {{\n        float y[2];\n        y[0] = law_step(&state, {});\n        \
             y[1] = state.position;\n        fwrite(y, sizeof y, 1, stdout);\n    }}\n    return 0;\n}}\n",
            arguments(&model)
        );
        std::fs::write(at.join("main.c"), main).unwrap();
        host_program(&[at.join("law.c"), at.join("main.c")], &at.join("program"));
        assert_same_bits(&name, &model, &at.join("program"));
    }
}

fn succeed(command: &mut Command) -> Vec<u8> {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

fn rustc(at: &Path, arguments: &[&str]) {
    let common = ["--edition", "2024", "-D", "warnings", "-C", "opt-level=1"];
    succeed(Command::new("rustc").current_dir(at).args(common).args(arguments));
}

/// One program holds all models: starting the compiler takes longer than the rest.
#[test]
fn rust_computes_the_bits_of_the_step_and_needs_nothing_but_core() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (mut library, mut main) = (String::from("#![no_std]\n"), String::new());
    for (index, (_, model)) in with_every_effect().iter().enumerate() {
        let module = rust::module("test", &from_bytes(&image(model)).unwrap()).unwrap();
        std::fs::write(at.join(format!("law_{index}.rs")), module).unwrap();
        library += &format!("pub mod law_{index};\n");
        main += &format!(
            "        \"{index}\" => {{ let mut state = laws::law_{index}::Friction::new(); \
             run(&mut |x| [state.step({}), state.position]) }}\n",
            arguments(model)
        );
    }
    std::fs::write(at.join("laws.rs"), library).unwrap();
    let head = "use std::io::{Read, Write};\n\
        fn run(step: &mut dyn FnMut(&[f32]) -> [f32; 2]) {\n    let (mut bytes, mut out) = (Vec::new(), Vec::new());\n    \
        std::io::stdin().read_to_end(&mut bytes).unwrap();\n    \
        let values: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();\n    \
        for row in values.chunks_exact(ROW) { for y in step(row) { out.extend(y.to_le_bytes()); } }\n    \
        std::io::stdout().write_all(&out).unwrap();\n}\n";
    let main = format!(
        "const ROW: usize = {ROW};\n{head}fn main() {{\n    match std::env::args().next().unwrap().rsplit('/').next().unwrap() {{\n{main}        \
         _ => panic!(),\n    }}\n}}\n"
    );
    std::fs::write(at.join("main.rs"), main).unwrap();
    rustc(at, &["--crate-type", "rlib", "laws.rs"]);
    rustc(at, &["--extern", "laws=liblaws.rlib", "-o", "program", "main.rs"]);
    for (index, (name, model)) in with_every_effect().iter().enumerate() {
        // The program takes its model from its own name.
        let program = at.join(index.to_string());
        std::fs::copy(at.join("program"), &program).unwrap();
        assert_same_bits(name, model, &program);
    }
}

/// Python computes in double precision: as close as the rounding of the drive lets it.
#[test]
fn python_computes_the_step_but_for_the_rounding_of_the_drive() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let samples = samples(6_000);
    let list: Vec<String> = samples.iter().map(|row| row.map(|x| x.to_string()).join(" ")).collect();
    std::fs::write(at.join("samples.txt"), list.join("\n")).unwrap();
    for (name, model) in with_every_effect() {
        let module = python::module("test", &from_bytes(&image(&model)).unwrap()).unwrap();
        let main = format!(
            "{module}\nstate = Friction()\nfor line in open('samples.txt'):\n    x = [float(word) for word in line.split()]\n    \
             print(repr(state.step({})), repr(state.position))\n",
            arguments(&model)
        );
        std::fs::write(at.join("run.py"), main).unwrap();
        let printed = String::from_utf8(succeed(Command::new("python3").current_dir(at).arg("run.py"))).unwrap();
        let got = printed.lines().map(|line| line.split(' ').map(|word| word.parse::<f64>().unwrap()).collect());
        let got: Vec<Vec<f64>> = got.collect();
        let expected = expected(&model, &samples);
        assert_eq!(got.len(), expected.len(), "{name}");
        let largest = expected.iter().fold(0.0f32, |most, [torque, _]| most.max(torque.abs()));
        for (row, (got, expected)) in got.iter().zip(&expected).enumerate() {
            let error = (got[0] - f64::from(expected[0])).abs().max((got[1] - f64::from(expected[1])).abs());
            assert!(
                error < 1e-4 * f64::from(largest),
                "{name}, sample {row} {:?}: {got:?} for {expected:?}",
                samples[row]
            );
        }
    }
}

/// An exported step that forgets is caught: without what it remembers the same samples give something else.
#[test]
fn what_the_step_remembers_matters_to_these_samples() {
    let samples = samples(20_000);
    let remembered = expected(&by_velocity(), &samples);
    let forgotten: Vec<[f32; 2]> = samples.iter().flat_map(|sample| expected(&by_velocity(), &[*sample])).collect();
    assert_ne!(remembered, forgotten);
}
