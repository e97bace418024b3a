use super::*;
use crate::compensator::{Compensator, Limited, Limits, Status};
use crate::test_models::{coulomb_model, image_of};
use frikan_shared::model::{Input, Law, Model, RigidBody};
use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry};
use frikan_shared::units::{Quantity, Unit};
use proptest::prelude::*;
use std::vec::Vec;

const CELLS: usize = 64;
const DT: f32 = 1.0e-3;

/// A table that jumps from cell to cell, so that every cell is told from its neighbours.
fn table_model(symmetry: Symmetry, octave_cells_log2: u8, first_cell: u16) -> Model<CELLS> {
    let layout = Geometric::new(GeometricShape {
        first_cell,
        offset_exponent: -5,
        octave_cells_log2,
        symmetry,
        reach: 2.0,
        reach_negative: if symmetry == Symmetry::Sided { 1.3 } else { 2.0 },
    });
    let cells = u32::from(first_cell) + layout.cells();
    let input = Input { quantity: Quantity::Velocity, unit: Unit::RadianPerSecond, low: -1.3, high: 2.0 };
    Model {
        law: Law::Geometric(layout),
        cells: (0..cells).map(|cell| Cell::from_floats([3.0 + cell as f32, 0.7, -0.3, 0.01 * cell as f32])).collect(),
        inputs: core::iter::once(input).collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: 200.0,
        rigid_body: RigidBody::default(),
        effects: heapless::Vec::new(),
    }
}

fn image(model: Model<CELLS>) -> Vec<u8> {
    let mut buffer = [0; 4096];
    let provenance = frikan_shared::model::Provenance {
        joint: "elbow".try_into().unwrap(),
        trainer_version: "0.1.0".try_into().unwrap(),
        recordings_hash: u64::MAX,
        seed: 300,
        ..Default::default()
    };
    frikan_shared::image::encode(&frikan_shared::image::Image { provenance, model }, &mut buffer).unwrap().to_vec()
}

fn images() -> Vec<Vec<u8>> {
    let symmetries = [Symmetry::Odd, Symmetry::Even, Symmetry::Sided];
    let shapes = [(0, 0), (2, 0), (1, 3)];
    let models =
        symmetries.into_iter().flat_map(|symmetry| shapes.map(|(log2, first)| table_model(symmetry, log2, first)));
    models.map(image).collect()
}

/// What earlier versions wrote is read where it lies, and says the same as when it is decoded.
#[test]
fn images_of_earlier_formats_are_read_in_place() {
    let older: [&[u8]; 3] = [
        include_bytes!("../../../fixtures/older/stribeck-3.frk"),
        include_bytes!("../../../fixtures/older/stribeck-4.frk"),
        include_bytes!("../../../fixtures/older/stribeck-5.frk"),
    ];
    let limits = Limits::new(1.0, 1.0e3, 1.0e9).unwrap();
    for (image, version) in older.into_iter().zip(3..) {
        assert_eq!(image[4], version);
        let mut in_place = Limited::by(TableInPlace::new(image), limits);
        let mut decoded = Compensator::<128>::new(image, limits);
        for velocity in [-0.9, -1.0e-3, 0.02, 0.5] {
            let sample = Measurement { velocity, ..Measurement::MISSING };
            let answer = in_place.step(&sample, DT);
            assert!(answer.status == Status::Active && answer.torque != 0.0);
            assert_eq!(answer.torque.to_bits(), decoded.step(&sample, DT).torque.to_bits());
        }
    }
}

/// Samples of every kind: motion at every scale, special values, periods that are none.
fn samples() -> impl Iterator<Item = (f32, f32)> {
    let special =
        [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MIN_POSITIVE, 1.0e-45, f32::MAX, -f32::MAX];
    let scattered = (0..20_000u32).map(|k| f32::from_bits(k.wrapping_mul(0x9E37_79B9)));
    let moving = (-400..=400).map(|k| 0.006 * k as f32);
    let velocities = special.into_iter().chain(scattered).chain(moving);
    velocities
        .enumerate()
        .map(|(row, velocity)| (velocity, if row % 61 == 60 { [0.0, -1.0, 2.0][row % 3] } else { DT }))
}

