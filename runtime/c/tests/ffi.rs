//! The functions as C calls them, on the host: bad pointers, memory that was never started, slots.
#![allow(unsafe_code)]

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use frikan::admission::{
    FRIKAN_CHANNEL_POSITION, FRIKAN_CHANNEL_VELOCITY, FRIKAN_UNIT_AMPERE, FRIKAN_UNIT_NEWTON_METRE, FrikanFacts,
    FrikanTrust, frikan_facts,
};
use frikan::ffi::{
    FrikanCompensator, frikan_compensator_bytes, frikan_model_crc, frikan_no_measurement, frikan_replace, frikan_reset,
    frikan_set_limits, frikan_start, frikan_start_with_law, frikan_status, frikan_step,
};
use frikan::keep::{FrikanLearnt, frikan_learnt, frikan_restore_learnt};
use frikan::slots::{frikan_next_write, frikan_slot_header, frikan_slot_in_use, frikan_start_from_slots};
use frikan::supervised::{
    FrikanAdaptation, FrikanSample, FrikanSupervision, FrikanSupervisor, frikan_clear_fault, frikan_forget,
    frikan_set_inertia, frikan_supervise, frikan_supervised_step, frikan_supervision,
};
use frikan::types::{FrikanLimits, FrikanMeasurement, FrikanSlotWrite, FrikanStatus};

const IMAGE: &[u8] = include_bytes!("../../../fixtures/stribeck.frk");
const LIMITS: FrikanLimits = FrikanLimits { gain: 1.0, torque: 100.0, slew: 1.0e9, position: 0.0 };
const MOVING: FrikanMeasurement =
    FrikanMeasurement { velocity: 0.5, position: 0.0, acceleration: 0.0, load: 0.0, temperature: 0.0, other: [0.0; 4] };

const ANY: FrikanTrust =
    FrikanTrust { key: null(), public_key: null(), joint: null(), unit: 0, channels: 0, least_release: 0 };

/// As the static data of a firmware.
fn zeroed() -> Box<FrikanCompensator> {
    // SAFETY: words, of which every pattern is one.
    unsafe { Box::new(MaybeUninit::zeroed().assume_init()) }
}

fn zeroed_supervisor() -> Box<FrikanSupervisor> {
    // SAFETY: words, of which every pattern is one.
    unsafe { Box::new(MaybeUninit::zeroed().assume_init()) }
}

fn step(compensator: &mut FrikanCompensator) -> (f32, FrikanStatus) {
    // SAFETY: references.
    let answer = unsafe { frikan_step(compensator, &MOVING, 1.0e-3) };
    (answer.torque, answer.status)
}

fn start(compensator: &mut FrikanCompensator, flash: &[u8], key: Option<&[u8; 32]>) -> FrikanStatus {
    let trust = FrikanTrust { key: key.map_or(null(), |key| key.as_ptr()), ..ANY };
    // SAFETY: a slice and its length, an array of a key's length.
    unsafe { frikan_start(compensator, flash.as_ptr(), flash.len(), &trust, &LIMITS) }
}

#[test]
fn a_compensator_is_off_until_it_has_an_image() {
    let mut elbow = zeroed();
    assert_eq!(step(&mut elbow), (0.0, FrikanStatus::NotStarted));
    assert_eq!(start(&mut elbow, &IMAGE[..20], None), FrikanStatus::Truncated);
    assert_eq!(step(&mut elbow), (0.0, FrikanStatus::Truncated));
    assert_eq!(start(&mut elbow, &[], None), FrikanStatus::Truncated);
    let flash = [IMAGE, &[0xFF; 64]].concat();
    assert_eq!(start(&mut elbow, &flash, None), FrikanStatus::Active);
    let (torque, status) = step(&mut elbow);
    assert!(torque > 10.0 && status == FrikanStatus::Active);
    // SAFETY: references.
    unsafe {
        let _ = frikan_set_limits(&mut *elbow, &FrikanLimits { torque: 3.0, ..LIMITS });
        for bad in [FrikanLimits { gain: f32::NAN, ..LIMITS }, FrikanLimits { position: -1.0, ..LIMITS }] {
            assert_eq!(frikan_set_limits(&mut *elbow, &bad), FrikanStatus::BadLimits);
        }
        assert_eq!(frikan_step(&mut *elbow, &MOVING, 1.0e-3).torque, 3.0);
        frikan_reset(&mut *elbow);
        let answer = frikan_step(&mut *elbow, &FrikanMeasurement { velocity: f32::NAN, ..MOVING }, 1.0e-3);
        assert_eq!((answer.torque, answer.status), (0.0, FrikanStatus::NotFinite));
    }
}

