//! The C library in the example firmware on the emulated Cortex-M4F, against the compensator of the host.

use std::path::PathBuf;
use std::process::Command;

use frikan_runtime::compensator::{Compensator, Limits, Status};
use frikan_runtime::friction::Measurement;
use frikan_runtime::shared::authentication::{KEY_BYTES, Key};
use frikan_runtime::shared::effect::{Effect, Element, Harmonic, Kind};
use frikan_runtime::shared::model::Input;
use frikan_runtime::shared::units::{Quantity, Unit};
use frikan_runtime::supervised::{Sample, Supervised, Supervision, Supervisor};
use frikan_tests::c::{EVERY_FEATURE, EXAMPLE_INPUTS as INPUTS, example, example_of_nothing, library_folder};
use frikan_tests::cost::Documented;
use frikan_tests::models::{CELLS, TestModel, image, sided_table, stribeck_expression, symmetric_table};
use frikan_trainer::emulator::{Answer, Emulator, Firmware, Mode, Request, footprint, forbidden_symbols};
use frikan_trainer::error::Result;
use frikan_trainer::export::c_array::c_header;

const ROWS: usize = 20_000;

/// The limits, the period, the inertia, the friction and the encoder's count of the example.
const LIMITS: [f32; 3] = [0.9, 40.0, 8000.0];
const PERIOD: f32 = 1.0e-3;
const INERTIA: f32 = 0.5;
const FRICTION: f32 = 20.0;
const COUNT: f32 = std::f32::consts::TAU / 1_048_576.0;

/// Most that the library takes with its default features, bytes of flash and of stack.
const FLASH_BYTES: u64 = 8 << 10;
const STACK_BYTES: u32 = 512;

fn emulator(elf: PathBuf) -> Emulator {
    let target = Firmware::find().unwrap().target("cortex-m4f").unwrap();
    Emulator::with_elf(target, elf).unwrap()
}

fn torques(emulator: &Emulator, image: &[u8], values: &[f32]) -> Result<Answer> {
    emulator.run(&Request {
        image,
        values,
        inputs: INPUTS,
        outputs: 1,
        mode: Mode::Evaluate,
        floating_point_control: 0,
    })
}

/// A joint that goes to and fro, rests, and now and then lacks a channel.
fn samples() -> Vec<[f32; INPUTS]> {
    let mut position = 0.0f32;
    let row = |index: usize| {
        let time = index as f32 * PERIOD;
        let reference = if index / 900 % 4 == 3 { 0.0 } else { 1.2 * (3.0 * time).sin() };
        let velocity = reference + 0.003 * (211.0 * time).sin();
        position += velocity * PERIOD;
        let mut row = [velocity, position, 8.0 * time.cos(), 20.0 + time, reference, 15.0 * velocity.signum()];
        if index % 61 == 60 {
            row[index / 61 % INPUTS] = [f32::NAN, f32::INFINITY, -0.0][index / 61 % 3];
        }
        row
    };
    (0..ROWS).map(row).collect()
}

/// A law with corrections that remember, over all channels of the example.
fn with_effects() -> TestModel {
    let smoothing_velocity = 0.02;
    let harmonic = Harmonic { order: 12.0, cosine: 0.4, sine: -0.3 };
    let channels = [
        (Quantity::Position, Unit::Radian, 3.0),
        (Quantity::Load, Unit::NewtonMetre, 20.0),
        (Quantity::Temperature, Unit::Celsius, 60.0),
    ];
    let mut model = stribeck_expression();
    model.inputs.extend(channels.map(|(quantity, unit, high)| Input { quantity, unit, low: -high, high }));
    model.effects.extend([
        Effect::Presliding {
            smoothing_velocity,
            elements: std::iter::once(Element { torque: 5.0, distance: 1.0e-3 }).collect(),
        },
        Effect::WarmUp { time_constant: 1.0, coulomb: -0.1, viscous: 0.1, power_limit: 20.0, smoothing_velocity },
        Effect::Ripple { kind: Kind::Friction, smoothing_velocity, harmonics: std::iter::once(harmonic).collect() },
        Effect::Load {
            mean: 0.05,
            difference: 0.01,
            quadratic: 1.0e-3,
            stribeck: 0.3,
            velocity: 0.1,
            smoothing_velocity,
        },
        Effect::Temperature { reference: 20.0, coulomb: -0.1, viscous: -0.05, decay: 0.0, smoothing_velocity },
    ]);
    model.validate().unwrap();
    model
}

