//! Two slots on flash as it is: programmed in units that take one write each, erased in sectors, read with errors.
//!
//! Where a word was torn by a loss of power, flash with error correction does not give some other bytes, it gives an error, on many parts a
//! bus fault. A drive that reads its slots by pointers then restarts for ever. Here every read may fail, and a slot that cannot be read is a bad slot.
//! What [`newest_usable`] has found intact was read as a whole, so that it may be read where it lies from then on.
//!
//! A slot is the one of [`super`], but for the place of its image: header and image never share a program unit, so that no unit is
//! programmed twice.

#[cfg(feature = "embedded-storage")]
mod nor;

#[cfg(feature = "embedded-storage")]
pub use nor::Nor;

use core::num::NonZeroU32;

use frikan_shared::image::{Checksum, ImageError};

use super::{Fields, SLOT_HEADER_BYTES, Which, fields, first_usable, newest_first, slot_header};

/// Flash, as a driver gives access to it. With the feature `embedded-storage`, `Nor` takes the drivers of that crate.
pub trait Flash {
    /// Why the driver refused.
    type Error;

    /// Reads whole units, or a header, from the address of one. An uncorrectable word is an error; on parts where it is a bus fault, the driver has to catch that.
    ///
    /// # Errors
    /// Where the bytes cannot be read.
    fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), Self::Error>;

    /// Erases from one address to another, both at the ends of sectors.
    ///
    /// # Errors
    /// Where the sectors cannot be erased.
    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error>;

    /// Programs whole units, at the address of a unit, erased since they were programmed last.
    ///
    /// # Errors
    /// Where the bytes cannot be programmed.
    fn program(&mut self, at: u32, bytes: &[u8]) -> Result<(), Self::Error>;
}

/// Where the slots lie, and how their flash is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    slots: [u32; 2],
    slot_bytes: u32,
    unit: NonZeroU32,
    sector: NonZeroU32,
    erased: u8,
}

/// Which slots cannot be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutError {
    /// The program unit is not 1, 2, 4, 8, 16 or 32 bytes.
    Unit,
    /// A sector is no multiple of a unit.
    Sector,
    /// A slot does not begin and end with a sector, is empty, or ends beyond the addresses.
    Slot,
    /// The slots overlap.
    Overlap,
    /// Erased bytes are neither 0xFF nor 0x00.
    Erased,
}

impl core::fmt::Display for LayoutError {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.write_str(match self {
            Self::Unit => "a program unit has 1, 2, 4, 8, 16 or 32 bytes",
            Self::Sector => "a sector is made of program units",
            Self::Slot => "a slot is made of sectors",
            Self::Overlap => "the slots overlap",
            Self::Erased => "erased bytes are 0xFF or 0x00",
        })
    }
}

impl core::error::Error for LayoutError {}

/// Bytes that are read or programmed at a time: at least the largest unit.
const CHUNK: usize = 64;

/// Largest program unit, bytes: the flash word of an STM32H7.
pub const LARGEST_UNIT: u32 = 32;

impl Layout {
    /// Two slots of `slot_bytes` at two addresses, in flash of sectors that are erased as a whole, programmed in units of so many bytes, all
    /// sizes in bytes. `erased` is what an erased byte reads: 0xFF, or 0x00.
    ///
    /// # Errors
    /// [`LayoutError`] where the slots cannot be written so.
    pub fn new(slots: [u32; 2], slot_bytes: u32, unit: u32, sector: u32, erased: u8) -> Result<Self, LayoutError> {
        let is_unit = unit.is_power_of_two() && unit <= LARGEST_UNIT;
        let unit = NonZeroU32::new(unit).filter(|_| is_unit).ok_or(LayoutError::Unit)?;
        let sector = NonZeroU32::new(sector).filter(|sector| sector.get() % unit == 0).ok_or(LayoutError::Sector)?;
        let [first, second] = slots;
        let is_whole = |start: u32| start % sector == 0 && start.checked_add(slot_bytes).is_some();
        if !(slot_bytes > 0 && slot_bytes % sector == 0 && is_whole(first) && is_whole(second)) {
            return Err(LayoutError::Slot);
        }
        if first.abs_diff(second) < slot_bytes {
            return Err(LayoutError::Overlap);
        }
        if ![0x00, 0xFF].contains(&erased) {
            return Err(LayoutError::Erased);
        }
        Ok(Self { slots, slot_bytes, unit, sector, erased })
    }

    /// Address of a slot.
    #[must_use]
    pub fn slot(&self, which: Which) -> u32 {
        let [first, second] = self.slots;
        if which == Which::First { first } else { second }
    }

    /// Bytes from the start of a slot to its image: the header in program units of its own.
    #[must_use]
    pub fn image_offset(&self) -> u32 {
        let header = SLOT_HEADER_BYTES as u32;
        if self.unit.get() > header { self.unit.get() } else { header }
    }

    /// Longest image and tag, bytes.
    #[must_use]
    pub fn largest_image(&self) -> u32 {
        self.slot_bytes.saturating_sub(self.image_offset())
    }

