//! G1, Nordin and Gutman 2002: play between motor and load. While it is crossed the motor loses the load, and at its end the
//! link is caught. With a motor encoder alone both follow from the torque that the transmission would have to carry.

use super::transmission::{
    INFERRED, MEASURED, SUBSTEPS, column, half_span_of_twist, is_possible, is_shown, left_behind, nominal_inertia,
    opening, usual_link_inertia,
};
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};
use crate::numerics::statistics::quantile;

pub(super) struct Backlash;

/// Shares (0..1) of the inertia that may lie behind the play, on the grid; refined afterwards. In steps of 1.7 about
/// the half that a transmission is usually matched to.
const LINK_SHARES: [f64; 3] = [0.25, 0.42, 0.7];
/// Shortest and longest time in which a play is crossed, s. Chosen by judgement: a shorter one is within one sample of
/// a drive, a longer one is free motion that position shows.
const CROSSING_S: (f64, f64) = (0.001, 0.06);

/// What the twist within a play leaves behind: free between the flanks, caught where it reaches one.
fn crossing(state: &JointState, link_inertia: f64, half_width: f64) -> Vec<f64> {
    let opening = opening(state, link_inertia);
    let h = state.period / SUBSTEPS as f64;
    let mut column = vec![0.0; state.len()];
    for segment in &state.segments {
        let mut twist = half_width * opening[segment.start].signum();
        let mut rate = 0.0;
        for i in segment.clone() {
            let before = rate;
            for _ in 0..SUBSTEPS {
                rate += h * opening[i];
                let free = twist + h * rate;
                twist = free.clamp(-half_width, half_width);
                if twist != free {
                    rate = 0.0;
                }
            }
            column[i] = left_behind(state, link_inertia, i, twist, (rate - before) / state.period);
        }
    }
    column
}

impl Hypothesis for Backlash {
    fn id(&self) -> EffectId {
        EffectId::Backlash
    }

    fn equation(&self) -> &'static str {
        "dF = -J_l e'' - dtau_g/dq e, e'' = a + tau_g / J_l within |e| < b, e' = 0 at the flanks"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(inertia) = nominal_inertia(state).filter(|_| is_possible(state, self.id())) else {
            return Vec::new();
        };
        let mut shapes: Vec<Shape> = half_span_of_twist(state)
            .filter(|_| is_shown(state, self.id()))
            .zip(usual_link_inertia(state))
            .map(|(half, link)| vec![half, link, MEASURED])
            .into_iter()
            .collect();
        for share in LINK_SHARES {
            let link = share * inertia;
            let opening = opening(state, link);
            let typical = quantile(opening.iter().map(|u| u.abs()), 0.5);
            let changes = opening.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
            if changes >= 4 && typical > 0.0 {
                let half_width = |crossing_s: f64| 0.25 * typical * crossing_s * crossing_s;
                let widths = geometric_grid(half_width(CROSSING_S.0), half_width(CROSSING_S.1), 16);
                shapes.extend(widths.into_iter().map(|width| vec![width, link, INFERRED]));
            }
        }
        shapes
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        column(state, shape[1], shape[2], || crossing(state, shape[1], shape[0]))
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("caught_inertia", "J_l", Dimension::Inertia)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("half_width", "b", Dimension::Position),
            ShapeName::new("link_inertia", "J_l", Dimension::Inertia),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        let inertia = nominal_inertia(state)?;
        match index {
            _ if shape[2] == MEASURED => None,
            0 => Some((0.3 * shape[0], 3.0 * shape[0])),
            1 => Some((0.1 * inertia, inertia)),
            _ => None,
        }
    }
}
