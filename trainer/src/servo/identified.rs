//! What recordings tell of an actuator.

use super::candidate::Candidate;
use crate::actuator::{Actuator, Constant, Known, Open, Partial};
use crate::joint::Joint;
use crate::parameter::Parameter;
use crate::samples::Preparation;

/// What the recordings tell of an actuator.
#[derive(Clone, Debug)]
pub struct Identified {
    /// The actuator, nothing of it open; constants that differ from recording to recording are those of the first.
    pub partial: Partial,
    /// The constants that were identified, with their 95 % intervals.
    pub parameters: Vec<Parameter>,
    /// What is not determined and what else was noticed, in sentences.
    pub remarks: Vec<String>,
    /// Whether gravity of the joint itself is identified beside that of the payload.
    pub has_own_gravity: bool,
    /// How the recordings are filtered.
    pub(super) preparation: Preparation,
    /// What was open, with what it is.
    pub(super) values: Vec<(Open, f64)>,
    /// What of that was identified.
    pub(super) open: Vec<Open>,
    /// Loss of a motor by its velocity where the recordings tell it from viscous friction, N m s/rad.
    pub(super) back_emf: Option<f64>,
    /// Delays of command and feedback where they were identified, s.
    pub(super) delays_s: Option<[f64; 2]>,
    /// Largest torque of a motor where that was identified, N m.
    pub(super) torque_limit: Option<f64>,
    /// Friction of the gear per torque of its actuator.
    pub(super) load: f64,
}

impl Identified {
    /// An actuator of which nothing was identified yet.
    pub(super) fn unsolved(partial: Partial, preparation: Preparation) -> Self {
        Self {
            partial,
            parameters: Vec::new(),
            remarks: Vec::new(),
            has_own_gravity: true,
            preparation,
            values: Vec::new(),
            open: Vec::new(),
            back_emf: None,
            delays_s: None,
            torque_limit: None,
            load: 0.0,
        }
    }

    /// The joint with the constants in force, those kept that its file gives.
    #[must_use]
    pub fn joint(&self, joint: &Joint) -> Joint {
        let mut known = joint.clone();
        for (constant, value) in self.partial.in_force() {
            let own = known.actuator.constants.entry(constant).or_insert(Known::Given(value));
            if own.given().is_none() {
                *own = Known::Given(value);
            }
        }
        // Bounds give way to what was found, nothing among it.
        if let Some(bounds) = known.actuator.constants.get_mut(&Constant::FeedbackDelay) {
            *bounds = Known::Given(bounds.given().unwrap_or(self.partial.actuator.feedback_delay_s));
        }
        known
    }

    pub(super) fn value(&self, open: Open) -> Option<f64> {
        self.values.iter().find(|(constant, _)| *constant == open).map(|(_, value)| *value)
    }

    /// The same with another value of a constant.
    pub(super) fn set(&mut self, open: Open, value: f64) {
        self.values.iter_mut().filter(|(constant, _)| *constant == open).for_each(|(_, own)| *own = value);
        self.partial = self.partial.clone().with(open, value);
    }

    /// The same with another loss, other delays and another limit.
    pub(super) fn set_rest(&mut self, candidate: &Candidate) {
        (self.back_emf, self.torque_limit) = (candidate.back_emf, candidate.torque_limit);
        self.delays_s = Some([candidate.delay_s, candidate.feedback_delay_s]);
        self.partial.actuator = self.with_rest(self.partial.actuator);
    }

    /// An actuator with the loss, the delays and the limit that were identified.
    fn with_rest(&self, mut actuator: Actuator) -> Actuator {
        actuator.back_emf = self.back_emf.unwrap_or(actuator.back_emf);
        [actuator.delay_s, actuator.feedback_delay_s] =
            self.delays_s.unwrap_or([actuator.delay_s, actuator.feedback_delay_s]);
        actuator.limits.torque = self.torque_limit.unwrap_or(actuator.limits.torque);
        actuator
    }

    /// The actuator of a recording, of which some constants may be its own.
    pub(super) fn complete(&self, partial: &Partial) -> Partial {
        let mut complete = partial.clone();
        for (open, value) in &self.values {
            if partial.open.contains(open) {
                complete = complete.with(*open, *value);
            }
        }
        complete.actuator = self.with_rest(complete.actuator);
        complete
    }
}
