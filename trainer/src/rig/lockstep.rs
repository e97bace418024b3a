//! Sample by sample: counts and reference to the drive, its torque to the joint.

use frikan_runtime::controller::Target;
use frikan_runtime::drive::DriveInput;

use super::course::Course;
use super::drive::DriveUnderTest;
use super::scores::Row;
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
    /// Where it is to go.
    pub course: Course,
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
    let Bench { joint, seed, friction_scale, course, duration, swap } = bench;
    let rate = joint.drive.rate_hz;
    let mut moving = plant::at_rest(joint, *seed)?;
    let load = Load::of(joint, joint.gravity_torque_nm.first().copied().unwrap_or(0.0));
    let dry = joint.friction.dry_level(0.0);
    let count = plant::encoder_step(joint);
    let mut acting = 0.0_f32;
    let mut rows = Vec::new();
    for index in 0..(duration * rate).round() as usize {
        let time = index as f64 / rate;
        if let Some((_, image)) = swap.as_ref().filter(|(at, _)| (at * rate).round() as usize == index) {
            drive.replace_image(image)?;
        }
        let target = course.target(index, rate);
        let counts = (moving.motor.position / count).floor() as i32;
        // The drive knows gravity where its encoder says that the joint is.
        let gravity = load.gravity(f64::from(counts) * count) as f32;
        let temperature = if joint.thermal.sensor { moving.housing.temperature as f32 } else { f32::NAN };
        let answer = drive.answer(&DriveInput { counts, target, gravity, temperature })?;
        let missing = Target { position: f32::NAN, velocity: f32::NAN, acceleration: f32::NAN };
        let reference = target.unwrap_or(missing);
        rows.push(Row {
            time,
            position: moving.motor.position,
            velocity: moving.motor.velocity,
            temperature: moving.housing.temperature,
            reference: [reference.position, reference.velocity],
            answer,
        });
        let motion = course.motion();
        let outside = motion.map_or(0.0, |motion| motion.disturbance(time, joint.inertia_kgm2, dry));
        moving.friction_scale = friction_scale * motion.map_or(1.0, |motion| motion.friction_factor(time));
        moving.see_neighbour(time);
        let _ = moving.sample(moving.actuated(f64::from(acting)) + outside, time, &load);
        acting = answer.torque;
    }
    Ok(rows)
}
