//! Files and exit by Arm semihosting (ARM-software/abi-aa, `semihosting.rst`; RISC-V uses the same calls behind another
//! trap). Four calls, none of which can panic.

use core::arch::asm;
use core::ffi::CStr;

const SYS_OPEN: usize = 0x01;
const SYS_WRITE: usize = 0x05;
const SYS_READ: usize = 0x06;
const SYS_EXIT_EXTENDED: usize = 0x20;
const APPLICATION_EXIT: usize = 0x20026;

/// How [`File::open`] opens.
pub(crate) enum Mode {
    /// An existing file, binary.
    Read = 1,
    /// A new or emptied file, binary.
    Write = 5,
}

/// A file of the host, open until the emulation ends.
pub(crate) struct File {
    handle: usize,
}

impl File {
    /// Opens a file in the emulator's working directory.
    pub(crate) fn open(name: &CStr, mode: Mode) -> Option<Self> {
        // SAFETY: the name is terminated and its length is right; the host only reads it.
        let handle = unsafe { call(SYS_OPEN, &[name.as_ptr() as usize, mode as usize, name.to_bytes().len()]) };
        (handle != usize::MAX).then_some(Self { handle })
    }

    /// Fills `bytes`, or `None` where the file ends before.
    pub(crate) fn read(&mut self, bytes: &mut [u8]) -> Option<()> {
        // SAFETY: the host writes at most the length given, into bytes that are exclusively borrowed.
        let missing = unsafe { call(SYS_READ, &[self.handle, bytes.as_mut_ptr() as usize, bytes.len()]) };
        (missing == 0).then_some(())
    }

    /// Writes `bytes`, or `None` where the host took fewer.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> Option<()> {
        // SAFETY: the host only reads the length given.
        let missing = unsafe { call(SYS_WRITE, &[self.handle, bytes.as_ptr() as usize, bytes.len()]) };
        (missing == 0).then_some(())
    }
}

/// Ends the emulation with an exit status.
pub(crate) fn exit(status: usize) -> ! {
    loop {
        // SAFETY: the host does not return from it, and reads two words.
        unsafe { call(SYS_EXIT_EXTENDED, &[APPLICATION_EXIT, status]) };
    }
}

/// # Safety
/// `arguments` must be what the operation asks for, and pointers in it good for what the host does with them.
#[inline(never)]
unsafe fn call(operation: usize, arguments: &[usize]) -> usize {
    let result: usize;
    // SAFETY: the trap goes to the emulator, which changes the first register and the memory it was given.
    #[cfg(target_arch = "arm")]
    unsafe {
        asm!("bkpt #0xAB", inout("r0") operation => result, in("r1") arguments.as_ptr(), options(nostack));
    }
    // SAFETY: as above. The emulator knows the trap by its neighbours, which must not be compressed, nor lie on two pages.
    #[cfg(target_arch = "riscv32")]
    unsafe {
        asm!(
            ".option push",
            ".option norvc",
            ".balign 16",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") operation => result, in("a1") arguments.as_ptr(), options(nostack)
        );
    }
    result
}
