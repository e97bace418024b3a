//! Maximisation without derivatives (Hooke and Jeeves 1961).

/// Evaluations of the statistic at most.
const MOST_EVALUATIONS: usize = 60;

/// A shape parameter that may move: its place, its first step and its bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Movable {
    pub index: usize,
    pub step: f64,
    pub low: f64,
    pub high: f64,
}

/// Climbs a statistic by a shrinking pattern search (Hooke and Jeeves 1961); derivative-free because some regressors
/// (windows, bristles) are not smooth in their shape.
pub(crate) fn climb(start: &[f64], free: &[Movable], mut statistic: impl FnMut(&[f64]) -> Option<f64>) -> Vec<f64> {
    let mut best = start.to_vec();
    if free.is_empty() {
        return best;
    }
    let Some(mut value) = statistic(&best) else { return best };
    let mut steps: Vec<f64> = free.iter().map(|free| free.step).collect();
    let smallest: Vec<f64> = steps.iter().map(|step| 0.01 * step).collect();
    let mut evaluations = 1;
    while evaluations < MOST_EVALUATIONS && steps.iter().zip(&smallest).any(|(step, least)| step > least) {
        let mut moved = false;
        for (slot, Movable { index, low, high, .. }) in free.iter().enumerate() {
            for direction in [1.0, -1.0] {
                let mut trial = best.clone();
                trial[*index] = (trial[*index] + direction * steps[slot]).clamp(*low, *high);
                evaluations += 1;
                if let Some(trial_value) = statistic(&trial).filter(|v| *v > value) {
                    (best, value, moved) = (trial, trial_value, true);
                    break;
                }
            }
        }
        if !moved {
            steps.iter_mut().for_each(|step| *step *= 0.4);
        }
    }
    best
}
