//! How the friction of today differs from that of the model: its level, a viscous part and an offset, estimated while the joint slides.
//!
//! Least squares with exponential forgetting (Astrom & Wittenmark 1995, section 2.3) and, in place of a covariance that could wind up, a
//! prior of constant weight: what the motion does not excite goes back to the model. The number of operations does not depend on the
//! data, the state is bounded because every regressor is, and the firmware bounds the solution.

use super::adaptation_settings::AdaptationSettings;
use super::observer::{Observation, follow};
use super::pace::Pace;
use crate::bounds::within;

/// Largest torque and regressor that is taken for real, N m: squares of it and their products are far from overflow.
const LARGEST: f32 = 1.0e6;

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

/// What an adaptation has learnt, to be kept while the power is off: plain numbers, to be written anywhere and read back. They belong to one model:
/// the firmware keeps its checksum beside them. What no adaptation can have learnt, as damaged memory, is nothing learnt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Learnt {
    /// Mean products of the regressors (11, 12, 13, 22, 23, 33) and of these with what the model leaves, (N m)^2.
    pub means: [f32; 9],
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
    friction: [f32; 2],
    compensation: [f32; 2],
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
            friction: [0.0; 2],
            compensation: [0.0; 2],
            products: [0.0; 6],
            projections: [0.0; 3],
            correction: Correction::NONE,
        }
    }

    /// What has been learnt before.
    pub(super) fn again(learnt: &Learnt, settings: &AdaptationSettings) -> Self {
        let [a11, a12, a13, a22, a23, a33, b1, b2, b3] = learnt.means;
        let is_sound = learnt.means.iter().all(|mean| mean.abs() <= LARGEST * LARGEST)
            && [a11, a22, a33].iter().all(|square| *square >= 0.0);
        if !is_sound {
            return Self::new();
        }
        let mut adaptation =
            Self { products: [a11, a12, a13, a22, a23, a33], projections: [b1, b2, b3], ..Self::new() };
        adaptation.correct(settings);
        adaptation
    }

    /// What has been learnt.
    pub(super) fn learnt(&self) -> Learnt {
        let ([a11, a12, a13, a22, a23, a33], [b1, b2, b3]) = (self.products, self.projections);
        Learnt { means: [a11, a12, a13, a22, a23, a33, b1, b2, b3] }
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
        follow(&mut self.friction, pace.observer, within(torques.friction, LARGEST));
        follow(&mut self.compensation, pace.observer, within(torques.compensation, LARGEST));
        let ([_, friction], [_, compensation]) = (self.friction, self.compensation);
        if !is_sliding {
            return;
        }
        let regressors = [settings.reach() * friction, settings.viscous * observed.velocity, settings.offset]
            .map(|regressor| within(regressor, LARGEST));
        let [a, b, c] = regressors;
        // What no correction within the bounds explains is a knock or a push.
        let explainable = a.abs() + b.abs() + c.abs();
        let left = within(observed.net_friction + compensation - friction, explainable);
        let share = pace.memory;
        for (mean, product) in self.products.iter_mut().zip([a * a, a * b, a * c, b * b, b * c, c * c]) {
            *mean += share * (product - *mean);
        }
        for (mean, regressor) in self.projections.iter_mut().zip(regressors) {
            *mean += share * (regressor * left - *mean);
        }
        self.correct(settings);
    }

    /// The correction by what was learnt, within the bounds.
    fn correct(&mut self, settings: &AdaptationSettings) {
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
