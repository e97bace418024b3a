//! What needs `unsafe` besides semihosting: the image window, the instruction clock, the stack's paint, the
//! floating-point control register and the panic handler that cannot be linked.

use core::arch::asm;
use core::panic::PanicInfo;
use core::ptr;

use crate::protocol::{CALIBRATION_NOPS, Row};

unsafe extern "C" {
    // Defined by no one: a panic that is reachable is a link error.
    safe fn frikan_firmware_can_panic() -> !;
    // Defined in `memory.x`; only their addresses mean anything.
    static _image_start: u8;
    static _image_end: u8;
    // Defined by the start-up crates: the end of the static data.
    static __sheap: u8;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    frikan_firmware_can_panic()
}

/// The flash that `memory.x` keeps for the image.
#[must_use]
pub fn flash() -> &'static [u8] {
    let (start, end) = (&raw const _image_start, &raw const _image_end);
    let bytes = (end as usize).saturating_sub(start as usize);
    // SAFETY: `memory.x` keeps the window out of every section, it lies in memory that is there from reset on, and
    // `write_flash` is called only while nobody holds what this returns.
    unsafe { core::slice::from_raw_parts(start, bytes) }
}

/// Writes words to a place of the flash, a multiple of four bytes behind its start; what lies beyond its end is not written. The boards'
/// code memory takes writes as they are, where a drive's flash wants to be erased. Nobody may hold a slice of [`flash`] meanwhile.
pub fn write_flash(place: u32, words: &[u32]) {
    let (start, end) = (&raw const _image_start as usize, &raw const _image_end as usize);
    let first = start.saturating_add((place & !3) as usize);
    for (address, word) in (first..end).step_by(4).zip(words) {
        // SAFETY: inside the window, aligned, and borrowed by nobody.
        unsafe { ptr::with_exposed_provenance_mut::<u32>(address).write_volatile(*word) };
    }
}

const PAINT: u32 = 0xA5C3_3C5A;

/// Calls `work` and returns its result with the bytes of stack that it used.
#[inline(never)]
pub(crate) fn stack_depth<R>(work: impl FnOnce() -> R) -> (R, u32) {
    let top = stack_pointer();
    let bottom = (&raw const __sheap as usize).next_multiple_of(4);
    for address in (bottom..top).step_by(4) {
        // SAFETY: above the static data and below the stack pointer; no interrupt is enabled and there is no heap, so
        // nobody owns these words. Volatile, so that it does not become a call.
        unsafe { ptr::with_exposed_provenance_mut::<u32>(address).write_volatile(PAINT) };
    }
    let result = work();
    // SAFETY: as above, reading.
    let is_paint = |address: &usize| unsafe { ptr::with_exposed_provenance::<u32>(*address).read_volatile() } == PAINT;
    let untouched = (bottom..top).step_by(4).take_while(is_paint).count();
    (result, top.saturating_sub(bottom + 4 * untouched) as u32)
}

#[inline(always)]
fn stack_pointer() -> usize {
    let pointer: usize;
    // SAFETY: reads a register.
    #[cfg(target_arch = "arm")]
    unsafe {
        asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags))
    };
    #[cfg(target_arch = "riscv32")]
    unsafe {
        asm!("mv {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags))
    };
    pointer & !3
}

/// A call that costs its return and nothing else: what an evaluation is measured against.
#[cfg(target_arch = "arm")]
#[unsafe(naked)]
pub(crate) extern "C" fn empty_call<E>(_: &mut E, _: &Row) -> f32 {
    core::arch::naked_asm!("bx lr")
}

/// A call that costs its return and nothing else: what an evaluation is measured against.
#[cfg(target_arch = "riscv32")]
#[unsafe(naked)]
pub(crate) extern "C" fn empty_call<E>(_: &mut E, _: &Row) -> f32 {
    core::arch::naked_asm!("ret")
}

