use super::*;
use crate::test_models::{coulomb_model, image_of};
use frikan_shared::authentication::Trust;
use frikan_shared::effect::Effect;
use frikan_shared::model::Model;
use std::vec;
use std::vec::Vec;

const SLOT_BYTES: u32 = 512;
const SECTOR: u32 = 256;
/// An interpreter sees a part of the cuts.
const EVERY: usize = if cfg!(miri) { 97 } else { 1 };

/// What a loss of power leaves of the unit or the sector that was written just then.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Torn {
    /// Bits of both contents, and no correction that would notice.
    Mixed,
    /// An uncorrectable error.
    Uncorrectable,
}

/// Flash whose units can be programmed once after an erase.
#[derive(Clone)]
struct Chip {
    bytes: Vec<u8>,
    /// By unit: programmed since it was erased; not to be read.
    programmed: Vec<bool>,
    unreadable: Vec<bool>,
    layout: Layout,
    /// Writes of units and erases of sectors that are still done.
    left: usize,
    torn: Torn,
    /// Whether the operation that fails is the last one: the power is gone.
    loses_power: bool,
}

impl Chip {
    fn new(unit: u32, erased: u8) -> Self {
        let layout = Layout::new([0x100, 0x100 + SLOT_BYTES], SLOT_BYTES, unit, SECTOR, erased).unwrap();
        let bytes = (0x100 + 2 * SLOT_BYTES) as usize;
        let units = bytes / unit as usize;
        Self {
            // Whatever lay there before.
            bytes: vec![0x5A; bytes],
            programmed: vec![true; units],
            unreadable: vec![false; units],
            layout,
            left: usize::MAX,
            torn: Torn::Mixed,
            loses_power: true,
        }
    }

    fn units(&self, from: u32, to: u32) -> core::ops::Range<usize> {
        (from / self.layout.unit.get()) as usize..to.div_ceil(self.layout.unit.get()) as usize
    }

    /// Writes bytes, all of them units that are then programmed or erased; or, where it is not done any more, tears them.
    fn put(&mut self, at: u32, bytes: &[u8], programmed: bool) -> Result<(), ()> {
        let units = self.units(at, at + bytes.len() as u32);
        let is_done = self.left > 0;
        if self.loses_power || is_done {
            self.left = self.left.saturating_sub(1);
        } else {
            self.left = usize::MAX;
        }
        let torn = !is_done;
        for (index, byte) in bytes.iter().enumerate() {
            let place = &mut self.bytes[at as usize + index];
            *place = if torn { (*byte & 0x3C) | (*place & !0x3C) } else { *byte };
        }
        for unit in units {
            self.programmed[unit] = programmed || torn;
            self.unreadable[unit] = torn && self.torn == Torn::Uncorrectable;
        }
        if torn { Err(()) } else { Ok(()) }
    }

    fn model(&mut self) -> Result<Vec<u8>, ImageError> {
        let layout = self.layout;
        newest_usable(self, &layout, usable).map(|(stored, _)| {
            let at = stored.at as usize;
            self.bytes[at..at + stored.bytes as usize].to_vec()
        })
    }

    fn update(&mut self, image: &[u8]) -> Result<Stored, WriteError<()>> {
        let layout = self.layout;
        write(self, &layout, image, usable)
    }

    fn booted(&self) -> Self {
        Self { left: usize::MAX, ..self.clone() }
    }
}

impl Flash for Chip {
    type Error = ();

    fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), ()> {
        let end = at + bytes.len() as u32;
        if self.units(at, end).any(|unit| self.unreadable[unit]) {
            return Err(());
        }
        bytes.copy_from_slice(&self.bytes[at as usize..end as usize]);
        Ok(())
    }

    fn erase(&mut self, from: u32, to: u32) -> Result<(), ()> {
        assert!(from.is_multiple_of(SECTOR) && to.is_multiple_of(SECTOR) && from < to);
        for sector in (from..to).step_by(SECTOR as usize) {
            self.put(sector, &[self.layout.erased; SECTOR as usize], false)?;
        }
        Ok(())
    }

    fn program(&mut self, at: u32, bytes: &[u8]) -> Result<(), ()> {
        let unit = self.layout.unit.get();
        assert!(at.is_multiple_of(unit) && bytes.len().is_multiple_of(unit as usize) && !bytes.is_empty());
        for (index, part) in bytes.chunks(unit as usize).enumerate() {
            let at = at + index as u32 * unit;
            assert!(!self.programmed[(at / unit) as usize], "a unit is programmed once");
            self.put(at, part, true)?;
        }
        Ok(())
    }
}

