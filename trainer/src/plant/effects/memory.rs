//! Memory of the contact: presliding, lag and dwell.

use super::mechanism::{Mechanism, Moment, Resistance, Setting};
use crate::plant::random::Draws;

/// Dry friction that builds up over a distance after a reversal.
///
/// The drawn share of the dry level is taken from the set-valued contact and given to springs that slip, so that steady
/// sliding stays as it was: one bristle (Canudas de Wit et al. 1995) or three Maxwell elements (Al-Bender et al. 2005).
pub(super) fn presliding(draws: &mut Draws, _: &Setting) -> Mechanism {
    let level = draws.uniform("presliding_torque_Nm", 0.8, 1.3);
    if draws.choice("generalised_maxwell_slip", 2) == 0 { lugre(draws, level) } else { maxwell_slip(draws, level) }
}

fn lugre(draws: &mut Draws, level: f64) -> Mechanism {
    let distance = draws.log_uniform("break_away_distance_rad", 1.5e-3, 1.2e-2);
    let damping = draws.uniform("bristle_damping_Nm_s_rad", 0.0, 0.05);
    let mut bristle: f64 = 0.0;
    Mechanism::torque(move |m: &Moment, step_s: f64| {
        let travel = m.velocity * step_s;
        let settled = travel.signum();
        let before = bristle;
        // dz/dx = (1 - z sgn v) / distance, solved exactly over the step.
        bristle = settled + (bristle - settled) * (-travel.abs() / distance).exp();
        let rate = if step_s > 0.0 { (bristle - before) / step_s } else { 0.0 };
        Resistance::dry(-level).with_smooth(level * bristle + damping * distance * rate)
    })
}

fn maxwell_slip(draws: &mut Draws, level: f64) -> Mechanism {
    let mut elements = [(0.0, 0.0, 0.0); 3];
    let names = ["stick_distance_1_rad", "stick_distance_2_rad", "stick_distance_3_rad"];
    let mut total = 0.0;
    for (element, name) in elements.iter_mut().zip(names) {
        let share = draws.between(0.5, 1.5);
        *element = (draws.log_uniform(name, 1e-3, 1.5e-2), share, 0.0);
        total += share;
    }
    let attraction = draws.uniform("attraction_1_s", 150.0, 400.0);
    Mechanism::torque(move |m: &Moment, step_s: f64| {
        let mut torque = 0.0;
        for (distance, share, state) in &mut elements {
            // Stick: a spring. Slip: drawn towards its full deflection.
            let spring = *state + m.velocity * step_s / *distance;
            *state = if spring.abs() <= 1.0 {
                spring
            } else {
                let full = spring.signum();
                full + (state.clamp(-1.0, 1.0) - full) * (-attraction * step_s).exp()
            };
            torque += level * *share / total * *state;
        }
        Resistance::dry(-level).with_smooth(torque)
    })
}

/// Friction that follows a change of speed late (Hess & Soom 1990): at amplitude 1 the whole law at a lagged velocity.
pub(super) fn frictional_lag(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let lag = draws.log_uniform("lag_s", 0.01, 0.06);
    let width = draws.uniform("sign_width_rad_s", 0.03, 0.08);
    let (coulomb, viscous) = (setting.joint.friction.coulomb_torque_nm, setting.joint.friction.viscous_nm_s_rad);
    let mut lagged = 0.0;
    Mechanism::torque(move |m: &Moment, step_s: f64| {
        lagged += (m.velocity - lagged) * -(-step_s / lag).exp_m1();
        let steady = |v: f64| coulomb * (v / width).tanh() + viscous * v;
        Resistance::smooth(steady(lagged) - steady(m.velocity))
    })
}

/// Breakaway torque that grows with the logarithm of the stop before it (Rabinowicz 1958).
pub(super) fn dwell_breakaway(draws: &mut Draws, _: &Setting) -> Mechanism {
    let growth = draws.uniform("growth_Nm", 0.35, 0.7);
    let onset = draws.log_uniform("onset_s", 0.01, 0.05);
    let distance = draws.log_uniform("breakaway_distance_rad", 0.008, 0.05);
    let (mut dwell, mut latched, mut travelled) = (0.0, 0.0, 0.0_f64);
    Mechanism::torque(move |m: &Moment, step_s: f64| {
        if m.velocity == 0.0 {
            dwell += step_s;
            latched = growth * (dwell / onset).ln_1p();
            travelled = 0.0;
        } else {
            dwell = 0.0;
            travelled += (m.velocity * step_s).abs();
        }
        Resistance::dry(latched * (-travelled / distance).exp())
    })
}
