//! How the friction of today differs from that of the model: its level, a viscous part and an offset, estimated while the joint slides.
//!
//! Least squares with exponential forgetting (Astrom & Wittenmark 1995, section 2.3) and, in place of a covariance that could wind up, a
//! prior of constant weight: what the motion does not excite goes back to the model. The number of operations does not depend on the
//! data, the state is bounded because every regressor is, and the firmware bounds the solution.

use super::observer::Observation;
use super::pace::Pace;
use crate::evaluate::within;

/// Largest bound of the level.
const HIGHEST_LEVEL: f32 = 4.0;
/// Largest bound of the viscous part, N m s/rad, and of the offset, N m; largest torque and regressor that is taken for real, N m: squares
/// of it and their products are far from overflow.
const LARGEST: f32 = 1.0e6;
/// Smallest trusted torque, N m: its square is far from the smallest number.
const SMALLEST: f32 = 1.0e-6;
/// Longest memory, s.
const LONGEST_MEMORY: f32 = 1.0e6;

/// How far the firmware lets the friction differ from the model, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptationSettings {
    /// Lowest and highest ratio of the friction to that of the model.
    level: [f32; 2],
    /// Largest viscous part that is added or taken away, N m s/rad.
    viscous: f32,
    /// Largest offset, N m.
    offset: f32,
    /// Time constant of forgetting, s of sliding.
    memory: f32,
    /// A residual of this size counts as much as an unknown at its bound, N m.
    trusted_torque: f32,
}

/// Which setting of an adaptation cannot be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdaptationError {
    /// The bounds of the level are not `0 <= low <= 1 <= high <= 4`.
    Level,
    /// The bound of the viscous part or of the offset is not between 0 and 1e6.
    Bound,
    /// The memory is not above 0 s and at most 1e6 s.
    Memory,
    /// The trusted torque is not between 1e-6 and 1e6 N m.
    TrustedTorque,
}

impl AdaptationSettings {
    /// `level`: lowest and highest ratio of the friction to that of the model, around 1; `viscous`, N m s/rad, and `offset`, N m: the
    /// largest that is added or taken away, 0 for none; `memory`: time constant of forgetting, s of sliding, a change is followed to a tenth in
    /// three of it; `trusted_torque`: a residual of this size, N m, counts as much as an unknown at its bound: what is smaller is noise.
    ///
    /// # Errors
    /// [`AdaptationError`] where a setting lies outside of its range.
    pub fn new(
        level: [f32; 2],
        [viscous, offset]: [f32; 2],
        memory: f32,
        trusted_torque: f32,
    ) -> Result<Self, AdaptationError> {
        let [low, high] = level;
        if !((0.0..=1.0).contains(&low) && (1.0..=HIGHEST_LEVEL).contains(&high)) {
            return Err(AdaptationError::Level);
        }
        if ![viscous, offset].iter().all(|bound| (0.0..=LARGEST).contains(bound)) {
            return Err(AdaptationError::Bound);
        }
        if !(memory > 0.0 && memory <= LONGEST_MEMORY) {
            return Err(AdaptationError::Memory);
        }
        if !(SMALLEST..=LARGEST).contains(&trusted_torque) {
            return Err(AdaptationError::TrustedTorque);
        }
        Ok(Self { level, viscous, offset, memory, trusted_torque })
    }

    /// Lowest and highest ratio of the friction to that of the model.
    #[must_use]
    pub fn level(&self) -> [f32; 2] {
        self.level
    }

    /// Largest viscous part, N m s/rad, and largest offset, N m.
    #[must_use]
    pub fn bounds(&self) -> [f32; 2] {
        [self.viscous, self.offset]
    }

    /// Time constant of forgetting, s of sliding.
    #[must_use]
    pub fn memory(&self) -> f32 {
        self.memory
    }

    /// The residual that counts as much as an unknown at its bound, N m.
    #[must_use]
    pub fn trusted_torque(&self) -> f32 {
        self.trusted_torque
    }

    /// Largest distance of the level from that of the model.
    fn reach(&self) -> f32 {
        let [down, up] = [1.0 - self.level[0], self.level[1] - 1.0];
        if down > up { down } else { up }
    }
}

/// The friction of today: `level` times that of the model, `+ viscous v + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// Ratio to the friction of the model.
    pub level: f32,
    /// N m s/rad.
    pub viscous: f32,
    /// N m.
    pub offset: f32,
}