/// The example with the library of `features`, against the supervised compensator of the host.
fn computes_the_bits_of_the_host(features: Option<&str>, models: &[(&str, TestModel)]) {
    let folder = tempfile::tempdir().unwrap();
    let emulator = emulator(example(folder.path(), features, &[]));
    let samples = samples();
    for (name, model) in models {
        let image = image(model);
        let answer = torques(&emulator, &image, samples.as_flattened()).unwrap();
        let mut compensator = Compensator::<CELLS>::new(&image, Limits::new(LIMITS[0], LIMITS[1], LIMITS[2]).unwrap());
        let mut supervisor = Supervisor::new(Supervision::new(INERTIA, FRICTION, COUNT)).unwrap();
        // The example measures its stack by a first step at rest.
        let at_rest = Sample { measurement: Measurement::ZERO, reference_velocity: Some(0.0), loop_torque: 0.0 };
        let _ = supervisor.step(&mut compensator, &at_rest, PERIOD);
        let mut active = 0;
        for (row, torque) in samples.iter().zip(&answer.outputs) {
            let [velocity, position, load, temperature, reference, loop_torque] = *row;
            let measurement = Measurement { velocity, position, load, temperature, other: [0.0; 4], acceleration: 0.0 };
            let reference_velocity = (!reference.is_nan()).then_some(reference);
            let sample = Sample { measurement, reference_velocity, loop_torque };
            let expected = supervisor.step(&mut compensator, &sample, PERIOD);
            let is_active = [Supervised::Compensator(Status::Active), Supervised::Degraded].contains(&expected.status);
            active += usize::from(is_active && expected.torque != 0.0);
            assert_eq!(torque.to_bits(), expected.torque.to_bits(), "{name} at {row:?}");
        }
        assert!(active > ROWS / 2 && answer.outputs.len() == ROWS, "{name}: {active}");
    }
}

#[test]
fn the_example_in_c_computes_the_bits_of_the_host() {
    computes_the_bits_of_the_host(None, &[("table", symmetric_table()), ("sided table", sided_table())]);
    let others = [("table", symmetric_table()), ("expression with effects", with_effects())];
    computes_the_bits_of_the_host(Some(EVERY_FEATURE), &others);
}

#[test]
fn the_library_is_small_by_default() {
    let folder = tempfile::tempdir().unwrap();
    let elf = example(folder.path(), None, &[]);
    let flash = footprint(&elf).unwrap().beyond(footprint(&example_of_nothing(folder.path())).unwrap()).flash_bytes;
    assert!(flash <= FLASH_BYTES, "{flash} bytes of flash");
    let documented = Documented::of("The C library on cortex-m4f", "by default");
    documented.holds("flash B", flash);
    let answer = torques(&emulator(elf), &image(&symmetric_table()), &[0.0; INPUTS]).unwrap();
    let stack = answer.decode_stack_bytes.max(answer.evaluate_stack_bytes);
    assert!(stack <= STACK_BYTES && answer.decode_stack_bytes > 100, "{answer:?}");
    documented.holds("stack, start B", answer.decode_stack_bytes.into());
    documented.holds("stack, step B", answer.evaluate_stack_bytes.into());
}