#[test]
fn a_supervisor_watches_over_a_compensator() {
    let (mut elbow, mut watch) = (zeroed(), zeroed_supervisor());
    let sample = FrikanSample { measurement: MOVING, reference_velocity: 0.5, loop_torque: 40.0 };
    // SAFETY: references, and null where it is said.
    unsafe {
        let step = |watch: &mut FrikanSupervisor, elbow: &mut FrikanCompensator| {
            frikan_supervised_step(watch, elbow, &sample, 1.0e-3)
        };
        assert_eq!(step(&mut watch, &mut elbow).status, FrikanStatus::NotStarted);
        assert_eq!(start(&mut elbow, IMAGE, None), FrikanStatus::Active);
        let settings = frikan_supervision(0.5, 20.0, 6.0e-6);
        for bad in [
            FrikanSupervision { inertia: -1.0, ..settings },
            FrikanSupervision { fall_time: 0.0, ..settings },
            FrikanSupervision { count: f32::INFINITY, ..settings },
            FrikanSupervision { standstill: 0.0, ..settings },
            FrikanSupervision { rest_velocity: f32::NAN, ..settings },
            FrikanSupervision { adaptation: FrikanAdaptation { memory: 1.0, ..settings.adaptation }, ..settings },
        ] {
            assert_eq!(frikan_supervise(&mut *watch, &bad), FrikanStatus::BadSupervision);
        }
        assert_eq!(frikan_supervise(&mut *watch, null()), FrikanStatus::BadSupervision);
        assert_eq!(frikan_supervise(null_mut(), &settings), FrikanStatus::NotStarted);
        assert_eq!(frikan_supervise(&mut *watch, &settings), FrikanStatus::Active);
        let answer = step(&mut watch, &mut elbow);
        assert!(answer.torque > 10.0 && answer.gain_share == 1.0 && answer.level == 1.0, "{answer:?}");
        assert_eq!(answer.status, FrikanStatus::Active);
        // The position stands still while the velocity does not.
        let later: Vec<_> = (0..1000).map(|_| step(&mut watch, &mut elbow)).collect();
        assert_eq!(later.last().unwrap().status, FrikanStatus::Implausible);
        assert_eq!(later.last().unwrap().torque, 0.0);
        frikan_clear_fault(&mut *watch);
        frikan_clear_fault(null_mut());
        assert!(step(&mut watch, &mut elbow).torque > 10.0);
        frikan_forget(&mut *watch);
        frikan_forget(null_mut());
        assert_eq!(frikan_supervised_step(&mut *watch, &mut *elbow, null(), 1.0e-3).status, FrikanStatus::NotStarted);
        assert_eq!(frikan_supervised_step(&mut *watch, null_mut(), &sample, 1.0e-3).status, FrikanStatus::NotStarted);
    }
}

#[test]
fn an_image_is_replaced_without_a_stop() {
    let mut elbow = zeroed();
    let limits = FrikanLimits { slew: 2000.0, ..LIMITS };
    let mut calls = 0u32;
    // SAFETY: references, slices and their lengths, and null where it is said.
    unsafe {
        let replace =
            |memory: *mut FrikanCompensator, image: &[u8]| frikan_replace(memory, image.as_ptr(), image.len(), null());
        assert_eq!(replace(&mut *elbow, IMAGE), FrikanStatus::NotStarted);
        assert_eq!(replace(null_mut(), IMAGE), FrikanStatus::NotStarted);
        frikan_start_with_law(&mut *elbow, Some(coulomb), (&raw mut calls).cast(), &limits);
        let mut torque = 0.0;
        for _ in 0..20 {
            torque = step(&mut elbow).0;
        }
        assert_eq!(torque, 8.0);
        // One that is refused leaves the one before in force.
        assert_eq!(replace(&mut *elbow, &IMAGE[..20]), FrikanStatus::Truncated);
        assert_eq!(step(&mut elbow), (8.0, FrikanStatus::Active));
        assert_eq!(replace(&mut *elbow, &[IMAGE, &[0xFF; 9]].concat()), FrikanStatus::Active);
        assert_eq!(step(&mut elbow), (10.0, FrikanStatus::Active));
    }
}

