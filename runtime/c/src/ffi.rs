//! What C calls. Audit: every pointer is tested for null, every length is the caller's word, no reference outlives its call.

use core::ffi::c_void;

use frikan_runtime::compensator::{Limited, Limits};
use frikan_runtime::measurement::Measurement;
use frikan_runtime::shared::authentication::KEY_BYTES;
use frikan_runtime::shared::image::ImageError;
use frikan_runtime::shared::input::MAX_INPUTS;

use crate::admission::{self, FrikanTrust};
use crate::memory::{self, Memory, content, readable};
use crate::model::{ImageModel, Law, Model};
use crate::types::{
    FRIKAN_KEY_BYTES, FRIKAN_OTHER_CHANNELS, FRIKAN_STORAGE_WORDS, FrikanCompensation, FrikanLaw, FrikanLimits,
    FrikanMeasurement, FrikanStatus,
};

/// Friction compensation of one joint. Its memory is the firmware's; its content is the library's. One that lies in zeroed memory is
/// off until it is started.
#[repr(C)]
pub struct FrikanCompensator {
    /// Whether there is a compensator in the memory.
    started: u32,
    /// How often one was started.
    pub(crate) starts: u32,
    /// Its memory.
    storage: [u64; FRIKAN_STORAGE_WORDS],
}

pub(crate) type Inner = Limited<Model>;

const _: () = {
    assert!(size_of::<Inner>() <= 8 * FRIKAN_STORAGE_WORDS && align_of::<Inner>() <= align_of::<u64>());
    assert!(KEY_BYTES == FRIKAN_KEY_BYTES);
    assert!(MAX_INPUTS == FRIKAN_OTHER_CHANNELS);
};

// SAFETY: both fields lie in the memory; size and alignment are asserted above.
unsafe impl Memory for FrikanCompensator {
    type Content = Inner;
    const MARK: u32 = u32::from_le_bytes(*b"FRKC");

    fn parts(memory: *mut Self) -> (*mut u32, *mut Inner) {
        // SAFETY: places of fields, nothing is read.
        unsafe { (&raw mut (*memory).started, (&raw mut (*memory).storage).cast()) }
    }
}

/// Puts a compensator into its memory and says whether it has a model.
///
/// # Safety
/// `memory` is null or may be read and written to.
pub(crate) unsafe fn start(memory: *mut FrikanCompensator, compensator: Inner) -> FrikanStatus {
    let status = compensator.status().into();
    // SAFETY: the caller's word.
    if !unsafe { memory::start(memory, compensator) } {
        return FrikanStatus::NotStarted;
    }
    // SAFETY: the pointer is not null.
    unsafe { count_start(memory) };
    status
}

/// Counts another model.
///
/// # Safety
/// `memory` may be read and written to.
unsafe fn count_start(memory: *mut FrikanCompensator) {
    // SAFETY: the caller's word, and any number is one.
    unsafe {
        let starts = &raw mut (*memory).starts;
        starts.write(starts.read().wrapping_add(1));
    }
}

/// Puts a model in place of the one in force, where there is one to put.
///
/// # Safety
/// As [`content`].
pub(crate) unsafe fn replace(memory: *mut FrikanCompensator, model: Result<ImageModel, ImageError>) -> FrikanStatus {
    // SAFETY: the caller's word.
    let Some(compensator) = (unsafe { content(memory) }) else { return FrikanStatus::NotStarted };
    match model {
        Err(error) => error.into(),
        Ok(model) => {
            compensator.replace(Ok(Model::Image(model)));
            // SAFETY: the pointer is not null.
            unsafe { count_start(memory) };
            FrikanStatus::Active
        }
    }
}

/// Limits of C; none for a null pointer and for limits that cannot be kept.
///
/// # Safety
/// `limits` is null or may be read.
pub(crate) unsafe fn limits_at(limits: *const FrikanLimits) -> Option<Limits> {
    // SAFETY: the caller's word.
    let FrikanLimits { gain, torque, slew, position } = *unsafe { limits.as_ref() }?;
    Limits::new(gain, torque, slew).and_then(|limits| limits.with_position(position)).ok()
}

/// Starts a compensator with the image at an address, which has to stay there: a table is read where it lies. An image that is refused leaves it off, and every step says why; limits that are
/// refused leave the memory as it was.
///
/// @param flash  where the image begins
/// @param bytes  bytes that may be read there; what follows image and tag is not looked at
/// @param trust  what image is taken; null for any
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_start(
    compensator: *mut FrikanCompensator,
    flash: *const u8,
    bytes: usize,
    trust: *const FrikanTrust,
    limits: *const FrikanLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (flash, limits) = unsafe { (readable(flash, bytes), limits_at(limits)) };
    let Some(limits) = limits else { return FrikanStatus::BadLimits };
    // SAFETY: the caller's word.
    let model = unsafe { admission::at(trust) }.and_then(|admission| admission.image_in(flash));
    // SAFETY: the caller's word.
    unsafe { start(compensator, Inner::by(model.map(Model::Image), limits)) }
}

