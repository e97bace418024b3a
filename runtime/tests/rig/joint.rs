//! A joint with LuGre friction (Canudas de Wit, Olsson, Astrom & Lischinsky 1995) under a supervised drive, written apart from the trainer's
//! simulator: what one of them gets wrong, the other does not.

use frikan_runtime::compensator::{Exported, Limited, Limits};
use frikan_runtime::controller::{Controller, Settings, Target};
use frikan_runtime::measurement::Measurement;
use frikan_runtime::supervised::{DEFAULT_GAIN, Sample, Supervised, SupervisedCompensation, Supervision, Supervisor};

/// A joint and the loop around it, in SI.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    pub name: &'static str,
    pub inertia: f64,
    pub coulomb: f64,
    pub stribeck: f64,
    pub stribeck_velocity: f64,
    pub viscous: f64,
    /// Of the bristles, N m/rad.
    pub contact: f64,
    /// Stiffness, N m/rad, and damping, N m s/rad, of the position loop.
    pub control: [f64; 2],
}

pub const ELBOW: Joint = Joint {
    name: "elbow",
    inertia: 0.5,
    coulomb: 2.0,
    stribeck: 0.8,
    stribeck_velocity: 0.05,
    viscous: 1.1,
    contact: 3000.0,
    control: [500.0, 30.0],
};
pub const WRIST: Joint = Joint {
    name: "wrist",
    inertia: 0.02,
    coulomb: 0.15,
    stribeck: 0.05,
    stribeck_velocity: 0.08,
    viscous: 0.05,
    contact: 200.0,
    control: [30.0, 1.4],
};
pub const BASE: Joint = Joint {
    name: "base",
    inertia: 12.0,
    coulomb: 40.0,
    stribeck: 15.0,
    stribeck_velocity: 0.03,
    viscous: 25.0,
    contact: 60_000.0,
    control: [12_000.0, 720.0],
};

pub const JOINTS: [Joint; 3] = [ELBOW, WRIST, BASE];

/// What is compensated, N m, by the velocity.
pub type Law = Box<dyn FnMut(&Measurement, f32) -> f32>;

impl Joint {
    /// Friction at a steady velocity.
    pub fn friction(&self, velocity: f64) -> f64 {
        let level = self.coulomb + self.stribeck * (-velocity.abs() / self.stribeck_velocity).exp();
        level * (192.0 * velocity).tanh() + self.viscous * velocity
    }

    /// A model of so much of its friction.
    pub fn law(self, scale: f64) -> Law {
        Box::new(move |sample, _| (scale * self.friction(sample.velocity.into())) as f32)
    }
}

/// What a joint is asked to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// There in a second and standing still on a floor that vibrates.
    Hold,
    /// 10 mrad/s.
    Creep,
    /// 50 mrad at 0.1 Hz.
    Reversals,
    /// 0.2 rad there and back, resting a second each.
    Dwells,
    /// 0.5 rad at 0.5 Hz.
    Sine,
    /// 0.5 mrad there and back at 2 Hz, within the contact.
    Small,
    /// 1.2 rad there and back at 0.5 Hz, with a wall after 0.1 rad.
    Blocked,
    /// 20 mrad in a second, and standing still for long.
    Stay,
    /// Pushed without a position loop, and let go.
    Nudge,
}

pub const MOTIONS: [Motion; 6] =
    [Motion::Hold, Motion::Creep, Motion::Reversals, Motion::Dwells, Motion::Sine, Motion::Nudge];

/// Where a joint is blocked, rad.
const WALL: f64 = 0.1;

/// When the joint is let go, s.
const LET_GO: f64 = 0.7;

impl Motion {
    pub fn duration(self) -> f64 {
        match self {
            Self::Nudge => 4.0,
            Self::Reversals | Self::Stay => 21.0,
            _ => 12.0,
        }
    }

