//! Two slots of flash as C calls them.

use core::mem::MaybeUninit;

use frikan_runtime::slots::{SLOT_HEADER_BYTES, Which, newest_usable, next_write_beside, slot_header};

use crate::admission::{self, FrikanTrust};
use crate::ffi::{FrikanCompensator, Inner, limits_at, start};
use crate::memory::readable;
use crate::model::Model;
use crate::types::{FRIKAN_SLOT_HEADER_BYTES, FrikanLimits, FrikanSlotWrite, FrikanStatus};

const _: () = assert!(SLOT_HEADER_BYTES == FRIKAN_SLOT_HEADER_BYTES);

/// Starts a compensator with the newest usable image of two slots of flash, which has to stay there.
///
/// @param trust  as for frikan_start
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
    trust: *const FrikanTrust,
    limits: *const FrikanLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (trusted, limits) = unsafe { (admission::at(trust), limits_at(limits)) };
    // SAFETY: the caller's word.
    let (first, second) = unsafe { (readable(first, first_bytes), readable(second, second_bytes)) };
    let Some(limits) = limits else { return FrikanStatus::BadLimits };
    let newest = trusted.and_then(|trusted| newest_usable(first, second, |image| trusted.read(image)));
    let model = newest.map(|(_, model)| Model::Image(model));
    // SAFETY: the caller's word.
    unsafe { start(compensator, Inner::by(model, limits)) }
}

/// The slot to write next, never the one in use. Erase it, program the image, and the header of frikan_slot_header last.
///
/// @param trust  as for frikan_start
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_next_write(
    first: *const u8,
    first_bytes: usize,
    second: *const u8,
    second_bytes: usize,
    trust: *const FrikanTrust,
) -> FrikanSlotWrite {
    // SAFETY: the caller's word.
    let (first, second) = unsafe { (readable(first, first_bytes), readable(second, second_bytes)) };
    // SAFETY: the caller's word.
    let trusted = unsafe { admission::at(trust) };
    let (which, sequence) =
        next_write_beside(first, second, |image| trusted.as_ref().map_err(|error| *error)?.read(image));
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

/// The slot that the drive would take.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrikanSlotInUse {
    /// Active, or why there is none.
    pub status: FrikanStatus,
    /// 0 for the first slot, 1 for the second.
    pub slot: u32,
    /// Number of the slot.
    pub sequence: u32,
    /// Address of its image, for frikan_facts.
    pub image: *const u8,
    /// Bytes of the image and its tag.
    pub bytes: usize,
}

/// The slot that frikan_start_from_slots takes.
///
/// @param trust  as for frikan_start
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_slot_in_use(
    first: *const u8,
    first_bytes: usize,
    second: *const u8,
    second_bytes: usize,
    trust: *const FrikanTrust,
) -> FrikanSlotInUse {
    // SAFETY: the caller's word.
    let (first, second) = unsafe { (readable(first, first_bytes), readable(second, second_bytes)) };
    // SAFETY: the caller's word.
    let newest =
        unsafe { admission::at(trust) }.and_then(|trusted| newest_usable(first, second, |image| trusted.read(image)));
    match newest {
        Err(error) => {
            FrikanSlotInUse { status: error.into(), slot: 0, sequence: 0, image: core::ptr::null(), bytes: 0 }
        }
        Ok((slot, _)) => FrikanSlotInUse {
            status: FrikanStatus::Active,
            slot: u32::from(slot.which == Which::Second),
            sequence: slot.sequence,
            image: slot.image.as_ptr(),
            bytes: slot.image.len(),
        },
    }
}
