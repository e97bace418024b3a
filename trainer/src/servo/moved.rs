//! The constants that a fit by trajectory moves, with their bounds and what is known of them before.

use super::candidate::{Candidate, What};
use super::friction::Terms;
use crate::actuator::{Known, Open};
use crate::rollout::State;

/// How late a controller sees the motion where nobody says it, s: a half-normal deviation. Drives close such loops at 1 to 20 kHz and act on a motion of
/// a period and a half before (Franklin, Powell & Workman 1998): the latest, 1.5 ms, is at two deviations.
const FEEDBACK_DELAY_S: f64 = 0.75e-3;
/// The latest that is looked for, s: beyond it the first order of the delay says little.
const LATEST_FEEDBACK_S: f64 = 0.01;
/// Least limit of a torque over the one where the search begins: without torque nothing moves and no constant shows.
const LEAST_LIMIT: f64 = 0.1;

/// Rows of each recording from which its recorded state is taken, with that state.
pub(super) type Starts = Vec<Vec<(usize, State)>>;

/// A constant that is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moved {
    pub(super) what: What,
    /// Its size, by which steps are measured.
    pub(super) scale: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    /// Mean and deviation of what is known of it before.
    pub(super) prior: Option<(f64, f64)>,
}

impl Moved {
    fn between(what: What, scale: f64, low: f64, high: f64) -> Self {
        Self { what, scale, low, high, prior: None }
    }

    /// How late a controller sees the motion, by what joint.toml says of it: kp and kd times the delay is what the feedback takes of viscous friction
    /// and inertia, in first order. `None` where it is given.
    pub(super) fn feedback_delay(known: Option<Known>) -> Option<Self> {
        let (low, high, mean, deviation) = match known {
            Some(Known::Given(_)) => return None,
            // Four deviations wide.
            Some(Known::Between(low, high)) => (low, high, 0.5 * (low + high), 0.25 * (high - low)),
            None => (0.0, LATEST_FEEDBACK_S, 0.0, FEEDBACK_DELAY_S),
        };
        let prior = Some((mean, deviation));
        Some(Self { prior, ..Self::between(What::FeedbackDelay, deviation, low, high) })
    }

    /// How many deviations a candidate is from what was known before.
    pub(super) fn beside_prior(&self, candidate: &Candidate) -> f64 {
        self.prior.map_or(0.0, |(mean, deviation)| (candidate.value(self.what) - mean) / deviation)
    }
}

/// Constants that are moved from a start on, with their bounds; the joint's own gravity where that is not the payload's alone. The loss by
/// back-EMF of a motor of which nothing else is known is part of the viscous friction. Friction that falls over more than a fifth of the top speed
/// would be Coulomb and viscous friction under other names.
pub(super) fn moved(
    start: &Candidate,
    open: &[Open],
    [torque, speed]: [f64; 2],
    terms: Terms,
    own_gravity: bool,
    delay_is_open: bool,
    feedback_delay: Option<Moved>,
) -> Vec<Moved> {
    let positive = |what, scale: f64| Moved::between(what, scale, 0.0, f64::INFINITY);
    let mut moved: Vec<Moved> = open
        .iter()
        .map(|open| {
            let value = start.value(What::Actuator(*open)).abs().max(f64::MIN_POSITIVE);
            Moved::between(What::Actuator(*open), value, 0.05 * value, 20.0 * value)
        })
        .collect();
    moved.extend([
        positive(What::Inertia, start.inertia.abs().max(1e-3 * torque)),
        Moved::between(What::Offset, 0.1 * torque, -torque, torque),
        positive(What::Coulomb, 0.1 * torque),
    ]);
    if terms.stribeck {
        moved.extend([
            positive(What::Stribeck, 0.1 * torque),
            Moved::between(What::StribeckVelocity, 0.05 * speed, 0.005 * speed, 0.2 * speed),
        ]);
    }
    moved.push(positive(What::Viscous, 0.1 * torque / speed));
    moved.extend(terms.load.then_some(Moved::between(What::Load, 0.1, 0.0, 0.95)));
    moved.extend(
        start.torque_limit.map(|limit| Moved { low: LEAST_LIMIT * limit, ..positive(What::TorqueLimit, limit) }),
    );
    if own_gravity {
        let free = |what| Moved::between(what, 0.1 * torque, f64::NEG_INFINITY, f64::INFINITY);
        moved.extend([free(What::GravitySin), free(What::GravityCos)]);
    }
    moved.extend(start.back_emf.map(|_| positive(What::BackEmf, 0.1 * torque / speed)));
    moved.extend(delay_is_open.then_some(Moved::between(What::Delay, 0.01, 0.0, 0.1)));
    moved.extend(feedback_delay);
    moved
}
