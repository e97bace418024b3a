//! The integer compensator as C calls it, on the host: bad pointers, memory that was never started, slots.
#![cfg(feature = "integer")]
#![allow(unsafe_code)]

use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use frikan::admission::{FrikanFacts, FrikanTrust, frikan_facts};
use frikan::integers::{
    FRIKAN_INTEGER_ONE, FrikanIntegerCompensator, FrikanIntegerLimits, FrikanUnits, frikan_integer_friction,
    frikan_integer_model_crc, frikan_integer_next_write, frikan_integer_replace, frikan_integer_reset,
    frikan_integer_set_limits, frikan_integer_start, frikan_integer_start_from_slots, frikan_integer_status,
    frikan_integer_step,
};
use frikan::presliding::{FrikanIntegerPresliding, frikan_integer_preslide, frikan_integer_step_with};
use frikan::slots::frikan_slot_header;
use frikan::types::{FrikanSlotWrite, FrikanStatus};
use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, IntegerTableInPlace, Units};

const IMAGE: &[u8] = include_bytes!("../../../fixtures/integers.frk");
const OTHER_LAW: &[u8] = include_bytes!("../../../fixtures/stribeck.frk");
/// Q0.15 and Q5.10, as the image was made for.
const UNITS: FrikanUnits = FrikanUnits { velocity: 1.0 / 32_768.0, torque: 1.0 / 1024.0 };
const LIMITS: FrikanIntegerLimits = FrikanIntegerLimits { gain: FRIKAN_INTEGER_ONE, torque: 32_767, slew: 65_535 };
const ANY: *const FrikanTrust = null();

/// As the static data of a firmware.
fn zeroed<T>() -> Box<T> {
    // SAFETY: words, of which every pattern is one.
    unsafe { Box::new(MaybeUninit::zeroed().assume_init()) }
}

fn start(elbow: &mut FrikanIntegerCompensator, flash: &'static [u8], units: &FrikanUnits) -> FrikanStatus {
    // SAFETY: a slice and its length, references.
    unsafe { frikan_integer_start(elbow, flash.as_ptr(), flash.len(), ANY, units, &LIMITS) }
}

#[test]
fn the_torques_are_those_of_the_runtime() {
    let mut elbow = zeroed();
    assert_eq!(start(&mut elbow, IMAGE, &UNITS), FrikanStatus::Active);
    let units = Units { velocity: UNITS.velocity, torque: UNITS.torque };
    let limits = IntegerLimits::new(LIMITS.gain, LIMITS.torque, LIMITS.slew).unwrap();
    let mut joint = IntegerCompensator::new(IntegerTableInPlace::new(IMAGE, units), limits);
    for velocity in (-40_000..40_000).step_by(13).chain([i32::MIN, i32::MAX, 0]) {
        // SAFETY: references.
        let answers =
            unsafe { (frikan_integer_friction(&mut *elbow, velocity), frikan_integer_step(&mut *elbow, velocity)) };
        assert_eq!(answers, (joint.friction(velocity), joint.step(velocity)), "{velocity}");
    }
    // SAFETY: references.
    unsafe {
        assert_eq!(frikan_integer_model_crc(&mut *elbow), joint.checksum().unwrap());
        let slow = FrikanIntegerLimits { slew: 10, ..LIMITS };
        assert_eq!(frikan_integer_set_limits(&mut *elbow, &slow), FrikanStatus::Active);
        frikan_integer_reset(&mut *elbow);
        assert_eq!(frikan_integer_step(&mut *elbow, 9000), 10);
        for bad in
            [FrikanIntegerLimits { gain: FRIKAN_INTEGER_ONE + 1, ..LIMITS }, FrikanIntegerLimits { slew: 0, ..LIMITS }]
        {
            assert_eq!(frikan_integer_set_limits(&mut *elbow, &bad), FrikanStatus::BadLimits);
        }
        // An image that is refused leaves the one before in force.
        let replaced = frikan_integer_replace(&mut *elbow, OTHER_LAW.as_ptr(), OTHER_LAW.len(), ANY, &UNITS);
        assert_eq!((replaced, frikan_integer_step(&mut *elbow, 9000)), (FrikanStatus::NotBuiltIn, 20));
        let replaced = frikan_integer_replace(&mut *elbow, IMAGE.as_ptr(), IMAGE.len(), ANY, &UNITS);
        assert_eq!((replaced, frikan_integer_step(&mut *elbow, 9000)), (FrikanStatus::Active, 30));
    }
}