/// By `find_package(Frikan)`, with features and a number of cells that the header has to be told of.
#[test]
fn cmake_builds_the_example() {
    let folder = tempfile::tempdir().unwrap();
    let source = library_folder().join("example").display().to_string();
    let cmake = |arguments: &[&str]| {
        let output = Command::new("cmake").current_dir(folder.path()).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    cmake(&["-S", &source, "-B", "build", "-DFRIKAN_FEATURES=supervised,slots,expression", "-DFRIKAN_CELLS=64"]);
    cmake(&["--build", "build"]);
    let emulator = emulator(folder.path().join("build/drive.elf"));
    let torque = torques(&emulator, &image(&symmetric_table()), &[0.3; INPUTS]).unwrap().outputs[0];
    assert!(torque > 0.0, "{torque}");
}

/// What the module of Zephyr takes for a processor, by a project that is configured and has nothing of Zephyr but the function that links.
#[test]
fn zephyr_takes_the_library_of_its_processor() {
    let folder = tempfile::tempdir().unwrap();
    let project = "cmake_minimum_required(VERSION 3.20)\nproject(application NONE)\n\
        function(zephyr_link_libraries library)\n    get_target_property(place ${library} IMPORTED_LOCATION)\n    \
        message(STATUS \"linked: ${place}\")\nendfunction()\n\
        add_subdirectory(${MODULE} module)\n";
    std::fs::write(folder.path().join("CMakeLists.txt"), project).unwrap();
    let module = library_folder().join("../../zephyr");
    for (target, options) in [
        ("thumbv6m-none-eabi", &["ARMV6_M_ARMV8_M_BASELINE"][..]),
        ("thumbv7m-none-eabi", &["CPU_CORTEX_M3", "ARMV7_M_ARMV8_M_MAINLINE"]),
        ("thumbv7em-none-eabi", &["ARMV7_M_ARMV8_M_MAINLINE"]),
        ("thumbv7em-none-eabihf", &["ARMV7_M_ARMV8_M_MAINLINE", "FP_HARDABI"]),
        ("thumbv8m.main-none-eabihf", &["ARMV7_M_ARMV8_M_MAINLINE", "ARMV8_M_MAINLINE", "FP_HARDABI"]),
        ("riscv32imc-unknown-none-elf", &["RISCV"]),
        ("riscv32imac-unknown-none-elf", &["RISCV", "RISCV_ISA_EXT_A"]),
    ] {
        let mut cmake = Command::new("cmake");
        cmake.current_dir(folder.path()).args(["-S", ".", "-B", target]).arg(format!("-DMODULE={}", module.display()));
        cmake.args(["FRIKAN"].iter().chain(options).map(|option| format!("-DCONFIG_{option}=y")));
        let output = cmake.output().unwrap();
        let told = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{told}{}", String::from_utf8_lossy(&output.stderr));
        assert!(told.contains(&format!("/{target}/drive/libfrikan.a")), "{options:?}: {told}");
    }
}

/// The library of the Arduino IDE, as a board with a Cortex-M4F links it with its sketch.
#[test]
fn the_arduino_library_is_packed_and_its_sketch_links() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let succeeds = |command: &mut Command| {
        let output = command.current_dir(at).output().unwrap();
        assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    };
    let script = library_folder().join("arduino/package.cmake");
    succeeds(Command::new("cmake").args(["-DPROCESSORS=cortex-m4", "-P"]).arg(script));
    succeeds(Command::new("cmake").args(["-E", "tar", "xf", "Frikan.zip"]));
    serde_json::from_slice::<serde_json::Value>(&std::fs::read(at.join("Frikan/library.json")).unwrap()).unwrap();
    let image = c_header("elbow", &image(&symmetric_table()), "test");
    std::fs::write(at.join("elbow.h"), image).unwrap();
    let of_arduino = "#include <stdint.h>\n#define NAN __builtin_nanf(\"\")\nextern \"C\" uint32_t micros(void);\n";
    std::fs::write(at.join("Arduino.h"), of_arduino).unwrap();
    let core = "void setup();\nvoid loop();\nextern \"C\" uint32_t micros(void) { return 0; }\n\
        int main() { setup(); for (;;) loop(); }\n";
    std::fs::write(at.join("core.cpp"), core).unwrap();
    let mut compiler = Command::new("arm-none-eabi-g++");
    compiler.args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-Os", "-ffreestanding"]);
    compiler.args(["-fno-exceptions", "-fno-threadsafe-statics", "-Wall", "-Werror", "-nostdlib", "-Wl,--gc-sections"]);
    compiler.args(["-Wl,--entry=main", "-I.", "-IFrikan/src", "-include", "Arduino.h", "-x", "c++", "core.cpp"]);
    compiler.args(["Frikan/examples/Elbow/Elbow.ino", "-x", "none", "-LFrikan/src/cortex-m4/fpv4-sp-d16-hard"]);
    succeeds(compiler.args(["-lfrikan", "-lgcc", "-o", "sketch.elf"]));
    assert_eq!(forbidden_symbols(&at.join("sketch.elf")).unwrap(), [""; 0]);
}

#[test]
fn a_damaged_image_leaves_the_example_off() {
    let folder = tempfile::tempdir().unwrap();
    let emulator = emulator(example(folder.path(), None, &[]));
    let sound = image(&symmetric_table());
    torques(&emulator, &sound, &[0.1; INPUTS]).unwrap();
    for byte in [0, 5, 9, 13, 40, sound.len() - 1] {
        let mut damaged = sound.clone();
        damaged[byte] ^= 0x04;
        let error = torques(&emulator, &damaged, &[0.1; INPUTS]).unwrap_err().to_string();
        assert!(error.contains("refuses the image"), "byte {byte}: {error}");
    }
}

#[test]
fn an_example_with_a_key_takes_its_images_only() {
    let secret: [u8; KEY_BYTES] = std::array::from_fn(|index| 7 * index as u8 + 1);
    let digits: Vec<String> = secret.iter().map(|byte| format!("0x{byte:02x}")).collect();
    let folder = tempfile::tempdir().unwrap();
    let key = format!("DRIVE_KEY={}", digits.join(","));
    let emulator = emulator(example(folder.path(), Some(EVERY_FEATURE), &[key]));
    let plain = image(&symmetric_table());
    let tagged = |key: [u8; KEY_BYTES]| [&plain[..], &Key::new(key).tag(&plain)].concat();
    assert!(torques(&emulator, &tagged(secret), &[0.1; INPUTS]).unwrap().outputs[0] > 0.0);
    let mut other = secret;
    other[31] ^= 0x80;
    for foreign in [plain.clone(), tagged(other)] {
        let error = torques(&emulator, &foreign, &[0.1; INPUTS]).unwrap_err().to_string();
        // 0x100 and FRIKAN_STATUS_NOT_AUTHENTIC.
        assert!(error.contains("refuses the image") && error.contains("260"), "{error}");
    }
}
