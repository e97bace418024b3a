//! One step of an inertia under constant push, viscous drag and set-valued dry friction.
//!
//! Within a step the push and the dry levels are held and the equation is solved exactly, event by event: slide, reach
//! zero, stick or break loose again. Nothing is regularised, so stiction neither creeps nor chatters.

use super::Number;

/// Levels of dry friction for motion to either side, N m (>= 0 each for a passive contact).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DryLevels<T = f64> {
    pub(crate) forward: T,
    pub(crate) backward: T,
}

impl<T> DryLevels<T> {
    pub(crate) fn towards(self, direction: f64) -> T {
        if direction > 0.0 { self.forward } else { self.backward }
    }
}

/// Position and velocity of an inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Motion1D<T = f64> {
    pub(crate) position: T,
    pub(crate) velocity: T,
}

/// Advances `inertia * dv/dt = push - viscous * v - dry(sign v)` by `step_s` and returns the mean dry friction torque, N m.
pub(crate) fn advance<T: Number>(
    state: &mut Motion1D<T>,
    push: T,
    dry: DryLevels<T>,
    viscous: T,
    inertia: T,
    step_s: f64,
) -> T {
    let mut left = T::from(step_s);
    let mut impulse = T::from(0.0);
    // At most two events fit in a step of constant push: stop, then leave the other way.
    for _ in 0..3 {
        let direction = if state.velocity != 0.0 {
            state.velocity.re().signum()
        } else if push > dry.forward {
            1.0
        } else if push < -dry.backward {
            -1.0
        } else {
            return (impulse + push * left) / step_s;
        };
        let friction = dry.towards(direction) * direction;
        let net = push - friction;
        let stop = time_to_stop(state.velocity, net, viscous, inertia);
        let slice = stop.filter(|time| *time < left).unwrap_or(left);
        glide(state, net, viscous, inertia, slice);
        impulse += friction * slice;
        left -= slice;
        if left <= 0.0 {
            break;
        }
        state.velocity = T::from(0.0);
    }
    impulse / step_s
}

/// Time until the velocity reaches zero under `net` torque, if it does, s.
fn time_to_stop<T: Number>(velocity: T, net: T, viscous: T, inertia: T) -> Option<T> {
    if velocity * net >= 0.0 {
        return None;
    }
    let ratio = -viscous * velocity / net;
    if ratio > 1e-9 { Some(inertia / viscous * ratio.ln_1p()) } else { Some(-inertia * velocity / net) }
}

/// Time over the time constant of the drag up to which a motion is a series: its next term is a part in 10^10 of what is gained.
const SHORT: f64 = 1e-3;

/// Exact motion under constant `net` torque and viscous drag.
fn glide<T: Number>(state: &mut Motion1D<T>, net: T, viscous: T, inertia: T, time: T) {
    let x = viscous * time / inertia;
    if x < SHORT {
        // The series of the exponential, as its terms cancel.
        let gained = (net - viscous * state.velocity) / inertia * time;
        state.position += (state.velocity + gained * (x * (x / 24.0 - 1.0 / 6.0) + 0.5)) * time;
        state.velocity += gained * (x * (x / 6.0 - 0.5) + 1.0);
        return;
    }
    let share = -(-x).exp_m1();
    let terminal = net / viscous;
    let gap = state.velocity - terminal;
    state.position += terminal * time + gap * share * inertia / viscous;
    state.velocity -= gap * share;
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: DryLevels = DryLevels { forward: 2.0, backward: 2.0 };

    #[test]
    fn viscous_decay_is_exact() {
        let mut state = Motion1D { position: 0.0, velocity: 3.0 };
        for _ in 0..1000 {
            advance(&mut state, 0.0, DryLevels::default(), 1.2, 0.5, 0.001);
        }
        let decay = (-1.2_f64 / 0.5).exp();
        assert!((state.velocity - 3.0 * decay).abs() < 1e-12);
        assert!((state.position - 3.0 * (1.0 - decay) * 0.5 / 1.2).abs() < 1e-12);
    }

    #[test]
    fn coulomb_stops_in_finite_time_and_stays() {
        let mut state = Motion1D { position: 0.0, velocity: 1.0 };
        for _ in 0..1000 {
            advance(&mut state, 0.0, DRY, 0.0, 0.5, 0.00025);
        }
        // v^2 J / (2 F_c) = 0.125 rad, reached after J v / F_c = 0.25 s.
        assert_eq!(state.velocity, 0.0);
        assert!((state.position - 0.125).abs() < 1e-9, "{}", state.position);
        let before = state;
        for k in 0..1000 {
            let friction = advance(&mut state, 1.9 * (k as f64 * 0.1).sin(), DRY, 0.0, 0.5, 0.00025);
            assert!(friction.abs() <= 2.0);
        }
        assert_eq!(state, before, "no creep and no chatter inside the friction cone");
    }

    #[test]
    fn breaks_loose_above_the_level_and_reverses_within_one_step() {
        let mut state = Motion1D::default();
        advance(&mut state, 2.5, DRY, 0.0, 0.5, 0.001);
        assert!((state.velocity - 0.001).abs() < 1e-15);
        let mut state = Motion1D { position: 0.0, velocity: 0.001 };
        advance(&mut state, -5.0, DRY, 0.0, 0.5, 0.001);
        assert!(state.velocity < 0.0);
    }

    #[test]
    fn work_of_friction_is_the_kinetic_energy_lost() {
        let mut state = Motion1D { position: 0.0, velocity: 2.0 };
        let mut work = 0.0;
        for _ in 0..4000 {
            let before = state;
            let friction = advance(&mut state, 0.0, DRY, 1.2, 0.5, 0.00025);
            let drag = 1.2 * 0.5 * (before.velocity + state.velocity);
            work += (friction + drag) * (state.position - before.position);
        }
        assert!((work - 0.5 * 0.5 * 4.0).abs() < 1e-3, "{work}");
    }
}
