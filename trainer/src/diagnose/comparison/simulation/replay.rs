//! What a learned law leaves of its simulation: errors of its formulas, which the same motion meets again in the recording.

use crate::diagnose::measurement::signals::Signals;
use crate::numerics::statistics::root_mean_square;
use crate::physics::JointState;

/// Largest difference of the positions, over their travel, at which recording and simulation are of one motion.
const SAME_MOTION_SHARE: f64 = 0.02;

/// Torque left over time, with the position at which it was left.
#[derive(Clone, Debug)]
pub(crate) struct ReplayedResidual {
    /// Time since the start, s.
    time: Vec<f64>,
    position: Vec<f64>,
    torque: Vec<f64>,
}

/// What of it a recording meets again.
pub(crate) struct Replay {
    /// Torque at every sample, nothing beyond the simulation.
    pub torque: Vec<f64>,
    /// Share of the samples within the simulation.
    pub share: f64,
}

impl ReplayedResidual {
    pub fn of(simulation: &Signals, law: &[f64]) -> Self {
        let start = simulation.time.first().copied().unwrap_or(0.0);
        Self {
            time: simulation.time.iter().map(|time| time - start).collect(),
            position: simulation.position.clone(),
            torque: simulation.torque.iter().zip(law).map(|(torque, law)| torque - law).collect(),
        }
    }

    /// The torque at the same times of a recording. `None` where that is of another motion.
    pub fn at(&self, state: &JointState) -> Option<Replay> {
        let start = state.time.first()?;
        let (mut torque, mut differences) = (Vec::with_capacity(state.len()), Vec::new());
        for (time, position) in state.time.iter().zip(&state.position) {
            let since = time - start;
            let after = self.time.partition_point(|earlier| *earlier <= since);
            if after == 0 || after == self.time.len() {
                torque.push(0.0);
                continue;
            }
            let share = (since - self.time[after - 1]) / (self.time[after] - self.time[after - 1]);
            let between = |series: &[f64]| series[after - 1] + share * (series[after] - series[after - 1]);
            differences.push(between(&self.position) - position);
            torque.push(between(&self.torque));
        }
        if differences.is_empty() {
            return None;
        }
        let difference = root_mean_square(&differences);
        let share = differences.len() as f64 / torque.len() as f64;
        (difference <= SAME_MOTION_SHARE * state.span()).then_some(Replay { torque, share })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_met_at_the_same_time_of_the_same_motion_only() {
        let moving = |start: f64, rate: f64| Signals {
            period: 0.01,
            time: (0..400).map(|i| start + 0.01 * f64::from(i)).collect(),
            position: (0..400).map(|i| (0.01 * rate * f64::from(i)).sin()).collect(),
            torque: (0..400).map(f64::from).collect(),
            segments: std::iter::once(0..400).collect(),
            rotary: true,
            ..Signals::default()
        };
        let left = ReplayedResidual::of(&moving(0.0, 3.0), &[100.0; 400]);
        let later = left.at(&moving(50.0, 3.0).states()).unwrap();
        assert!((later.torque[250] - 150.0).abs() < 1e-6 && later.torque.last() == Some(&0.0), "{}", later.torque[250]);
        assert!((later.share - 399.0 / 400.0).abs() < 1e-9, "{}", later.share);
        assert!(left.at(&moving(0.0, 3.5).states()).is_none());
    }
}
