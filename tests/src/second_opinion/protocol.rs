//! How the recordings of faults and mixtures are made: a fine grid, of which the samples are taken.

use super::joint::Joint;
use super::motion::{Grid, Plan, Trajectory};
use super::noise::noise;
use super::random::Random;
use super::recording::{Compared, Material, Recording};

/// A joint, a motion, a rate and a noise.
#[derive(Clone, Copy, Debug)]
pub struct Protocol {
    /// The joint.
    pub joint: Joint,
    /// Its motion.
    pub plan: Plan,
    /// Samples a second, Hz.
    pub rate_hz: f64,
    /// s.
    pub duration_s: f64,
    /// Standard deviation of the torque's noise, % of Coulomb friction.
    pub noise_percent: f64,
    /// Correlation of neighbouring noise.
    pub correlation: f64,
}

/// Least rate of the fine grid, Hz.
pub const FINE_HZ: f64 = 4000.0;
/// Noise of the velocity as a share of the top speed.
pub const VELOCITY_NOISE: f64 = 3e-4;

/// A motion on the fine grid.
#[derive(Clone, Debug)]
pub struct Fine {
    /// The joint, its weight at an angle of its own.
    pub joint: Joint,
    /// Time of a fine step, s.
    pub period_s: f64,
    /// Fine steps of a sample.
    pub step: usize,
    /// The motion.
    pub path: Trajectory,
}

impl Fine {
    /// The motion at the samples.
    #[must_use]
    pub fn sampled(&self) -> Trajectory {
        self.path.every(self.step)
    }

    /// Every sample of fine values.
    #[must_use]
    pub fn samples_of(&self, values: &[f64]) -> Vec<f64> {
        values.iter().copied().step_by(self.step).collect()
    }
}

impl Protocol {
    /// A motion on a grid of at least [`FINE_HZ`].
    pub fn fine(&self, random: &mut Random) -> Fine {
        self.finer_than(FINE_HZ, random)
    }

    /// A motion on a grid of at least this rate.
    pub fn finer_than(&self, hz: f64, random: &mut Random) -> Fine {
        self.oversampled((hz / self.rate_hz).ceil().max(1.0) as usize, random)
    }

    /// A motion on a grid of `step` times the rate.
    pub fn oversampled(&self, step: usize, random: &mut Random) -> Fine {
        let joint = self.joint.drawn(random);
        let rate_hz = self.rate_hz * step as f64;
        let grid = Grid::new(rate_hz, (self.duration_s * rate_hz).round() as usize + 1);
        let path = self.plan.draw(&joint, &grid, random).at(&grid);
        Fine { joint, period_s: grid.period_s, step, path }
    }

    /// Torque of rigid body and friction, N m or N.
    #[must_use]
    pub fn torque(joint: &Joint, path: &Trajectory) -> Vec<f64> {
        path.map(|_, q, v, a| joint.rigid_body(q, a) + joint.friction(v))
    }

    /// Noise for `count` samples, N m or N.
    pub fn noise(&self, count: usize, random: &mut Random) -> Vec<f64> {
        noise(count, self.noise_percent / 100.0 * self.joint.coulomb, self.correlation, random)
    }

    /// Adds noise to a torque.
    pub fn disturb(&self, torque: &mut [f64], random: &mut Random) {
        let noise = self.noise(torque.len(), random);
        torque.iter_mut().zip(noise).for_each(|(torque, noise)| *torque += noise);
    }

    /// The recording of a motion and a torque that has its noise already.
    pub fn columns(
        joint: &Joint,
        path: &Trajectory,
        torque: Vec<f64>,
        velocity_noise: f64,
        random: &mut Random,
    ) -> Recording {
        let unit = joint.unit();
        let mut real = Recording::default();
        let read = path.position.iter().map(|q| joint.read(*q)).collect();
        let noisy = path.velocity.iter().map(|v| v + velocity_noise * joint.top_speed * random.normal()).collect();
        real.put("time_s", path.time.clone());
        real.put(format!("position_{unit}"), read);
        real.put(format!("velocity_{unit}_s"), noisy);
        real.put(joint.actuator(), torque);
        if joint.linear {
            real.put("rigid_body_torque_N", path.map(|_, q, _, a| joint.rigid_body(q, a)));
        }
        real
    }

    /// A case of a motion and a torque, to which noise is added.
    pub fn material(
        &self,
        joint: &Joint,
        path: &Trajectory,
        mut torque: Vec<f64>,
        note: &str,
        random: &mut Random,
    ) -> Material {
        self.disturb(&mut torque, random);
        let real = Self::columns(joint, path, torque, VELOCITY_NOISE, random);
        self.of(joint, real, note)
    }

    /// A case of a recording.
    #[must_use]
    pub fn of(&self, joint: &Joint, real: Recording, note: &str) -> Material {
        let description = format!("{note}; {}", self.described());
        Material { real, joint: Some(joint.file()), compared: Compared::Itself, description }
    }

    /// How it was recorded, in words.
    #[must_use]
    pub fn described(&self) -> String {
        let Self { joint, plan, rate_hz, duration_s, noise_percent, correlation } = self;
        let colour = if *correlation > 0.0 { "coloured" } else { "white" };
        format!(
            "{}, {}, {rate_hz} Hz, {duration_s:.0} s, {colour} noise {noise_percent} % of Coulomb",
            joint.name,
            plan.name()
        )
    }
}
