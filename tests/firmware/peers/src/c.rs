//! The peers in C. The only `unsafe` of this crate: it says what the functions of `c/friction.c` are.
#![allow(unsafe_code)]

use crate::Friction;
use crate::linear::TABLE;

unsafe extern "C" {
    safe fn friction_newlib_float(velocity: f32) -> f32;
    safe fn friction_newlib_double(velocity: f32) -> f32;
    fn friction_linear_table(table: *const f32, velocity: f32) -> f32;
}

/// newlib's `expf` and `tanhf`.
pub struct NewlibFloat;

impl Friction for NewlibFloat {
    fn friction(velocity: f32) -> f32 {
        friction_newlib_float(velocity)
    }
}

/// newlib's `exp` and `tanh`.
pub struct NewlibDouble;

impl Friction for NewlibDouble {
    fn friction(velocity: f32) -> f32 {
        friction_newlib_double(velocity)
    }
}

/// Linear interpolation in C.
pub struct LinearTableC;

impl Friction for LinearTableC {
    fn friction(velocity: f32) -> f32 {
        // SAFETY: the table has the 256 entries that the function reads.
        unsafe { friction_linear_table(TABLE.as_ptr(), velocity) }
    }
}
