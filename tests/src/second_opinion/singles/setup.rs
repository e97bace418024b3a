//! How a joint was recorded.

use super::{Bench, Effect};
use crate::second_opinion::joint::{Joint, LARGE, LINEAR, ROBOT, SERVO};
use crate::second_opinion::motion::{CHIRP, Grid, MULTISINE, Plan, STROKES, Trajectory};
use crate::second_opinion::noise::{correlation, noise};
use crate::second_opinion::random::Random;
use crate::second_opinion::recording::{Compared, Material, Recording};

/// Whether the recording has a velocity of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocityColumn {
    /// Without noise.
    Clean,
    /// With noise of 0.2 % of the top speed.
    Noisy,
    /// Only the position, in steps of the encoder.
    Absent,
}

/// How the rigid body is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidBody {
    /// By inertia and weight in the joint file.
    JointFile,
    /// By a column of its torque.
    Column,
    /// There is none.
    Absent,
    /// It is taken off already: the recording holds the friction.
    Removed,
}

/// A column that has nothing to do with the friction.
#[derive(Clone, Copy, Debug)]
pub enum Decoy {
    /// A temperature that rises.
    Temperature,
    /// A load torque that acts on nothing.
    Load,
    /// The velocity of another joint.
    OtherJoint,
    /// The position of the link, the motor's own.
    Link,
}

/// A recording to be made.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// What is hidden.
    pub effect: Effect,
    /// The joint.
    pub joint: Joint,
    /// Samples a second, Hz.
    pub rate_hz: f64,
    /// Samples of the recording.
    pub samples: usize,
    /// The motion.
    pub plan: Plan,
    /// Whether neighbouring noise is correlated.
    pub coloured: bool,
    /// Standard deviation of the noise as a share of Coulomb friction.
    pub noise: f64,
    /// The velocity.
    pub velocity: VelocityColumn,
    /// The rigid body.
    pub rigid_body: RigidBody,
    /// Whether the acceleration is recorded.
    pub acceleration: bool,
    /// Columns to be misled by.
    pub decoys: &'static [Decoy],
}

/// Noise of a noisy velocity as a share of the top speed.
const VELOCITY_NOISE: f64 = 0.002;

impl Setup {
    /// The `index`-th of six different ways to record, which begin again after the sixth.
    #[must_use]
    pub const fn nth(index: usize, effect: Effect) -> Self {
        let way = index % 6;
        let (rate_hz, samples) =
            [(1000.0, 12_000), (250.0, 7500), (100.0, 3000), (500.0, 10_000), (2000.0, 20_000), (200.0, 6000)][way];
        let rigid_body = match way {
            0 | 4 => RigidBody::JointFile,
            2 | 3 => RigidBody::Column,
            _ => RigidBody::Absent,
        };
        Self {
            effect,
            joint: [ROBOT, SERVO, LARGE, LINEAR, ROBOT, SERVO][way],
            rate_hz,
            samples,
            plan: [MULTISINE, STROKES, CHIRP, STROKES, MULTISINE, CHIRP][way],
            coloured: matches!(way, 2 | 4),
            noise: [0.02, 0.003, 0.02, 0.05, 0.003, 0.02][way],
            velocity: [VelocityColumn::Clean, VelocityColumn::Noisy, VelocityColumn::Absent][way % 3],
            rigid_body,
            acceleration: false,
            decoys: &[],
        }
    }

    /// The same at another rate and length.
    #[must_use]
    pub const fn lasting(self, rate_hz: f64, samples: usize) -> Self {
        Self { rate_hz, samples, ..self }
    }

    /// The same with another motion.
    #[must_use]
    pub const fn moving(self, plan: Plan) -> Self {
        Self { plan, ..self }
    }

    /// The recording of one seed.
    pub fn record(&self, random: &mut Random) -> Material {
        let setup = self.settled();
        let joint = setup.joint.drawn(random);
        let grid = Grid::new(setup.rate_hz, setup.samples);
        let motion = setup.plan.draw(&joint, &grid, random);
        let mut bench = Bench::new(joint, grid, motion, setup.rigid_body, random);
        setup.effect.hide(&mut bench);
        let hidden = bench.hidden_share();
        let (note, added, stated, path) = (bench.note, bench.columns, bench.stated_rigid_body, bench.path);
        let mut torque: Vec<f64> =
            (0..path.len()).map(|i| bench.rigid_body[i] + bench.friction[i] + bench.extra[i]).collect();
        let correlation = if setup.coloured { correlation(grid.period_s) } else { 0.0 };
        let noise = noise(torque.len(), setup.noise * joint.coulomb, correlation, random);
        torque.iter_mut().zip(&noise).for_each(|(torque, noise)| *torque += noise);
        let mut real = setup.columns(&joint, &path, torque, stated, random);
        for (name, values) in added {
            real.put(name, values);
        }
        setup.decoys.iter().for_each(|decoy| mislead(*decoy, &joint, &path, &mut real, random));
        let description = format!("{note} ({hidden:.3} of Coulomb friction); {}", setup.described());
        let file = (setup.rigid_body == RigidBody::JointFile).then(|| joint.file());
        Material { real, joint: file, compared: Compared::Itself, description }
    }

