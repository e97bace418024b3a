//! The board's UART, polled: Arm's CMSDK on the MPS2 boards, a 16550 on QEMU's RISC-V machine.

use core::ptr::with_exposed_provenance_mut;

unsafe extern "C" {
    // Defined in `memory.x`; only its address means anything.
    static _uart: u8;
}

/// The UART by which the host talks to a running program, words in little-endian order.
pub struct Uart {
    address: usize,
}

/// Offsets and bits of the registers.
#[cfg(target_arch = "arm")]
mod registers {
    pub(super) const DATA: usize = 0x0;
    pub(super) const STATE: usize = 0x4;
    pub(super) const CONTROL: usize = 0x8;
    pub(super) const DIVIDER: usize = 0x10;
    /// The transmitter takes no byte.
    pub(super) const FULL: u32 = 1;
    /// The receiver holds a byte.
    pub(super) const RECEIVED: u32 = 2;
}

impl Uart {
    /// Takes the UART and switches it on.
    #[must_use]
    pub fn start() -> Self {
        let uart = Self { address: &raw const _uart as usize };
        #[cfg(target_arch = "arm")]
        {
            // The smallest divider that the device accepts, and both directions on.
            uart.write(registers::DIVIDER, 16);
            uart.write(registers::CONTROL, 0b11);
        }
        uart
    }

    /// Fills `words` with what the host sends, and waits for it.
    pub fn receive(&mut self, words: &mut [u32]) {
        for word in words {
            let mut bytes = [0; 4];
            bytes.iter_mut().for_each(|byte| *byte = self.receive_byte());
            *word = u32::from_le_bytes(bytes);
        }
    }

    /// Sends `words` to the host.
    pub fn send(&mut self, words: &[u32]) {
        for byte in words.iter().flat_map(|word| word.to_le_bytes()) {
            self.send_byte(byte);
        }
    }
}

#[cfg(target_arch = "arm")]
impl Uart {
    fn receive_byte(&mut self) -> u8 {
        while self.read(registers::STATE) & registers::RECEIVED == 0 {}
        self.read(registers::DATA) as u8
    }

    fn send_byte(&mut self, byte: u8) {
        while self.read(registers::STATE) & registers::FULL != 0 {}
        self.write(registers::DATA, u32::from(byte));
    }

    fn read(&self, register: usize) -> u32 {
        // SAFETY: a register of the UART, which nobody else uses.
        unsafe { with_exposed_provenance_mut::<u32>(self.address + register).read_volatile() }
    }

    fn write(&self, register: usize, value: u32) {
        // SAFETY: as in `read`.
        unsafe { with_exposed_provenance_mut::<u32>(self.address + register).write_volatile(value) }
    }
}

/// Line status of the 16550, whether it holds a byte, whether it takes one.
#[cfg(target_arch = "riscv32")]
const STATUS: (usize, u8, u8) = (5, 1, 0x20);

#[cfg(target_arch = "riscv32")]
impl Uart {
    fn receive_byte(&mut self) -> u8 {
        let (status, received, _) = STATUS;
        while self.register(status) & received == 0 {}
        self.register(0)
    }

    fn send_byte(&mut self, byte: u8) {
        let (status, _, empty) = STATUS;
        while self.register(status) & empty == 0 {}
        // SAFETY: the data register of the UART, which nobody else uses.
        unsafe { with_exposed_provenance_mut::<u8>(self.address).write_volatile(byte) };
    }

    fn register(&self, offset: usize) -> u8 {
        // SAFETY: as in `send_byte`.
        unsafe { with_exposed_provenance_mut::<u8>(self.address + offset).read_volatile() }
    }
}
