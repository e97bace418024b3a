//! Shapes between the points of a grid.

use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::hypotheses::refine::refine;
use crate::diagnose::infer::side::Side;
use crate::diagnose::noise::autoregression::Noise;
use crate::numerics::least_squares::{gram, moments, orthonormal, project_out, solve_symmetric};
use crate::physics::{Hypothesis, Shape};

/// Change of a shape over the first step of its refinement at which the curvature of its likelihood is taken. Chosen by judgement: small
/// beside the peak of a shape that the rows determine, large beside the rounding of its columns.
const CURVATURE_STEP_SHARE: f64 = 0.1;

/// A refined shape with its weight among the points of the grid.
pub(crate) struct Refined {
    pub shape: Shape,
    /// Logarithm of the width of its peak over the distance of two points of the grid (Laplace), at most zero.
    pub log_width: f64,
}

/// The likeliest shape near a start beside a model that leaves `target`: base and the other members are the whitened `beside`. `None`
/// where nothing of it moves.
pub(crate) fn refined(
    hypotheses: &[Box<dyn Hypothesis + Send>],
    side: &Side,
    (label, start): (&Label, &[f64]),
    (beside, target): (&[Vec<f64>], &[f64]),
    noise: &Noise,
) -> Option<Refined> {
    let Label::Named(effect) = label else { return None };
    let hypothesis = hypotheses.iter().find(|hypothesis| hypothesis.id() == *effect)?;
    let state = &side.prepared.state;
    let free: Vec<usize> = (0..start.len()).filter(|&i| hypothesis.bounds(state, i, start).is_some()).collect();
    if free.is_empty() {
        return None;
    }
    let all = std::iter::once(0..target.len()).collect::<Vec<_>>();
    let basis = orthonormal(beside, &all);
    let mut rest = target.to_vec();
    project_out(&mut rest, &basis, &all);
    let explained = |shape: &[f64]| {
        let mut columns = side.whitened(&side.filtered(hypotheses, (label, shape), state), noise);
        columns.iter_mut().for_each(|column| project_out(column, &basis, &all));
        let mut asked = moments(&columns, &rest, &all);
        if let Some(first) = asked.get_mut(0) {
            *first -= side.product_with_own_noise(hypotheses, label, shape);
        }
        let solution = solve_symmetric(&gram(&columns, &all), &asked)?;
        let is_possible = !hypothesis.only_positive() || solution.iter().all(|value| *value > 0.0);
        is_possible.then(|| 0.5 * solution.dot(&asked)).filter(|value| value.is_finite())
    };
    let shape = refine(hypothesis.as_ref(), state, start, explained);
    let peak = explained(&shape)?;
    let mut log_width = 0.0;
    for index in free {
        let step = hypothesis.step(state, index, &shape);
        let at = |by: f64| {
            let mut moved = shape.clone();
            moved[index] += by * CURVATURE_STEP_SHARE * step;
            explained(&moved).unwrap_or(peak)
        };
        // Nats by which the likelihood bends over a step.
        let bend = (2.0 * peak - at(1.0) - at(-1.0)).max(0.0) / (CURVATURE_STEP_SHARE * CURVATURE_STEP_SHARE);
        log_width += (0.5 * (std::f64::consts::TAU / bend.max(f64::MIN_POSITIVE)).ln()).min(0.0);
    }
    Some(Refined { shape, log_width })
}
