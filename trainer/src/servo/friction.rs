//! The friction of a joint that is identified by its trajectories: what servo gears have (Duclusaud et al. 2024), each term with a meaning.

use crate::law::{Expr, KnownForm, Unary};
use crate::numerics::Number;
use crate::numerics::dry_friction::DryLevels;
use crate::rollout::{Instant, Levels, Resistance};

/// The smoothing of the sign in an image over the top speed: below it the law is no friction but the flank through rest.
pub const FLANK_SHARE: f64 = 3e-4;

/// Friction = (coulomb + stribeck exp(-(v/v_s)²) + load |τ|) sign(v) + viscous v, with τ the torque of the actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GearFriction<T = f64> {
    /// N m
    pub coulomb: T,
    /// What friction is more at rest than in motion, N m.
    pub stribeck: T,
    /// Speed over which it falls, rad/s.
    pub stribeck_velocity: T,
    /// N m s/rad
    pub viscous: T,
    /// Share of the torque that the gear carries.
    pub load: T,
}

/// Terms beside Coulomb and viscous friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Terms {
    pub(super) stribeck: bool,
    pub(super) load: bool,
}

impl Terms {
    /// Those of a form that is asked for, all where none is; `None` of a form that this law cannot have.
    pub(super) fn of(form: Option<KnownForm>) -> Option<Self> {
        match form {
            None => Some(Self { stribeck: true, load: true }),
            Some(KnownForm::CoulombViscous) => Some(Self { stribeck: false, load: false }),
            Some(KnownForm::StribeckGaussian) => Some(Self { stribeck: true, load: false }),
            Some(_) => None,
        }
    }
}

impl<T: Number> Resistance<T> for GearFriction<T> {
    fn levels(&mut self, at: &Instant<T>, _: f64) -> Levels<T> {
        let slow = (-(at.velocity / self.stribeck_velocity).powi(2)).exp();
        let level = self.coulomb + self.stribeck * slow + self.load * at.load.abs();
        Levels { dry: DryLevels { forward: level, backward: level }, viscous: self.viscous }
    }
}

impl GearFriction {
    /// The law over velocity (input 0) and load (input 1), the sign of the velocity smoothed for a top speed, rad/s.
    #[must_use]
    pub fn expression(&self, top_speed: f64) -> Expr {
        let velocity = || Expr::Input(0);
        let sign = (Expr::Const(1.0 / (FLANK_SHARE * top_speed)) * velocity()).then(Unary::Tanh);
        let fall = (-(velocity() / Expr::Const(self.stribeck_velocity)).then(Unary::Square)).exp();
        let mut level = Expr::Const(self.coulomb);
        if self.stribeck > 0.0 {
            level = level + Expr::Const(self.stribeck) * fall;
        }
        if self.load > 0.0 {
            level = level + Expr::Const(self.load) * Expr::Input(1).abs();
        }
        level * sign + Expr::Const(self.viscous) * velocity()
    }
}
