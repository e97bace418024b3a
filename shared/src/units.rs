//! Units of channels and outputs, and the quantities that a model may read.

#[cfg(feature = "models")]
use serde::{Deserialize, Serialize};

/// Longest name of an input channel that has no standard quantity, in bytes.
pub const CHANNEL_NAME_BYTES: usize = 16;

/// Unit of a channel or of the output. All are SI; a drive converts before it calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize))]
pub enum Unit {
    /// Dimensionless, written `1`.
    One,
    /// Joint angle.
    Radian,
    /// Joint velocity.
    RadianPerSecond,
    /// Joint acceleration.
    RadianPerSecondSquared,
    /// Axis position.
    Metre,
    /// Axis velocity.
    MetrePerSecond,
    /// Axis acceleration.
    MetrePerSecondSquared,
    /// Torque.
    NewtonMetre,
    /// Force.
    Newton,
    /// Motor current.
    Ampere,
    /// Temperature in degrees Celsius.
    Celsius,
    /// Voltage.
    Volt,
}

impl Unit {
    /// Every unit by the number that an image has of it.
    pub const ALL: [Self; 12] = [
        Self::One,
        Self::Radian,
        Self::RadianPerSecond,
        Self::RadianPerSecondSquared,
        Self::Metre,
        Self::MetrePerSecond,
        Self::MetrePerSecondSquared,
        Self::NewtonMetre,
        Self::Newton,
        Self::Ampere,
        Self::Celsius,
        Self::Volt,
    ];

    /// The unit as it is printed, for example `rad/s`.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::One => "1",
            Self::Radian => "rad",
            Self::RadianPerSecond => "rad/s",
            Self::RadianPerSecondSquared => "rad/s^2",
            Self::Metre => "m",
            Self::MetrePerSecond => "m/s",
            Self::MetrePerSecondSquared => "m/s^2",
            Self::NewtonMetre => "N m",
            Self::Newton => "N",
            Self::Ampere => "A",
            Self::Celsius => "degC",
            Self::Volt => "V",
        }
    }
}

/// What an input channel measures. The compensator feeds the standard quantities by name.
#[cfg(feature = "models")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Joint or axis velocity.
    Velocity,
    /// Joint or axis position.
    Position,
    /// Torque or force transmitted by the gear.
    Load,
    /// Temperature of housing, oil or winding.
    Temperature,
    /// Joint or axis acceleration.
    Acceleration,
    /// Any other channel, by its column name.
    Other(heapless::String<CHANNEL_NAME_BYTES>),
}

#[cfg(feature = "models")]
impl Quantity {
    /// The name of the channel as in a recording's column, without its unit.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Velocity => "velocity",
            Self::Position => "position",
            Self::Load => "load",
            Self::Temperature => "temperature",
            Self::Acceleration => "acceleration",
            Self::Other(name) => name.as_str(),
        }
    }
}