/// A model that the drive can use, read where it lies.
fn usable(chip: &mut Chip, stored: &Stored) -> Result<(), ImageError> {
    let at = stored.at as usize;
    let units = chip.units(stored.at, stored.at + stored.bytes);
    assert!(!chip.unreadable[units].iter().any(|is| *is), "a bus fault");
    let image = &chip.bytes[at..at + stored.bytes as usize];
    Trust::Anyone.decode(image).map(|_: frikan_shared::image::Image<16>| ())
}

/// An image of some length: every spring takes nine bytes.
fn image(coulomb: f32, springs: usize) -> Vec<u8> {
    let springs = vec![Effect::Spring { stiffness: 1.0, rest: 0.5 }; springs];
    let model: Model<16> = coulomb_model(coulomb, &springs);
    image_of(model)
}

const UNITS: [u32; 6] = [1, 2, 4, 8, 16, 32];

#[test]
fn images_are_written_and_found_on_every_flash() {
    for unit in UNITS {
        for erased in [0xFF, 0x00] {
            let mut chip = Chip::new(unit, erased);
            assert_eq!(chip.model(), Err(ImageError::NoImage));
            for round in 0..5 {
                let next = image(1.0 + round as f32, round);
                let stored = chip.update(&next).unwrap();
                let which = [Which::First, Which::Second][round % 2];
                assert_eq!((stored.which, stored.sequence), (which, round as u32 + 1), "unit {unit}");
                assert!(stored.at.is_multiple_of(unit) && chip.model() == Ok(next));
            }
            // Up to a unit of 16 bytes the slots are those that are read by pointers.
            let slot = |which| &chip.bytes[chip.layout.slot(which) as usize..][..SLOT_BYTES as usize];
            let mapped = super::super::valid_slots(slot(Which::First), slot(Which::Second))[0];
            assert_eq!(mapped.map(|slot| slot.sequence), (unit <= 16).then_some(5), "unit {unit}");
        }
    }
}

/// Every program and every erase is cut, or refused by a flash that wears out: what was in use before, or the whole new image, is found
/// afterwards, and the next update goes through.
#[test]
fn a_fault_at_any_program_or_erase_leaves_a_valid_model() {
    let (old, new, third) = (image(1.0, 2), image(2.0, 4), image(3.0, 1));
    for unit in UNITS {
        for erased in [0xFF, 0x00] {
            for (torn, loses_power) in [(Torn::Mixed, true), (Torn::Uncorrectable, true), (Torn::Uncorrectable, false)]
            {
                let mut before = Chip { torn, loses_power, ..Chip::new(unit, erased) };
                before.update(&image(0.5, 3)).unwrap();
                before.update(&old).unwrap();
                let mut cuts = 0;
                for left in (0..).step_by(EVERY) {
                    let mut chip = Chip { left, ..before.clone() };
                    let written = chip.update(&new);
                    let mut chip = chip.booted();
                    let found = chip.model();
                    let name = std::format!("unit {unit}, erased {erased}, {torn:?}, cut {left}: {written:?}");
                    match written {
                        Ok(_) => assert_eq!(found.as_ref(), Ok(&new), "{name}"),
                        Err(_) => assert!(found.as_ref() == Ok(&old) || found.as_ref() == Ok(&new), "{name}"),
                    }
                    chip.update(&third).unwrap();
                    assert_eq!(chip.model().as_ref(), Ok(&third), "{name}");
                    cuts += 1;
                    if written.is_ok() {
                        break;
                    }
                }
                assert!(cfg!(miri) || cuts > new.len() / unit as usize, "{cuts} cuts of unit {unit}");
            }
        }
    }
}