    /// Position, velocity and acceleration at a time.
    fn reference(self, time: f64) -> Option<[f64; 3]> {
        let sine = |amplitude: f64, frequency: f64| {
            let w = std::f64::consts::TAU * frequency;
            let (s, c) = (w * time).sin_cos();
            [amplitude * (1.0 - c), amplitude * w * s, amplitude * w * w * c]
        };
        let quintic = |way: f64, time: f64| {
            let s = time.min(1.0);
            [
                way * s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s),
                way * 30.0 * s * s * (1.0 - s) * (1.0 - s),
                way * 60.0 * s * (1.0 - 3.0 * s + 2.0 * s * s),
            ]
        };
        match self {
            Self::Hold => Some(quintic(0.012_345, time)),
            Self::Creep if time < 0.5 => Some([0.01 * time * time, 0.02 * time, 0.02]),
            Self::Creep => Some([0.01 * (time - 0.25), 0.01, 0.0]),
            Self::Reversals => Some(sine(0.05, 0.1)),
            Self::Sine => Some(sine(0.5, 0.5)),
            Self::Small => Some(sine(5.0e-4, 2.0)),
            Self::Blocked => Some(sine(1.2, 0.5)),
            Self::Stay => Some(quintic(0.02, time)),
            Self::Dwells => {
                let [x, v, a] = quintic(0.2, time % 2.0);
                let is_back = !((time / 2.0) as u64).is_multiple_of(2);
                Some(if is_back { [0.2 - x, -v, -a] } else { [x, v, a] })
            }
            Self::Nudge => None,
        }
    }

    fn push(self, joint: &Joint, time: f64) -> f64 {
        match self {
            Self::Hold => 0.02 * joint.coulomb * (std::f64::consts::TAU * 7.3 * time).sin(),
            Self::Nudge if (0.5..LET_GO).contains(&time) => {
                joint.coulomb + joint.stribeck + joint.inertia * 0.3 / (LET_GO - 0.5)
            }
            _ => 0.0,
        }
    }
}

/// A run.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub joint: Joint,
    pub motion: Motion,
    /// Of the encoder, per turn.
    pub bits: u32,
    /// Samples a second.
    pub rate: f64,
    /// Friction over that of the model.
    pub friction: f64,
    pub gain: f32,
}

/// One sample of it.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub time: f64,
    pub error: f64,
    pub position: f64,
    pub velocity: f64,
    pub stands: bool,
    pub answer: SupervisedCompensation,
}

impl Run {
    pub fn of(joint: Joint, motion: Motion, bits: u32) -> Self {
        Self { joint, motion, bits, rate: 1000.0, friction: 1.0, gain: DEFAULT_GAIN }
    }

    /// Angle of a count, rad.
    pub fn count(&self) -> f64 {
        std::f64::consts::TAU / f64::from(1_u32 << self.bits)
    }

    pub fn supervision(&self) -> Supervision {
        Supervision::new(self.joint.inertia as f32, self.joint.coulomb as f32, self.count() as f32)
    }

    /// The rows of the run.
    pub fn plain(&self) -> Vec<Row> {
        self.rows(self.supervision(), |_, _| {})
    }

    /// The rows of the run; `between` sees and may change what the drive measures.
    pub fn rows(&self, supervision: Supervision, mut between: impl FnMut(f64, &mut Sample)) -> Vec<Row> {
        self.driven(supervision, |time, sample, _, _| between(time, sample))
    }

    /// The rows of the run; `between` stands where the firmware does.
    pub fn driven(
        &self,
        supervision: Supervision,
        mut between: impl FnMut(f64, &mut Sample, &mut Supervisor, &mut Limited<Exported<Law>>),
    ) -> Vec<Row> {
        let Self { joint, motion, rate, friction, gain, .. } = *self;
        let (count, dt) = (self.count(), (1.0 / rate) as f32);
        let largest = 4.0 * (joint.coulomb + joint.stribeck) as f32;
        let limits = Limits::new(gain, largest, largest / 2e-3).unwrap();
        let mut compensator = Limited::by(Ok(Exported(joint.law(1.0))), limits);
        let mut supervisor = Supervisor::new(supervision).unwrap();
        let mut controller = Controller::new(Settings {
            stiffness: joint.control[0] as f32,
            damping: joint.control[1] as f32,
            inertia: joint.inertia as f32,
            count: count as f32,
            velocity_corner: 628.0,
            torque_limit: f32::MAX,
        });
        let mut moving =
            Moving { wall: if motion == Motion::Blocked { WALL } else { f64::INFINITY }, ..Moving::default() };
        let (mut acting, mut loop_torque, mut rows) = (0.0, [0.0; 2], Vec::new());
        for index in 0..(motion.duration() * rate) as usize {
            let time = index as f64 / rate;
            let reference = motion.reference(time);
            let target =
                reference.map(|[x, v, a]| Target { position: x as f32, velocity: v as f32, acceleration: a as f32 });
            let counts = (moving.position / count).floor() as i32;
            let sample = controller.step(counts, target.as_ref(), dt);
            let measurement =
                Measurement { velocity: sample.velocity, position: sample.position, ..Measurement::MISSING };
            let mut seen = Sample {
                measurement,
                reference_velocity: target.map(|target| target.velocity),
                loop_torque: loop_torque[0],
            };
            between(time, &mut seen, &mut supervisor, &mut compensator);
            let answer = supervisor.step(&mut compensator, &seen, dt);
            let wanted = sample.feedback + sample.feed_forward;
            loop_torque = [loop_torque[1], wanted];
            rows.push(Row {
                time,
                error: reference.map_or(0.0, |[x, ..]| x - moving.position),
                position: moving.position,
                velocity: moving.velocity,
                stands: reference.is_some_and(|[_, v, a]| v == 0.0 && a == 0.0),
                answer,
            });
            moving.hold(&joint, friction, acting + motion.push(&joint, time), 1.0 / rate);
            acting = f64::from(wanted + answer.torque);
        }
        rows
    }
}

