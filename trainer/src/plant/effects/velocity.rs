//! Shapes of the velocity characteristic.

use super::mechanism::{Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;

/// Friction that falls with speed near rest (Stribeck 1902; Bo & Pavelescu 1982).
pub(super) fn stribeck(draws: &mut Draws, _: &Setting) -> Mechanism {
    let level = draws.uniform("stribeck_torque_Nm", 0.6, 1.2);
    let velocity = draws.log_uniform("stribeck_velocity_rad_s", 0.03, 0.3);
    let exponent = draws.uniform("exponent", 0.7, 2.0);
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(level * (-(m.speed() / velocity).powf(exponent)).exp()))
}

/// Viscous torque that is not linear in speed (Wolf & Iskandar 2018).
pub(super) fn viscous_nonlinearity(draws: &mut Draws, _: &Setting) -> Mechanism {
    let thinning = draws.choice("churning", 2) == 0;
    let exponent = if thinning { draws.uniform("exponent", 0.45, 0.75) } else { draws.uniform("exponent", 1.8, 3.0) };
    let level = if thinning {
        draws.uniform("torque_at_1_rad_s_Nm", 1.5, 3.0)
    } else {
        draws.uniform("torque_at_1_rad_s_Nm", 0.15, 0.4)
    };
    Mechanism::torque(move |m: &Moment, _| Resistance::dry(level * m.speed().powf(exponent)))
}

/// More friction one way than the other.
pub(super) fn direction_asymmetry(draws: &mut Draws, _: &Setting) -> Mechanism {
    let dry = draws.signed("coulomb_difference_Nm", 0.2, 0.5);
    let viscous = draws.signed("viscous_difference_Nm_s_rad", 0.05, 0.2);
    Mechanism::torque(move |m: &Moment, _| Resistance::sided(dry, -dry).with_smooth(viscous * m.speed()))
}
