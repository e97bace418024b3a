//! C1, Dahl 1968; Canudas de Wit et al. 1995; Al-Bender, Lampaert and Swevers 2005: after a reversal friction builds up
//! over a distance, not at once; over one distance or over several.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(super) struct Presliding;

/// Normalised bristle deflection in [-1, 1] with the exact exponential step
/// z <- S + (z - S) exp(-|dq| / distance), S = sign(dq); at the start of a segment as if it had moved so before.
pub(crate) fn bristle(state: &JointState, distance: f64) -> Vec<f64> {
    let mut deflection = vec![0.0; state.len()];
    for segment in &state.segments {
        let mut z = state.sign[segment.start];
        for i in segment.clone() {
            if i > segment.start {
                let step = state.position[i] - state.position[i - 1];
                let target = if step > 0.0 { 1.0 } else { -1.0 };
                z = target + (z - target) * (-step.abs() / distance).exp();
            }
            deflection[i] = z;
        }
    }
    deflection
}

/// Distance at least: over less, friction has turned over by the first sample after a reversal.
fn shortest(state: &JointState) -> f64 {
    (0.5 * state.resolved_speed() * state.period).max(state.resolution).max(1e-9)
}

/// Longest distance over which a joint may slip: what a bearing or gear yields before it slides; beyond it is a spring.
fn longest(state: &JointState) -> f64 {
    if state.rotary { 0.1 } else { f64::INFINITY }
}

/// Distances over which friction may build up, as far as the recording resolves and travels them.
pub(crate) fn breakaway_distances(state: &JointState) -> Vec<f64> {
    let travel = state.span();
    let finest = (4.0 * state.resolution).max(3e-5 * travel).max(shortest(state));
    geometric_grid(finest, (0.4 * travel).min(longest(state)).max(finest), 10)
}

impl Hypothesis for Presliding {
    fn id(&self) -> EffectId {
        EffectId::Presliding
    }

    fn equation(&self) -> &'static str {
        "dF = sum_i F_i (z_i - tanh(v/v_eps)), dz_i = (sign(dq) - z_i) |dq| / delta_i, delta_i = delta 4^(i-1)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        breakaway_distances(state).into_iter().flat_map(|delta| [vec![delta, 1.0], vec![delta, 3.0]]).collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        (0..shape[1] as usize)
            .map(|element| {
                let z = bristle(state, shape[0] * 4f64.powi(element as i32));
                state.map(|i| z[i] - state.sign[i])
            })
            .collect()
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        const SYMBOLS: [&str; 3] = ["F_1", "F_2", "F_3"];
        SYMBOLS.iter().take(shape[1] as usize).map(|symbol| ("presliding_torque", *symbol, Dimension::Torque)).collect()
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("breakaway_distance", "delta", Dimension::Position),
            ShapeName::new("elements", "n", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        (index == 0).then(|| (shortest(state), (1.5 * state.span()).min(longest(state))))
    }
}
