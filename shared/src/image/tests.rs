use super::header::*;
use super::*;
use crate::effect::{Effect, Element, Harmonic, Kind, MAX_ELEMENTS};
use crate::expression::{Operation, Program, ProgramFault};
use crate::invalid::InvalidModel;
use crate::model::{Input, Law, LawError, Model, Provenance, RigidBody, RigidBodyError};
use crate::table::{Cell, Geometric, GeometricShape, Symmetry};
use crate::units::{Quantity, Unit};
use proptest::prelude::*;
use std::vec::Vec;

type Pool = Model<64>;

/// An interpreter sees a part of the bits.
const EVERY: usize = if cfg!(miri) { 97 } else { 1 };

fn input(quantity: Quantity) -> Input {
    Input { quantity, unit: Unit::RadianPerSecond, low: -2.0, high: 2.0 }
}

fn table_image(symmetry: Symmetry) -> Image<64> {
    let layout = Geometric::new(GeometricShape {
        first_cell: 0,
        offset_exponent: -6,
        octave_cells_log2: 2,
        symmetry,
        reach: 2.0,
        reach_negative: 2.0,
    });
    let cells = (0..layout.cells()).map(|cell| Cell::from_floats([cell as f32, 0.5, -0.25, 1.0e-3]));
    let model = Pool {
        inputs: heapless::Vec::from_slice(&[input(Quantity::Velocity)]).unwrap(),
        output_unit: Unit::NewtonMetre,
        output_limit: 100.0,
        rigid_body: RigidBody::default(),
        law: Law::Geometric(layout),
        effects: heapless::Vec::new(),
        cells: cells.collect(),
    };
    let provenance = Provenance {
        joint: "axis 1".try_into().unwrap(),
        trainer_version: "0.1.0".try_into().unwrap(),
        recordings_hash: u64::MAX,
        seed: 7,
        law_error: LawError { slow: 0.25, sliding: 0.125 },
        rigid_body_error: RigidBodyError { factor: core::array::from_fn(|k| 0.5 - k as f32) },
    };
    Image { provenance, model }
}

fn encoded<const CELLS: usize>(image: &Image<CELLS>) -> Vec<u8> {
    let mut buffer = [0; 8192];
    encode(image, &mut buffer).unwrap().to_vec()
}

/// The bytes of a model or provenance that decoding would refuse, with a right checksum.
fn forged(model: &Pool, provenance: &Provenance) -> Vec<u8> {
    let mut payload = [0; 8192];
    let provenance = postcard::to_slice(provenance, &mut payload).unwrap().to_vec();
    let mut bytes = Vec::new();
    let model_bytes = postcard::to_slice(model, &mut payload).unwrap();
    bytes.extend(MAGIC);
    bytes.extend(FORMAT_VERSION.to_le_bytes());
    bytes.extend((model.cells.len() as u16).to_le_bytes());
    bytes.extend(((provenance.len() + model_bytes.len()) as u32).to_le_bytes());
    let crc32 = checksum(&[&bytes, &provenance, model_bytes]);
    bytes.extend(crc32.to_le_bytes());
    bytes.extend(provenance);
    bytes.extend(&*model_bytes);
    bytes
}

#[test]
fn an_error_of_law_or_rigid_body_that_is_none_is_refused() {
    let model = table_image(Symmetry::Odd).model;
    for bad in [f32::NAN, f32::INFINITY, -0.5] {
        for law_error in [LawError { slow: bad, sliding: 0.0 }, LawError { slow: 0.0, sliding: bad }] {
            let provenance = Provenance { law_error, ..Provenance::default() };
            assert_eq!(decode::<64>(&forged(&model, &provenance)).unwrap_err(), ImageError::Malformed, "{law_error:?}");
        }
    }
    let mut rigid_body_error = RigidBodyError::default();
    for bad in [f32::NAN, f32::NEG_INFINITY] {
        rigid_body_error.factor[14] = bad;
        let provenance = Provenance { rigid_body_error, ..Provenance::default() };
        assert_eq!(decode::<64>(&forged(&model, &provenance)).unwrap_err(), ImageError::Malformed);
    }
}

#[test]
fn what_is_written_is_read() {
    for symmetry in [Symmetry::Odd, Symmetry::Even, Symmetry::Sided] {
        let image = table_image(symmetry);
        assert_eq!(decode(&encoded(&image)).as_ref(), Ok(&image));
    }
}

#[test]
fn images_are_small() {
    let symmetric = encoded(&table_image(Symmetry::Odd)).len();
    let sided = encoded(&table_image(Symmetry::Sided)).len();
    std::println!("{symmetric} bytes symmetric, {sided} bytes sided");
    assert!(symmetric <= 700 && sided <= 1200);
}

