//! The C library in the example firmware on the emulated Cortex-M4F, against the compensator of the host.

use std::path::Path;

use frikan_runtime::compensator::{Compensator, Limits, Status};
use frikan_runtime::friction::Measurement;
use frikan_runtime::shared::authentication::{KEY_BYTES, Key};
use frikan_runtime::shared::effect::{Effect, Element, Harmonic, Kind};
use frikan_runtime::shared::model::Input;
use frikan_runtime::shared::units::{Quantity, Unit};
use frikan_tests::c::{firmware, library_folder};
use frikan_tests::models::{CELLS, TestModel, image, stribeck_expression, symmetric_table};
use frikan_tests::vectors::space_filling;
use frikan_trainer::emulator::{Answer, Emulator, Firmware, Mode, Request, forbidden_symbols};
use frikan_trainer::error::Result;

const ROWS: usize = 20_000;

/// The limits and the period of the example.
const LIMITS: [f32; 3] = [0.9, 40.0, 8000.0];
const PERIOD: f32 = 1.0e-3;

/// The example with `definitions`, linked into `folder`.
fn example(folder: &Path, definitions: &[String]) -> Emulator {
    let sources = Firmware::find().unwrap();
    let target = sources.target("cortex-m4f").unwrap();
    let library = sources.build_c_library(&target).unwrap();
    let elf = folder.join("drive.elf");
    firmware(&[library_folder().join("example/drive.c"), library], definitions, &elf);
    assert_eq!(forbidden_symbols(&elf).unwrap(), [""; 0]);
    Emulator::with_elf(target, elf).unwrap()
}

fn torques(emulator: &Emulator, image: &[u8], values: &[f32]) -> Result<Answer> {
    emulator.run(&Request { image, values, inputs: 4, outputs: 1, mode: Mode::Evaluate, floating_point_control: 0 })
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

#[test]
fn the_example_in_c_computes_the_bits_of_the_host() {
    let folder = tempfile::tempdir().unwrap();
    let emulator = example(folder.path(), &[]);
    // Every sixteenth row has a special value: NaN and infinities are among them.
    let values = space_filling(ROWS, &[2.0, 3.0, 20.0, 60.0]);
    for (name, model) in [("table", symmetric_table()), ("expression with effects", with_effects())] {
        let image = image(&model);
        let answer = torques(&emulator, &image, &values).unwrap();
        let mut compensator = Compensator::<CELLS>::new(&image, Limits::new(LIMITS[0], LIMITS[1], LIMITS[2]).unwrap());
        let (rows, _) = values.as_chunks::<4>();
        let mut active = 0;
        for (row, torque) in rows.iter().zip(&answer.outputs) {
            let [velocity, position, load, temperature] = *row;
            let sample = Measurement { velocity, position, load, temperature, ..Measurement::default() };
            let expected = compensator.step(&sample, PERIOD);
            active += usize::from(expected.status == Status::Active && expected.torque != 0.0);
            assert_eq!(torque.to_bits(), expected.torque.to_bits(), "{name} at {row:?}");
        }
        assert!(active > ROWS / 2 && answer.outputs.len() == ROWS);
    }
}

#[test]
fn a_damaged_image_leaves_the_example_off() {
    let folder = tempfile::tempdir().unwrap();
    let emulator = example(folder.path(), &[]);
    let sound = image(&symmetric_table());
    torques(&emulator, &sound, &[0.1; 4]).unwrap();
    for byte in [0, 5, 9, 13, 40, sound.len() - 1] {
        let mut damaged = sound.clone();
        damaged[byte] ^= 0x04;
        let error = torques(&emulator, &damaged, &[0.1; 4]).unwrap_err().to_string();
        assert!(error.contains("refuses the image"), "byte {byte}: {error}");
    }
}

#[test]
fn an_example_with_a_key_takes_its_images_only() {
    let secret: [u8; KEY_BYTES] = std::array::from_fn(|index| 7 * index as u8 + 1);
    let digits: Vec<String> = secret.iter().map(|byte| format!("0x{byte:02x}")).collect();
    let folder = tempfile::tempdir().unwrap();
    let emulator = example(folder.path(), &[format!("DRIVE_KEY={}", digits.join(","))]);
    let plain = image(&symmetric_table());
    let tagged = |key: [u8; KEY_BYTES]| [&plain[..], &Key::new(key).tag(&plain)].concat();
    assert!(torques(&emulator, &tagged(secret), &[0.1; 4]).unwrap().outputs[0] > 0.0);
    let mut other = secret;
    other[31] ^= 0x80;
    for foreign in [plain.clone(), tagged(other)] {
        let error = torques(&emulator, &foreign, &[0.1; 4]).unwrap_err().to_string();
        // 0x100 and FRIKAN_STATUS_NOT_AUTHENTIC.
        assert!(error.contains("refuses the image") && error.contains("260"), "{error}");
    }
}