/// What a supervisor has learnt on the image is forgotten with it, and kept by the firmware where it wants.
#[test]
fn what_was_learnt_is_kept_by_the_firmware_and_forgotten_with_the_image() {
    let (mut elbow, mut watch) = (zeroed(), zeroed_supervisor());
    assert_eq!(start(&mut elbow, IMAGE, None), FrikanStatus::Active);
    let mut settings = frikan_supervision(0.5, 20.0, 0.0);
    settings.adaptation = FrikanAdaptation {
        lowest_level: 0.5,
        highest_level: 2.0,
        viscous: 0.0,
        offset: 0.0,
        memory: 0.5,
        trusted_torque: 0.1,
    };
    // SAFETY: references, a slice and its length, and null where it is said.
    unsafe {
        assert_eq!(frikan_supervise(&mut *watch, &settings), FrikanStatus::Active);
        assert_eq!(frikan_set_inertia(&mut *watch, 0.7), FrikanStatus::Active);
        assert_eq!(frikan_set_inertia(&mut *watch, f32::NAN), FrikanStatus::BadSupervision);
        assert_eq!(frikan_set_inertia(null_mut(), 0.7), FrikanStatus::NotStarted);
        let mut position = 0.0;
        let mut step = |watch: &mut FrikanSupervisor, elbow: &mut FrikanCompensator| {
            position += 0.5e-3;
            let sample = FrikanSample {
                measurement: FrikanMeasurement { position, ..MOVING },
                reference_velocity: 0.5,
                loop_torque: 15.0,
            };
            frikan_supervised_step(watch, elbow, &sample, 1.0e-3).level
        };
        let level = (0..2000).map(|_| step(&mut watch, &mut elbow)).last().unwrap();
        assert!(level > 1.5, "{level}");
        let learnt = frikan_learnt(&mut *watch);
        assert_eq!(frikan_learnt(null_mut()), FrikanLearnt::default());
        // Another start of the drive.
        assert_eq!(frikan_supervise(&mut *watch, &settings), FrikanStatus::Active);
        frikan_restore_learnt(&mut *watch, &learnt);
        frikan_restore_learnt(null_mut(), null());
        assert_eq!(step(&mut watch, &mut elbow), level);
        assert_eq!(frikan_replace(&mut *elbow, IMAGE.as_ptr(), IMAGE.len(), null()), FrikanStatus::Active);
        assert_eq!(step(&mut watch, &mut elbow), 1.0);
    }
}

#[cfg(feature = "effects")]
#[test]
fn warmth_is_kept_by_the_firmware() {
    use frikan::keep::{FrikanWarmth, frikan_restore, frikan_warmth};
    use frikan_runtime::shared::effect::Effect;
    use frikan_runtime::shared::image::{decode, encode};
    let mut image = decode::<128>(IMAGE).unwrap();
    let warm_up = Effect::WarmUp {
        time_constant: 100.0,
        coulomb: -0.1,
        viscous: 0.0,
        power_limit: 20.0,
        smoothing_velocity: 0.02,
    };
    assert!(image.model.effects.push(warm_up).is_ok());
    let mut buffer = [0; 4096];
    let image = encode(&image, &mut buffer).unwrap();
    let mut elbow = zeroed();
    assert_eq!(start(&mut elbow, image, None), FrikanStatus::Active);
    let cold = step(&mut elbow).0;
    // SAFETY: references, and null where it is said.
    unsafe {
        (0..5000).for_each(|_| _ = step(&mut elbow));
        let warmth = frikan_warmth(&mut *elbow);
        let warm = step(&mut elbow).0;
        assert!(warmth.power[0] > 0.0 && warm < cold, "{warmth:?}");
        assert_eq!(start(&mut elbow, image, None), FrikanStatus::Active);
        frikan_restore(&mut *elbow, &warmth, 0.0);
        assert!((step(&mut elbow).0 - warm).abs() < 1.0e-3);
        assert_eq!(frikan_warmth(null_mut()), FrikanWarmth::default());
        frikan_restore(null_mut(), null(), 0.0);
    }
}

