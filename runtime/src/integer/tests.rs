use super::*;
use crate::compensator::LimitError;
use crate::test_models::{coulomb_model, image_of};
use frikan_shared::authentication::admission::{Admission, Demands};
use frikan_shared::image::{Image, encode};
use frikan_shared::integer_table::{IntegerShape, IntegerTable, SEGMENTS};
use frikan_shared::invalid::InvalidModel;
use frikan_shared::model::{Input, Law, Model, Provenance, RigidBody};
use frikan_shared::table::{Cell, Symmetry};
use frikan_shared::units::{Quantity, Unit};
use proptest::prelude::*;
use std::vec::Vec;

/// Eight steps of the table are a count of the velocity, and sixteen of its values a count of the torque.
const UNITS: Units = Units { velocity: 1.5 / 4096.0, torque: 0.001 };
const INPUT_STEP: f32 = UNITS.velocity / 8.0;
const OUTPUT_STEP: f32 = UNITS.torque / 16.0;

/// 16 cells a side, a jump from each to the next, so that every one is told from its neighbours.
fn model(symmetry: Symmetry, range: [f32; 2]) -> Model<64> {
    let cells = [1; SEGMENTS];
    let shape = IntegerShape { first_cell: 0, cells, symmetry, input_step: INPUT_STEP, output_step: OUTPUT_STEP };
    let table = IntegerTable::new(shape);
    let cell = |index: u32| Cell::from_integers([1600 * (index as i32 + 1), 800, -300, 7 * index as i32]);
    let [low, high] = range;
    Model {
        law: Law::IntegerTable(table),
        cells: (0..table.cells()).map(cell).collect(),
        inputs: core::iter::once(Input { quantity: Quantity::Velocity, unit: Unit::RadianPerSecond, low, high })
            .collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: 200.0,
        rigid_body: RigidBody::default(),
        effects: heapless::Vec::new(),
    }
}

fn image(model: Model<64>) -> Vec<u8> {
    let mut buffer = [0; 4096];
    encode(&Image { provenance: Provenance::default(), model }, &mut buffer).unwrap().to_vec()
}

fn symmetries() -> impl Strategy<Value = Symmetry> {
    prop_oneof![Just(Symmetry::Odd), Just(Symmetry::Even), Just(Symmetry::Sided)]
}

fn ends() -> impl Strategy<Value = [f32; 2]> {
    (-15.0f32..-0.01, 0.01f32..15.0).prop_map(|(low, high)| [low, high])
}

/// What the documentation says, in wide numbers and by division.
fn expected(model: &Model<64>, velocity: i32) -> i64 {
    let Law::IntegerTable(table) = &model.law else { unreachable!() };
    let [input] = &model.inputs[..] else { unreachable!() };
    let [low, high] = [input.low, input.high].map(|end| (f64::from(end) / f64::from(UNITS.velocity)).trunc() as i64);
    let most = ((1 << 18) - 1) / 8;
    let held = i64::from(velocity).clamp(low.max(-most), high.min(most));
    if velocity == 0 {
        return 0;
    }
    let steps = 8 * held.abs();
    let sided = velocity < 0 && table.shape().symmetry == Symmetry::Sided;
    let cell = steps / (1 << 14) + if sided { 16 } else { 0 };
    let [c0, c1, c2, c3] = model.cells[cell as usize].integers().map(i64::from);
    let x = (steps % (1 << 14)) * 4;
    let floor = |product: i64| product.div_euclid(1 << 16);
    let value = c0 + floor((c1 + floor((c2 + floor(c3 * x)) * x)) * x);
    let turned = if velocity < 0 && table.shape().symmetry == Symmetry::Odd { -value } else { value };
    (turned + 8).div_euclid(16)
}

proptest! {
    #[test]
    fn every_count_gives_what_is_documented(
        symmetry in symmetries(),
        range in ends(),
        velocities in prop::collection::vec(prop_oneof![-40_000i32..40_000, any::<i32>(), Just(i32::MIN), Just(0)], 64),
    ) {
        let model = model(symmetry, range);
        let image = image(model.clone());
        let table = IntegerTableInPlace::new(&image, UNITS).unwrap();
        for velocity in velocities {
            prop_assert_eq!(i64::from(table.friction(velocity)), expected(&model, velocity), "at {}", velocity);
        }
    }

    /// Never beyond the limits, whatever the counts and however they follow each other.
    #[test]
    fn limits_hold_for_every_sequence_of_counts(
        velocities in prop::collection::vec(prop_oneof![-40_000i32..40_000, any::<i32>()], 64),
        gain in 0u16..=ONE, torque in 0u16..=32_767, slew in 1u16..,
    ) {
        let image = image(model(Symmetry::Sided, [-15.0, 15.0]));
        let limits = IntegerLimits::new(gain, torque, slew).unwrap();
        let mut joint = IntegerCompensator::new(IntegerTableInPlace::new(&image, UNITS), limits);
        let mut before = 0i32;
        for velocity in velocities {
            let answer = joint.step(velocity);
            prop_assert!(answer.abs() <= i32::from(torque));
            prop_assert!((answer - before).abs() <= i32::from(slew));
            before = answer;
        }
    }
}

