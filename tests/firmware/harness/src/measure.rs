//! Instructions and stack of one call.

use core::hint::black_box;

use crate::hardware::{calibration_call, clock, empty_call, stack_depth};
use crate::protocol::{MAX_INPUTS, Row};

/// An evaluation as the harness calls it.
pub(crate) type Call<E> = extern "C" fn(&mut E, &Row) -> f32;

/// Calls through a pointer that the compiler cannot see through, so that every call costs the same around it, and
/// returns the output with the ticks between the two readings of the clock.
#[inline(never)]
pub(crate) fn ticks<E>(call: Call<E>, evaluator: &mut E, row: &Row) -> (f32, u32) {
    let (call, evaluator, row) = (black_box(call), black_box(evaluator), black_box(row));
    let start = clock::now();
    let output = black_box(call(evaluator, row));
    let end = clock::now();
    (output, clock::elapsed(start, end))
}

/// Ticks of `work`, then the stack bytes that it uses when it runs again.
#[inline(never)]
pub(crate) fn ticks_and_stack<R>(work: impl Fn() -> R) -> (u32, u32) {
    (ticks_of(&work), stack_of(&work))
}

/// Ticks of a call that only returns and of one with [`CALIBRATION_NOPS`](crate::protocol::CALIBRATION_NOPS) more instructions, for the
/// host to turn ticks into instructions.
#[must_use]
pub fn calibration() -> [u32; 2] {
    let row = [0.0; MAX_INPUTS];
    [empty_call::<()>, calibration_call::<()>].map(|call: Call<()>| ticks(call, &mut (), &row).1)
}

/// What `work` returns, and the ticks that it took.
#[inline(never)]
pub fn counted<R>(work: impl FnOnce() -> R) -> (R, u32) {
    let start = clock::now();
    let result = work();
    (result, clock::elapsed(start, clock::now()))
}

// Frames of their own, so that only one result of `work` is on the stack at a time.
#[inline(never)]
fn ticks_of<R>(work: impl Fn() -> R) -> u32 {
    let start = clock::now();
    black_box(black_box(&work)());
    clock::elapsed(start, clock::now())
}

#[inline(never)]
fn stack_of<R>(work: impl Fn() -> R) -> u32 {
    let (_, bytes) = stack_depth(|| {
        black_box(work());
    });
    bytes
}
