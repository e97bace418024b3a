//! What a learned law leaves of its simulation: errors of its formulas, which the same motion meets again in the recording.
//!
//! Where friction turns over they are largest, and there the recorded joint, whose friction is another one, comes to rest and starts
//! a little earlier or later than the simulated one: the instants of both are put on each other.

use crate::numerics::statistics::root_mean_square;
use crate::physics::JointState;

/// Largest difference of the positions, over their travel, at which recording and simulation are of one motion.
const SAME_MOTION_SHARE: f64 = 0.02;

/// Largest distance of an instant of rest or start in the recording from that in the simulation, s. Chosen by judgement: a controller
/// of a few hertz hardly lags more; larger takes another reversal for the same.
const SAME_INSTANT_S: f64 = 0.06;

/// What is left over time, with the position and velocity at which it was.
#[derive(Clone, Debug)]
pub(crate) struct ReplayedResidual {
    /// Time since the start, s.
    time: Vec<f64>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    series: Vec<Vec<f64>>,
}

/// What of it a recording meets again.
pub(crate) struct Replay {
    /// Each series at every sample, nothing beyond the simulation.
    pub series: Vec<Vec<f64>>,
    /// Share of the samples within the simulation.
    pub share: f64,
}

impl ReplayedResidual {
    /// What a law leaves of a simulation, as series at its states.
    pub fn of(series: Vec<Vec<f64>>, state: &JointState) -> Self {
        Self {
            time: since_start(&state.time),
            position: state.position.clone(),
            velocity: state.velocity.clone(),
            series,
        }
    }

    /// The series at the same instants of a recording. `None` where that is of another motion.
    pub fn at(&self, state: &JointState) -> Option<Replay> {
        let (mut series, mut differences) = (vec![Vec::with_capacity(state.len()); self.series.len()], Vec::new());
        let time = since_start(&state.time);
        let instants = self.same_instants(&time, state);
        for (since, position) in time.iter().zip(&state.position) {
            let since = simulated_time(*since, &instants);
            let after = self.time.partition_point(|earlier| *earlier <= since);
            if after == 0 || after == self.time.len() {
                series.iter_mut().for_each(|series| series.push(0.0));
                continue;
            }
            let share = (since - self.time[after - 1]) / (self.time[after] - self.time[after - 1]);
            let between = |series: &[f64]| series[after - 1] + share * (series[after] - series[after - 1]);
            differences.push(between(&self.position) - position);
            series.iter_mut().zip(&self.series).for_each(|(met, left)| met.push(between(left)));
        }
        if differences.is_empty() {
            return None;
        }
        let difference = root_mean_square(&differences);
        let share = differences.len() as f64 / state.len() as f64;
        (difference <= SAME_MOTION_SHARE * state.span()).then_some(Replay { series, share })
    }

    /// Instants at which the recorded joint comes to rest or starts, each with that of the simulated one, s since the start.
    fn same_instants(&self, time: &[f64], state: &JointState) -> Vec<(f64, f64)> {
        let recorded = turns(time, &state.velocity, state.sign_velocity);
        let simulated = turns(&self.time, &self.velocity, state.sign_velocity);
        let nearest = |turn: &Turn, others: &[Turn]| {
            let distance = |other: &Turn| (other.time_s - turn.time_s).abs();
            let same = others.iter().filter(|other| other.kind == turn.kind && distance(other) < SAME_INSTANT_S);
            same.min_by(|a, b| distance(a).total_cmp(&distance(b))).copied()
        };
        let mutual = recorded.iter().filter_map(|turn| {
            let other = nearest(turn, &simulated)?;
            (nearest(&other, &recorded)? == *turn).then_some((turn.time_s, other.time_s))
        });
        let mut instants: Vec<(f64, f64)> = Vec::new();
        for (recorded, simulated) in mutual {
            if instants.last().is_none_or(|last| recorded > last.0 && simulated > last.1) {
                instants.push((recorded, simulated));
            }
        }
        instants
    }
}