#[test]
fn every_step_leads_to_the_share_of_the_friction() {
    let image = image(model(Symmetry::Odd, [-15.0, 15.0]));
    let table = IntegerTableInPlace::new(&image, UNITS).unwrap();
    let mut joint = IntegerCompensator::new(Ok(table), IntegerLimits::new(ONE / 2, 700, 32_767).unwrap());
    for velocity in [1, -1, 5000, -5000, 14_000, 20_000, i32::MAX, i32::MIN] {
        let share = (f64::from(table.friction(velocity)) / 2.0 + 0.5).floor().clamp(-700.0, 700.0);
        assert_eq!(f64::from(joint.step(velocity)), share, "at {velocity}");
    }
    assert_eq!(joint.status(), Status::Active);
    // The slew limit holds when the torque limit shrinks, and a reset starts from 0.
    let before = joint.step(-20_000);
    joint.set_limits(IntegerLimits::new(ONE, 100, 50).unwrap());
    assert_eq!(joint.step(-20_000), before + 50);
    joint.reset();
    assert_eq!(joint.step(-20_000), -50);
}

#[test]
fn a_drive_without_an_image_puts_out_nothing() {
    let sound = image(model(Symmetry::Odd, [-15.0, 15.0]));
    let limits = IntegerLimits::new(ONE, 1000, 1000).unwrap();
    let mut joint = IntegerCompensator::new(IntegerTableInPlace::new(&[], UNITS), limits);
    assert_eq!((joint.step(1000), joint.status()), (0, Status::NoModel(ImageError::Truncated)));
    joint.replace(IntegerTableInPlace::new(&sound, UNITS));
    assert!(joint.step(1000) != 0 && joint.checksum().is_some());
    joint.replace(Err(ImageError::NoImage));
    assert_eq!((joint.step(1000), joint.checksum()), (0, None));
    let flash = [&sound[..], &[0xFF; 9]].concat();
    joint.replace(IntegerTableInPlace::at_start(&flash, UNITS));
    assert!(joint.step(1000) != 0);
}

#[test]
fn images_for_other_counts_are_refused() {
    let sound = image(model(Symmetry::Odd, [-15.0, 15.0]));
    let read = |velocity, torque| IntegerTableInPlace::new(&sound, Units { velocity, torque }).err();
    // A power of two of the count it was made for is as good.
    assert_eq!(read(UNITS.velocity / 4.0, UNITS.torque * 2.0), None);
    let other = Some(ImageError::OtherUnit);
    for wrong in [0.0, -UNITS.velocity, f32::NAN, f32::INFINITY, 1.0e-40, 1.0e-3, UNITS.velocity.next_up(), 1.5e9] {
        assert_eq!(read(wrong, UNITS.torque), other, "{wrong}");
    }
    for wrong in [UNITS.torque / 32.0, UNITS.torque * 2.0f32.powi(11), 0.0011, f32::NAN] {
        assert_eq!(read(UNITS.velocity, wrong), other, "{wrong}");
    }
    // More counts than a drive has.
    let mut large = model(Symmetry::Odd, [-15.0, 15.0]);
    large.cells[3] = Cell::from_integers([32_767 * 16, 100, 0, 0]);
    let refused = IntegerTableInPlace::new(&image(large), UNITS).err();
    assert_eq!(refused, Some(ImageError::InvalidModel(InvalidModel::OutputLimit)));
}

#[test]
fn damaged_images_and_other_laws_are_refused() {
    let sound = image(model(Symmetry::Odd, [-15.0, 15.0]));
    for bit in 0..8 * sound.len() {
        let mut damaged = sound.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(IntegerTableInPlace::new(&damaged, UNITS).is_err(), "bit {bit}");
    }
    for length in 0..sound.len() {
        assert!(IntegerTableInPlace::new(&sound[..length], UNITS).is_err(), "{length} bytes");
    }
    assert_eq!(IntegerTableInPlace::new(&image_of(coulomb_model(2.0, &[])), UNITS).err(), Some(ImageError::NotBuiltIn));
}

#[test]
fn a_firmware_can_ask_for_more_of_an_image() {
    let sound = image(model(Symmetry::Odd, [-15.0, 15.0]));
    let asking = |output_unit| {
        let demands = Demands { output_unit: Some(output_unit), ..Demands::NONE };
        let table = Admission { demands, ..Admission::ANY }.integer_table(&sound);
        table.and_then(|table| IntegerTableInPlace::of(table, UNITS)).err()
    };
    assert_eq!(asking(Unit::NewtonMetre), None);
    assert_eq!(asking(Unit::Ampere), Some(ImageError::OtherUnit));
}

#[test]
fn limits_out_of_range_are_refused() {
    let refused = |gain, torque, slew| IntegerLimits::new(gain, torque, slew).err();
    assert_eq!(refused(ONE + 1, 1, 1), Some(LimitError::Gain));
    assert_eq!(refused(ONE, 32_768, 1), Some(LimitError::Torque));
    assert_eq!(refused(ONE, 1, 0), Some(LimitError::Slew));
    assert_eq!(refused(ONE, 32_767, u16::MAX), None);
}
