//! Settings of the supervision.

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
    /// Inertia of the joint, kg m^2; an error of it of a tenth is seen as friction of a tenth of the inertial torque.
    pub inertia: f32,
    /// Which velocity is compensated.
    pub source: VelocitySource,
    /// Whether the gain follows the monitor.
    pub monitored: bool,
    /// Speed below which the joint counts as at rest, rad/s. Above the noise of the measured velocity.
    pub rest_velocity: f32,
    /// Way after a reversal in which the contact is elastic, rad.
    pub presliding: f32,
    /// Time constant of the observer's low-pass, s.
    pub observer_time: f32,
    /// Time in which the monitor lowers the gain from full to none where all friction is over-compensated once more, s.
    pub fall_time: f32,
    /// Time in which it raises it again where nothing is compensated, s.
    pub rise_time: f32,
    /// Friction below which the monitor takes no ratios, N m.
    pub least_friction: f32,
    /// How long velocity and position may contradict each other, s.
    pub implausible_time: f32,
    /// Whether and how far the compensation follows a friction that changes; not, unless the firmware sets bounds.
    pub adaptation: Option<AdaptationSettings>,
}

impl Supervision {
    /// Defaults for a revolute joint of `inertia` kg m^2 with a friction of about `friction` N m.
    #[must_use]
    pub fn new(inertia: f32, friction: f32) -> Self {
        Self {
            inertia,
            source: VelocitySource::Blended,
            monitored: true,
            rest_velocity: 0.02,
            presliding: 2.0e-3,
            observer_time: 0.01,
            fall_time: 0.02,
            rise_time: 0.5,
            least_friction: 0.1 * friction.abs(),
            implausible_time: 0.2,
            adaptation: None,
        }
    }

    /// Whether all settings are finite, the inertia not negative and the others above 0.
    #[must_use]
    pub fn is_within_range(&self) -> bool {
        let above_0 = [
            self.rest_velocity,
            self.presliding,
            self.observer_time,
            self.fall_time,
            self.rise_time,
            self.least_friction,
            self.implausible_time,
        ];
        let is_above_0 = |setting: &f32| *setting > 0.0 && setting.is_finite();
        self.inertia >= 0.0 && self.inertia.is_finite() && above_0.iter().all(is_above_0)
    }
}
