//! Drivers of the crate `embedded-storage` as flash for slots.

use embedded_storage::nor_flash::NorFlash;

use super::{Flash, Layout, LayoutError};

/// A driver that keeps the contract of [`NorFlash`].
#[derive(Debug)]
pub struct Nor<F>(pub F);

impl<F: NorFlash> Nor<F> {
    /// Two slots of `slot_bytes` at two offsets of this flash, as [`Layout::new`].
    ///
    /// # Errors
    /// [`LayoutError`] where the slots cannot be written so.
    pub fn layout(slots: [u32; 2], slot_bytes: u32, erased: u8) -> Result<Layout, LayoutError> {
        let unit = if F::READ_SIZE > F::WRITE_SIZE { F::READ_SIZE } else { F::WRITE_SIZE };
        let unit = u32::try_from(unit).map_err(|_| LayoutError::Unit)?;
        let sector = u32::try_from(F::ERASE_SIZE).map_err(|_| LayoutError::Sector)?;
        Layout::new(slots, slot_bytes, unit, sector, erased)
    }
}

impl<F: NorFlash> Flash for Nor<F> {
    type Error = F::Error;

    fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), F::Error> {
        self.0.read(at, bytes)
    }

    fn erase(&mut self, from: u32, to: u32) -> Result<(), F::Error> {
        self.0.erase(from, to)
    }

    fn program(&mut self, at: u32, bytes: &[u8]) -> Result<(), F::Error> {
        self.0.write(at, bytes)
    }
}

#[cfg(all(test, feature = "models"))]
mod tests {
    use super::super::{intact, write};
    use super::*;
    use core::convert::Infallible;
    use embedded_storage::nor_flash::{ErrorType, ReadNorFlash};
    use frikan_shared::image::ImageError;
    use std::vec;
    use std::vec::Vec;

    struct Ram(Vec<u8>);

    impl ErrorType for Ram {
        type Error = Infallible;
    }

    impl ReadNorFlash for Ram {
        const READ_SIZE: usize = 4;
        fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), Infallible> {
            assert!(at.is_multiple_of(4) && bytes.len().is_multiple_of(4));
            bytes.copy_from_slice(&self.0[at as usize..][..bytes.len()]);
            Ok(())
        }
        fn capacity(&self) -> usize {
            self.0.len()
        }
    }

    impl NorFlash for Ram {
        const WRITE_SIZE: usize = 2;
        const ERASE_SIZE: usize = 128;
        fn erase(&mut self, from: u32, to: u32) -> Result<(), Infallible> {
            self.0[from as usize..to as usize].fill(0xFF);
            Ok(())
        }
        fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Infallible> {
            self.0[at as usize..][..bytes.len()].copy_from_slice(bytes);
            Ok(())
        }
    }

    #[test]
    fn a_driver_writes_and_finds_an_image() {
        let mut flash = Nor(Ram(vec![0; 1024]));
        let layout = Nor::<Ram>::layout([0, 512], 512, 0xFF).unwrap();
        for round in 1..4_u8 {
            let image = [round; 77];
            let stored = write(&mut flash, &layout, &image, |_, _| Ok::<(), ImageError>(())).unwrap();
            assert_eq!(intact(&mut flash, &layout)[0], Some(stored));
            assert_eq!(flash.0.0[stored.at as usize..][..77], image);
            assert_eq!(stored.sequence, u32::from(round));
        }
        assert_eq!(Nor::<Ram>::layout([0, 500], 512, 0xFF), Err(LayoutError::Slot));
    }
}