/// [`CALIBRATION_NOPS`] instructions and a return.
#[cfg(target_arch = "arm")]
#[unsafe(naked)]
pub(crate) extern "C" fn calibration_call<E>(_: &mut E, _: &Row) -> f32 {
    core::arch::naked_asm!(".rept {nops}", "nop", ".endr", "bx lr", nops = const CALIBRATION_NOPS)
}

/// [`CALIBRATION_NOPS`] instructions and a return.
#[cfg(target_arch = "riscv32")]
#[unsafe(naked)]
pub(crate) extern "C" fn calibration_call<E>(_: &mut E, _: &Row) -> f32 {
    core::arch::naked_asm!(".rept {nops}", "nop", ".endr", "ret", nops = const CALIBRATION_NOPS)
}

/// The instruction clock: SysTick, which QEMU drives from the instruction count under `-icount`.
#[cfg(target_arch = "arm")]
pub(crate) mod clock {
    use core::ptr::with_exposed_provenance_mut;

    const CONTROL: usize = 0xE000_E010;
    const RELOAD: usize = 0xE000_E014;
    const CURRENT: usize = 0xE000_E018;
    const MASK: u32 = 0x00FF_FFFF;

    /// Starts the clock: core clock, no interrupt.
    pub(crate) fn start() {
        // SAFETY: the registers of SysTick, present in every target's core and used by nobody else.
        unsafe {
            with_exposed_provenance_mut::<u32>(RELOAD).write_volatile(MASK);
            with_exposed_provenance_mut::<u32>(CURRENT).write_volatile(0);
            with_exposed_provenance_mut::<u32>(CONTROL).write_volatile(0b101);
        }
    }

    /// Reads the clock; it counts down.
    #[inline(always)]
    pub(crate) fn now() -> u32 {
        // SAFETY: as in `start`.
        unsafe { with_exposed_provenance_mut::<u32>(CURRENT).read_volatile() }
    }

    /// Ticks from `earlier` to `later`, less than 2^24.
    #[inline(always)]
    pub(crate) fn elapsed(earlier: u32, later: u32) -> u32 {
        earlier.wrapping_sub(later) & MASK
    }
}

/// The instruction clock: `minstret`, exact under `-icount shift=0`.
#[cfg(target_arch = "riscv32")]
pub(crate) mod clock {
    use core::arch::asm;

    /// The counter runs from reset.
    pub(crate) fn start() {}

    /// Reads the low word of the clock.
    #[inline(always)]
    pub(crate) fn now() -> u32 {
        let ticks: u32;
        // SAFETY: reads a counter that machine mode may read.
        unsafe { asm!("csrr {}, minstret", out(reg) ticks, options(nostack)) };
        ticks
    }

    /// Ticks from `earlier` to `later`, less than 2^32.
    #[inline(always)]
    pub(crate) fn elapsed(earlier: u32, later: u32) -> u32 {
        later.wrapping_sub(earlier)
    }
}

/// Sets the floating-point control bits (FPSCR on Arm: bit 24 flushes subnormals to zero, bit 25 makes every NaN the
/// default one). Returns whether the target has them.
pub(crate) fn set_floating_point_control(bits: u32) -> bool {
    if bits == 0 {
        return true;
    }
    #[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
    {
        // SAFETY: changes how subnormals and NaN come out, which is what the caller asked for.
        unsafe { asm!("vmsr fpscr, {}", in(reg) bits, options(nomem, nostack)) };
        true
    }
    #[cfg(not(all(target_arch = "arm", target_abi = "eabihf")))]
    false
}

/// Starts the instruction clock, for a program that does not [`serve`](crate::serve).
pub fn start_clock() {
    clock::start();
}

/// A fault ends the emulation instead of hanging it.
#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
unsafe fn HardFault(_: &cortex_m_rt::ExceptionFrame) -> ! {
    crate::semihosting::exit(101)
}

/// A fault ends the emulation instead of hanging it.
#[cfg(target_arch = "riscv32")]
#[unsafe(no_mangle)]
extern "C" fn ExceptionHandler() -> ! {
    crate::semihosting::exit(101)
}
