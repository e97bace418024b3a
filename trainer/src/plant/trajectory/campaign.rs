//! A campaign: the list of trajectories that make one recording.

use super::motion::Motion;
use serde::{Deserialize, Serialize};

/// Trajectories in turn. The joint starts and ends each at rest at zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Campaign {
    /// Length of a trajectory that does not say its own, s.
    pub trajectory_s: f64,
    /// How often the whole list is repeated (>= 1), each time with fresh random details.
    pub sets: usize,
    /// The trajectories.
    pub trajectories: Vec<Trajectory>,
}

/// One motion with one payload.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trajectory {
    /// Shape of the motion.
    pub motion: Motion,
    /// Length, s; the campaign's when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_s: Option<f64>,
    /// Amplitude of the gravity torque of this payload, N m; the joint's list in turn when absent.
    #[serde(rename = "gravity_torque_Nm", default, skip_serializing_if = "Option::is_none")]
    pub gravity_torque_nm: Option<f64>,
    /// Rest before this trajectory that is not recorded but in which the joint cools, s.
    #[serde(default)]
    pub pause_before_s: f64,
}

impl From<Motion> for Trajectory {
    fn from(motion: Motion) -> Self {
        Self { motion, duration_s: None, gravity_torque_nm: None, pause_before_s: 0.0 }
    }
}

impl Default for Campaign {
    fn default() -> Self {
        Self { trajectory_s: 6.0, sets: 1, trajectories: twelve().into_iter().map(Trajectory::from).collect() }
    }
}

impl Campaign {
    /// Every trajectory of every set.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Trajectory> {
        (0..self.sets.max(1)).flat_map(|_| &self.trajectories)
    }

    /// Length of the whole recording, s.
    pub fn duration_s(&self) -> f64 {
        let set = self.trajectories.iter().map(|trajectory| trajectory.duration_s.unwrap_or(self.trajectory_s));
        self.sets.max(1) as f64 * set.sum::<f64>()
    }

    /// As many of the trajectories, in turn, as fill another total length, s (> 0): cut, repeated with fresh random
    /// details, and stretched or shortened a little so that they fit.
    pub fn with_duration(mut self, duration_s: f64) -> Self {
        let count = (duration_s / self.trajectory_s).round().max(1.0);
        let in_turn = self.trajectories.iter().cycle().take(count as usize);
        self.trajectories = in_turn.map(|trajectory| Trajectory { duration_s: None, ..trajectory.clone() }).collect();
        self.trajectory_s = duration_s / count;
        self.sets = 1;
        self
    }

    /// Puts an unrecorded rest of `pause_s` in the middle of the list, so that the joint cools inside the recording.
    pub fn with_cooling(mut self, pause_s: f64) -> Self {
        let middle = self.trajectories.len() / 2;
        if let Some(trajectory) = self.trajectories.get_mut(middle) {
            trajectory.pause_before_s = pause_s;
        }
        self
    }
}

/// Twelve motions that between them excite every effect of the catalogue.
fn twelve() -> [Motion; 12] {
    let multisine = |amplitude_rad, lowest_hz, highest_hz| Motion::Multisine {
        amplitude_rad,
        lowest_hz,
        highest_hz,
        speed_rad_s: 3.5,
        lines: 7,
    };
    [
        multisine(2.2, 0.17, 0.9),
        Motion::StopAndGo { step_rad: 0.4, speed_rad_s: 1.6, dwells_s: vec![0.05, 0.15, 0.4, 0.9] },
        Motion::Triangles { amplitude_rad: 1.9, speed_rad_s: 2.6 },
        Motion::SmallReversals { smallest_rad: 0.002, largest_rad: 0.08, frequency_hz: 2.0 },
        multisine(0.7, 0.3, 3.2),
        Motion::Plateaus { speeds_rad_s: vec![0.06, 0.35, 2.0, 0.15, 0.9], hold_s: 0.5 },
        Motion::Trapezoids { amplitude_rad: 2.3, speed_rad_s: 3.2, dwells_s: vec![0.1, 0.3, 0.8] },
        Motion::Sweep { amplitude_rad: 0.9, lowest_hz: 0.3, highest_hz: 6.0 },
        Motion::Triangles { amplitude_rad: 0.35, speed_rad_s: 0.5 },
        Motion::UnidirectionalSwing { speed_rad_s: 0.45, swing: 0.8, frequency_hz: 1.7 },
        Motion::StopAndGo { step_rad: 0.12, speed_rad_s: 0.4, dwells_s: vec![0.08, 0.25, 0.7] },
        multisine(2.5, 0.14, 1.4),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn default_campaign_is_twelve_times_six_seconds() {
        assert_eq!(Campaign::default().trajectories.len(), 12);
        assert!((Campaign::default().duration_s() - 72.0).abs() < 1e-9);
        for (duration, count) in [(2.0, 1), (10.0, 2), (600.0, 100)] {
            let campaign = Campaign::default().with_duration(duration);
            assert_eq!(campaign.trajectories.len(), count);
            assert!((campaign.duration_s() - duration).abs() < 1e-9);
        }
    }
}
