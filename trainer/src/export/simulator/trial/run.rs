//! A motion under a controller, of the identified joint and of a simulated one, and what the second leaves of the first.

use std::f64::consts::TAU;

use super::identified::IdentifiedJoint;
use super::scheme::{Drive, Integrator, Motion, SimulatedJoint};

/// Length of a trial, s: more than two periods of the slowest sine.
const SECONDS: f64 = 10.0;

/// Frequency (Hz) and amplitude of the sines of a motion, which do not repeat; the amplitudes are scaled to the trained velocity.
const SINES: [[f64; 2]; 3] = [[0.21, 0.8], [0.63, 0.3], [1.7, 0.08]];

/// What the frequencies of a motion are multiplied by, and the phases of its sines, rad: what a form leaves differs by a fifth from one
/// motion to the next.
pub(crate) const MOTIONS: [(f64, [f64; 3]); 3] =
    [(1.0, [0.0, 0.0, 0.0]), (0.85, [1.9, 4.2, 0.7]), (1.15, [3.6, 1.1, 5.3])];

/// A position that is commanded: a sum of sines whose velocity reaches at most `top`, rad/s (m/s).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Command {
    pub(crate) top: f64,
    /// Which of [`MOTIONS`].
    pub(crate) motion: usize,
}

impl Command {
    /// Position and velocity at a time in s.
    pub(crate) fn at(self, time: f64) -> [f64; 2] {
        let (factor, phases) = MOTIONS[self.motion];
        let most: f64 = SINES.iter().map(|[frequency, amplitude]| TAU * factor * frequency * amplitude).sum();
        let mut sums = [0.0; 2];
        for ([frequency, amplitude], phase) in SINES.into_iter().zip(phases) {
            let (omega, amplitude) = (TAU * factor * frequency, amplitude * self.top / most);
            sums[0] += amplitude * (omega * time + phase).sin();
            sums[1] += amplitude * omega * (omega * time + phase).cos();
        }
        sums
    }
}

/// A position controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Controller {
    /// N m/rad (N/m).
    pub(crate) kp: f64,
    /// N m s/rad (N s/m).
    pub(crate) kv: f64,
    /// Whether it is an actuator of the model, which damps the velocity itself; otherwise its torque is held over a step.
    pub(crate) is_actuator: bool,
}

impl Controller {
    fn drive(&self, command: [f64; 2], at: Motion) -> Drive {
        let [position, velocity] = command;
        if self.is_actuator {
            Drive::Actuator { kp: self.kp, kv: self.kv, reference: position }
        } else {
            Drive::Held(self.kp * (position - at.q) + self.kv * (velocity - at.v))
        }
    }
}

/// How a simulator steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepping {
    pub(crate) integrator: Integrator,
    /// s.
    pub(crate) step: f64,
}

/// The torques of the controller at each step with the identified joint.
pub(crate) fn identified_torques(
    joint: &IdentifiedJoint,
    (command, controller): (Command, &Controller),
    other: &impl Fn(f64) -> f64,
    step: f64,
) -> Vec<f64> {
    let [q, v] = command.at(0.0);
    let mut motion = joint.starting(q, v);
    let count = (SECONDS / step) as usize;
    (0..count)
        .map(|index| {
            let drive = controller.drive(command.at(index as f64 * step), motion.at);
            let torque = drive.torque(motion.at.q, motion.at.v);
            joint.step(&mut motion, drive, other, step);
            torque
        })
        .collect()
}

/// Root mean square of what a simulated joint leaves of the controller's torque, N m (N); `None` where it diverges.
pub(crate) fn left_over(
    joint: &SimulatedJoint,
    (command, controller): (Command, &Controller),
    other: &impl Fn(f64) -> f64,
    stepping: Stepping,
    wanted: &[f64],
) -> Option<f64> {
    let [q, v] = command.at(0.0);
    let mut motion = Motion { q, v, z: 0.0 };
    let mut sum = 0.0;
    for (index, wanted) in wanted.iter().enumerate() {
        let drive = controller.drive(command.at(index as f64 * stepping.step), motion);
        sum += (drive.torque(motion.q, motion.v) - wanted).powi(2);
        joint.step(&mut motion, drive, other, stepping.integrator, stepping.step);
    }
    let rms = (sum / wanted.len() as f64).sqrt();
    rms.is_finite().then_some(rms)
}
