//! What a firmware asks of an image beside who made it: the joint, the unit of the torque, the channels that it reads, and how old it may be. An image
//! of another joint or in amperes where newton metres are meant is whole and authentic, and still the wrong one.

use core::hint::black_box;

use crate::authentication::Trust;
#[cfg(feature = "models")]
use crate::image::{Image, decode};
use crate::image::{ImageError, IntegerTableImage, TableImage};
use crate::units::Unit;
#[cfg(feature = "models")]
use crate::{model::Model, units::Quantity};

/// A set of the channels of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channels(u8);

impl Channels {
    /// Velocity of the joint.
    pub const VELOCITY: Self = Self(1);
    /// Position of the joint.
    pub const POSITION: Self = Self(2);
    /// Torque or force transmitted by the gear.
    pub const LOAD: Self = Self(4);
    /// Temperature.
    pub const TEMPERATURE: Self = Self(8);
    /// Acceleration of the joint.
    pub const ACCELERATION: Self = Self(16);
    /// Any channel without a standard quantity.
    pub const OTHER: Self = Self(32);
    /// All of them.
    pub const ALL: Self = Self(63);

    /// The set of the channels of both.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all of `other` are in the set.
    #[must_use]
    pub const fn hold(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }

    /// The set as bits, in the order of the constants from the lowest on.
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// The set of these bits; others are left out.
    #[must_use]
    pub const fn of_bits(bits: u8) -> Self {
        Self(bits & Self::ALL.0)
    }
}

/// What an image says of itself, all of it under its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts<'a> {
    /// Name of the joint, UTF-8.
    pub joint: &'a [u8],
    /// Unit of the torque.
    pub output_unit: Unit,
    /// Channels that the model reads.
    pub channels: Channels,
    /// Number of the release; 0 where there is none.
    pub release: u32,
}

/// What a firmware asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Demands<'a> {
    /// Name of the joint; any, where there is none.
    pub joint: Option<&'a [u8]>,
    /// Unit of the torque; any, where there is none.
    pub output_unit: Option<Unit>,
    /// Channels that the drive measures.
    pub channels: Channels,
    /// Least release: an older image is refused, and so is one without a number. The firmware raises it, in memory that no image reaches, when it
    /// has taken a later one. Only tagged images have a number.
    pub least_release: u32,
}

impl Demands<'_> {
    /// Any image will do.
    pub const NONE: Self = Self { joint: None, output_unit: None, channels: Channels::ALL, least_release: 0 };

    /// Whether an image is what is asked for.
    ///
    /// # Errors
    /// [`ImageError::OtherJoint`], [`ImageError::OtherUnit`], [`ImageError::MissingChannel`] or [`ImageError::Outdated`].
    #[inline(always)]
    pub fn met_by(&self, facts: &Facts<'_>) -> Result<(), ImageError> {
        if self.joint.is_some_and(|joint| !are_same(joint, facts.joint)) {
            return Err(ImageError::OtherJoint);
        }
        if self.output_unit.is_some_and(|unit| unit != facts.output_unit) {
            return Err(ImageError::OtherUnit);
        }
        if !self.channels.hold(facts.channels) {
            return Err(ImageError::MissingChannel);
        }
        if facts.release < self.least_release { Err(ImageError::Outdated) } else { Ok(()) }
    }
}

/// Whether two names are the same.
fn are_same(one: &[u8], other: &[u8]) -> bool {
    // Behind a black box the loop stays as short as it is written.
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| black_box(*one) == *other)
}

/// Whom a firmware trusts, and what it asks for.
#[derive(Clone, Copy, Debug)]
pub struct Admission<'a> {
    /// Who may have made the image.
    pub trust: Trust<'a>,
    /// What it has to be.
    pub demands: Demands<'a>,
}

impl Admission<'_> {
    /// Anyone's image, whatever it is.
    pub const ANY: Self = Self { trust: Trust::Anyone, demands: Demands::NONE };

    /// The table of exactly one image that is admitted, to be read where it lies.
    ///
    /// # Errors
    /// Those of [`Trust::released`], [`TableImage::read`] and [`Demands::met_by`].
    #[inline(always)]
    pub fn table<'b>(&self, bytes: &'b [u8]) -> Result<TableImage<'b>, ImageError> {
        let (image, release) = self.trust.released(bytes)?;
        let table = TableImage::read(image)?;
        self.demands.met_by(&table.facts(release)).map(|()| table)
    }

    /// The integer table of exactly one image that is admitted, to be read where it lies.
    ///
    /// # Errors
    /// Those of [`Trust::released`], [`IntegerTableImage::read`] and [`Demands::met_by`].
    #[inline(always)]
    pub fn integer_table<'b>(&self, bytes: &'b [u8]) -> Result<IntegerTableImage<'b>, ImageError> {
        let (image, release) = self.trust.released(bytes)?;
        let table = IntegerTableImage::read(image)?;
        self.demands.met_by(&table.facts(release)).map(|()| table)
    }

    /// Decodes exactly one image that is admitted.
    ///
    /// # Errors
    /// Those of [`Trust::released`], [`decode`] and [`Demands::met_by`].
    #[cfg(feature = "models")]
    pub fn decode<const CELLS: usize>(&self, bytes: &[u8]) -> Result<Image<CELLS>, ImageError> {
        let (bytes, release) = self.trust.released(bytes)?;
        let image = decode(bytes)?;
        self.demands.met_by(&image.facts(release)).map(|()| image)
    }
}

impl<'a> TableImage<'a> {
    /// What the image says of itself.
    #[must_use]
    pub fn facts(&self, release: u32) -> Facts<'a> {
        Facts { joint: self.joint, output_unit: self.output_unit, channels: Channels::VELOCITY, release }
    }
}

impl<'a> IntegerTableImage<'a> {
    /// What the image says of itself.
    #[must_use]
    pub fn facts(&self, release: u32) -> Facts<'a> {
        Facts { joint: self.joint, output_unit: self.output_unit, channels: Channels::VELOCITY, release }
    }
}

#[cfg(feature = "models")]
impl<const CELLS: usize> Image<CELLS> {
    /// What the image says of itself.
    #[must_use]
    pub fn facts(&self, release: u32) -> Facts<'_> {
        let joint = self.provenance.joint.as_bytes();
        Facts { joint, output_unit: self.model.output_unit, channels: channels(&self.model), release }
    }
}

/// The channels that a model reads.
#[cfg(feature = "models")]
fn channels<const CELLS: usize>(model: &Model<CELLS>) -> Channels {
    let channel = |quantity: &Quantity| match quantity {
        Quantity::Velocity => Channels::VELOCITY,
        Quantity::Position => Channels::POSITION,
        Quantity::Load => Channels::LOAD,
        Quantity::Temperature => Channels::TEMPERATURE,
        Quantity::Acceleration => Channels::ACCELERATION,
        Quantity::Other(_) => Channels::OTHER,
    };
    model.inputs.iter().fold(Channels(0), |all, input| all.with(channel(&input.quantity)))
}

#[cfg(all(test, feature = "models", feature = "auth"))]
mod tests;