#[test]
fn null_pointers_leave_everything_off() {
    let mut elbow = zeroed();
    // SAFETY: null is what every function is ready for.
    unsafe {
        assert_eq!(frikan_start(null_mut(), IMAGE.as_ptr(), IMAGE.len(), null(), &LIMITS), FrikanStatus::NotStarted);
        assert_eq!(frikan_start(&mut *elbow, null(), 100, null(), &LIMITS), FrikanStatus::Truncated);
        assert_eq!(frikan_start(&mut *elbow, IMAGE.as_ptr(), IMAGE.len(), null(), null()), FrikanStatus::BadLimits);
        assert_eq!(frikan_step(&mut *elbow, &MOVING, 1.0e-3).torque, 0.0);
        let missing = frikan_no_measurement();
        assert_eq!(frikan_start(&mut *elbow, IMAGE.as_ptr(), IMAGE.len(), null(), &LIMITS), FrikanStatus::Active);
        assert_eq!(frikan_step(&mut *elbow, &missing, 1.0e-3).status, FrikanStatus::NotFinite);
        assert_eq!(frikan_step(&mut *elbow, null(), 1.0e-3).status, FrikanStatus::NotStarted);
        assert_eq!(frikan_step(null_mut(), &MOVING, 1.0e-3).status, FrikanStatus::NotStarted);
        assert!(!frikan_slot_header(1, IMAGE.as_ptr(), IMAGE.len(), null_mut()));
        assert_eq!(frikan_set_limits(null_mut(), &LIMITS), FrikanStatus::NotStarted);
        frikan_reset(null_mut());
    }
}

#[test]
fn an_image_says_what_it_is_and_has_to_be_what_is_asked_for() {
    let mut elbow = zeroed();
    let mut facts: MaybeUninit<FrikanFacts> = MaybeUninit::zeroed();
    let start = |elbow: &mut FrikanCompensator, trust: FrikanTrust| {
        // SAFETY: a slice and its length, references.
        unsafe { frikan_start(elbow, IMAGE.as_ptr(), IMAGE.len(), &trust, &LIMITS) }
    };
    let fitting =
        FrikanTrust { joint: c"".as_ptr(), unit: FRIKAN_UNIT_NEWTON_METRE, channels: FRIKAN_CHANNEL_VELOCITY, ..ANY };
    assert_eq!(start(&mut elbow, fitting), FrikanStatus::Active);
    // SAFETY: slices and their lengths, references, and null where it is said.
    unsafe {
        assert_eq!(frikan_status(&mut *elbow), FrikanStatus::Active);
        assert_eq!((frikan_status(null_mut()), frikan_model_crc(null_mut())), (FrikanStatus::NotStarted, 0));
        let sum = frikan_model_crc(&mut *elbow);
        (0..10).for_each(|_| _ = step(&mut elbow));
        assert!(sum != 0 && frikan_model_crc(&mut *elbow) == sum);
        assert_eq!(frikan_facts(IMAGE.as_ptr(), IMAGE.len(), &fitting, facts.as_mut_ptr()), FrikanStatus::Active);
        let facts = facts.assume_init();
        let crc32 = u32::from_le_bytes(IMAGE[12..16].try_into().unwrap());
        assert_eq!(
            (facts.joint[0], facts.unit, facts.channels),
            (0, FRIKAN_UNIT_NEWTON_METRE, FRIKAN_CHANNEL_VELOCITY)
        );
        assert_eq!((facts.release, facts.crc32), (0, crc32));
        assert_eq!(frikan_facts(IMAGE.as_ptr(), IMAGE.len(), null(), null_mut()), FrikanStatus::NotStarted);
        assert_eq!(frikan_facts(IMAGE.as_ptr(), 20, null(), null_mut()), FrikanStatus::Truncated);
    }
    for (trust, status) in [
        (FrikanTrust { joint: c"wrist".as_ptr(), ..fitting }, FrikanStatus::OtherJoint),
        (FrikanTrust { unit: FRIKAN_UNIT_AMPERE, ..fitting }, FrikanStatus::OtherUnit),
        (FrikanTrust { unit: 99, ..fitting }, FrikanStatus::OtherUnit),
        (FrikanTrust { channels: FRIKAN_CHANNEL_POSITION, ..fitting }, FrikanStatus::MissingChannel),
        (FrikanTrust { least_release: 1, ..fitting }, FrikanStatus::Outdated),
    ] {
        assert_eq!(start(&mut elbow, trust), status);
        assert_eq!(step(&mut elbow), (0.0, status));
    }
}

