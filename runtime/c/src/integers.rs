//! The integer compensator as C calls it. Audit: every pointer is tested for null, every length is the caller's word, no reference outlives its call.

use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, IntegerTableInPlace, Units};
use frikan_runtime::shared::image::ImageError;
#[cfg(feature = "slots")]
use frikan_runtime::slots::{Which, newest_usable, next_write_beside};

use crate::admission::{self, FrikanTrust, Trusted};
use crate::memory::{self, Memory, content, readable};
#[cfg(feature = "slots")]
use crate::types::FrikanSlotWrite;
use crate::types::FrikanStatus;

/// Gain of one.
pub const FRIKAN_INTEGER_ONE: u16 = 32768;

/// Words of an integer compensator's memory.
pub const FRIKAN_INTEGER_STORAGE_WORDS: usize = 24;

/// Friction compensation of one joint in whole numbers, for drives without floating-point unit: its table lies in flash. Its memory is the
/// firmware's; its content is the library's. One that lies in zeroed memory is off until it is started.
#[repr(C)]
pub struct FrikanIntegerCompensator {
    /// Whether there is a compensator in the memory.
    started: u32,
    /// Its memory.
    storage: [usize; FRIKAN_INTEGER_STORAGE_WORDS],
}

type Inner = IntegerCompensator<'static>;

const _: () = {
    assert!(size_of::<Inner>() <= size_of::<[usize; FRIKAN_INTEGER_STORAGE_WORDS]>());
    assert!(align_of::<Inner>() <= align_of::<usize>());
    assert!(FRIKAN_INTEGER_ONE == frikan_runtime::integer::ONE);
};

// SAFETY: both fields lie in the memory; size and alignment are asserted above.
unsafe impl Memory for FrikanIntegerCompensator {
    type Content = Inner;
    const MARK: u32 = u32::from_le_bytes(*b"FRKI");

    fn parts(memory: *mut Self) -> (*mut u32, *mut Inner) {
        // SAFETY: places of fields, nothing is read.
        unsafe { (&raw mut (*memory).started, (&raw mut (*memory).storage).cast()) }
    }
}

/// What a count of the drive is worth, both above 0: an image whose steps are not counts times powers of two is refused as one of another unit.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanUnits {
    /// A count of the velocity, rad/s or m/s.
    pub velocity: f32,
    /// A count of the torque, in the unit of the model's output.
    pub torque: f32,
}

/// Limits of the firmware in counts; no image changes them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanIntegerLimits {
    /// Share of the friction that is compensated, in 2^-15: at most FRIKAN_INTEGER_ONE.
    pub gain: u16,
    /// Largest torque put out, counts, at most 32767.
    pub torque: u16,
    /// Its largest change in a step, counts, at least 1.
    pub slew: u16,
}

/// Limits of C; none for a null pointer and for limits that cannot be kept.
///
/// # Safety
/// `limits` is null or may be read.
unsafe fn limits_at(limits: *const FrikanIntegerLimits) -> Option<IntegerLimits> {
    // SAFETY: the caller's word.
    let FrikanIntegerLimits { gain, torque, slew } = *unsafe { limits.as_ref() }?;
    IntegerLimits::new(gain, torque, slew).ok()
}

/// The units of C; those that no image has for a null pointer.
///
/// # Safety
/// `units` is null or may be read.
unsafe fn units_at(units: *const FrikanUnits) -> Units {
    // SAFETY: the caller's word.
    unsafe { units.as_ref() }.map_or(Units { velocity: 0.0, torque: 0.0 }, |units| {
        let FrikanUnits { velocity, torque } = *units;
        Units { velocity, torque }
    })
}

/// Puts a compensator into its memory and says whether it has a table.
///
/// # Safety
/// `memory` is null or may be written to.
unsafe fn start(
    memory: *mut FrikanIntegerCompensator,
    table: Result<IntegerTableInPlace<'static>, ImageError>,
    limits: IntegerLimits,
) -> FrikanStatus {
    let started = Inner::new(table, limits);
    let status = started.status().into();
    // SAFETY: the caller's word.
    if unsafe { memory::start(memory, started) } { status } else { FrikanStatus::NotStarted }
}

