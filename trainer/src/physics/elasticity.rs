//! G2, Spong 1987: behind an elastic transmission the link swings against the motor. With a motor encoder alone its twist
//! follows from the motor's own motion, and the motor carries what the link's inertia does beyond it.

use super::transmission::{
    INFERRED, MEASURED, antiresonance_of_twist, column, is_possible, is_shown, left_behind, opening, usual_link_inertia,
};
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};
use std::f64::consts::TAU;

pub(super) struct Elasticity;

/// Damping ratios of the link on the locked motor on the grid (dimensionless); refined afterwards. Chosen by judgement:
/// a factor of four apart, between ringing and nearly none.
const DAMPING_RATIOS: [f64; 2] = [0.05, 0.2];

/// Highest antiresonance in rad/s whose ringing the sampling shows.
pub(super) fn highest_antiresonance(state: &JointState) -> f64 {
    TAU * (0.15 / state.period).min(90.0)
}

impl Hypothesis for Elasticity {
    fn id(&self) -> EffectId {
        EffectId::Elasticity
    }

    fn equation(&self) -> &'static str {
        "dF = -J_l e'' - dtau_g/dq e, e'' + 2 zeta w_a e' + w_a^2 e = a + tau_g / J_l"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if usual_link_inertia(state).is_none() || !is_possible(state, self.id()) {
            return Vec::new();
        }
        let highest = highest_antiresonance(state);
        let inferred = geometric_grid(0.08 * highest, highest, 7);
        inferred
            .into_iter()
            .flat_map(|w| DAMPING_RATIOS.map(|ratio| vec![w, ratio, INFERRED]))
            .chain(
                antiresonance_of_twist(state)
                    .filter(|_| is_shown(state, self.id()))
                    .map(|w| vec![w, DAMPING_RATIOS[0], MEASURED]),
            )
            .collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(link_inertia) = usual_link_inertia(state) else { return Vec::new() };
        column(state, link_inertia, shape[2], || swinging(state, link_inertia, shape[0], shape[1]))
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("link_inertia", "J_l", Dimension::Inertia)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("antiresonance", "w_a", Dimension::RadianPerSecond),
            ShapeName::new("damping_ratio", "zeta", Dimension::One),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        let highest = highest_antiresonance(state);
        match index {
            _ if shape[2] == MEASURED => None,
            0 => Some((0.05 * highest, 1.5 * highest)),
            1 => Some((0.005, 1.0)),
            _ => None,
        }
    }
}

/// What the twist that the motor's acceleration and gravity excite leaves behind, by the trapezoidal rule.
fn swinging(state: &JointState, link_inertia: f64, antiresonance: f64, damping_ratio: f64) -> Vec<f64> {
    let drive = opening(state, link_inertia);
    let (h, stiffness, damping) = (state.period, antiresonance * antiresonance, 2.0 * damping_ratio * antiresonance);
    let mut column = vec![0.0; state.len()];
    for segment in &state.segments {
        let (mut twist, mut rate) = (drive[segment.start] / stiffness, 0.0);
        let mut bend = 0.0;
        for i in segment.clone() {
            // rate' = a - damping rate - stiffness twist, all taken at the middle of the step.
            let known =
                drive[i] - damping * (rate + 0.5 * h * bend) - stiffness * (twist + h * rate + 0.25 * h * h * bend);
            let next = known / (1.0 + 0.5 * h * damping + 0.25 * h * h * stiffness);
            twist += h * rate + 0.25 * h * h * (bend + next);
            rate += 0.5 * h * (bend + next);
            bend = next;
            column[i] = left_behind(state, link_inertia, i, twist, bend);
        }
    }
    column
}
