//! What a second encoder tells of a transmission: over the torque that it carries the twist is a line (an elastic gear, Spong 1987),
//! a jump (play, Nordin and Gutman 2002) or a loop (hysteretic wind-up, Taghirad and Belanger 1998).

use crate::numerics::least_squares::{dot, fit_residual};
use crate::numerics::statistics::quantile;
use crate::physics::{EffectId, JointState, Twist, carried_torque, usual_link_inertia};
use std::ops::Range;

/// Energy of the twist that the best of line, jump and loop leaves over the whole, above which the twist is no function
/// of the torque but a kinematic error, another convention or noise. Half: it explains more than it leaves.
const UNEXPLAINED_SHARE: f64 = 0.5;
/// Energy that a line leaves over the whole, below which the gear is elastic however much less another leaves. Chosen
/// by judgement: smaller names a play in the noise of the encoders, larger hides a small play.
const LINE_RESIDUAL_SHARE: f64 = 0.02;
/// Energy that jump or loop leaves over that of the line, below which it is the better one. Chosen by judgement: nearer
/// to one their further parameter wins by chance, smaller misses a play beside elasticity.
const HYSTERESIS_ENERGY_RATIO: f64 = 0.6;
/// Twist over the travel that is rounding of printed positions: nine digits.
const ROUNDING_SHARE: f64 = 1e-9;
/// Torque over the largest within which a jump turns over: the narrowest loop of [`LOOP_TORQUE_SHARES`].
const JUMP_TORQUE_SHARE: f64 = LOOP_TORQUE_SHARES[0];
/// Torques over the largest over which a loop builds up: half decades of the one parameter that is not fitted.
const LOOP_TORQUE_SHARES: [f64; 4] = [0.03, 0.1, 0.3, 1.0];

/// What the twist between both encoders shows.
pub(crate) fn shown_by_twist(state: &JointState) -> Twist {
    shown(state).unwrap_or_default()
}

/// `None` without a second encoder or a rigid body, or where the twist shows nothing clearly.
fn shown(state: &JointState) -> Option<Twist> {
    let (link, link_inertia) = (state.link.as_ref()?, usual_link_inertia(state)?);
    let all = &state.segments;
    let twist = state.map(|i| state.position[i] - link.position[i]);
    let carried = carried_torque(state, link, link_inertia);
    let largest = quantile(carried.iter().map(|torque| torque.abs()), 0.98);
    let line = [vec![1.0; state.len()], carried.clone(), link.acceleration.clone()];
    let left = |with: Option<Vec<f64>>| {
        let columns: Vec<Vec<f64>> = line.iter().cloned().chain(with).collect();
        fit_residual(&columns, &twist, all).map(|left| dot(&left, &left, all))
    };
    let whole = fit_residual(&line[..1], &twist, all).map(|left| dot(&left, &left, all))?;
    let grain = state.resolution.max(ROUNDING_SHARE * state.span());
    if whole <= state.len() as f64 * grain * grain {
        return Some(Twist::Rigid);
    }
    let by_line = left(None)?;
    let by_jump = left(Some(carried.iter().map(|torque| (torque / (JUMP_TORQUE_SHARE * largest)).tanh()).collect()))?;
    let loops = LOOP_TORQUE_SHARES.iter().filter_map(|share| left(Some(winding(&carried, share * largest, all))));
    let by_loop = loops.fold(f64::INFINITY, f64::min);
    if by_line.min(by_jump).min(by_loop) > UNEXPLAINED_SHARE * whole {
        return None;
    }
    Some(Twist::Shows(
        if by_line < LINE_RESIDUAL_SHARE * whole || by_jump.min(by_loop) > HYSTERESIS_ENERGY_RATIO * by_line {
            EffectId::Elasticity
        } else if by_jump < by_loop {
            EffectId::Backlash
        } else {
            EffectId::WindupHysteresis
        },
    ))
}