/// The joint in motion.
#[derive(Clone, Copy, Debug, Default)]
struct Moving {
    position: f64,
    velocity: f64,
    /// Deflection of the bristles, rad.
    bristles: f64,
    /// Position that it does not get beyond, rad.
    wall: f64,
}

impl Moving {
    /// A torque held for a time.
    fn hold(&mut self, joint: &Joint, scale: f64, torque: f64, time: f64) {
        let steps = (time / 1.0e-4).round().max(1.0);
        let dt = time / steps;
        // Damped as the bristles alone would be to 0.7 of critical.
        let micro = 1.4 * (joint.contact * joint.inertia).sqrt() * 0.5;
        for _ in 0..steps as usize {
            let v = self.velocity;
            let level = scale * (joint.coulomb + joint.stribeck * (-v.abs() / joint.stribeck_velocity).exp());
            let end = level / joint.contact;
            let left = (-v.abs() * dt / end).exp();
            let before = self.bristles;
            self.bristles = before * left + (1.0 - left) * end * v.signum();
            let rate = (self.bristles - before) / dt;
            let friction = joint.contact * self.bristles + micro * rate + scale * joint.viscous * v;
            self.velocity += dt / joint.inertia * (torque - friction);
            self.position += dt * self.velocity;
            if self.position > self.wall {
                (self.position, self.velocity) = (self.wall, self.velocity.min(0.0));
            }
        }
    }
}

/// What a run is worth, after the first second.
#[derive(Clone, Copy, Debug)]
pub struct Scores {
    /// Root mean square of the error, rad.
    pub rms: f64,
    /// Largest range of the position where the reference has stood for half a second, rad.
    pub range: f64,
    /// Largest speed after the joint was let go less that at which it was, rad/s.
    pub gained: f64,
    /// Mean share of the gain.
    pub share: f64,
    /// Share of samples in which the drive says that it compensates less than it was set to.
    pub degraded: f64,
    /// The same where the range was taken.
    pub degraded_at_rest: f64,
    /// Share of samples in which it takes the velocity for implausible.
    pub implausible: f64,
}

impl Scores {
    pub fn of(rows: &[Row]) -> Self {
        let settled: Vec<&Row> = rows.iter().filter(|row| row.time >= 1.0).collect();
        let mean = |of: &dyn Fn(&Row) -> f64| settled.iter().map(|row| of(row)).sum::<f64>() / settled.len() as f64;
        let mut at_rest = Vec::new();
        let (mut since, mut low, mut high, mut range) = (f64::NAN, 0.0_f64, 0.0_f64, 0.0_f64);
        for row in rows {
            if !row.stands {
                since = f64::NAN;
            } else if since.is_nan() {
                since = row.time;
            } else if row.time < since + 0.5 {
                (low, high) = (row.position, row.position);
            } else {
                (low, high) = (low.min(row.position), high.max(row.position));
                range = range.max(high - low);
                at_rest.push(f64::from(u8::from(row.answer.status == Supervised::Degraded)));
            }
        }
        let free: Vec<f64> = rows.iter().filter(|row| row.time >= LET_GO).map(|row| row.velocity.abs()).collect();
        Self {
            rms: mean(&|row| row.error * row.error).sqrt(),
            range,
            gained: free.iter().copied().fold(0.0, f64::max) - free.first().copied().unwrap_or(0.0),
            share: mean(&|row| f64::from(row.answer.gain_share)),
            degraded: mean(&|row| f64::from(u8::from(row.answer.status == Supervised::Degraded))),
            degraded_at_rest: at_rest.iter().copied().sum::<f64>() / at_rest.len().max(1) as f64,
            implausible: mean(&|row| f64::from(u8::from(row.answer.status == Supervised::Implausible))),
        }
    }
}
