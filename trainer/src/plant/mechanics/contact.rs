//! A contact that yields before it slips.

use crate::numerics::dry_friction::DryLevels;

/// Integration steps in a second that a stiff contact needs: 50 us are a hundredth of the period of a joint that swings at 200 Hz on it.
pub(crate) const STEPS_PER_SECOND: f64 = 20_000.0;

/// Dry friction with presliding (LuGre, Canudas de Wit et al. 1995) in place of a level that switches with the sign of the velocity.
pub(crate) struct Contact {
    /// Stiffness in presliding, N m/rad.
    stiffness: f64,
    /// Damping of the presliding at rest, N m s/rad.
    damping: f64,
    /// Speed at which that damping has faded to 1/e, rad/s.
    fading_speed: f64,
    /// Deflection, rad.
    deflection: f64,
}

impl Contact {
    /// A contact of `stiffness` N m/rad under an inertia in kg m2, undeflected. Its damping is half of critical at rest and fades over
    /// `fading_speed` rad/s, which keeps the friction passive (Olsson 1996).
    pub(crate) fn new(stiffness: f64, inertia: f64, fading_speed: f64) -> Self {
        Self { stiffness, damping: (stiffness * inertia).sqrt(), fading_speed, deflection: 0.0 }
    }

    /// Friction torque, N m, over a step at `velocity` rad/s between the `dry` levels: `dz/dt = v - |v| z / z_slip` with
    /// `z_slip = level / stiffness`, solved exactly for a held velocity.
    pub(crate) fn torque(&mut self, velocity: f64, dry: DryLevels, step_s: f64) -> f64 {
        let before = self.deflection;
        if velocity != 0.0 {
            let slip = (dry.towards(velocity) / self.stiffness).copysign(velocity);
            let passed = if slip == 0.0 { f64::INFINITY } else { velocity * step_s / slip };
            self.deflection = slip + (before - slip) * (-passed).exp();
        }
        let damping = self.damping * (-(velocity / self.fading_speed).powi(2)).exp();
        self.stiffness * self.deflection + damping * (self.deflection - before) / step_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_torque_rises_over_the_slip_distance_and_settles_at_the_level() {
        let mut contact = Contact::new(2000.0, 0.5, 0.05);
        let dry = DryLevels { forward: 2.0, backward: 3.0 };
        let mut slide = |velocity: f64, seconds: f64| {
            (0..(seconds / 5e-5) as usize).map(|_| contact.torque(velocity, dry, 5e-5)).last().unwrap()
        };
        // One slip distance of 1 mrad at 1 rad/s: 1 - 1/e of the level.
        assert!((slide(1.0, 1e-3) - 2.0 * (1.0 - (-1.0_f64).exp())).abs() < 0.01);
        assert!((slide(1.0, 0.1) - 2.0).abs() < 1e-9);
        assert!((slide(-1.0, 0.1) + 3.0).abs() < 1e-9);
    }

    #[test]
    fn no_level_is_no_friction() {
        let mut contact = Contact::new(2000.0, 0.5, 0.05);
        assert_eq!(contact.torque(0.3, DryLevels::default(), 1e-3), 0.0);
    }
}