    /// A joint file knows no mass, and a joint without a rigid body has none.
    fn settled(&self) -> Self {
        let mut setup = *self;
        if setup.joint.linear && setup.rigid_body == RigidBody::JointFile {
            setup.rigid_body = RigidBody::Column;
        }
        if matches!(setup.rigid_body, RigidBody::Absent | RigidBody::Removed) {
            (setup.joint.inertia, setup.joint.gravity) = (0.0, 0.0);
        }
        setup
    }

    fn columns(
        &self,
        joint: &Joint,
        path: &Trajectory,
        torque: Vec<f64>,
        rigid_body: Vec<f64>,
        random: &mut Random,
    ) -> Recording {
        let unit = joint.unit();
        let mut real = Recording::default();
        real.put("time_s", path.time.clone());
        let read = |position: &f64| match self.velocity {
            VelocityColumn::Absent => joint.read(*position),
            VelocityColumn::Clean | VelocityColumn::Noisy => *position,
        };
        real.put(format!("position_{unit}"), path.position.iter().map(read).collect());
        let deviation = if self.velocity == VelocityColumn::Noisy { VELOCITY_NOISE * joint.top_speed } else { 0.0 };
        if self.velocity != VelocityColumn::Absent {
            let noisy = path.velocity.iter().map(|v| v + deviation * random.normal()).collect();
            real.put(format!("velocity_{unit}_s"), noisy);
        }
        if self.acceleration {
            real.put(format!("acceleration_{unit}_s2"), path.acceleration.clone());
        }
        let (removed, body) = if joint.linear {
            ("friction_force_N", "rigid_body_torque_N")
        } else {
            ("friction_torque_Nm", "rigid_body_torque_Nm")
        };
        let is_removed = self.rigid_body == RigidBody::Removed;
        real.put(if is_removed { removed } else { joint.actuator() }, torque);
        if self.rigid_body == RigidBody::Column {
            real.put(body, rigid_body);
        }
        real
    }

    fn described(&self) -> String {
        let Self { joint, plan, rate_hz, samples, .. } = self;
        let seconds = *samples as f64 / rate_hz;
        let colour = if self.coloured { "coloured" } else { "white" };
        let velocity = match self.velocity {
            VelocityColumn::Clean => "with velocity",
            VelocityColumn::Noisy => "with noisy velocity",
            VelocityColumn::Absent => "without velocity",
        };
        let body = match self.rigid_body {
            RigidBody::JointFile => "rigid body by the joint file",
            RigidBody::Column => "rigid body by a column",
            RigidBody::Absent => "no rigid body",
            RigidBody::Removed => "rigid body removed",
        };
        let noise = 100.0 * self.noise;
        format!(
            "{}, {}, {rate_hz} Hz, {seconds:.0} s, {colour} noise {noise} % of Coulomb, {velocity}, {body}",
            joint.name,
            plan.name()
        )
    }
}

fn mislead(decoy: Decoy, joint: &Joint, path: &Trajectory, real: &mut Recording, random: &mut Random) {
    let duration_s = path.time[path.len() - 1];
    match decoy {
        Decoy::Temperature => {
            let rising = |t: &f64| 25.0 + 8.0 * (1.0 - (-t / duration_s / 0.4).exp()) + 0.05 * random.normal();
            real.put("temperature_C", path.time.iter().map(rising).collect());
        }
        Decoy::Load => {
            let w = std::f64::consts::TAU * 0.23;
            real.put("load_torque_Nm", path.map(|t, _, _, _| 2.0 * joint.coulomb * (w * t).sin()));
        }
        Decoy::OtherJoint => {
            real.put("joint2_velocity_rad_s", path.map(|t, _, _, _| (1.7 * t).cos() + (4.1 * t).cos()));
        }
        Decoy::Link => real.put("link_position_rad", path.position.clone()),
    }
}
