//! Friction for a simulation in which a joint can stick: a law as levels of dry friction and a viscous coefficient.
//!
//! A law over velocity is steep but continuous at zero, and a joint under it would creep where a real one sticks. The flank through zero
//! is the law's stand-in for the sign of the velocity, so it is replaced by the sign: below the speed at which dry friction is largest, it has
//! that value, and at rest any up to it.

use frikan_shared::model::SLOW_SHARE;

use crate::numerics::Number;
use crate::numerics::dry_friction::DryLevels;

/// Where a joint is, and what else friction may depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant<T = f64> {
    /// Time, s.
    pub time: f64,
    /// rad
    pub position: T,
    /// rad/s
    pub velocity: T,
    /// Torque that the gear carries, N m: that of the actuator, or of gravity under a recorded torque.
    pub load: T,
    /// degrees Celsius, NaN where nobody knows.
    pub temperature: f64,
}

/// Friction around a velocity.
#[derive(Clone, Copy, Debug, Default)]
pub struct Levels<T = f64> {
    pub(crate) dry: DryLevels<T>,
    /// Viscous coefficient, N m s/rad.
    pub(crate) viscous: T,
}

/// Friction in a simulation that computes with `T`.
pub trait Resistance<T: Number = f64> {
    /// Friction at an instant, at which a step of so many seconds begins.
    fn levels(&mut self, at: &Instant<T>, step_s: f64) -> Levels<T>;

    /// The joint begins anew.
    fn restart(&mut self) {}
}

/// How a law is split into dry and viscous friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Split {
    /// Viscous coefficient, N m s/rad; zero or above.
    pub viscous: f64,
    /// Speed forward at which dry friction is largest, rad/s.
    forward: f64,
    /// The same backward.
    backward: f64,
}

/// Slow speeds that are looked at, each way.
const LOOKED_AT: i32 = 40;
/// The slowest of them over the top speed.
const SLOWEST_SHARE: f64 = 1e-4;
/// Shares of the top speed between which the viscous coefficient is read off.
const SLIDING: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];

impl Split {
    /// The split of a law of the velocity whose top speed is `top`, rad/s.
    pub fn of(law: impl Fn(f64) -> f64, top: f64) -> Self {
        let odd = |speed: f64| 0.5 * (law(speed) - law(-speed));
        let mean = SLIDING.iter().sum::<f64>() / SLIDING.len() as f64;
        let centred = |weight: &dyn Fn(f64) -> f64| SLIDING.iter().map(|x| (x - mean) * weight(*x)).sum::<f64>();
        let slope = centred(&|x| odd(x * top)) / centred(&|x| x * top);
        let viscous = if slope.is_finite() { slope.max(0.0) } else { 0.0 };
        let largest = |direction: f64| {
            let speed = |k: i32| {
                let share = f64::from(k) / f64::from(LOOKED_AT);
                top * SLOWEST_SHARE * libm::pow(SLOW_SHARE / SLOWEST_SHARE, share)
            };
            let dry = |speed: f64| direction * law(direction * speed) - viscous * speed;
            (0..=LOOKED_AT).map(speed).max_by(|a, b| dry(*a).total_cmp(&dry(*b))).unwrap_or(0.0)
        };
        Self { viscous, forward: largest(1.0), backward: largest(-1.0) }
    }

    /// Friction of the law around a velocity.
    pub(crate) fn levels(&self, law: impl Fn(f64) -> f64, velocity: f64) -> Levels {
        let dry = |direction: f64, slowest: f64| {
            let speed = (direction * velocity).max(slowest);
            (direction * law(direction * speed) - self.viscous * speed).max(0.0)
        };
        let dry = DryLevels { forward: dry(1.0, self.forward), backward: dry(-1.0, self.backward) };
        Levels { dry, viscous: self.viscous }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(level: f64, expected: f64) {
        assert!((level - expected).abs() < 5e-3 * expected, "{level} {expected}");
    }

    #[test]
    fn a_smoothed_sign_becomes_a_sign_and_the_rest_stays() {
        let law = |v: f64| 0.5 * (v / 0.004).tanh() + 0.3 * v;
        let split = Split::of(law, 4.0);
        close(split.viscous, 0.3);
        let rest = split.levels(law, 0.0);
        close(rest.dry.forward, 0.5);
        close(rest.dry.backward, 0.5);
        let moving = split.levels(law, -2.0);
        close(moving.dry.backward + 2.0 * moving.viscous, -law(-2.0));
    }

    #[test]
    fn break_away_is_the_largest_of_a_falling_law() {
        let law = |v: f64| (0.5 + 0.4 * (-(v / 0.2).powi(2)).exp()) * (v / 0.002).tanh() + 0.1 * v;
        let split = Split::of(law, 4.0);
        close(split.levels(law, 0.0).dry.forward, 0.9);
        let slow = split.levels(law, 0.2);
        close(slow.dry.forward + 0.2 * slow.viscous, law(0.2));
    }

    #[test]
    fn directions_are_their_own() {
        let law = |v: f64| if v > 0.0 { 0.6 } else { -0.4 };
        let rest = Split::of(law, 1.0).levels(law, 0.0);
        assert_eq!((rest.dry.forward, rest.dry.backward), (0.6, 0.4));
    }
}