    /// `bytes` in whole multiples of `of`.
    fn whole(bytes: u32, of: NonZeroU32) -> u32 {
        match bytes % of {
            0 => bytes,
            begun => bytes.saturating_add(of.get() - begun),
        }
    }
}

/// An image in an intact slot: read once as a whole, checksum and all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Which slot it is in.
    pub which: Which,
    /// Its sequence number.
    pub sequence: u32,
    /// Address of the image.
    pub at: u32,
    /// Bytes of the image and its tag.
    pub bytes: u32,
}

/// Why an image was not written. The slot in use is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WriteError<E> {
    /// The image and its header are longer than a slot.
    TooLarge,
    /// The driver refused.
    Flash(E),
    /// What was written does not read back.
    NotWritten,
}

/// The slot, where it can be read and its checksum is right.
fn stored<F: Flash>(flash: &mut F, layout: &Layout, which: Which) -> Option<Stored> {
    let start = layout.slot(which);
    let mut chunk = [0; CHUNK];
    flash.read(start, chunk.get_mut(..layout.image_offset() as usize)?).ok()?;
    let header = *chunk.first_chunk::<SLOT_HEADER_BYTES>()?;
    let Fields { sequence, length, crc32, covered } = fields(&header)?;
    if length > layout.largest_image() {
        return None;
    }
    let at = start + layout.image_offset();
    let mut sum = Checksum::new().over(covered);
    let (mut from, end) = (at, at + length);
    while from < end {
        let left = (end - from).min(CHUNK as u32);
        flash.read(from, chunk.get_mut(..Layout::whole(left, layout.unit) as usize)?).ok()?;
        sum = sum.over(chunk.get(..left as usize)?);
        from += left;
    }
    (sum.value() == crc32).then_some(Stored { which, sequence, at, bytes: length })
}

/// The intact slots, the newest first.
pub fn intact<F: Flash>(flash: &mut F, layout: &Layout) -> [Option<Stored>; 2] {
    let [first, second] = [Which::First, Which::Second].map(|which| stored(flash, layout, which));
    newest_first(first, second, |stored| stored.sequence)
}

/// The newest slot that can be used, and what `read` makes of it, which may read it where it lies: as [`super::newest_usable`].
///
/// # Errors
/// [`ImageError::NoImage`] where no slot is intact, else why the newest intact one cannot be used: compensation stays off.
pub fn newest_usable<F: Flash, T>(
    flash: &mut F,
    layout: &Layout,
    mut read: impl FnMut(&mut F, &Stored) -> Result<T, ImageError>,
) -> Result<(Stored, T), ImageError> {
    let slots = intact(flash, layout);
    first_usable(slots.into_iter().flatten(), |stored| read(flash, stored))
}

/// Writes an image, with its tag where the drive asks for one, to the slot that is not in use, which is the newest one that `read` can use, and
/// says where it is then. Its header comes last: a loss of power at any moment leaves the slot in use the newest.
///
/// # Errors
/// [`WriteError`]; the slot in use is never touched.
pub fn write<F: Flash, T>(
    flash: &mut F,
    layout: &Layout,
    image: &[u8],
    read: impl FnMut(&mut F, &Stored) -> Result<T, ImageError>,
) -> Result<Stored, WriteError<F::Error>> {
    let bytes = u32::try_from(image.len()).map_err(|_| WriteError::TooLarge)?;
    if bytes > layout.largest_image() {
        return Err(WriteError::TooLarge);
    }
    let newest = intact(flash, layout)[0];
    let in_use = newest_usable(flash, layout, read).map(|(stored, _)| stored).ok().or(newest);
    let which = in_use.map_or(Which::First, |stored| stored.which.other());
    let sequence = newest.map_or(1, |stored| stored.sequence.wrapping_add(1));
    let Some(header) = slot_header(sequence, image) else { return Err(WriteError::TooLarge) };
    let start = layout.slot(which);
    let at = start + layout.image_offset();
    let end = start + Layout::whole(layout.image_offset() + bytes, layout.sector);
    flash.erase(start, end).map_err(WriteError::Flash)?;
    program(flash, layout, at, image).map_err(WriteError::Flash)?;
    program(flash, layout, start, &header).map_err(WriteError::Flash)?;
    let written = Stored { which, sequence, at, bytes };
    if stored(flash, layout, which) == Some(written) { Ok(written) } else { Err(WriteError::NotWritten) }
}

/// Programs bytes from the address of a unit on; the last unit is filled with erased bytes.
fn program<F: Flash>(flash: &mut F, layout: &Layout, mut at: u32, bytes: &[u8]) -> Result<(), F::Error> {
    for part in bytes.chunks(CHUNK) {
        let mut chunk = [layout.erased; CHUNK];
        chunk.iter_mut().zip(part).for_each(|(to, from)| *to = *from);
        let whole = Layout::whole(part.len() as u32, layout.unit);
        flash.program(at, chunk.get(..whole as usize).unwrap_or_default())?;
        at += whole;
    }
    Ok(())
}

#[cfg(all(test, feature = "models"))]
mod tests;
