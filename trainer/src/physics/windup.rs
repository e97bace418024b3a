//! G3, Taghirad and Belanger 1998; Ruderman et al. 2009: the transmission winds up in a loop, stiffer after each reversal of
//! the torque that it carries (a spring beside Dahl's element, both over the twist). With a motor encoder alone the twist
//! follows from the motor's motion and the load.

use super::elasticity::highest_antiresonance;
use super::transmission::{
    INFERRED, MEASURED, SUBSTEPS, antiresonance_of_twist, column, half_span_of_twist, is_possible, is_shown,
    left_behind, opening, usual_link_inertia,
};
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};
use crate::numerics::statistics::quantile;

pub(super) struct WindupHysteresis;

/// Stiffness of the loop at a reversal over that of the spring (dimensionless). Chosen by judgement: fixed, as a
/// further shape parameter would cost evidence; a wrong one changes the fitted loop twist and inertia.
const LOOP_STIFFNESS_RATIO: f64 = 1.5;
/// Damping ratio of the spring (dimensionless). Chosen by judgement: fixed for the same reason, between those tried for
/// an elastic gear; raised from 0.1 with a denser grid of antiresonances.
const DAMPING_RATIO: f64 = 0.15;

/// What the twist leaves behind, by `e'' = u - w^2 (e + r L z) - 2 zeta w e'`, `dz = (sign(de) - z) |de| / L`.
fn winding(state: &JointState, link_inertia: f64, antiresonance: f64, loop_twist: f64) -> Vec<f64> {
    let drive = opening(state, link_inertia);
    let h = state.period / SUBSTEPS as f64;
    let (stiffness, damping) = (antiresonance * antiresonance, 2.0 * DAMPING_RATIO * antiresonance);
    let mut column = vec![0.0; state.len()];
    for segment in &state.segments {
        let (mut twist, mut rate, mut memory) = (drive[segment.start] / stiffness, 0.0, 0.0);
        for i in segment.clone() {
            let before: f64 = rate;
            for _ in 0..SUBSTEPS {
                let restoring = stiffness * (twist + LOOP_STIFFNESS_RATIO * loop_twist * memory);
                // The damping is taken at the end of the step, so that no stiffness makes it unstable.
                rate = (rate + h * (drive[i] - restoring)) / (1.0 + h * damping);
                let step = h * rate;
                twist += step;
                let settled = step.signum();
                memory = settled + (memory - settled) * (-step.abs() / loop_twist).exp();
            }
            column[i] = left_behind(state, link_inertia, i, twist, (rate - before) / state.period);
        }
    }
    column
}

/// Twist that the usual drive causes in a spring of that antiresonance.
fn usual_twist(drive: &[f64], antiresonance: f64) -> f64 {
    quantile(drive.iter().map(|u| u.abs()), 0.8) / (antiresonance * antiresonance)
}

impl Hypothesis for WindupHysteresis {
    fn id(&self) -> EffectId {
        EffectId::WindupHysteresis
    }

    fn equation(&self) -> &'static str {
        "dF = -J_l e'' - dtau_g/dq e, e'' + 2 zeta w_a e' + w_a^2 (e + r L z) = a + tau_g / J_l, dz = (sign(de) - z) |de| / L"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(link_inertia) = usual_link_inertia(state).filter(|_| is_possible(state, self.id())) else {
            return Vec::new();
        };
        let drive = opening(state, link_inertia);
        if usual_twist(&drive, 1.0) <= 0.0 {
            return Vec::new();
        }
        let highest = highest_antiresonance(state);
        geometric_grid(0.12 * highest, 0.8 * highest, 9)
            .into_iter()
            .flat_map(|w| [0.03, 0.1, 0.3].map(|share| vec![w, share * usual_twist(&drive, w), INFERRED]))
            .chain(
                antiresonance_of_twist(state)
                    .zip(half_span_of_twist(state))
                    .filter(|_| is_shown(state, self.id()))
                    .map(|(w, half)| vec![w, half, MEASURED]),
            )
            .collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(link_inertia) = usual_link_inertia(state) else { return Vec::new() };
        column(state, link_inertia, shape[2], || winding(state, link_inertia, shape[0], shape[1]))
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("link_inertia", "J_l", Dimension::Inertia)]
    }

    fn yields_to(&self) -> Option<(EffectId, f64)> {
        Some((EffectId::Elasticity, 5.0))
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("antiresonance", "w_a", Dimension::RadianPerSecond),
            ShapeName::new("loop_twist", "L", Dimension::Position),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        let highest = highest_antiresonance(state);
        match index {
            _ if shape[2] == MEASURED => None,
            0 => Some((0.05 * highest, 1.5 * highest)),
            1 => Some((0.1 * shape[1], 10.0 * shape[1])),
            _ => None,
        }
    }
}
