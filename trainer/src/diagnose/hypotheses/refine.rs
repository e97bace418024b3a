//! Continuous refinement of a hypothesis' shape from its best grid point.

use crate::numerics::pattern_search::{Movable, climb};
use crate::physics::{Hypothesis, JointState, Shape};

/// Climbs the statistic over the refinable shape parameters of a hypothesis.
pub(crate) fn refine(
    hypothesis: &dyn Hypothesis,
    state: &JointState,
    start: &[f64],
    statistic: impl Fn(&[f64]) -> Option<f64>,
) -> Shape {
    let free = |index| {
        let (low, high) = hypothesis.bounds(state, index, start)?;
        Some(Movable { index, step: hypothesis.step(state, index, start), low, high })
    };
    climb(start, &(0..start.len()).filter_map(free).collect::<Vec<_>>(), statistic)
}
