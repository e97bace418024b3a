//! What a compensator of C is driven by: an image, as far as this library was built for it, or a law of the firmware. Audit: the law and
//! its context are the caller's word, given at the start.

use core::ffi::c_void;

use frikan_runtime::compensator::{Exported, FrictionModel};
#[cfg(feature = "models")]
use frikan_runtime::friction::Warmth;
use frikan_runtime::measurement::{Friction, Measurement};
use frikan_runtime::shared::authentication::admission::{Admission, Facts};
use frikan_runtime::shared::image::ImageError;

use crate::types::FrikanMeasurement;

/// An image decoded to memory.
#[cfg(feature = "models")]
pub(crate) type ImageModel = frikan_runtime::compensator::Decoded<{ crate::types::FRIKAN_CELLS }>;

/// A table where it lies in flash.
#[cfg(not(feature = "models"))]
pub(crate) type ImageModel = frikan_runtime::in_place::TableInPlace<'static>;

/// The model of exactly one image that is admitted.
#[cfg(feature = "models")]
pub(crate) fn read(image: &'static [u8], admission: &Admission<'_>) -> Result<ImageModel, ImageError> {
    admission.decode(image).and_then(|image| ImageModel::new(image.model))
}

/// The model of exactly one image that is admitted.
#[cfg(not(feature = "models"))]
pub(crate) fn read(image: &'static [u8], admission: &Admission<'_>) -> Result<ImageModel, ImageError> {
    admission.table(image).map(ImageModel::from)
}

/// What is made of what exactly one image says of itself, where it is admitted.
pub(crate) fn with_facts<T>(
    bytes: &[u8],
    admission: &Admission<'_>,
    told: impl FnOnce(&Facts<'_>) -> T,
) -> Result<T, ImageError> {
    let (_, release) = admission.trust.released(bytes)?;
    #[cfg(feature = "models")]
    let image = admission.decode::<{ crate::types::FRIKAN_CELLS }>(bytes)?;
    #[cfg(not(feature = "models"))]
    let image = match admission.table(bytes) {
        #[cfg(feature = "integer")]
        Err(ImageError::NotBuiltIn) => return Ok(told(&admission.integer_table(bytes)?.facts(release))),
        table => table?,
    };
    Ok(told(&image.facts(release)))
}

/// What gives the friction.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Model {
    /// An image.
    Image(ImageModel),
    /// A law of the firmware.
    Law(Law),
}

/// A law of the firmware and what it is called with.
pub(crate) struct Law {
    pub(crate) function: unsafe extern "C" fn(*mut c_void, *const FrikanMeasurement, f32) -> f32,
    pub(crate) context: *mut c_void,
}

#[cfg(feature = "models")]
impl Model {
    /// How warm the joint is, where the model is an image.
    pub(crate) fn warmth(&self) -> Option<Warmth> {
        if let Self::Image(model) = self { Some(model.warmth()) } else { None }
    }

    /// At rest, and as warm as `warmth` is after a rest of so many seconds.
    pub(crate) fn restore(&mut self, warmth: &Warmth, rest: f32) {
        if let Self::Image(model) = self {
            model.restore(warmth, rest);
        }
    }
}

impl FrictionModel for Model {
    fn friction(&mut self, measurement: &Measurement, dt: f32, is_step: i32, largest_position: f32) -> Friction {
        match self {
            Self::Image(model) => model.friction(measurement, dt, is_step, largest_position),
            Self::Law(Law { function, context }) => {
                let call = |sample: &Measurement, dt: f32| {
                    let sample = FrikanMeasurement::from(sample);
                    // SAFETY: the word that was given for both at the start.
                    unsafe { function(*context, &raw const sample, dt) }
                };
                Exported(call).friction(measurement, dt, is_step, largest_position)
            }
        }
    }

    #[inline(always)]
    fn share(
        &mut self,
        gain: f32,
        measurement: &Measurement,
        dt: f32,
        is_step: i32,
        largest_position: f32,
    ) -> Friction {
        match self {
            Self::Image(model) => model.share(gain, measurement, dt, is_step, largest_position),
            Self::Law(_) => {
                let friction = self.friction(measurement, dt, is_step, largest_position);
                Friction { torque: gain * friction.torque, ..friction }
            }
        }
    }

    fn rest(&mut self) {
        if let Self::Image(model) = self {
            model.rest();
        }
    }

    fn checksum(&self) -> Option<u32> {
        if let Self::Image(model) = self { model.checksum() } else { None }
    }
}
