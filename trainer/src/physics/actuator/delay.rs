//! H8: the command acts later than the actuator's constants say.

use super::{asked_of_gain, missing_torque};
use crate::actuator::Commanded;
use crate::numerics::between_samples::between_samples;
use crate::physics::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(in crate::physics) struct CommandDelay;

/// Longest delay that is looked for, s: a command over a busy serial bus of many servos or over a network. Longer shows as another motion.
const LONGEST_S: f64 = 0.1;
/// Shortest, in samples: less shows nothing between two of them.
const SHORTEST_SAMPLES: f64 = 0.5;
/// Delays that are tried, each about a quarter longer than the one before; refined afterwards. Between steps that are further apart other effects
/// make up for the difference.
const STEPS: usize = 18;

fn bounds(state: &JointState) -> (f64, f64) {
    let shortest = SHORTEST_SAMPLES * state.period;
    (shortest, LONGEST_S.max(2.0 * shortest))
}

/// Torque that a recorded current or duty lacks where it acts late by so many samples: by what the joint needs of it.
fn late_torque(state: &JointState, samples: f64) -> Vec<f64> {
    let asked = asked_of_gain(state, &state.predicted);
    let mut column = vec![0.0; state.len()];
    for segment in &state.segments {
        let of_segment = &asked[segment.clone()];
        for i in segment.clone() {
            column[i] = asked[i] - between_samples(of_segment, (i - segment.start) as f64 - samples);
        }
    }
    column
}

impl Hypothesis for CommandDelay {
    fn id(&self) -> EffectId {
        EffectId::CommandDelay
    }

    fn equation(&self) -> &'static str {
        "dF = tau(command(t)) - tau(command(t - d))"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if state.commanded.is_none() {
            return Vec::new();
        }
        let (shortest, longest) = bounds(state);
        geometric_grid(shortest, longest, STEPS).into_iter().map(|delay| vec![delay]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let late = shape[0] / state.period;
        let follows_position =
            |commanded: &Commanded| commanded.actuators.iter().all(|(_, a)| a.kind.follows_position());
        let mut column = if state.commanded.as_ref().is_none_or(follows_position) {
            missing_torque(state, |commanded| commanded.delayed(&state.segments, late))
        } else {
            late_torque(state, late)
        };
        column.iter_mut().for_each(|torque| *torque /= shape[0]);
        vec![column]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("command_delay", "d", Dimension::Second)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        // The delay over which the change of the command is taken: of short delays any shows the same.
        vec![ShapeName::new("variant", "variant", Dimension::Second)]
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some(bounds(state))
    }
}
