//! What a drive would carry instead of Frikan, each as an evaluator of the harness: the same friction law
//! `(22 + 8 exp(-|v / 0.1|)) tanh(50 v) + 0.03 v` by a library's elementary functions or by a linear table.
//!
//! The image in flash is ignored: these laws are compiled in.
#![no_std]
#![deny(unsafe_code)]

pub mod c;
pub mod linear;

use frikan_firmware_harness::{Evaluator, Row};

/// An evaluator of a function that is compiled in.
pub trait Friction {
    /// Friction torque at a velocity.
    fn friction(velocity: f32) -> f32;
}

/// Makes an [`Evaluator`] of a [`Friction`].
pub struct Peer<F>(core::marker::PhantomData<F>);

impl<F: Friction> Evaluator for Peer<F> {
    fn decode(_: &'static [u8]) -> Result<Self, u32> {
        Ok(Self(core::marker::PhantomData))
    }

    fn inputs(&self) -> usize {
        1
    }

    fn evaluate(&mut self, row: &Row) -> f32 {
        F::friction(row[0])
    }
}

/// Nothing: its size is that of the harness.
pub struct Nothing;

impl Friction for Nothing {
    fn friction(velocity: f32) -> f32 {
        velocity
    }
}

/// The crate libm.
pub struct Libm;

impl Friction for Libm {
    fn friction(velocity: f32) -> f32 {
        (22.0 + 8.0 * libm::expf(-libm::fabsf(velocity / 0.1))) * libm::tanhf(50.0 * velocity) + 0.03 * velocity
    }
}

/// The crate micromath, which has no tanh: `1 - 2 / (exp(2 x) + 1)`.
pub struct Micromath;

impl Friction for Micromath {
    fn friction(velocity: f32) -> f32 {
        use micromath::F32Ext;
        let exp = |x: f32| F32Ext::exp(x);
        let tanh = 1.0 - 2.0 / (exp(100.0 * velocity) + 1.0);
        (22.0 + 8.0 * exp(-F32Ext::abs(velocity / 0.1))) * tanh + 0.03 * velocity
    }
}
