//! Slots on flash that C drives: written, found, started from.
#![cfg(feature = "slots")]
#![allow(unsafe_code)]

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use frikan::ffi::{FrikanCompensator, frikan_step};
use frikan::flash::{FrikanFlash, frikan_replace_from_flash, frikan_start_from_flash, frikan_write_image};
use frikan::types::{FrikanLimits, FrikanMeasurement, FrikanStatus};

const IMAGE: &[u8] = include_bytes!("../../../fixtures/stribeck.frk");
const LIMITS: FrikanLimits = FrikanLimits { gain: 1.0, torque: 100.0, slew: 1.0e9, position: 0.0 };
const SLOT: usize = 2048;

/// Flash in memory, of which some bytes cannot be read.
struct Chip {
    bytes: Vec<u8>,
    unreadable: Option<usize>,
    writes: usize,
}

unsafe extern "C" fn read(context: *mut c_void, at: u32, bytes: *mut u8, length: usize) -> bool {
    // SAFETY: the test gives a chip, the library room for so many bytes.
    let (chip, room) = unsafe { (&*context.cast::<Chip>(), std::slice::from_raw_parts_mut(bytes, length)) };
    let range = at as usize..at as usize + length;
    if chip.unreadable.is_some_and(|byte| range.contains(&byte)) {
        return false;
    }
    room.copy_from_slice(&chip.bytes[range]);
    true
}

unsafe extern "C" fn program(context: *mut c_void, at: u32, bytes: *const u8, length: usize) -> bool {
    // SAFETY: the test gives a chip, the library so many bytes.
    let (chip, from) = unsafe { (&mut *context.cast::<Chip>(), std::slice::from_raw_parts(bytes, length)) };
    let room = &mut chip.bytes[at as usize..][..length];
    assert!(at.is_multiple_of(32) && length.is_multiple_of(32) && room.iter().all(|byte| *byte == 0));
    room.copy_from_slice(from);
    chip.writes += 1;
    true
}

unsafe extern "C" fn erase(context: *mut c_void, from: u32, to: u32) -> bool {
    // SAFETY: the test gives a chip.
    let chip = unsafe { &mut *context.cast::<Chip>() };
    chip.bytes[from as usize..to as usize].fill(0);
    true
}

fn zeroed() -> Box<FrikanCompensator> {
    // SAFETY: numbers, of which zero is one.
    unsafe { Box::new(MaybeUninit::zeroed().assume_init()) }
}

#[test]
fn an_image_is_written_found_and_survives_a_word_that_cannot_be_read() {
    let mut chip = Chip { bytes: vec![0xA5; 2 * SLOT], unreadable: None, writes: 0 };
    let flash = FrikanFlash {
        context: (&raw mut chip).cast(),
        read: Some(read),
        program: Some(program),
        erase: Some(erase),
        mapped: chip.bytes.as_ptr(),
        slots: [0, SLOT as u32],
        slot_bytes: SLOT as u32,
        unit: 32,
        sector: 1024,
        erased: 0,
    };
    let mut elbow = zeroed();
    let moving = FrikanMeasurement { velocity: 0.5, ..FrikanMeasurement::default() };
    // SAFETY: references, slices and their lengths, no key, null where it is said.
    unsafe {
        let start = |elbow: &mut FrikanCompensator| frikan_start_from_flash(elbow, &flash, null(), &LIMITS);
        let write = |image: &[u8]| frikan_write_image(&flash, image.as_ptr(), image.len(), null());
        assert_eq!(start(&mut elbow), FrikanStatus::NoImage);
        assert_eq!(write(IMAGE), FrikanStatus::Active);
        assert_eq!(write(IMAGE), FrikanStatus::Active);
        assert_eq!(start(&mut elbow), FrikanStatus::Active);
        assert!(frikan_step(&mut *elbow, &moving, 1.0e-3).torque > 1.0);
        assert_eq!(frikan_replace_from_flash(&mut *elbow, &flash, null()), FrikanStatus::Active);
        assert_eq!(frikan_replace_from_flash(&mut *elbow, null(), null()), FrikanStatus::BadFlash);
        assert_eq!(frikan_replace_from_flash(null_mut(), &flash, null()), FrikanStatus::NotStarted);
        for (first, second) in [(40, FrikanStatus::Active), (SLOT + 40, FrikanStatus::Active)] {
            (*flash.context.cast::<Chip>()).unreadable = Some(first);
            assert_eq!(start(&mut elbow), second);
        }
        (*flash.context.cast::<Chip>()).unreadable = None;
        // What the drive would not take is not written.
        let writes = (*flash.context.cast::<Chip>()).writes;
        assert_ne!(write(&IMAGE[1..]), FrikanStatus::Active);
        assert_eq!((*flash.context.cast::<Chip>()).writes, writes);
        // A drive that does not write, flash that is none.
        let reader = FrikanFlash { program: None, ..flash };
        assert_eq!(frikan_write_image(&reader, IMAGE.as_ptr(), IMAGE.len(), null()), FrikanStatus::NotWritten);
        for bad in [FrikanFlash { unit: 3, ..flash }, FrikanFlash { read: None, ..flash }] {
            assert_eq!(frikan_start_from_flash(&mut *elbow, &bad, null(), &LIMITS), FrikanStatus::BadFlash);
        }
        assert_eq!(frikan_start_from_flash(&mut *elbow, null(), null(), &LIMITS), FrikanStatus::BadFlash);
        assert_eq!(frikan_start_from_flash(null_mut(), &flash, null(), &LIMITS), FrikanStatus::NotStarted);
    }
}