/// Goes on with the image at another address, which has to stay there, without a stop: at the torque put out last, from where the slew limit leads.
/// What effects remember and a supervisor has learnt is gone. An image that is refused leaves the one before in force.
///
/// @param trust  as for frikan_start
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_replace(
    compensator: *mut FrikanCompensator,
    flash: *const u8,
    bytes: usize,
    trust: *const FrikanTrust,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (flash, admission) = unsafe { (readable(flash, bytes), admission::at(trust)) };
    // SAFETY: the caller's word.
    unsafe { replace(compensator, admission.and_then(|admission| admission.image_in(flash))) }
}

/// Starts a compensator with a law of the firmware in place of an image, within the same limits.
///
/// @param law      called once a step with `context`; null leaves the compensator as it was
/// @param context  handed over to the law as it is
///
/// # Safety
/// Pointers are null or good for what their names say, law and context as long as the compensator steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_start_with_law(
    compensator: *mut FrikanCompensator,
    law: FrikanLaw,
    context: *mut c_void,
    limits: *const FrikanLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let Some(limits) = (unsafe { limits_at(limits) }) else { return FrikanStatus::BadLimits };
    let Some(function) = law else { return FrikanStatus::NotStarted };
    // SAFETY: the caller's word.
    unsafe { start(compensator, Inner::by(Ok(Model::Law(Law { function, context })), limits)) }
}

/// Bytes of a FrikanCompensator as this library knows it. Where it is not the size that the firmware knows, FRIKAN_MODELS is not defined as the
/// library was built.
#[unsafe(no_mangle)]
pub extern "C" fn frikan_compensator_bytes() -> usize {
    size_of::<FrikanCompensator>()
}

/// The compensation after a sample period of `dt` seconds. Call it at a fixed rate.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_step(
    compensator: *mut FrikanCompensator,
    measurement: *const FrikanMeasurement,
    dt: f32,
) -> FrikanCompensation {
    // SAFETY: the caller's word.
    let (Some(compensator), Some(measurement)) = (unsafe { (content(compensator), measurement.as_ref()) }) else {
        return FrikanCompensation { torque: 0.0, position: 0.0, status: FrikanStatus::NotStarted };
    };
    let answer = compensator.step(&Measurement::from(measurement), dt);
    FrikanCompensation { torque: answer.torque, position: answer.position, status: answer.status.into() }
}

/// Changes the limits between two steps; the slew limit holds across the change. BadLimits leaves those before in force.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_set_limits(
    compensator: *mut FrikanCompensator,
    limits: *const FrikanLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    match unsafe { (content(compensator), limits_at(limits)) } {
        (None, _) => FrikanStatus::NotStarted,
        (_, None) => FrikanStatus::BadLimits,
        (Some(compensator), Some(limits)) => {
            compensator.set_limits(limits);
            compensator.status().into()
        }
    }
}

/// A measurement of which every channel is missing, to be filled in.
#[unsafe(no_mangle)]
pub extern "C" fn frikan_no_measurement() -> FrikanMeasurement {
    let Measurement { velocity, position, acceleration, load, temperature, other } = Measurement::MISSING;
    FrikanMeasurement { velocity, position, acceleration, load, temperature, other }
}

/// Starts from zero torque, at rest and with nothing wound up; the warmth of the joint stays.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_reset(compensator: *mut FrikanCompensator) {
    // SAFETY: the caller's word.
    if let Some(compensator) = unsafe { content(compensator) } {
        compensator.reset();
    }
}

/// What a step would say of the model: active, or why there is none.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_status(compensator: *mut FrikanCompensator) -> FrikanStatus {
    // SAFETY: the caller's word.
    unsafe { content(compensator) }.map_or(FrikanStatus::NotStarted, |compensator| compensator.status().into())
}

/// CRC-32 of the model as it is now in memory or flash: one that differs from that after the start is damaged. 0 where there is no model or it is a law
/// of the firmware. Not for the control loop: it takes as long as the model is large.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_model_crc(compensator: *mut FrikanCompensator) -> u32 {
    // SAFETY: the caller's word.
    unsafe { content(compensator) }.and_then(|compensator| compensator.checksum()).unwrap_or(0)
}
