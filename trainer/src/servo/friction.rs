//! The friction of a joint that is identified by its trajectories: what servo gears have (Duclusaud et al. 2024), each term with a meaning.

use crate::law::{Expr, KnownForm, Unary};
use crate::numerics::dry_friction::DryLevels;
use crate::rollout::{Instant, Levels, Resistance};

/// The smoothing of the sign in an image over the top speed: below it the law is no friction but the flank through rest.
pub const FLANK_SHARE: f64 = 3e-4;

/// Friction = (coulomb + stribeck exp(-(v/v_s)²) + load |τ|) sign(v) + viscous v, with τ the torque of the actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GearFriction {
    /// N m
    pub coulomb: f64,
    /// What friction is more at rest than in motion, N m.
    pub stribeck: f64,
    /// Speed over which it falls, rad/s.
    pub stribeck_velocity: f64,
    /// N m s/rad
    pub viscous: f64,
    /// Share of the torque that the gear carries.
    pub load: f64,
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

impl Resistance for GearFriction {
    fn levels(&mut self, at: &Instant, _: f64) -> Levels {
        let slow = libm::exp(-(at.velocity / self.stribeck_velocity).powi(2));
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
