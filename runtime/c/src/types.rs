//! What C hands over and gets back.

use core::ffi::c_void;

use frikan_runtime::compensator::Status;
use frikan_runtime::measurement::Measurement;
use frikan_runtime::shared::image::ImageError;

/// Cells of tables for which a compensator has room; an image with more is refused. The environment variable of the same name, at the build of the
/// library, sets another number.
///
/// cbindgen:ignore
pub const FRIKAN_CELLS: usize = match option_env!("FRIKAN_CELLS") {
    None => 128,
    Some(digits) => number(digits.as_bytes()),
};

/// A decimal number from 1 to 9999, or no library at all.
const fn number(digits: &[u8]) -> usize {
    assert!(!digits.is_empty() && digits.len() < 5, "FRIKAN_CELLS is no number from 1 to 9999");
    let (mut number, mut at) = (0, 0);
    while at < digits.len() {
        assert!(digits[at].is_ascii_digit(), "FRIKAN_CELLS is no number from 1 to 9999");
        number = 10 * number + (digits[at] - b'0') as usize;
        at += 1;
    }
    assert!(number > 0, "FRIKAN_CELLS is no number from 1 to 9999");
    number
}

/// Bytes of a key.
pub const FRIKAN_KEY_BYTES: usize = 32;

/// Bytes of a public key.
pub const FRIKAN_PUBLIC_KEY_BYTES: usize = 32;

/// Bytes of the header of a slot.
pub const FRIKAN_SLOT_HEADER_BYTES: usize = 16;

/// Words of a compensator's memory; the header has the same.
///
/// cbindgen:ignore
pub const FRIKAN_STORAGE_WORDS: usize = if cfg!(feature = "models") { 384 + 2 * FRIKAN_CELLS } else { 12 };

/// Channels without a standard quantity.
pub const FRIKAN_OTHER_CHANNELS: usize = 4;

/// Whether a torque is a compensation, and why not.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrikanStatus {
    /// The torque compensates friction.
    Active = 0,
    /// A channel that the model reads was missing or not finite, or the sample period not above 0 s and at most 1 s: the torque is 0.
    NotFinite = 1,
    /// The compensator was never started, or a pointer is null.
    NotStarted = 2,
    /// Neither slot holds an intact image.
    NoImage = 3,
    /// The tag of the key or the signature does not stand behind the image.
    NotAuthentic = 4,
    /// The bytes end before the image does.
    Truncated = 5,
    /// The bytes are no image.
    BadMagic = 6,
    /// The image is of a later format, or of one that is no longer read.
    UnsupportedVersion = 7,
    /// The image has more cells than FRIKAN_CELLS.
    TooLarge = 8,
    /// Bytes follow the image in its slot.
    TrailingBytes = 9,
    /// The image is damaged.
    CrcMismatch = 10,
    /// The image is not what its format says.
    Malformed = 11,
    /// The model cannot be evaluated.
    InvalidModel = 12,
    /// A limit is missing, negative or not finite, or the slew is 0: nothing was changed.
    BadLimits = 13,
    /// Velocity and position have contradicted each other for too long: the torque ramps down to 0 and stays there until frikan_clear_fault.
    Implausible = 14,
    /// A setting of the supervision is out of range: nothing was changed.
    BadSupervision = 15,
    /// The image needs a part that this library was built without.
    NotBuiltIn = 16,
    /// Compensated, but by less than half of what the gain asks for, since more would feed the joint; or slowly, with an encoder that has too few
    /// counts to tell whether the joint sticks.
    Degraded = 17,
    /// The slots cannot be kept on such flash, or there is no function to read it.
    BadFlash = 18,
    /// The flash did not take the image: what was in use before still is.
    NotWritten = 19,
    /// The image is of another joint than the drive asks for.
    OtherJoint = 20,
    /// The torque of the image is in another unit.
    OtherUnit = 21,
    /// The image reads a channel that the drive does not measure.
    MissingChannel = 22,
    /// The image is older than the drive allows.
    Outdated = 23,
}