#[cfg(feature = "auth")]
#[test]
fn a_key_asks_for_its_tag() {
    use frikan_runtime::shared::authentication::{Key, release_block};
    let key = [9; 32];
    let tagged = [IMAGE, &Key::new(key).tag(IMAGE), &[0xFF; 8]].concat();
    let release = [IMAGE, &release_block(7)].concat();
    let release = [&release[..], &Key::new(key).tag(&release), &[0xFF; 8]].concat();
    let mut elbow = zeroed();
    assert_eq!(start(&mut elbow, &tagged, Some(&key)), FrikanStatus::Active);
    for (bytes, least_release, status) in [
        (&release, 7, FrikanStatus::Active),
        (&release, 8, FrikanStatus::Outdated),
        (&tagged, 0, FrikanStatus::Active),
        (&tagged, 1, FrikanStatus::Outdated),
    ] {
        let trust = FrikanTrust { key: key.as_ptr(), least_release, ..ANY };
        // SAFETY: a slice and its length, references.
        assert_eq!(unsafe { frikan_start(&mut *elbow, bytes.as_ptr(), bytes.len(), &trust, &LIMITS) }, status);
    }
    assert_eq!(start(&mut elbow, &tagged, Some(&[8; 32])), FrikanStatus::NotAuthentic);
    assert_eq!(step(&mut elbow), (0.0, FrikanStatus::NotAuthentic));
    assert_eq!(start(&mut elbow, &[IMAGE, &[0xFF; 64]].concat(), Some(&key)), FrikanStatus::NotAuthentic);
}

fn start_signed(compensator: &mut FrikanCompensator, flash: &[u8], trust: FrikanTrust) -> FrikanStatus {
    // SAFETY: a slice and its length, a reference to keys that outlive the call.
    unsafe { frikan_start(compensator, flash.as_ptr(), flash.len(), &trust, &LIMITS) }
}

#[cfg(feature = "signature")]
#[test]
fn a_public_key_asks_for_the_signature_of_its_secret() {
    use frikan_runtime::shared::authentication::release_block;
    use frikan_runtime::shared::authentication::signature::Signer;
    let (signer, other) = (Signer::new([9; 32]), Signer::new([8; 32]));
    let key = signer.public_key();
    let trust = FrikanTrust { public_key: key.as_ptr(), ..ANY };
    let signed = [IMAGE, &signer.sign(IMAGE), &[0xFF; 8]].concat();
    let release = [IMAGE, &release_block(7)].concat();
    let release = [&release[..], &signer.sign(&release)].concat();
    let mut forged = signed.clone();
    forged[IMAGE.len() + 5] ^= 1;
    let mut elbow = zeroed();
    for (flash, trust, status) in [
        (&signed, trust, FrikanStatus::Active),
        (&forged, trust, FrikanStatus::NotAuthentic),
        (&[IMAGE, &other.sign(IMAGE)].concat(), trust, FrikanStatus::NotAuthentic),
        (&[IMAGE, &[0xFF; 80]].concat(), trust, FrikanStatus::NotAuthentic),
        (&release, FrikanTrust { least_release: 7, ..trust }, FrikanStatus::Active),
        (&release, FrikanTrust { least_release: 8, ..trust }, FrikanStatus::Outdated),
        // What asks for both takes nothing.
        (&signed, FrikanTrust { key: key.as_ptr(), ..trust }, FrikanStatus::NotAuthentic),
    ] {
        assert_eq!(start_signed(&mut elbow, flash, trust), status);
        assert_eq!(step(&mut elbow).1, status);
    }
}

/// A public key that nobody can check is no reason to start.
#[cfg(not(feature = "signature"))]
#[test]
fn a_public_key_is_refused_by_a_library_without_signatures() {
    let mut elbow = zeroed();
    let trust = FrikanTrust { public_key: [9; 32].as_ptr(), ..ANY };
    assert_eq!(start_signed(&mut elbow, IMAGE, trust), FrikanStatus::NotBuiltIn);
    assert_eq!(step(&mut elbow), (0.0, FrikanStatus::NotBuiltIn));
}

