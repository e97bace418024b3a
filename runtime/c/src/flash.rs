//! Two slots on flash that C drives. Audit: the functions and their context are the caller's word, and so is what lies at the mapped address.

use core::ffi::c_void;

use frikan_runtime::shared::image::ImageError;
use frikan_runtime::slots::flash::{Flash, Layout, Stored, WriteError, newest_usable, write};

use crate::admission::{self, FrikanTrust};
use crate::ffi::{FrikanCompensator, Inner, limits_at, replace, start};
use crate::memory::readable;
use crate::model::{ImageModel, Model};
use crate::types::{FrikanLimits, FrikanStatus};

/// Reads bytes from an address; false where that cannot be done: an uncorrectable word is no fault of the program.
pub type FrikanFlashRead =
    Option<unsafe extern "C" fn(context: *mut c_void, address: u32, bytes: *mut u8, length: usize) -> bool>;
/// Programs whole units, erased before; false where that cannot be done.
pub type FrikanFlashProgram =
    Option<unsafe extern "C" fn(context: *mut c_void, address: u32, bytes: *const u8, length: usize) -> bool>;
/// Erases the sectors from one address to another; false where that cannot be done.
pub type FrikanFlashErase = Option<unsafe extern "C" fn(context: *mut c_void, from: u32, to: u32) -> bool>;

/// Flash with two slots, and how it is written.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanFlash {
    /// Handed over to the functions as it is.
    pub context: *mut c_void,
    /// Reads.
    pub read: FrikanFlashRead,
    /// Programs; null in a drive that does not write.
    pub program: FrikanFlashProgram,
    /// Erases; null in a drive that does not write.
    pub erase: FrikanFlashErase,
    /// Where address 0 is read by pointers: null in most microcontrollers, whose flash addresses are those of the pointers.
    pub mapped: *const u8,
    /// Addresses of the slots, each the start of a sector.
    pub slots: [u32; 2],
    /// Bytes of a slot, whole sectors.
    pub slot_bytes: u32,
    /// Bytes that are programmed at once, 1, 2, 4, 8, 16 or 32.
    pub unit: u32,
    /// Bytes that are erased at once.
    pub sector: u32,
    /// What an erased byte reads: 0xFF or 0x00.
    pub erased: u8,
}

impl FrikanFlash {
    fn layout(&self) -> Option<Layout> {
        self.read?;
        Layout::new(self.slots, self.slot_bytes, self.unit, self.sector, self.erased).ok()
    }

    /// The image where it lies.
    ///
    /// # Safety
    /// The slots may be read at their mapped addresses as long as the compensator steps.
    unsafe fn image(&self, stored: &Stored) -> &'static [u8] {
        // SAFETY: the caller's word. No pointer arithmetic on a null pointer.
        unsafe { readable(self.mapped.wrapping_add(stored.at as usize), stored.bytes as usize) }
    }
}

/// The functions of C.
struct Driver(FrikanFlash);

/// That they were not there, or said no.
struct Refused;

fn done(is_done: bool) -> Result<(), Refused> {
    if is_done { Ok(()) } else { Err(Refused) }
}

impl Flash for Driver {
    type Error = Refused;

    fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), Refused> {
        let read = self.0.read.ok_or(Refused)?;
        // SAFETY: the caller's word for the function; a slice and its length.
        done(unsafe { read(self.0.context, at, bytes.as_mut_ptr(), bytes.len()) })
    }

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Refused> {
        let erase = self.0.erase.ok_or(Refused)?;
        // SAFETY: the caller's word for the function.
        done(unsafe { erase(self.0.context, from, to) })
    }

    fn program(&mut self, at: u32, bytes: &[u8]) -> Result<(), Refused> {
        let program = self.0.program.ok_or(Refused)?;
        // SAFETY: the caller's word for the function; a slice and its length.
        done(unsafe { program(self.0.context, at, bytes.as_ptr(), bytes.len()) })
    }
}

/// Starts a compensator with the newest usable image of two slots: each is read once through the functions, so that a torn word is a bad slot
/// and no bus fault, and the one that is taken is read where it lies from then on.
///
/// @param trust  as for frikan_start
///
/// # Safety
/// Pointers are null or good for what their names say, the functions may be called, and the slots may be read where they are mapped as long as
/// the compensator steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_start_from_flash(
    compensator: *mut FrikanCompensator,
    flash: *const FrikanFlash,
    trust: *const FrikanTrust,
    limits: *const FrikanLimits,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let Some(limits) = (unsafe { limits_at(limits) }) else { return FrikanStatus::BadLimits };
    // SAFETY: the caller's word.
    match unsafe { newest(flash, trust) } {
        None => FrikanStatus::BadFlash,
        // SAFETY: the caller's word.
        Some(model) => unsafe { start(compensator, Inner::by(model.map(Model::Image), limits)) },
    }
}

/// Goes on with the newest usable image of two slots without a stop, as frikan_replace.
///
/// # Safety
/// As frikan_start_from_flash.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_replace_from_flash(
    compensator: *mut FrikanCompensator,
    flash: *const FrikanFlash,
    trust: *const FrikanTrust,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    match unsafe { newest(flash, trust) } {
        None => FrikanStatus::BadFlash,
        // SAFETY: the caller's word.
        Some(model) => unsafe { replace(compensator, model) },
    }
}

/// The newest usable image; none where the flash is no such flash.
///
/// # Safety
/// As frikan_start_from_flash.
unsafe fn newest(flash: *const FrikanFlash, trust: *const FrikanTrust) -> Option<Result<ImageModel, ImageError>> {
    // SAFETY: the caller's word.
    let (flash, trusted) = unsafe { (*flash.as_ref()?, admission::at(trust)) };
    let layout = flash.layout()?;
    Some(trusted.and_then(|trusted| {
        // SAFETY: the caller's word.
        newest_usable(&mut Driver(flash), &layout, |_, stored| trusted.read(unsafe { flash.image(stored) }))
            .map(|(_, model)| model)
    }))
}

/// Writes an image, with its tag where the drive asks for one, to the slot that is not in use; a loss of power at any moment leaves the one in
/// use. Active once it is there; frikan_replace_from_flash goes on with it.
///
/// @param trust  as for frikan_start: an image that the drive would not take is not written
///
/// # Safety
/// As frikan_start_from_flash, and `image` is null or good for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_write_image(
    flash: *const FrikanFlash,
    image: *const u8,
    bytes: usize,
    trust: *const FrikanTrust,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (flash, image, trusted) = unsafe { (flash.as_ref(), readable(image, bytes), admission::at(trust)) };
    let Some((flash, layout)) = flash.and_then(|flash| Some((*flash, flash.layout()?))) else {
        return FrikanStatus::BadFlash;
    };
    let trusted = match trusted {
        Ok(trusted) => trusted,
        Err(error) => return error.into(),
    };
    let usable = |image| trusted.read(image);
    if let Err(error) = usable(image) {
        return error.into();
    }
    // SAFETY: the caller's word.
    match write(&mut Driver(flash), &layout, image, |_, stored| usable(unsafe { flash.image(stored) })) {
        Ok(_) => FrikanStatus::Active,
        Err(WriteError::TooLarge) => FrikanStatus::TooLarge,
        Err(WriteError::Flash(Refused) | WriteError::NotWritten) => FrikanStatus::NotWritten,
    }
}