#[test]
fn what_is_not_started_or_not_given_puts_out_nothing() {
    let (mut elbow, mut contact) = (zeroed::<FrikanIntegerCompensator>(), zeroed::<FrikanIntegerPresliding>());
    // SAFETY: references, and null.
    unsafe {
        assert_eq!(frikan_integer_step(&mut *elbow, 9000), 0);
        assert_eq!(frikan_integer_step(null_mut(), 9000), 0);
        assert_eq!(frikan_integer_status(&mut *elbow), FrikanStatus::NotStarted);
        assert_eq!(frikan_integer_set_limits(&mut *elbow, &LIMITS), FrikanStatus::NotStarted);
        let (flash, bytes) = (IMAGE.as_ptr(), IMAGE.len());
        assert_eq!(frikan_integer_replace(&mut *elbow, flash, bytes, ANY, &UNITS), FrikanStatus::NotStarted);
        assert_eq!(frikan_integer_start(&mut *elbow, flash, bytes, ANY, &UNITS, null()), FrikanStatus::BadLimits);
        assert_eq!(frikan_integer_start(null_mut(), flash, bytes, ANY, &UNITS, &LIMITS), FrikanStatus::NotStarted);
        assert_eq!(frikan_integer_start(&mut *elbow, flash, bytes, ANY, null(), &LIMITS), FrikanStatus::OtherUnit);
        assert_eq!(frikan_integer_start(&mut *elbow, null(), bytes, ANY, &UNITS, &LIMITS), FrikanStatus::Truncated);
        assert_eq!((frikan_integer_step(&mut *elbow, 9000), frikan_integer_model_crc(&mut *elbow)), (0, 0));
        assert_eq!(frikan_integer_status(&mut *elbow), FrikanStatus::Truncated);
    }
    let wrong = FrikanUnits { torque: 0.001, ..UNITS };
    assert_eq!(start(&mut elbow, IMAGE, &wrong), FrikanStatus::OtherUnit);
    assert_eq!(start(&mut elbow, OTHER_LAW, &UNITS), FrikanStatus::NotBuiltIn);
    assert_eq!(start(&mut elbow, IMAGE, &UNITS), FrikanStatus::Active);
    // SAFETY: references, and null.
    unsafe {
        assert_eq!(frikan_integer_step_with(&mut *elbow, &mut *contact, 9000, 0), 0);
        assert_eq!(frikan_integer_preslide(&mut *contact, 9000, 50, 8000), FrikanStatus::BadLimits);
        assert_eq!(frikan_integer_preslide(null_mut(), 8000, 50, 8000), FrikanStatus::NotStarted);
        assert_eq!(frikan_integer_preslide(&mut *contact, 8000, 50, 8000), FrikanStatus::Active);
        let table = frikan_integer_friction(&mut *elbow, 9000);
        assert_eq!(frikan_integer_step_with(&mut *elbow, &mut *contact, 9000, 0), table - 8000);
        assert_eq!(frikan_integer_step_with(&mut *elbow, &mut *contact, 9000, 5000), table);
    }
}

#[test]
fn the_newest_slot_is_taken_and_the_other_written() {
    let flash: &'static mut [u8] = Box::leak(vec![0xFF; 4096].into_boxed_slice());
    let mut header = [0; 16];
    // SAFETY: a slice and its length, room for a header.
    assert!(unsafe { frikan_slot_header(7, IMAGE.as_ptr(), IMAGE.len(), header.as_mut_ptr()) });
    flash[2048..][..16].copy_from_slice(&header);
    flash[2048 + 16..][..IMAGE.len()].copy_from_slice(IMAGE);
    let (first, second) = flash.split_at(2048);
    let mut elbow = zeroed();
    // SAFETY: slices and their lengths, references.
    unsafe {
        let (a, b) = (first.as_ptr(), second.as_ptr());
        let status = frikan_integer_start_from_slots(&mut *elbow, a, 2048, b, 2048, ANY, &UNITS, &LIMITS);
        assert_eq!(status, FrikanStatus::Active);
        assert!(frikan_integer_step(&mut *elbow, 9000) > 0);
        let write = frikan_integer_next_write(a, 2048, b, 2048, ANY, &UNITS);
        assert_eq!(write, FrikanSlotWrite { slot: 0, sequence: 8 });
    }
}

#[test]
fn an_integer_image_says_what_it_is() {
    let mut facts = MaybeUninit::<FrikanFacts>::zeroed();
    // SAFETY: a slice and its length, room for facts, which are words.
    let (status, facts) =
        unsafe { (frikan_facts(IMAGE.as_ptr(), IMAGE.len(), ANY, facts.as_mut_ptr()), facts.assume_init()) };
    assert_eq!((status, facts.channels), (FrikanStatus::Active, 1));
    assert_eq!(facts.crc32.to_le_bytes(), IMAGE[12..16]);
}