impl Correction {
    /// The model as it is.
    pub const NONE: Self = Self { level: 1.0, viscous: 0.0, offset: 0.0 };

    /// The friction of today where that of the model is `friction`, N m, at a velocity in rad/s.
    #[must_use]
    pub fn applied(&self, friction: f32, velocity: f32) -> f32 {
        self.level * friction + self.viscous * velocity + self.offset
    }
}

/// Torques of a sample, N m, finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Torques {
    /// Friction of the model at the velocity of the sample.
    pub(super) friction: f32,
    /// Compensation that acted.
    pub(super) compensation: f32,
}

/// The estimate and what it is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation {
    /// Friction of the model and compensation behind the low-pass of the observer, N m.
    friction: f32,
    compensation: f32,
    /// Mean products of the regressors, each the torque of an unknown at its bound: 11, 12, 13, 22, 23, 33, (N m)^2.
    products: [f32; 6],
    /// Mean products of the regressors with what the model leaves, (N m)^2.
    projections: [f32; 3],
    correction: Correction,
}

impl Adaptation {
    /// Nothing learnt.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            friction: 0.0,
            compensation: 0.0,
            products: [0.0; 6],
            projections: [0.0; 3],
            correction: Correction::NONE,
        }
    }

    /// The correction in force.
    #[must_use]
    pub fn correction(&self) -> Correction {
        self.correction
    }

    /// Takes a sample; the filters always follow, and from one of sliding the friction is learnt.
    pub(super) fn take(
        &mut self,
        settings: &AdaptationSettings,
        observed: &Observation,
        torques: Torques,
        pace: &Pace,
        is_sliding: bool,
    ) {
        self.friction += pace.observer * (within(torques.friction, LARGEST) - self.friction);
        self.compensation += pace.observer * (within(torques.compensation, LARGEST) - self.compensation);
        if !is_sliding {
            return;
        }
        let regressors = [settings.reach() * self.friction, settings.viscous * observed.velocity, settings.offset]
            .map(|regressor| within(regressor, LARGEST));
        let [a, b, c] = regressors;
        // What no correction within the bounds explains is a knock or a push.
        let explainable = a.abs() + b.abs() + c.abs();
        let left = within(observed.net_friction + self.compensation - self.friction, explainable);
        let share = pace.memory;
        for (mean, product) in self.products.iter_mut().zip([a * a, a * b, a * c, b * b, b * c, c * c]) {
            *mean += share * (product - *mean);
        }
        for (mean, regressor) in self.projections.iter_mut().zip(regressors) {
            *mean += share * (regressor * left - *mean);
        }
        let prior = settings.trusted_torque * settings.trusted_torque;
        let [level, viscous, offset] = solved(self.products, self.projections, prior).map(|share| within(share, 1.0));
        let level = 1.0 + level * settings.reach();
        let [low, high] = settings.level;
        let level = if level < low { low } else { level };
        self.correction = Correction {
            level: if level > high { high } else { level },
            viscous: viscous * settings.viscous,
            offset: offset * settings.offset,
        };
    }
}

impl Default for Adaptation {
    fn default() -> Self {
        Self::new()
    }
}

/// The solution `x` of `(A + prior I) x = b` with the upper triangle of a positive semidefinite `A`, by `L D L'`; a pivot that rounding
/// took below `prior`, where none can be, is `prior`.
fn solved([a11, a12, a13, a22, a23, a33]: [f32; 6], [b1, b2, b3]: [f32; 3], prior: f32) -> [f32; 3] {
    let pivot = |pivot: f32| if pivot > prior { pivot } else { prior };
    let d1 = pivot(a11 + prior);
    let (l21, l31) = (a12 / d1, a13 / d1);
    let d2 = pivot(a22 + prior - l21 * a12);
    let remaining = a23 - l31 * a12;
    let l32 = remaining / d2;
    let d3 = pivot(a33 + prior - l31 * a13 - l32 * remaining);
    let y2 = b2 - l21 * b1;
    let y3 = b3 - l31 * b1 - l32 * y2;
    let x3 = y3 / d3;
    let x2 = y2 / d2 - l32 * x3;
    [b1 / d1 - l21 * x2 - l31 * x3, x2, x3]
}

#[cfg(test)]
mod tests;