/// A key that nobody can check is no reason to start.
#[cfg(not(feature = "auth"))]
#[test]
fn a_key_is_refused_by_a_library_without_authentication() {
    let mut elbow = zeroed();
    assert_eq!(start(&mut elbow, IMAGE, Some(&[9; 32])), FrikanStatus::NotBuiltIn);
    assert_eq!(step(&mut elbow), (0.0, FrikanStatus::NotBuiltIn));
}

/// A decoded formula takes more memory than a table in flash.
#[test]
fn a_formula_is_taken_by_a_library_with_formulas() {
    let formula = include_bytes!("../../../fixtures/elbow.frk");
    let expected = if cfg!(feature = "expression") { FrikanStatus::Active } else { FrikanStatus::NotBuiltIn };
    assert_eq!(start(&mut zeroed(), formula, None), expected);
    assert_eq!(frikan_compensator_bytes(), size_of::<FrikanCompensator>());
}

/// Calls so far, beside the law.
unsafe extern "C" fn coulomb(calls: *mut c_void, sample: *const FrikanMeasurement, _: f32) -> f32 {
    // SAFETY: the test gives a counter, the library a sample.
    unsafe {
        *calls.cast::<u32>() += 1;
        8.0 * (*sample).velocity.signum()
    }
}

#[test]
fn a_law_of_the_firmware_stands_within_the_limits() {
    let (mut elbow, mut calls) = (zeroed(), 0u32);
    let limits = FrikanLimits { gain: 0.5, torque: 3.0, ..LIMITS };
    // SAFETY: references, and null where it is said.
    unsafe {
        let context = (&raw mut calls).cast();
        assert_eq!(frikan_start_with_law(&mut *elbow, None, context, &limits), FrikanStatus::NotStarted);
        assert_eq!(frikan_start_with_law(&mut *elbow, Some(coulomb), context, null()), FrikanStatus::BadLimits);
        assert_eq!(frikan_start_with_law(&mut *elbow, Some(coulomb), context, &limits), FrikanStatus::Active);
        assert_eq!(step(&mut elbow), (3.0, FrikanStatus::Active));
        let missing = frikan_step(&mut *elbow, &frikan_no_measurement(), 1.0e-3);
        assert_eq!((missing.torque, missing.status), (0.0, FrikanStatus::NotFinite));
        // A period that is none does not reach the law.
        assert_eq!(frikan_step(&mut *elbow, &MOVING, 0.0).status, FrikanStatus::NotFinite);
    }
    assert_eq!(calls, 2);
}

#[test]
fn an_update_goes_to_the_slot_that_is_not_in_use() {
    let mut flash = [vec![0xFF; 2048], vec![0xFF; 2048]];
    let mut elbow = zeroed();
    for round in 1..=3 {
        let [first, second] = &flash;
        // SAFETY: slices and their lengths, no key.
        let write = unsafe { frikan_next_write(first.as_ptr(), first.len(), second.as_ptr(), second.len(), null()) };
        assert_eq!(write, FrikanSlotWrite { slot: (round + 1) % 2, sequence: round });
        let mut header = [0; 16];
        // SAFETY: a slice and its length, room for a header.
        assert!(unsafe { frikan_slot_header(write.sequence, IMAGE.as_ptr(), IMAGE.len(), header.as_mut_ptr()) });
        let slot = &mut flash[write.slot as usize];
        slot[16..16 + IMAGE.len()].copy_from_slice(IMAGE);
        slot[..16].copy_from_slice(&header);
        let [first, second] = &flash;
        // SAFETY: slices and their lengths, no key.
        let status = unsafe {
            frikan_start_from_slots(
                &mut *elbow,
                first.as_ptr(),
                first.len(),
                second.as_ptr(),
                second.len(),
                null(),
                &LIMITS,
            )
        };
        assert_eq!(status, FrikanStatus::Active);
        assert!(step(&mut elbow).0 > 10.0);
        // SAFETY: slices and their lengths, any image.
        let used = unsafe { frikan_slot_in_use(first.as_ptr(), first.len(), second.as_ptr(), second.len(), null()) };
        assert_eq!((used.status, used.slot, used.sequence), (FrikanStatus::Active, write.slot, round));
        assert_eq!((used.image, used.bytes), (flash[write.slot as usize][16..].as_ptr(), IMAGE.len()));
    }
}
