//! The compensator of the features that this firmware was built with.

use frikan_runtime::compensator::{Limited, Limits};
use frikan_shared::authentication::Trust;
use frikan_shared::image::ImageError;

/// What an image is decoded to.
#[cfg(feature = "models")]
pub type Model = frikan_runtime::compensator::Decoded<{ crate::CELLS }>;

/// A table in flash.
#[cfg(not(feature = "models"))]
pub type Model = frikan_runtime::in_place::TableInPlace<'static>;

/// A compensator of such a model.
pub type Joint = Limited<Model>;

/// The model of exactly one image, with its tag where one is asked for.
#[cfg(feature = "models")]
pub fn read(image: &'static [u8], trust: Trust<'_>) -> Result<Model, ImageError> {
    trust.decode(image).and_then(|image| Model::new(image.model))
}

/// The model of exactly one image, with its tag where one is asked for.
#[cfg(not(feature = "models"))]
pub fn read(image: &'static [u8], trust: Trust<'_>) -> Result<Model, ImageError> {
    trust.authentic(image).and_then(Model::new)
}

/// Compensation by the image at the start of a region of flash.
#[cfg(feature = "models")]
pub fn joint(flash: &'static [u8], limits: Limits) -> Joint {
    Limited::by(Trust::Anyone.stored(flash).and_then(|image| read(image, Trust::Anyone)), limits)
}

/// Compensation by the image at the start of a region of flash.
#[cfg(not(feature = "models"))]
pub fn joint(flash: &'static [u8], limits: Limits) -> Joint {
    Limited::by(Model::at_start(flash), limits)
}
