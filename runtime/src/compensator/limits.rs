//! Limits of the firmware, and what is put out within them.

use frikan_shared::image::ImageError;

use crate::bounds::{beyond, within};
use crate::measurement::Friction;

/// Largest torque limit: the difference of two torques within it is finite.
pub const LARGEST_TORQUE: f32 = 0.25 * f32::MAX;

/// Limits of the firmware, all in force at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    gain: f32,
    torque: f32,
    slew: f32,
    position: f32,
}

/// Which limit cannot be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LimitError {
    /// The gain is negative or not finite.
    Gain,
    /// The largest torque is negative or not finite.
    Torque,
    /// The slew is not positive or not finite: a torque that cannot change would stay for ever.
    Slew,
    /// The largest position is negative or not finite.
    Position,
}

impl Limits {
    /// No compensation at all.
    pub const OFF: Self = Self { gain: 0.0, torque: 0.0, slew: f32::MAX, position: 0.0 };

    /// `gain`: share of the friction that is compensated, 0 to 1 in most drives; `torque`: largest torque put out, in the unit of the
    /// model's output, [`LARGEST_TORQUE`] at most; `slew`: its largest change in a second. A change in one sample below the rounding step of the
    /// torque (6e-8 of it) does not move it. No position is put out until [`Limits::with_position`] allows one.
    ///
    /// # Errors
    /// [`LimitError`] where gain or torque is negative, the slew is not positive, or one of them is not finite.
    pub fn new(gain: f32, torque: f32, slew: f32) -> Result<Self, LimitError> {
        Ok(Self {
            gain: not_negative(gain).ok_or(LimitError::Gain)?,
            torque: within(not_negative(torque).ok_or(LimitError::Torque)?, LARGEST_TORQUE),
            slew: not_negative(slew).filter(|slew| *slew > 0.0).ok_or(LimitError::Slew)?,
            position: 0.0,
        })
    }

    /// With positions of up to `position` rad put out, to either side.
    ///
    /// # Errors
    /// [`LimitError::Position`] where it is negative or not finite.
    pub fn with_position(self, position: f32) -> Result<Self, LimitError> {
        Ok(Self { position: not_negative(position).ok_or(LimitError::Position)?, ..self })
    }

    /// The share of the friction that is compensated.
    #[must_use]
    pub fn gain(&self) -> f32 {
        self.gain
    }

    /// The largest torque put out.
    #[must_use]
    pub fn torque(&self) -> f32 {
        self.torque
    }

    /// Its largest change in a second.
    #[must_use]
    pub fn slew(&self) -> f32 {
        self.slew
    }

    /// The largest position put out, rad.
    #[must_use]
    pub fn position(&self) -> f32 {
        self.position
    }

    /// As near to the torque `wanted` as the torque limit allows and a change of at most `reach` from `torque`, which may lie beyond a limit
    /// that is new. Written as what is taken back of the change wanted, so that rounding does not lead beyond the limit.
    #[inline(always)]
    pub(crate) fn approach(&self, torque: f32, wanted: f32, reach: f32) -> f32 {
        let wanted = within(wanted, self.torque);
        let change = wanted - torque;
        wanted - beyond(change, reach)
    }
}

/// A limit without the sign of a zero; none where it is negative or not finite.
fn not_negative(limit: f32) -> Option<f32> {
    (limit >= 0.0 && limit.is_finite()).then(|| limit.abs())
}

/// Whether a torque is a compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// The torque compensates friction.
    Active,
    /// No usable model: the torque is 0.
    NoModel(ImageError),
    /// A channel that the model reads was missing or not finite, or the sample period not above 0 s and at most 1 s: the torque is 0.
    NotFinite,
}

/// The answer to one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    /// Torque to add, in the unit of the model's output.
    pub torque: f32,
    /// What the model says of the link's position against the motor's, rad, within the limit; 0 unless active.
    pub position: f32,
    /// Whether it is a compensation.
    pub status: Status,
}

/// What is put out, within limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    limits: Limits,
    /// What was put out last.
    torque: f32,
}

impl Output {
    /// Nothing was put out yet.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self { limits, torque: 0.0 }
    }

    /// The limits in force.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Changes the limits between two samples; the slew limit holds across the change, that of a lower torque limit too.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
    }

    /// Puts out no torque, at once.
    pub fn release(&mut self) {
        self.torque = 0.0;
    }

    /// As near to the share of the friction that is compensated as the limits allow after `dt` seconds; 0 at once where the sample is of no use.
    #[inline(always)]
    pub(crate) fn put_out(&mut self, share: Friction, dt: f32) -> Compensation {
        let limits = &self.limits;
        // Nothing here is NaN but where the sample is of no use, and then nothing of it is kept.
        let torque = limits.approach(self.torque, share.torque, limits.slew * dt);
        self.torque = share.usable.or_zero(torque);
        let status = if share.usable.is_usable() { Status::Active } else { Status::NotFinite };
        Compensation { torque: self.torque, position: share.position, status }
    }
}