#[test]
fn every_flipped_bit_is_found() {
    let bytes = encoded(&table_image(Symmetry::Sided));
    for bit in (0..8 * bytes.len()).step_by(EVERY) {
        let mut damaged = bytes.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(decode::<64>(&damaged).is_err(), "bit {bit}");
    }
}

#[test]
fn every_failure_has_its_error() {
    let image = table_image(Symmetry::Odd);
    let bytes = encoded(&image);
    let changed = |at: usize, value: u8| {
        let mut changed = bytes.clone();
        changed[at] = value;
        decode::<64>(&changed).unwrap_err()
    };
    for length in (0..bytes.len()).step_by(EVERY) {
        assert_eq!(decode::<64>(&bytes[..length]), Err(ImageError::Truncated), "{length}");
    }
    assert_eq!(changed(0, 0), ImageError::BadMagic);
    assert_eq!(changed(4, 9), ImageError::UnsupportedVersion(9));
    assert_eq!(changed(4, 2), ImageError::UnsupportedVersion(2));
    assert_eq!(changed(4, 5), ImageError::CrcMismatch);
    assert_eq!(changed(11, 1), ImageError::TooLarge);
    assert_eq!(changed(40, 0x55), ImageError::CrcMismatch);
    assert_eq!(decode::<8>(&bytes), Err(ImageError::TooLarge));
    let trailing = [&bytes[..], &[0]].concat();
    assert_eq!(decode::<64>(&trailing), Err(ImageError::TrailingBytes));
    assert_eq!(encode(&image, &mut [0; 100]), Err(ImageError::BufferTooSmall));

    let mut malformed = bytes[..HEADER_BYTES].to_vec();
    malformed.extend([0xFF; 40]);
    malformed[8..12].copy_from_slice(&40u32.to_le_bytes());
    let crc32 = checksum(&[&malformed[..12], &malformed[16..]]);
    malformed[12..16].copy_from_slice(&crc32.to_le_bytes());
    assert_eq!(decode::<64>(&malformed), Err(ImageError::Malformed));
}

/// Of the version before the effects of today, as an earlier writer would have made it.
#[test]
fn effects_of_another_encoding_are_refused_and_no_effects_are_not() {
    let as_version_3 = |model: &Pool| {
        let mut payload = [0; 8192];
        let used = postcard::to_slice(&("axis", "0.1.0", 1u64, 2u64), &mut payload).unwrap().len();
        let used = used + postcard::to_slice(model, &mut payload[used..]).unwrap().len();
        let mut bytes =
            [&MAGIC[..], &[3, 0], &(model.cells.len() as u16).to_le_bytes(), &(used as u32).to_le_bytes()].concat();
        bytes.extend(checksum(&[&bytes, &payload[..used]]).to_le_bytes());
        [&bytes[..], &payload[..used]].concat()
    };
    let mut model = table_image(Symmetry::Odd).model;
    let read = decode::<64>(&as_version_3(&model)).unwrap();
    assert_eq!((&read.model, read.provenance.law_error), (&model, LawError::default()));
    model.inputs.push(input(Quantity::Position)).unwrap();
    model.effects.push(Effect::Spring { stiffness: 1.0, rest: 0.0 }).unwrap();
    assert_eq!(decode::<64>(&as_version_3(&model)), Err(ImageError::UnsupportedVersion(3)));
}

#[test]
fn a_model_that_changes_in_memory_has_another_checksum() {
    let model = table_image(Symmetry::Sided).model;
    let sum = model_checksum(&model);
    let mut changed = model.clone();
    changed.cells[5] = Cell::from_floats([1.0, 0.5, -0.25, 1.0e-3]);
    assert_eq!((model_checksum(&model), model_checksum(&changed) == sum), (sum, false));
}