impl Trusted<'_> {
    /// The integer table of exactly one image.
    fn integer_table(&self, image: &'static [u8], units: Units) -> Result<IntegerTableInPlace<'static>, ImageError> {
        self.admission().integer_table(image).and_then(|table| IntegerTableInPlace::of(table, units))
    }

    /// The integer table of the image at the start of a region of flash.
    fn integer_table_in(&self, flash: &'static [u8], units: Units) -> Result<IntegerTableInPlace<'static>, ImageError> {
        self.admission().trust.stored(flash).and_then(|image| self.integer_table(image, units))
    }
}

/// Starts an integer compensator with the image at an address, which has to stay there. An image that is refused leaves it off; limits that are
/// refused leave the memory as it was.
///
/// @param flash  where the image begins
/// @param bytes  bytes that may be read there; what follows image and tag is not looked at
/// @param trust  as for frikan_start
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_start(
    compensator: *mut FrikanIntegerCompensator,
    flash: *const u8,
    bytes: usize,
    trust: *const FrikanTrust,
    units: *const FrikanUnits,
    limits: *const FrikanIntegerLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (flash, units, limits) = unsafe { (readable(flash, bytes), units_at(units), limits_at(limits)) };
    let Some(limits) = limits else { return FrikanStatus::BadLimits };
    // SAFETY: the caller's word.
    let table = unsafe { admission::at(trust) }.and_then(|trusted| trusted.integer_table_in(flash, units));
    // SAFETY: the caller's word.
    unsafe { start(compensator, table, limits) }
}

/// As frikan_integer_start with the newest usable image of two slots of flash.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[cfg(feature = "slots")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_start_from_slots(
    compensator: *mut FrikanIntegerCompensator,
    first: *const u8,
    first_bytes: usize,
    second: *const u8,
    second_bytes: usize,
    trust: *const FrikanTrust,
    units: *const FrikanUnits,
    limits: *const FrikanIntegerLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (first, second) = unsafe { (readable(first, first_bytes), readable(second, second_bytes)) };
    // SAFETY: the caller's word.
    let (trusted, units, limits) = unsafe { (admission::at(trust), units_at(units), limits_at(limits)) };
    let Some(limits) = limits else { return FrikanStatus::BadLimits };
    let newest = trusted
        .and_then(|trusted| newest_usable(first, second, |image| trusted.integer_table(image, units)))
        .map(|(_, table)| table);
    // SAFETY: the caller's word.
    unsafe { start(compensator, newest, limits) }
}

/// As frikan_next_write, beside the slot that frikan_integer_start_from_slots takes.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[cfg(feature = "slots")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_next_write(
    first: *const u8,
    first_bytes: usize,
    second: *const u8,
    second_bytes: usize,
    trust: *const FrikanTrust,
    units: *const FrikanUnits,
) -> FrikanSlotWrite {
    // SAFETY: the caller's word.
    let (first, second) = unsafe { (readable(first, first_bytes), readable(second, second_bytes)) };
    // SAFETY: the caller's word.
    let (trusted, units) = unsafe { (admission::at(trust), units_at(units)) };
    let (which, sequence) =
        next_write_beside(first, second, |image| trusted.as_ref().map_err(|error| *error)?.integer_table(image, units));
    FrikanSlotWrite { slot: u32::from(which == Which::Second), sequence }
}

/// Goes on with the image at another address, which has to stay there, without a stop: at the torque put out last, from where the slew limit leads. An
/// image that is refused leaves the one before in force.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_replace(
    compensator: *mut FrikanIntegerCompensator,
    flash: *const u8,
    bytes: usize,
    trust: *const FrikanTrust,
    units: *const FrikanUnits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (flash, units, trusted) = unsafe { (readable(flash, bytes), units_at(units), admission::at(trust)) };
    // SAFETY: the caller's word.
    let Some(compensator) = (unsafe { content(compensator) }) else { return FrikanStatus::NotStarted };
    match trusted.and_then(|trusted| trusted.integer_table_in(flash, units)) {
        Err(error) => error.into(),
        Ok(table) => {
            compensator.replace(Ok(table));
            FrikanStatus::Active
        }
    }
}

/// The torque to add, in counts, at a velocity in counts, whatever it is; 0 without a table. Call it at a fixed rate.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_step(compensator: *mut FrikanIntegerCompensator, velocity: i32) -> i32 {
    // SAFETY: the caller's word.
    unsafe { content(compensator) }.map_or(0, |compensator| compensator.step(velocity))
}

/// The friction of the table at a velocity, both in counts, without limits; 0 without a table.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_friction(compensator: *mut FrikanIntegerCompensator, velocity: i32) -> i32 {
    // SAFETY: the caller's word.
    unsafe { content(compensator) }.map_or(0, |compensator| compensator.friction(velocity))
}

/// Changes the limits between two steps; the slew limit holds across the change. BadLimits leaves those before in force.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_set_limits(
    compensator: *mut FrikanIntegerCompensator,
    limits: *const FrikanIntegerLimits,
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

/// Starts from zero torque: for a drive that has no velocity, since no number says so.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_reset(compensator: *mut FrikanIntegerCompensator) {
    // SAFETY: the caller's word.
    if let Some(compensator) = unsafe { content(compensator) } {
        compensator.reset();
    }
}

/// Active, or why there is no table.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_status(compensator: *mut FrikanIntegerCompensator) -> FrikanStatus {
    // SAFETY: the caller's word.
    unsafe { content(compensator) }.map_or(FrikanStatus::NotStarted, |compensator| compensator.status().into())
}

/// CRC-32 of the table as it is now in memory and flash: one that differs from that after the start is damaged. 0 where there is none. Not for the
/// control loop.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_integer_model_crc(compensator: *mut FrikanIntegerCompensator) -> u32 {
    // SAFETY: the caller's word.
    unsafe { content(compensator) }.and_then(|compensator| compensator.checksum()).unwrap_or(0)
}