impl From<ImageError> for FrikanStatus {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::NoImage => Self::NoImage,
            ImageError::NotAuthentic => Self::NotAuthentic,
            ImageError::Truncated => Self::Truncated,
            ImageError::BadMagic => Self::BadMagic,
            ImageError::UnsupportedVersion(_) => Self::UnsupportedVersion,
            ImageError::TooLarge => Self::TooLarge,
            ImageError::TrailingBytes => Self::TrailingBytes,
            ImageError::CrcMismatch => Self::CrcMismatch,
            ImageError::InvalidModel(_) => Self::InvalidModel,
            ImageError::NotBuiltIn => Self::NotBuiltIn,
            ImageError::OtherJoint => Self::OtherJoint,
            ImageError::OtherUnit => Self::OtherUnit,
            ImageError::MissingChannel => Self::MissingChannel,
            ImageError::Outdated => Self::Outdated,
            _ => Self::Malformed,
        }
    }
}

impl From<Status> for FrikanStatus {
    fn from(status: Status) -> Self {
        match status {
            Status::Active => Self::Active,
            Status::NotFinite => Self::NotFinite,
            Status::NoModel(error) => error.into(),
        }
    }
}

/// Limits of the firmware; no image changes them. All are finite, none is negative, and the slew is above 0.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanLimits {
    /// Share of the friction that is compensated, 0 to 1 in most drives.
    pub gain: f32,
    /// Largest torque put out, in the unit of the model's output.
    pub torque: f32,
    /// Its largest change in a second.
    pub slew: f32,
    /// Largest position put out, rad or m; 0 for none.
    pub position: f32,
}

/// What the drive knows of the joint in one sample, in SI. Channels that the model does not use may hold anything; one that it does use and
/// that nobody measures has to be NaN, as in frikan_no_measurement, and gives no torque.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct FrikanMeasurement {
    /// Velocity, measured or of the reference, rad/s or m/s.
    pub velocity: f32,
    /// Position, rad or m.
    pub position: f32,
    /// Acceleration, rad/s^2 or m/s^2.
    pub acceleration: f32,
    /// Torque or force transmitted by the gear, N m or N.
    pub load: f32,
    /// Temperature, degC.
    pub temperature: f32,
    /// Channels without a standard quantity, in the order of the model's inputs.
    pub other: [f32; FRIKAN_OTHER_CHANNELS],
}

impl From<&Measurement> for FrikanMeasurement {
    fn from(measurement: &Measurement) -> Self {
        let Measurement { velocity, position, acceleration, load, temperature, other } = *measurement;
        Self { velocity, position, acceleration, load, temperature, other }
    }
}

impl From<&FrikanMeasurement> for Measurement {
    fn from(measurement: &FrikanMeasurement) -> Self {
        let FrikanMeasurement { velocity, position, acceleration, load, temperature, other } = *measurement;
        Self { velocity, position, acceleration, load, temperature, other }
    }
}

/// A law that is compiled in, such as `trainer export --to c` writes it: from what was handed over at the start, a sample and its period in
/// seconds to the friction. NaN where a channel that it reads is missing: the torque is then 0.
pub type FrikanLaw =
    Option<unsafe extern "C" fn(context: *mut c_void, measurement: *const FrikanMeasurement, dt: f32) -> f32>;

/// The answer to one sample.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrikanCompensation {
    /// Torque to add, in the unit of the model's output; 0 unless active.
    pub torque: f32,
    /// What the model says of the link's position against the motor's, rad, within the limit; 0 unless active.
    pub position: f32,
    /// Whether it is a compensation.
    pub status: FrikanStatus,
}

/// A write to come.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrikanSlotWrite {
    /// 0 for the first slot, 1 for the second.
    pub slot: u32,
    /// Number for the slot's header.
    pub sequence: u32,
}
