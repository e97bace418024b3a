//! The evaluators of this firmware's binaries: the friction image in flash, checked and decoded once or read in place, then evaluated.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(feature = "models", feature = "table"))]
mod drive;
#[cfg(feature = "integer")]
mod integer;
#[cfg(any(feature = "models", feature = "table"))]
mod joint;
#[cfg(feature = "models")]
mod laws;
#[cfg(feature = "watched")]
mod watched;

#[cfg(any(feature = "models", feature = "table"))]
pub use drive::Drive;
#[cfg(feature = "integer")]
pub use integer::CountingDrive;
#[cfg(any(feature = "models", feature = "table"))]
pub use joint::{Joint, Model, joint, read};
#[cfg(feature = "models")]
pub use laws::{IntegerDrive, StaticLaw};
#[cfg(feature = "watched")]
pub use watched::WatchedDrive;

use frikan_shared::image::ImageError;
#[cfg(feature = "models")]
pub use frikan_shared::pool::DRIVE_CELLS as CELLS;

/// The number by which the host knows a refusal.
pub fn reason(error: ImageError) -> u32 {
    match error {
        ImageError::Truncated => 1,
        ImageError::BadMagic => 2,
        ImageError::UnsupportedVersion(_) => 3,
        ImageError::TooLarge => 4,
        ImageError::TrailingBytes => 5,
        ImageError::CrcMismatch => 6,
        ImageError::Malformed => 7,
        ImageError::InvalidModel(_) => 8,
        _ => 9,
    }
}