#[test]
fn a_table_in_place_computes_the_bits_of_the_decoded_one() {
    for image in images() {
        let limits = Limits::new(0.9, 50.0, 4.0e4).unwrap();
        let mut decoded = Compensator::<CELLS>::new(&image, limits);
        let mut in_place = Limited::by(TableInPlace::new(&image), limits);
        assert_eq!(in_place.status(), Status::Active);
        for (velocity, dt) in samples() {
            let sample = Measurement { velocity, ..Measurement::MISSING };
            let (answer, expected) = (in_place.step(&sample, dt), decoded.step(&sample, dt));
            assert_eq!(answer.torque.to_bits(), expected.torque.to_bits(), "{velocity} after {dt}");
            assert_eq!(answer, expected);
        }
    }
}

#[test]
fn what_is_no_table_of_the_velocity_alone_is_refused() {
    let refusal = |image: &[u8]| TableInPlace::new(image).err();
    assert_eq!(refusal(&image_of(coulomb_model(1.0, &[]))), Some(ImageError::NotBuiltIn));
    let sound = table_model(Symmetry::Odd, 2, 0);
    let mut others = [sound.clone(), sound.clone(), sound];
    others[0].inputs[0].quantity = Quantity::Position;
    others[1].inputs.push(Input { quantity: Quantity::Load, unit: Unit::NewtonMetre, low: 0.0, high: 1.0 }).unwrap();
    others[2].effects.push(frikan_shared::effect::Effect::WindupHysteresis { torque: 1.0, distance: 0.1 }).unwrap();
    for other in others {
        assert_eq!(refusal(&image(other)), Some(ImageError::NotBuiltIn));
    }
}

/// As decoding refuses them, and a tag behind the image is no part of it.
#[test]
fn damaged_images_are_refused() {
    for sound in images().into_iter().step_by(4) {
        let refused = |bytes: &[u8]| {
            let error = TableInPlace::new(bytes).unwrap_err();
            assert_eq!(Status::NoModel(error), Compensator::<CELLS>::new(bytes, Limits::OFF).status());
        };
        for bit in (0..8 * sound.len()).step_by(if cfg!(miri) { 397 } else { 1 }) {
            let mut damaged = sound.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            refused(&damaged);
        }
        (0..sound.len()).for_each(|length| refused(&sound[..length]));
        let with_more = [&sound[..], &[0xFF; 32]].concat();
        refused(&with_more);
        assert!(TableInPlace::at_start(&with_more).is_ok());
    }
}

proptest! {
    /// Whatever the bytes behind a right checksum: what is taken gives finite friction, and where decoding takes it too, the same.
    #[test]
    fn forged_payloads_give_finite_friction_or_none(place in 16usize..600, byte: u8, velocity: f32) {
        for mut image in images() {
            let place = 16 + place % (image.len() - 16);
            image[place] = byte;
            let sum = frikan_shared::image::checksum(&[&image[..12], &image[16..]]);
            image[12..16].copy_from_slice(&sum.to_le_bytes());
            let Ok(table) = TableInPlace::new(&image) else { continue };
            prop_assert!(table.value(velocity).is_finite());
            if let Some(Law::Geometric(layout)) = Compensator::<CELLS>::new(&image, Limits::OFF).model().map(|model| &model.law) {
                let model = frikan_shared::image::decode::<CELLS>(&image).unwrap().model;
                let expected = crate::laws::table::geometric_value(layout, &model.cells, velocity);
                prop_assert_eq!(table.value(velocity).to_bits(), expected.to_bits());
            }
        }
    }
}
