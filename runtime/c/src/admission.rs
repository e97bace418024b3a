//! What image a drive takes, and what an image says of itself. Audit: a key is read for its length, the joint's name up to its end or its longest.

use core::ffi::c_char;
use core::hint::black_box;

use frikan_runtime::shared::authentication::admission::{Admission, Channels, Demands, Facts};
use frikan_runtime::shared::authentication::signature::{PUBLIC_KEY_BYTES, PublicKey};
use frikan_runtime::shared::authentication::{KEY_BYTES, Key, Trust};
use frikan_runtime::shared::image::{ImageError, image_crc32};
use frikan_runtime::shared::units::Unit;

use crate::memory::readable;
use crate::model::{ImageModel, read, with_facts};
use crate::types::FrikanStatus;

/// Longest name of a joint, bytes.
pub const FRIKAN_JOINT_BYTES: usize = 32;

/// Units of the torque of an image: any, in demands.
pub const FRIKAN_UNIT_ANY: u32 = 0;
/// Newton metre.
pub const FRIKAN_UNIT_NEWTON_METRE: u32 = 8;
/// Newton.
pub const FRIKAN_UNIT_NEWTON: u32 = 9;
/// Ampere.
pub const FRIKAN_UNIT_AMPERE: u32 = 10;

/// Channels: velocity of the joint.
pub const FRIKAN_CHANNEL_VELOCITY: u32 = 1;
/// Position of the joint.
pub const FRIKAN_CHANNEL_POSITION: u32 = 2;
/// Torque or force transmitted by the gear.
pub const FRIKAN_CHANNEL_LOAD: u32 = 4;
/// Temperature.
pub const FRIKAN_CHANNEL_TEMPERATURE: u32 = 8;
/// Acceleration of the joint.
pub const FRIKAN_CHANNEL_ACCELERATION: u32 = 16;
/// Any channel without a standard quantity.
pub const FRIKAN_CHANNEL_OTHER: u32 = 32;

const _: () = {
    assert!(Unit::NewtonMetre as u32 + 1 == FRIKAN_UNIT_NEWTON_METRE && Unit::Newton as u32 + 1 == FRIKAN_UNIT_NEWTON);
    assert!(Unit::Ampere as u32 + 1 == FRIKAN_UNIT_AMPERE);
    assert!(
        Channels::OTHER.bits() as u32 == FRIKAN_CHANNEL_OTHER && Channels::LOAD.bits() as u32 == FRIKAN_CHANNEL_LOAD
    );
};

/// What image a drive takes: all that is 0 takes any.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanTrust {
    /// FRIKAN_KEY_BYTES, of whoever may make images: one without its tag is refused; null for a drive that takes anyone's.
    pub key: *const u8,
    /// FRIKAN_PUBLIC_KEY_BYTES, those that `trainer export --signing-key-file` prints: an image without the signature of its secret is refused; null for none. A
    /// drive that asks for both takes no image.
    pub public_key: *const u8,
    /// Name of the joint, ended by a 0; null for any.
    pub joint: *const c_char,
    /// Unit of the torque, FRIKAN_UNIT_...
    pub unit: u32,
    /// Channels that the drive measures, the sum of FRIKAN_CHANNEL_...: an image that reads another is refused.
    pub channels: u32,
    /// Least release, of which the tag has the number: an older image is refused. The firmware raises it, in memory that no image reaches, when it has
    /// taken a later one.
    pub least_release: u32,
}

/// What an image says of itself.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanFacts {
    /// Name of the joint, ended by a 0.
    pub joint: [c_char; FRIKAN_JOINT_BYTES + 1],
    /// Unit of the torque, FRIKAN_UNIT_...
    pub unit: u32,
    /// Channels that the model reads, the sum of FRIKAN_CHANNEL_...
    pub channels: u32,
    /// Number of the release; 0 where there is none, or no key to believe it.
    pub release: u32,
    /// CRC-32 of the image, as `trainer show` prints it.
    pub crc32: u32,
}

/// The trust of C, with one key at most.
#[derive(Clone)]
pub(crate) struct Trusted<'a> {
    key: Option<Key>,
    public_key: Option<PublicKey>,
    demands: Demands<'a>,
}

impl Trusted<'_> {
    /// The same with a key that is borrowed.
    pub(crate) fn admission(&self) -> Admission<'_> {
        let trust = match (&self.key, &self.public_key) {
            (Some(key), _) => Trust::Key(key),
            (None, Some(key)) => Trust::Signed(key),
            (None, None) => Trust::Anyone,
        };
        Admission { trust, demands: self.demands }
    }

    /// The model of exactly one image.
    pub(crate) fn read(&self, image: &'static [u8]) -> Result<ImageModel, ImageError> {
        read(image, &self.admission())
    }

    /// The model of the image at the start of a region of flash.
    pub(crate) fn image_in(&self, flash: &'static [u8]) -> Result<ImageModel, ImageError> {
        self.admission().trust.stored(flash).and_then(|image| self.read(image))
    }
}

