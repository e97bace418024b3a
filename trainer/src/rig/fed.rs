//! An actuator that reports no torque, fed by the drive: what it is told of the drive's answer, and what it makes of that.

use crate::actuator::{Command, FeedForward, Motion};
use crate::plant::{Joint, Servo};

use super::drive::Answer;
use super::scores::Fed;

/// The actuator of a joint, told of the drive's torque in a form, one sample late.
///
/// A motor is told of the whole torque of the drive's position loop. An actuator that follows the position itself gets the reference as it is, and
/// of the drive the compensation alone.
pub(super) struct FedActuator {
    form: FeedForward,
    follows_position: bool,
    servo: Servo,
    /// The same without the drive, of one that follows the position: what it would do by itself.
    alone: Servo,
    /// What it was told at the sample before, and the same without the drive.
    told: Option<[Command; 2]>,
    /// What it did over the sample before, N m, and would have done without the drive.
    did: [f64; 2],
}

impl FedActuator {
    /// The actuator of a joint at rest; none of a joint that puts out the torque of its drive.
    pub(super) fn of(joint: &Joint, form: FeedForward) -> Option<Self> {
        let (servo, alone) = (Servo::of(joint)?, Servo::of(joint)?);
        let follows_position = servo.actuator().kind.follows_position();
        Some(Self { form, follows_position, servo, alone, told: None, did: [0.0; 2] })
    }

    /// Torque over the sample before, N m: what the gear carries.
    pub(super) fn load(&self) -> f32 {
        self.did[0] as f32
    }

    /// Torque over the sample before without what the drive added, N m; none where the position loop is the drive's.
    pub(super) fn own(&self) -> Option<f32> {
        self.follows_position.then_some(self.did[1] as f32)
    }

    /// Takes the answer of the drive to a sample at which the joint has a reference, the drive sees a motion and the joint has a velocity, rad/s:
    /// tells the actuator, which knows of it from the next sample on, and lets it act on what it was told before.
    pub(super) fn step(&mut self, answer: &Answer, reference: Motion, motion: Motion, velocity: f64) -> Fed {
        let compensation = f64::from(answer.compensation);
        let bare = self.servo.command(reference, 0.0, self.form, 0.0);
        let (command, told, feed_forward) = if !self.follows_position {
            let torque = f64::from(answer.torque);
            let command = self.servo.command(reference, torque, self.form, motion.velocity);
            let without = self.servo.actuator().effort_for(self.form, torque - compensation, motion.velocity);
            (command, command.effort, command.effort - without)
        } else if self.form == FeedForward::PositionOffset {
            let offset = self.servo.actuator().offset_for(compensation, &bare, motion);
            let reference = bare.reference + offset;
            (Command { reference, ..bare }, reference, offset)
        } else {
            (Command { feed_forward: compensation, ..bare }, compensation, compensation)
        };
        let [acting, without] = self.told.replace([command, bare]).unwrap_or([bare, bare]);
        self.did = [self.servo.drive(acting, motion, velocity), self.alone.drive(without, motion, velocity)];
        Fed { torque: self.did[0], told, feed_forward }
    }
}

/// In what form the drive of a joint feeds its actuator, where nothing else is asked for.
#[must_use]
pub fn usual_form(joint: &Joint) -> FeedForward {
    let kind = joint.actuator.map(|actuator| actuator.kind).unwrap_or_default();
    FeedForward::of(kind).first().copied().unwrap_or(FeedForward::Torque)
}
