//! Two slots of flash as C calls them.

use core::mem::MaybeUninit;

use frikan_runtime::slots::{SLOT_HEADER_BYTES, Which, newest_usable, next_write_beside, slot_header};

use crate::ffi::{FrikanCompensator, Inner, key_at, limits_at, readable, start, trust_of};
use crate::model::{Model, read};
use crate::types::{FRIKAN_SLOT_HEADER_BYTES, FrikanLimits, FrikanSlotWrite, FrikanStatus};

const _: () = assert!(SLOT_HEADER_BYTES == FRIKAN_SLOT_HEADER_BYTES);

/// Starts a compensator with the newest usable image of two slots of flash, which has to stay there.
///
/// @param key  FRIKAN_KEY_BYTES, or null for a drive that takes anyone's images
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_start_from_slots(
    compensator: *mut FrikanCompensator,
    first: *const u8,
    first_bytes: usize,
    second: *const u8,
    second_bytes: usize,
    key: *const u8,
    limits: *const FrikanLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (key, limits) = unsafe { (key_at(key), limits_at(limits)) };
    // SAFETY: the caller's word.
    let (first, second) = unsafe { (readable(first, first_bytes), readable(second, second_bytes)) };
    let Some(limits) = limits else { return FrikanStatus::BadLimits };
    let model = key.and_then(|key| {
        let trust = trust_of(key.as_ref());
        newest_usable(first, second, |image| read(image, trust)).map(|(_, model)| Model::Image(model))
    });
    // SAFETY: the caller's word.
    unsafe { start(compensator, Inner::by(model, limits)) }
}

/// The slot to write next, never the one in use. Erase it, program the image, and the header of frikan_slot_header last.
///
/// @param key  FRIKAN_KEY_BYTES, or null for a drive that takes anyone's images
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_next_write(
    first: *const u8,
    first_bytes: usize,
    second: *const u8,
    second_bytes: usize,
    key: *const u8,
) -> FrikanSlotWrite {
    // SAFETY: the caller's word.
    let (key, first, second) = unsafe { (key_at(key), readable(first, first_bytes), readable(second, second_bytes)) };
    let (which, sequence) =
        next_write_beside(first, second, |image| key.clone().and_then(|key| read(image, trust_of(key.as_ref()))));
    FrikanSlotWrite { slot: u32::from(which == Which::Second), sequence }
}

/// Writes the header of a slot, FRIKAN_SLOT_HEADER_BYTES, for an image (and its tag). False where there is none.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_slot_header(sequence: u32, image: *const u8, bytes: usize, header: *mut u8) -> bool {
    // SAFETY: the caller's word.
    let (made, room) = unsafe {
        (slot_header(sequence, readable(image, bytes)), header.cast::<MaybeUninit<[u8; SLOT_HEADER_BYTES]>>().as_mut())
    };
    match (made, room) {
        (Some(made), Some(room)) => {
            room.write(made);
            true
        }
        _ => false,
    }
}
