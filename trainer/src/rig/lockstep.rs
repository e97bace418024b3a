//! Sample by sample: counts and reference to the drive, its torque to the joint.

use frikan_runtime::compensator::{Compensator, Limits};
use frikan_runtime::controller::{Settings, Target};
use frikan_runtime::drive::{DriveInput, JointDrive};
use frikan_runtime::shared::model::Model;
use frikan_runtime::supervised::{SupervisedCompensator, Supervision};

use super::joint::{JointState, LuGreJoint};
use super::motion::Motion;
use super::scores::Row;

/// The drive with `model`, reset.
#[must_use]
pub fn drive_of<const CELLS: usize>(
    model: Model<CELLS>,
    settings: Settings,
    limits: Limits,
    supervision: Supervision,
) -> JointDrive<CELLS> {
    let compensator = Compensator::with_model(Ok(model), limits);
    JointDrive::new(settings, SupervisedCompensator::new(compensator, limits, supervision))
}

/// What is run.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The joint.
    pub joint: LuGreJoint,
    /// The motion.
    pub motion: Motion,
    /// Samples a second.
    pub rate: f64,
    /// Length, s.
    pub duration: f64,
}

/// Runs `bench` with a drive and returns every sample.
#[must_use]
pub fn run<const CELLS: usize>(bench: &Bench, drive: &mut JointDrive<CELLS>) -> Vec<Row> {
    let Bench { joint, motion, rate, duration } = bench;
    let friction = joint.friction.dry_level(0.0);
    let dt = 1.0 / rate;
    let mut state = JointState::default();
    let mut acting = 0.0_f32;
    let mut rows = Vec::new();
    for index in 0..(duration * rate).round() as usize {
        let time = index as f64 / rate;
        let target = motion.target(time);
        let counts = joint.counts(state.position);
        // The drive knows gravity where its encoder says that the joint is.
        let gravity = joint.gravity_torque(joint.angle(counts)) as f32;
        let input = DriveInput { counts, target, gravity, temperature: f32::NAN };
        let output = drive.step(&input, dt as f32);
        let missing = Target { position: f32::NAN, velocity: f32::NAN, acceleration: f32::NAN };
        let reference = target.unwrap_or(missing);
        rows.push(Row {
            time,
            position: state.position,
            velocity: state.velocity,
            reference: [reference.position, reference.velocity],
            torque: output.torque,
            compensation: output.compensation.torque,
            gain_share: output.compensation.gain_share,
        });
        let outside = motion.disturbance(time, joint.inertia, friction);
        joint.advance(&mut state, f64::from(acting) + outside, dt);
        acting = output.torque;
    }
    rows
}
