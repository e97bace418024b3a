//! Presliding in counts as C calls it. Audit: every pointer is tested for null, no reference outlives its call.

use frikan_runtime::integer::IntegerPresliding;

use crate::integers::FrikanIntegerCompensator;
use crate::memory::{self, Memory, content};
use crate::types::FrikanStatus;

/// Words of a presliding's memory.
pub const FRIKAN_INTEGER_PRESLIDING_WORDS: usize = 8;

/// A contact that bends before it slides, in the firmware's memory. Zeroed memory holds none.
#[repr(C)]
pub struct FrikanIntegerPresliding {
    /// Whether there is a contact in the memory.
    started: u32,
    /// Its memory.
    storage: [u32; FRIKAN_INTEGER_PRESLIDING_WORDS],
}

const _: () = {
    assert!(size_of::<IntegerPresliding>() == 4 * FRIKAN_INTEGER_PRESLIDING_WORDS);
    assert!(align_of::<IntegerPresliding>() <= align_of::<u32>());
};

// SAFETY: both fields lie in the memory; size and alignment are asserted above.
unsafe impl Memory for FrikanIntegerPresliding {
    type Content = IntegerPresliding;
    const MARK: u32 = u32::from_le_bytes(*b"FRKP");

    fn parts(memory: *mut Self) -> (*mut u32, *mut IntegerPresliding) {
        // SAFETY: places of fields, nothing is read.
        unsafe { (&raw mut (*memory).started, (&raw mut (*memory).storage).cast()) }
    }
}

/// Starts a presliding, relaxed: of `torque` counts, which turn over across `distance` counts of the position after a reversal (1 to 2^20);
/// `least_friction`, at least `torque`, is the least that the table has while the joint slides. BadLimits leaves the memory as it was.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_preslide(
    presliding: *mut FrikanIntegerPresliding,
    torque: u16,
    distance: u32,
    least_friction: u16,
) -> FrikanStatus {
    let Ok(contact) = IntegerPresliding::new(torque, distance, least_friction) else { return FrikanStatus::BadLimits };
    // SAFETY: the caller's word.
    if unsafe { memory::start(presliding, contact) } { FrikanStatus::Active } else { FrikanStatus::NotStarted }
}

/// As frikan_integer_step, with presliding; `position` in counts, which may wrap. 0 without a table or a presliding.
///
/// # Safety
/// Pointers are null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_step_with(
    compensator: *mut FrikanIntegerCompensator,
    presliding: *mut FrikanIntegerPresliding,
    velocity: i32,
    position: i32,
) -> i32 {
    // SAFETY: the caller's word.
    match unsafe { (content(compensator), content(presliding)) } {
        (Some(compensator), Some(presliding)) => compensator.step_with(presliding, velocity, position),
        _ => 0,
    }
}
