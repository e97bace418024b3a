//! What of the settings depends on the sample period: worked out once for all samples of one period, since a drive's hardly ever changes.

use frikan_shared::elementary;

use super::settings::Supervision;

/// The settings for one sample period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Sample period, s; 0 before the first sample.
    pub dt: f32,
    /// 1/s.
    pub rate: f32,
    /// Time constant of either stage of the observer's low-pass, s.
    pub observer_time: f32,
    /// Share by which either stage of the observer's low-pass moves in a sample.
    pub observer: f32,
    /// Hold times in a sample.
    pub hold: f32,
    /// Speed below which nothing is said of friction, rad/s.
    pub standstill: f32,
    /// Whether the encoder has too few counts within a contact to tell whether the joint sticks.
    pub is_coarse: bool,
    /// Rate of the low-pass of the velocity that is believed, 1/s.
    pub velocity_rate: f32,
    /// Share of a sample in the velocity that is believed.
    pub velocity: f32,
    /// Share of the gain that the monitor takes back in a sample where all friction is over-compensated once more.
    pub fall: f32,
    /// Share that it gives back where nothing is compensated.
    pub rise: f32,
    /// Energy that a contact stores, J.
    pub elastic_energy: f32,
    /// Share by which the low-pass of the plausibility moves in a sample.
    pub plausibility: f32,
    /// Velocity that a count looks like behind it, rad/s.
    pub count_velocity: f32,
    /// Share by which the means of the adaptation move in a sample.
    pub memory: f32,
}

impl Pace {
    /// What does not depend on the period, before the first sample.
    ///
    /// A step of one count, twice behind a low-pass of time constant `T`, looks like a torque of `inertia count / T^2`, and behind one of
    /// `T` like a velocity of `count / T`. `T` is as long as it takes for the first to be within the least friction, and for the second to be
    /// within half the rest velocity.
    #[must_use]
    pub fn of(supervision: &Supervision) -> Self {
        let of_count = root(supervision.inertia * supervision.count / supervision.least_friction);
        let time = larger(0.5 * supervision.observer_time, of_count);
        Self {
            observer_time: time,
            // One count is no motion: behind both stages it looks like a speed of 1 / e of this at most.
            standstill: larger(supervision.standstill, 0.5 * supervision.count / time),
            is_coarse: COUNTS_OF_A_CONTACT * supervision.count > supervision.presliding,
            // At once, where there are no counts.
            velocity_rate: 0.5 * supervision.rest_velocity / supervision.count,
            elastic_energy: FRICTION_OF_A_CONTACT * supervision.least_friction * supervision.presliding,
            count_velocity: PLAUSIBILITY_SHARE * supervision.count / supervision.implausible_time,
            ..Self::default()
        }
    }

    /// The settings for a period of `dt` seconds, above 0 and finite.
    #[inline(never)]
    pub fn set(&mut self, supervision: &Supervision, dt: f32) {
        self.dt = dt;
        self.rate = 1.0 / dt;
        self.observer = lag_share(dt / self.observer_time);
        self.hold = dt / supervision.hold_time;
        self.velocity = lag_share(dt * self.velocity_rate);
        self.fall = dt / supervision.fall_time;
        self.rise = dt / supervision.rise_time;
        self.plausibility = lag_share(PLAUSIBILITY_SHARE * dt / supervision.implausible_time);
        self.memory = supervision.adaptation.map_or(0.0, |adaptation| lag_share(dt / adaptation.memory()));
    }
}

/// [`elementary::lag_share`], once in the program: the sample period hardly ever changes, and flash is short.
#[inline(never)]
fn lag_share(ratio: f32) -> f32 {
    elementary::lag_share(ratio)
}

/// The square root of a number that is not negative, to 0.2 %, which is enough for a time constant: half the exponent, within 6 % of it, and a
/// step of Newton's.
fn root(square: f32) -> f32 {
    let half = f32::from_bits((square.to_bits() >> 1) + (1.0_f32.to_bits() >> 1));
    0.5 * (half + square / half)
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Counts that a contact has to take before it slips for the encoder to tell whether it does. Chosen by judgement: with two of them
/// (13 bits and a break-away of 1 to 2 mrad) the range at rest was at times larger than without compensation, with four it was not.
const COUNTS_OF_A_CONTACT: f32 = 4.0;

/// Friction of a contact over the least friction: what [`Supervision::new`] divides it by. Half of friction times way is stored where the contact is
/// a spring.
const FRICTION_OF_A_CONTACT: f32 = 10.0;

/// Implausible time over the time constant of the low-pass behind which velocity and position are compared.
const PLAUSIBILITY_SHARE: f32 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_near() {
        for exponent in -60..60 {
            for mantissa in 0..32 {
                let square = 2.0_f32.powi(exponent) * (1.0 + mantissa as f32 / 32.0);
                assert!((root(square) / square.sqrt() - 1.0).abs() < 2.0e-3, "{square}");
            }
        }
        assert!(root(0.0) < 1.0e-9);
    }
}