/// Dahl's element over a torque: towards the side to which it changes, over `reach` (Dahl 1968).
fn winding(torque: &[f64], reach: f64, segments: &[Range<usize>]) -> Vec<f64> {
    let mut wound = vec![0.0; torque.len()];
    for segment in segments {
        let mut z = 0.0f64;
        for i in segment.clone().skip(1) {
            let step = torque[i] - torque[i - 1];
            let side = if step == 0.0 { z } else { step.signum() };
            z = side + (z - side) * (-step.abs() / reach).exp();
            wound[i] = z;
        }
    }
    wound
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;
    use crate::physics::catalogue;

    fn told(twist: impl Fn(f64, f64) -> f64) -> Twist {
        state_of(twist).twist
    }

    /// A link of 0.4 kg m2 under gravity, swung behind a gear whose twist over the torque is given.
    fn state_of(twist: impl Fn(f64, f64) -> f64) -> JointState {
        let period = 0.002;
        let time: Vec<f64> = (0..20_000).map(|i| period * f64::from(i)).collect();
        let link = |t: f64| 0.6 * (1.1 * t).sin() + 0.2 * (2.9 * t).sin();
        let acceleration = |t: f64| -0.6 * 1.1 * 1.1 * (1.1 * t).sin() - 0.2 * 2.9 * 2.9 * (2.9 * t).sin();
        let gravity = |t: f64| 8.0 * link(t).sin();
        let carried: Vec<f64> = time.iter().map(|t| gravity(*t) + 0.4 * acceleration(*t)).collect();
        let wound = winding(&carried, 1.0, &[0..time.len()]);
        let link_position: Vec<f64> = time.iter().map(|t| link(*t)).collect();
        let position: Vec<f64> =
            link_position.iter().zip(carried.iter().zip(&wound)).map(|(q, (c, z))| q + twist(*c, *z)).collect();
        let load: Vec<f64> = time.iter().map(|t| gravity(*t)).collect();
        let rigid_body = time.iter().zip(&load).map(|(t, load)| load + 0.6 * acceleration(*t)).collect();
        let signals = Signals {
            period,
            torque: carried,
            position,
            link_position: Some(link_position),
            rigid_body: Some(rigid_body),
            load: Some(load),
            segments: vec![0..time.len()],
            time,
            rotary: true,
            ..Signals::default()
        };
        signals.states()
    }

    #[test]
    fn a_line_a_jump_and_a_loop_are_told_apart() {
        assert_eq!(told(|torque, _| torque / 2000.0), Twist::Shows(EffectId::Elasticity));
        assert_eq!(told(|torque, _| torque / 50_000.0 + 2e-3 * torque.signum()), Twist::Shows(EffectId::Backlash));
        assert_eq!(told(|torque, wound| torque / 4000.0 - 6e-4 * wound), Twist::Shows(EffectId::WindupHysteresis));
        assert_eq!(told(|_, _| 1e-3), Twist::Rigid, "an offset is no twist");
    }

    #[test]
    fn what_both_encoders_show_is_offered_as_it_was_measured_under_gravity_too() {
        // Gravity carries more than inertia here: over the link's acceleration the twist falls.
        let wound = state_of(|torque, wound| torque / 4000.0 - 6e-4 * wound);
        let hypotheses = catalogue();
        let windup = hypotheses.iter().find(|hypothesis| hypothesis.id() == EffectId::WindupHysteresis).unwrap();
        let shapes = windup.shapes(&wound);
        let [antiresonance, half_twist, 1.0] = shapes.last().unwrap()[..] else { panic!("{:?}", shapes.last()) };
        assert!((70.0..150.0).contains(&antiresonance), "sqrt(4000 / 0.4) rad/s but for the loop: {antiresonance}");
        assert!((5e-4..3e-3).contains(&half_twist), "{half_twist}");
    }

    #[test]
    fn a_twist_that_does_not_follow_the_torque_shows_nothing() {
        let samples = std::cell::Cell::new(0.0);
        let wave = |_, _| {
            samples.set(samples.get() + 1.0);
            1e-3 * f64::sin(0.05 * samples.get())
        };
        assert_eq!(told(wave), Twist::Unknown);
    }
}