/// The key of C, where there is one. A library without authentication does not start with one.
///
/// # Safety
/// `key` is null or KEY_BYTES may be read from it.
unsafe fn key_at(key: *const u8) -> Result<Option<Key>, ImageError> {
    // SAFETY: the caller's word; an array of bytes has no alignment.
    match unsafe { key.cast::<[u8; KEY_BYTES]>().as_ref() } {
        None => Ok(None),
        #[cfg(feature = "auth")]
        Some(bytes) => Ok(Some(Key::new(*bytes))),
        #[cfg(not(feature = "auth"))]
        Some(_) => Err(ImageError::NotBuiltIn),
    }
}

/// The public key of C, where there is one. A library without signatures does not start with one.
///
/// # Safety
/// `key` is null or PUBLIC_KEY_BYTES may be read from it.
unsafe fn public_key_at(key: *const u8) -> Result<Option<PublicKey>, ImageError> {
    // SAFETY: the caller's word; an array of bytes has no alignment.
    match unsafe { key.cast::<[u8; PUBLIC_KEY_BYTES]>().as_ref() } {
        None => Ok(None),
        #[cfg(feature = "signature")]
        Some(bytes) => Ok(Some(PublicKey::new(*bytes))),
        #[cfg(not(feature = "signature"))]
        Some(_) => Err(ImageError::NotBuiltIn),
    }
}

/// The bytes of a name before its 0; one that is too long for any joint is cut behind the longest, and so no joint's.
///
/// # Safety
/// `name` is null or may be read up to a 0 or FRIKAN_JOINT_BYTES and one more.
unsafe fn name_at<'a>(name: *const c_char) -> Option<&'a [u8]> {
    if name.is_null() {
        return None;
    }
    let mut length = 0;
    // SAFETY: the caller's word.
    while length <= FRIKAN_JOINT_BYTES && unsafe { name.add(length).read() } != 0 {
        // Behind a black box the loop stays as short as it is written.
        length = black_box(length + 1);
    }
    // SAFETY: so many bytes were just read.
    Some(unsafe { readable(name.cast(), length) })
}

/// The trust of C; any for a null pointer.
///
/// # Safety
/// `trust` is null or may be read, and its pointers as [`key_at`], [`public_key_at`] and [`name_at`] say.
pub(crate) unsafe fn at<'a>(trust: *const FrikanTrust) -> Result<Trusted<'a>, ImageError> {
    // SAFETY: the caller's word.
    let Some(FrikanTrust { key, public_key, joint, unit, channels, least_release }) = (unsafe { trust.as_ref() })
    else {
        return Ok(Trusted { key: None, public_key: None, demands: Demands::NONE });
    };
    let output_unit = match unit.checked_sub(1) {
        None => None,
        // A unit that no image has.
        Some(number) => Some(*Unit::ALL.get(number as usize).ok_or(ImageError::OtherUnit)?),
    };
    let channels = if *channels == 0 { Channels::ALL } else { Channels::of_bits(*channels as u8) };
    // SAFETY: the caller's word.
    let (key, public_key, joint) = unsafe { (key_at(*key)?, public_key_at(*public_key)?, name_at(*joint)) };
    if key.is_some() && public_key.is_some() {
        return Err(ImageError::NotAuthentic);
    }
    Ok(Trusted { key, public_key, demands: Demands { joint, output_unit, channels, least_release: *least_release } })
}

/// What the image at an address says of itself, once it is found whole and what the drive takes.
///
/// @param trust  as for frikan_start
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_facts(
    flash: *const u8,
    bytes: usize,
    trust: *const FrikanTrust,
    facts: *mut FrikanFacts,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let (flash, trusted) = unsafe { (readable(flash, bytes), at(trust)) };
    let told = trusted.and_then(|trusted| {
        let admission = trusted.admission();
        let image = admission.trust.stored(flash)?;
        let crc32 = image_crc32(flash)?;
        with_facts(image, &admission, |facts| in_c(facts, crc32))
    });
    match told {
        Err(error) => error.into(),
        // SAFETY: the caller's word.
        Ok(told) => match unsafe { facts.as_mut() } {
            None => FrikanStatus::NotStarted,
            Some(place) => {
                *place = told;
                FrikanStatus::Active
            }
        },
    }
}

fn in_c(facts: &Facts<'_>, crc32: u32) -> FrikanFacts {
    let mut joint = [0; FRIKAN_JOINT_BYTES + 1];
    for (place, byte) in joint.iter_mut().take(FRIKAN_JOINT_BYTES).zip(facts.joint) {
        *place = *byte as c_char;
    }
    FrikanFacts {
        joint,
        unit: facts.output_unit as u32 + 1,
        channels: facts.channels.bits().into(),
        release: facts.release,
        crc32,
    }
}