#[test]
fn models_that_cannot_be_evaluated_are_refused() {
    let good = table_image(Symmetry::Odd).model;
    assert!(decode::<64>(&forged(&good, &Provenance::default())).is_ok());
    let refused = |change: &dyn Fn(&mut Pool), fault: InvalidModel| {
        let mut model = good.clone();
        change(&mut model);
        assert_eq!(decode::<64>(&forged(&model, &Provenance::default())).unwrap_err(), ImageError::InvalidModel(fault));
    };
    refused(&|model| model.inputs.clear(), InvalidModel::NoInput);
    refused(&|model| model.inputs[0].low = 3.0, InvalidModel::InputRange);
    refused(&|model| model.inputs[0].high = f32::INFINITY, InvalidModel::InputRange);
    refused(&|model| model.inputs.push(input(Quantity::Velocity)).unwrap(), InvalidModel::DuplicateInput);
    refused(&|model| model.output_limit = f32::NAN, InvalidModel::OutputLimit);
    refused(&|model| model.output_limit = 0.0, InvalidModel::OutputLimit);
    refused(&|model| model.output_limit = 20.0, InvalidModel::OutputLimit);
    refused(&|model| model.rigid_body.inertia = f32::NAN, InvalidModel::RigidBody);
    refused(&|model| model.cells.truncate(20), InvalidModel::CellOutOfPool);
    for coefficient in [f32::NAN, f32::INFINITY, f32::from_bits(3)] {
        refused(&|model| model.cells[3] = Cell::from_floats([coefficient; 4]), InvalidModel::Coefficient);
    }
    refused(
        &|model| {
            model.law = Law::Expression(Program { operations: heapless::Vec::from_slice(&[Operation::Add]).unwrap() })
        },
        InvalidModel::Program(ProgramFault::MissingOperand),
    );
    let spring = |stiffness| Effect::Spring { stiffness, rest: 0.0 };
    refused(&|model| model.effects.push(spring(1.0)).unwrap(), InvalidModel::EffectInput);
    refused(&|model| model.effects.push(spring(f32::NAN)).unwrap(), InvalidModel::EffectCoefficient);
    refused(
        &|model| {
            let lag = Effect::FrictionalLag { time_constant: 0.01 };
            model.effects.extend([lag.clone(), lag]);
        },
        InvalidModel::LagNotFirst,
    );
    let presliding = |elements: &[Element]| Effect::Presliding {
        smoothing_velocity: 0.01,
        elements: heapless::Vec::from_slice(elements).unwrap(),
    };
    for elements in [&[][..], &[Element { torque: 1.0, distance: 0.0 }], &[Element { torque: -1.0, distance: 1.0e-3 }]]
    {
        refused(&|model| model.effects.push(presliding(elements)).unwrap(), InvalidModel::EffectCoefficient);
    }
}

#[test]
fn effects_are_written_and_read() {
    let mut image = table_image(Symmetry::Odd);
    image.model.law = Law::Expression(Program {
        operations: heapless::Vec::from_slice(&[Operation::ScaledInput(0, 3.0), Operation::Tanh]).unwrap(),
    });
    image.model.inputs.push(input(Quantity::Position)).unwrap();
    let harmonics = [Harmonic { order: 12.5, cosine: 0.1, sine: -0.2 }; 3];
    image.model.effects.extend([
        Effect::Ripple {
            kind: Kind::Friction,
            smoothing_velocity: 0.01,
            harmonics: heapless::Vec::from_slice(&harmonics).unwrap(),
        },
        Effect::Play { half_width: 1.0e-3, torque: 0.5 },
        Effect::Presliding {
            smoothing_velocity: 0.01,
            elements: heapless::Vec::from_slice(&[Element { torque: 1.5, distance: 2.0e-4 }; MAX_ELEMENTS]).unwrap(),
        },
    ]);
    assert_eq!(decode(&encoded(&image)).as_ref(), Ok(&image));
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        prop_assert!(decode::<16>(&bytes).is_err());
    }

    /// Arbitrary payloads behind a right header and checksum reach postcard and validation.
    #[test]
    fn arbitrary_payloads_never_panic(payload in proptest::collection::vec(any::<u8>(), 0..600), cells in 0u16..20) {
        let mut bytes = Vec::from(MAGIC);
        bytes.extend(FORMAT_VERSION.to_le_bytes());
        bytes.extend(cells.to_le_bytes());
        bytes.extend((payload.len() as u32).to_le_bytes());
        let crc32 = checksum(&[&bytes, &payload]);
        bytes.extend(crc32.to_le_bytes());
        bytes.extend(payload);
        let _ = decode::<16>(&bytes);
    }

    /// One changed byte of a good payload, with the checksum made right again, gives an error or a usable model.
    #[test]
    fn changed_payloads_are_refused_or_usable(at in 16usize..500, value in any::<u8>()) {
        let mut bytes = encoded(&table_image(Symmetry::Odd));
        let at = at.min(bytes.len() - 1);
        bytes[at] = value;
        let crc32 = checksum(&[&bytes[..12], &bytes[16..]]);
        bytes[12..16].copy_from_slice(&crc32.to_le_bytes());
        if let Ok(image) = decode::<64>(&bytes) {
            prop_assert!(image.model.validate().is_ok());
        }
    }
}
