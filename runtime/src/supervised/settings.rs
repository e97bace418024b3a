//! Settings of the supervision.

use core::f32::consts::TAU;

use super::adaptation_settings::AdaptationSettings;

/// Speed beyond any joint's, rad/s.
pub(super) const FASTEST: f32 = 1.0e6;

/// Gain for a supervised compensator. Between what tracks best where the model is right (1) and what leaves dissipation where it is a
/// little too large; `tests/tests/closed_loop.rs` runs it with frictions of 50 to 120 % of the model's.
pub const DEFAULT_GAIN: f32 = 0.95;

/// Which velocity is compensated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VelocitySource {
    /// The measured one always: hunts at rest, for trials.
    Measured,
    /// That of the reference always: blind to what the joint does.
    Reference,
    /// As [`super::blend::blended`].
    #[default]
    Blended,
}

/// Settings of the supervision; what a constructor does not ask for has a default that is documented with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supervision {
    /// Inertia of the joint, kg m^2, the largest where it depends on the pose ([`super::Supervisor::set_inertia`]); an error of it of a tenth is
    /// seen as friction of a tenth of the inertial torque.
    pub inertia: f32,
    /// Angle of a count of the encoder, rad: what is smaller is not seen as motion. 0 where the position is not made of counts.
    pub count: f32,
    /// Which velocity is compensated.
    pub source: VelocitySource,
    /// Whether the gain follows the monitor.
    pub monitored: bool,
    /// Speed of the reference up to which friction is compensated at it, rad/s, and below which the torque is held where it stands still.
    pub rest_velocity: f32,
    /// Speed below which nothing is said of friction: the joint may as well stand still, rad/s.
    pub standstill: f32,
    /// Way after a reversal in which the contact is elastic, rad.
    pub presliding: f32,
    /// Delay of the observer's low-pass, s; that of a coarse encoder is longer, see [`super::pace::Pace::of`].
    pub observer_time: f32,
    /// Time in which the monitor lowers the gain from full to none where all friction is over-compensated once more, s.
    pub fall_time: f32,
    /// Time in which it raises it again where nothing is compensated, s.
    pub rise_time: f32,
    /// Friction below which the monitor takes no ratios, N m.
    pub least_friction: f32,
    /// How long velocity and position may contradict each other, s.
    pub implausible_time: f32,
    /// How long the torque of a joint at rest is held, s; it falls to 0 within the same time again.
    pub hold_time: f32,
    /// Angle after which the position begins anew, rad; 0 where it never does.
    pub turn: f32,
    /// Whether and how far the compensation follows a friction that changes; not, unless the firmware sets bounds.
    pub adaptation: Option<AdaptationSettings>,
}

impl Supervision {
    /// Defaults for a revolute joint of `inertia` kg m^2 with a friction of about `friction` N m, whose encoder has counts of `count` rad.
    #[must_use]
    pub fn new(inertia: f32, friction: f32, count: f32) -> Self {
        Self {
            inertia,
            count,
            source: VelocitySource::Blended,
            monitored: true,
            rest_velocity: 0.02,
            standstill: 2.0e-3,
            presliding: 2.0e-3,
            observer_time: 0.01,
            fall_time: 0.02,
            rise_time: 0.5,
            least_friction: 0.1 * friction.abs(),
            implausible_time: 0.2,
            hold_time: 2.0,
            turn: TAU,
            adaptation: None,
        }
    }

    /// Whether the settings can be kept: inertia, count and turn from 0 to 1e9, the others from 1e-9 to 1e9, where no product of them overflows.
    ///
    /// # Errors
    /// [`SupervisionError`] names the first one that cannot.
    pub fn validate(&self) -> Result<(), SupervisionError> {
        let may_be_0 = [
            (self.inertia, SupervisionError::Inertia),
            (self.count, SupervisionError::Count),
            (self.turn, SupervisionError::Turn),
        ];
        let above_0 = [
            (self.rest_velocity, SupervisionError::RestVelocity),
            (self.standstill, SupervisionError::Standstill),
            (self.presliding, SupervisionError::Presliding),
            (self.observer_time, SupervisionError::ObserverTime),
            (self.fall_time, SupervisionError::FallTime),
            (self.rise_time, SupervisionError::RiseTime),
            (self.least_friction, SupervisionError::LeastFriction),
            (self.implausible_time, SupervisionError::ImplausibleTime),
            (self.hold_time, SupervisionError::HoldTime),
        ];
        let refused = |least: f32| move |(setting, _): &(f32, SupervisionError)| !is_within(least, *setting);
        let beyond = may_be_0.into_iter().find(refused(0.0));
        let beyond = beyond.or_else(|| above_0.into_iter().find(refused(SMALLEST)));
        beyond.map_or(Ok(()), |(_, error)| Err(error))
    }
}

/// Whether a setting lies from `least`, which is not negative, to [`LARGEST`]: the patterns of what is negative or no number lie above.
pub(super) fn is_within(least: f32, setting: f32) -> bool {
    (least.to_bits()..=LARGEST.to_bits()).contains(&setting.to_bits())
}

/// Smallest and largest setting, in its unit: beyond any drive's to either side.
const SMALLEST: f32 = 1.0e-9;
const LARGEST: f32 = 1.0e9;

/// Which setting of a supervision cannot be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SupervisionError {
    /// The inertia is not from 0 to 1e9 kg m^2.
    Inertia,
    /// The angle of a count is not from 0 to 1e9 rad.
    Count,
    /// The rest velocity is not from 1e-9 to 1e9 rad/s.
    RestVelocity,
    /// The standstill is not from 1e-9 to 1e9 rad/s.
    Standstill,
    /// The way of presliding is not from 1e-9 to 1e9 rad.
    Presliding,
    /// The delay of the observer is not from 1e-9 to 1e9 s.
    ObserverTime,
    /// The time in which the gain falls is not from 1e-9 to 1e9 s.
    FallTime,
    /// The time in which it rises is not from 1e-9 to 1e9 s.
    RiseTime,
    /// The least friction is not from 1e-9 to 1e9 N m: that of a joint without friction has to be given.
    LeastFriction,
    /// The time of a contradiction is not from 1e-9 to 1e9 s.
    ImplausibleTime,
    /// The time for which a torque is held is not from 1e-9 to 1e9 s.
    HoldTime,
    /// The angle of a turn is not from 0 to 1e9 rad.
    Turn,
}

impl core::fmt::Display for SupervisionError {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.write_str(match self {
            Self::Inertia => "the inertia is out of range",
            Self::Count => "the angle of a count is out of range",
            Self::RestVelocity => "the rest velocity is out of range",
            Self::Standstill => "the standstill is out of range",
            Self::Presliding => "the way of presliding is out of range",
            Self::ObserverTime => "the delay of the observer is out of range",
            Self::FallTime => "the time in which the gain falls is out of range",
            Self::RiseTime => "the time in which the gain rises is out of range",
            Self::LeastFriction => "the least friction is out of range",
            Self::ImplausibleTime => "the time of a contradiction is out of range",
            Self::HoldTime => "the time for which a torque is held is out of range",
            Self::Turn => "the angle of a turn is out of range",
        })
    }
}

impl core::error::Error for SupervisionError {}
