//! Adam (Kingma and Ba, 2015), full batch: the paper's baseline.

use super::lbfgs::{End, Iterate, Objective};

const FIRST_DECAY: f64 = 0.9;
const SECOND_DECAY: f64 = 0.999;
const EPSILON: f64 = 1e-8;

/// Takes `steps` steps of the given rate; leaves the last point in `values`.
pub(super) fn minimise(
    values: &mut [f64],
    steps: usize,
    rate: f64,
    objective: &mut Objective,
    observe: &mut dyn FnMut(&Iterate) -> bool,
) -> End {
    let (mut first, mut second) = (vec![0.0; values.len()], vec![0.0; values.len()]);
    let (mut first_bias, mut second_bias) = (1.0, 1.0);
    for step in 0.. {
        let (loss, gradient) = objective(values);
        if observe(&Iterate { values, loss, gradient: &gradient }) {
            return End::Stopped;
        }
        if gradient.iter().all(|g| g.abs() <= f64::EPSILON) {
            return End::Flat;
        }
        if step >= steps {
            break;
        }
        first_bias *= FIRST_DECAY;
        second_bias *= SECOND_DECAY;
        for i in 0..values.len() {
            first[i] = FIRST_DECAY * first[i] + (1.0 - FIRST_DECAY) * gradient[i];
            second[i] = SECOND_DECAY * second[i] + (1.0 - SECOND_DECAY) * gradient[i] * gradient[i];
            let deviation = (second[i] / (1.0 - second_bias)).sqrt() + EPSILON;
            values[i] -= rate * first[i] / (1.0 - first_bias) / deviation;
        }
    }
    End::Limit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walks_down_a_bowl() {
        let mut bowl = |x: &[f64]| (x[0] * x[0] + 10.0 * x[1] * x[1], vec![2.0 * x[0], 20.0 * x[1]]);
        let mut values = [1.0, -1.0];
        minimise(&mut values, 2000, 0.01, &mut bowl, &mut |_| false);
        assert!(values[0].abs() < 1e-3 && values[1].abs() < 1e-3);
    }
}
