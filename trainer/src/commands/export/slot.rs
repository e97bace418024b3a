//! A slot as the drive's own flash is written: header and image in program units of their own, the last one filled.

use clap::Args;
use frikan_runtime::slots::flash::{LARGEST_UNIT, Layout};
use frikan_runtime::slots::slot_header;

use super::number::number;
use crate::error::{Error, Result, codes};

/// How flash is written, for `--slot`.
#[derive(Args, Clone, Copy, Debug)]
pub struct FlashArguments {
    /// Bytes that the flash programs at once (1, 2, 4, 8, 16 or 32), for `--slot`: header and image never share a unit [default: 1]
    #[arg(long, value_parser = number, value_name = "BYTES")]
    program_unit: Option<u32>,
    /// Bytes that the flash erases at once, for `--slot`: the slot has to begin on a multiple of it [default: the program unit]
    #[arg(long, value_parser = number, value_name = "BYTES")]
    erase_size: Option<u32>,
    /// What an erased byte reads, for `--slot`: 0xFF, or 0x00 [default: 0xFF]
    #[arg(long, value_parser = number, value_name = "BYTE")]
    erased: Option<u32>,
}

impl FlashArguments {
    /// The bytes of a slot from its start, whole program units; `address`, where it is known, is that of the slot.
    ///
    /// # Errors
    /// `FRK-U001` for flash on which no slot can be kept and an address at which none begins, `FRK-I003` for an image that is too large.
    pub(super) fn slot(&self, sequence: u32, image: &[u8], address: Option<u32>) -> Result<Vec<u8>> {
        let usage = |message: String| Error::new(&codes::USAGE, message);
        let unit = self.program_unit.unwrap_or(1);
        let sector = self.erase_size.unwrap_or(unit);
        let erased = u8::try_from(self.erased.unwrap_or(0xFF)).map_err(|_| usage("`--erased` is a byte".to_owned()))?;
        let too_large = || Error::new(&codes::FILE_TOO_LARGE, "the image is too large for a slot");
        // Two slots one behind the other, each as long as it has to be.
        let bytes = u32::try_from(image.len() + LARGEST_UNIT as usize).map_err(|_| too_large())?;
        let slot_bytes = bytes.checked_next_multiple_of(sector).filter(|bytes| *bytes < 1 << 31);
        let slot_bytes = slot_bytes.ok_or_else(|| usage("`--erase-size` is a number of bytes above 0".to_owned()))?;
        let layout = Layout::new([0, slot_bytes], slot_bytes, unit, sector, erased)
            .map_err(|error| usage(format!("no slot can be kept on such flash: {error}")))?;
        if let Some(address) = address.filter(|address| !address.is_multiple_of(sector)) {
            let message =
                format!("a slot begins where {sector} bytes are erased at once: `--address` must be a multiple");
            return Err(usage(message).with_value(format!("{address:#010x}")));
        }
        let mut slot = slot_header(sequence, image).ok_or_else(too_large)?.to_vec();
        slot.resize(layout.image_offset() as usize, erased);
        slot.extend(image);
        slot.resize(slot.len().next_multiple_of(unit as usize), erased);
        Ok(slot)
    }

    /// # Errors
    /// `FRK-U001` where there is something to refuse.
    pub(super) fn refused_without_slot(&self) -> Result<()> {
        let given = [self.program_unit, self.erase_size, self.erased];
        if given.iter().all(Option::is_none) {
            return Ok(());
        }
        let message = "how flash is written matters to a slot alone: `--slot` gives its sequence number";
        Err(Error::new(&codes::USAGE, message))
    }
}
