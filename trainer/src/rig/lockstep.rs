//! Sample by sample: counts and reference to the drive, its torque to the joint.

use frikan_runtime::controller::Target;
use frikan_runtime::drive::DriveInput;

use super::course::Course;
use super::drive::DriveUnderTest;
use super::fed::FedActuator;
use super::scores::Row;
use crate::actuator::{FeedForward, Motion};
use crate::error::Result;
use crate::plant::{self, Joint, Load};

/// What is run.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The joint with the effects hidden in it; its friction yields where it has a contact stiffness.
    pub joint: Joint,
    /// Seed of the hidden effects: that of the recording in which they were hidden too.
    pub seed: u64,
    /// Factor on Coulomb, Stribeck and viscous friction of the joint, > 0.
    pub friction_scale: f64,
    /// Where it is to go; a joint whose actuator follows the position has to have a reference all the time.
    pub course: Course,
    /// In what form the drive's torque reaches an actuator that reports none: one that it takes. A joint without such an actuator puts out the
    /// torque.
    pub feed_forward: FeedForward,
    /// Length, s.
    pub duration: f64,
    /// Time, s, and image with which the drive goes on from then.
    pub swap: Option<(f64, Vec<u8>)>,
}

/// Runs `bench` with a drive and returns every sample.
///
/// # Errors
/// `FRK-D015` for a joint that cannot be simulated, and where the drive does not answer.
pub fn run(bench: &Bench, drive: &mut impl DriveUnderTest) -> Result<Vec<Row>> {
    let Bench { joint, seed, friction_scale, course, feed_forward, duration, swap } = bench;
    let rate = joint.drive.rate_hz;
    let mut moving = plant::at_rest(joint, *seed)?;
    let load = Load::of(joint, joint.gravity_torque_nm.first().copied().unwrap_or(0.0));
    let dry = joint.friction.dry_level(0.0);
    let count = plant::encoder_step(joint);
    let mut fed_actuator = FedActuator::of(joint, *feed_forward);
    let mut acting = 0.0;
    let mut rows = Vec::new();
    for index in 0..(duration * rate).round() as usize {
        let time = index as f64 / rate;
        if let Some((_, image)) = swap.as_ref().filter(|(at, _)| (at * rate).round() as usize == index) {
            drive.replace_image(image)?;
        }
        let target = course.target(index, rate);
        let counts = (moving.motor.position / count).floor() as i32;
        // The drive knows gravity where its encoder says that the joint is.
        let position = f64::from(counts) * count;
        let gravity = load.gravity(position) as f32;
        let temperature = if joint.thermal.sensor { moving.housing.temperature as f32 } else { f32::NAN };
        let known = fed_actuator.as_ref();
        let (carried, own) = known.map_or((gravity, None), |actuator| (actuator.load(), actuator.own()));
        let answer =
            drive.answer(&DriveInput { counts, target, gravity, load: carried, actuator: own, temperature })?;
        let missing = Target { position: f32::NAN, velocity: f32::NAN, acceleration: f32::NAN };
        let reference = target.unwrap_or(missing);
        let fed = fed_actuator.as_mut().map(|actuator| {
            let [wanted, speed] = [reference.position, reference.velocity].map(f64::from);
            let wanted = Motion { position: wanted, velocity: speed };
            let seen = Motion { position, velocity: f64::from(answer.velocity) };
            actuator.step(&answer, wanted, seen, moving.motor.velocity)
        });
        rows.push(Row {
            time,
            position: moving.motor.position,
            velocity: moving.motor.velocity,
            temperature: moving.housing.temperature,
            reference: [reference.position, reference.velocity],
            answer,
            fed,
        });
        let motion = course.motion();
        let outside = motion.map_or(0.0, |motion| motion.disturbance(time, joint.inertia_kgm2, dry));
        moving.friction_scale = friction_scale * motion.map_or(1.0, |motion| motion.friction_factor(time));
        moving.see_neighbour(time);
        // An actuator of its own acts at once on what it was told at the sample before, a drive on what it answered then.
        let torque = fed.map_or(acting, |fed| fed.torque);
        let _ = moving.sample(moving.actuated(torque) + outside, time, &load);
        acting = f64::from(answer.torque);
    }
    Ok(rows)
}