fn since_start(time: &[f64]) -> Vec<f64> {
    let start = time.first().copied().unwrap_or(0.0);
    time.iter().map(|time| time - start).collect()
}

/// An instant at which a joint comes to rest or starts.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    time_s: f64,
    /// Whether it starts, and whether it moves forwards.
    kind: (bool, bool),
}

/// The instants at which a joint comes to rest before it turns round, and at which it starts again.
fn turns(time: &[f64], velocity: &[f64], rest: f64) -> Vec<Turn> {
    let mut turns = Vec::new();
    let mut moving: Option<usize> = None;
    for (i, v) in velocity.iter().enumerate().filter(|(_, v)| v.abs() > rest) {
        if let Some(before) = moving.filter(|before| velocity[*before] * v < 0.0) {
            turns.push(Turn { time_s: time[before], kind: (false, velocity[before] > 0.0) });
            turns.push(Turn { time_s: time[i], kind: (true, *v > 0.0) });
        }
        moving = Some(i);
    }
    turns
}

/// Time of the simulation at a time of the recording, by instants that are the same in both.
fn simulated_time(recorded: f64, instants: &[(f64, f64)]) -> f64 {
    let after = instants.partition_point(|instant| instant.0 <= recorded);
    match (after.checked_sub(1).map(|before| instants[before]), instants.get(after)) {
        (Some(before), Some(after)) => before.1 + (recorded - before.0) * (after.1 - before.1) / (after.0 - before.0),
        (Some(only), None) | (None, Some(&only)) => only.1 + recorded - only.0,
        (None, None) => recorded,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;

    fn moving(start: f64, rate: f64, early_s: f64) -> JointState {
        let time: Vec<f64> = (0..400).map(|i| start + 0.01 * f64::from(i)).collect();
        // It turns round at one second, or a little earlier.
        let position = (0..400).map(|i| (rate * (0.01 * f64::from(i) - 1.0 + early_s)).cos()).collect();
        Signals::without_gap(0.01, time, position, vec![0.0; 400]).states()
    }

    #[test]
    fn what_is_left_is_met_at_the_same_time_of_the_same_motion_only() {
        let torque: Vec<f64> = (0..400).map(|i| f64::from(i) - 100.0).collect();
        let left = ReplayedResidual::of(vec![torque], &moving(0.0, 3.0, 0.0));
        let later = left.at(&moving(50.0, 3.0, 0.0)).unwrap();
        let met = &later.series[0];
        assert!((met[250] - 150.0).abs() < 1e-6 && met.last() == Some(&0.0), "{}", met[250]);
        assert!(later.share > 0.99, "{}", later.share);
        assert!(left.at(&moving(0.0, 3.5, 0.0)).is_none());
    }

    #[test]
    fn what_is_left_at_a_reversal_is_met_at_the_same_reversal_where_that_comes_earlier() {
        let torque: Vec<f64> = (0..400).map(|i| f64::from(u8::from(i > 100))).collect();
        let left = ReplayedResidual::of(vec![torque], &moving(0.0, 0.3, 0.0));
        let met = left.at(&moving(0.0, 0.3, 0.03)).unwrap();
        let step = met.series[0].iter().position(|torque| *torque > 0.5).unwrap();
        assert!((97..=99).contains(&step), "{step}");
    }

    #[test]
    fn instants_between_those_that_are_the_same_are_put_between_them() {
        let instants = [(1.0, 1.02), (2.0, 1.98)];
        let simulated = |recorded: f64| simulated_time(recorded, &instants);
        assert!((simulated(1.5) - 1.5).abs() < 1e-12 && (simulated(0.5) - 0.52).abs() < 1e-12);
        assert!((simulated(2.5) - 2.48).abs() < 1e-12 && (simulated_time(0.7, &[]) - 0.7).abs() < 1e-12);
    }
}