/// Nothing to fall back to: the first write ever, cut anywhere, leaves the whole image or none.
#[test]
fn a_cut_first_write_leaves_compensation_off() {
    let new = image(2.0, 4);
    for unit in UNITS {
        for torn in [Torn::Mixed, Torn::Uncorrectable] {
            for left in (0..).step_by(EVERY) {
                let mut chip = Chip { left, torn, ..Chip::new(unit, 0xFF) };
                let written = chip.update(&new);
                let found = chip.booted().model();
                assert!(found.as_ref() == Ok(&new) || (written.is_err() && found == Err(ImageError::NoImage)));
                if written.is_ok() {
                    break;
                }
            }
        }
    }
}

/// A word that goes bad later costs its slot and nothing else.
#[test]
fn an_uncorrectable_word_anywhere_is_a_bad_slot() {
    let (old, new) = (image(1.0, 0), image(2.0, 3));
    let mut chip = Chip::new(8, 0xFF);
    chip.update(&old).unwrap();
    let stored = chip.update(&new).unwrap();
    let start = chip.layout.slot(stored.which);
    for unit in chip.units(start, stored.at + stored.bytes).step_by(EVERY) {
        let mut bad = chip.clone();
        bad.unreadable[unit] = true;
        assert_eq!(bad.model().as_ref(), Ok(&old), "unit {unit}");
        // The slot in use is spared, and the bad one is written anew.
        assert_eq!(bad.update(&new).map(|stored| stored.which), Ok(stored.which));
        assert_eq!(bad.model().as_ref(), Ok(&new));
    }
}

/// The image has a checksum of its own and is decoded all the same; the slot's covers its number and its length too.
#[test]
fn a_flipped_bit_anywhere_is_a_bad_slot() {
    let (old, new) = (image(1.0, 0), image(2.0, 3));
    for unit in [1, 32] {
        let mut chip = Chip::new(unit, 0xFF);
        chip.update(&old).unwrap();
        let stored = chip.update(&new).unwrap();
        let start = chip.layout.slot(stored.which) as usize;
        let header = start..start + SLOT_HEADER_BYTES;
        let image = stored.at as usize..(stored.at + stored.bytes) as usize;
        for bit in header.chain(image).flat_map(|byte| 8 * byte..8 * byte + 8).step_by(EVERY) {
            let mut bad = chip.clone();
            bad.bytes[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(bad.model().as_ref(), Ok(&old), "bit {} of unit {unit}", bit - 8 * start);
            let [newest, older] = intact(&mut bad, &chip.layout);
            assert!(newest.is_some_and(|slot| slot.which != stored.which) && older.is_none());
        }
    }
}

#[test]
fn what_cannot_be_kept_is_refused_by_name() {
    for (slots, bytes, unit, sector, erased, error) in [
        ([0, 512], 512, 3, 256, 0xFF, LayoutError::Unit),
        ([0, 512], 512, 64, 256, 0xFF, LayoutError::Unit),
        ([0, 512], 512, 0, 256, 0xFF, LayoutError::Unit),
        ([0, 512], 512, 32, 0, 0xFF, LayoutError::Sector),
        ([0, 512], 512, 32, 48, 0xFF, LayoutError::Sector),
        ([0, 500], 512, 8, 256, 0xFF, LayoutError::Slot),
        ([0, 512], 0, 8, 256, 0xFF, LayoutError::Slot),
        ([0, 0xFFFF_FF00], 512, 8, 256, 0xFF, LayoutError::Slot),
        ([0, 256], 512, 8, 256, 0xFF, LayoutError::Overlap),
        ([0, 512], 512, 8, 256, 0x55, LayoutError::Erased),
    ] {
        assert_eq!(Layout::new(slots, bytes, unit, sector, erased), Err(error));
    }
    let mut chip = Chip::new(8, 0xFF);
    let too_large = vec![0; chip.layout.largest_image() as usize + 1];
    assert_eq!(chip.update(&too_large), Err(WriteError::TooLarge));
}
