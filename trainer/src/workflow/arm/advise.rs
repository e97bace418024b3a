//! The motion that an arm is best recorded with.

use std::fmt::Write;

use super::clearance;
use crate::arm::base::Base;
use crate::arm::clearance::{Nearest, Room};
use crate::arm::excitation::{Excitation, Limits};
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::joint::{ArmFile, Joint};
use crate::robot::parse;

/// Rate of the planned motion, Hz.
const RATE_HZ: f64 = 100.0;

/// A planned motion of all joints.
#[derive(Clone, Debug)]
pub struct Advised {
    /// Time, and position, velocity and acceleration of every joint, as CSV: one period, after which it starts again.
    pub trajectory: String,
    /// What it is worth, how close it comes to what, and what was not looked at.
    pub text: String,
    /// Condition number of what it tells; infinite where it cannot tell everything.
    pub condition: f64,
    /// Where a link comes closest to an obstacle and to another link, as far as there are any.
    pub nearest: Vec<Nearest>,
}

/// Plans a motion of the arm of a URDF or MJCF file within the limits of `arm.toml`, clear of its obstacles and of the arm itself; positions that it
/// does not limit are limited by the robot's file.
///
/// # Errors
/// As [`crate::arm::chain::Chain::parse`] and [`ArmFile::joints`]; `FRK-D014` where a limit of a joint is not known, or there are
/// obstacles and no shape of any link; `FRK-D047` where no motion keeps clear.
pub fn advise(robot: &str, file: &ArmFile, seed: u64) -> Result<Advised> {
    let robot = parse(robot)?;
    let (chain, joints) = super::described(&robot, file)?;
    let limits = chain.joints.iter().zip(&joints).map(|(joint, known)| limits(known, joint.limits, &joint.name));
    let limits = limits.collect::<Result<Vec<_>>>()?;
    let ranges: Vec<[f64; 2]> = limits.iter().map(|limits| limits.position).collect();
    let around = &file.surroundings;
    let room = Room::of(&robot, &chain, &ranges, around, seed)?;
    clearance::require_shapes(&room, around)?;
    let base = Base::of(&chain);
    let planned = Excitation::of(&chain, &base, &limits, &room, seed)?;
    let mut trajectory = String::from("time_s");
    for joint in &chain.joints {
        let (name, unit) = (&joint.name, if joint.is_prismatic { "m" } else { "rad" });
        // Writing to a string cannot fail.
        let _ = write!(trajectory, ",{name}_position_{unit},{name}_velocity_{unit}_s,{name}_acceleration_{unit}_s2");
    }
    trajectory.push('\n');
    for row in 0..(planned.period_s * RATE_HZ) as usize {
        let time = row as f64 / RATE_HZ;
        let _ = write!(trajectory, "{time:.2}");
        for [position, velocity, acceleration] in planned.at(time) {
            let _ = write!(trajectory, ",{position:.9},{velocity:.6},{acceleration:.6}");
        }
        trajectory.push('\n');
    }
    let told = if planned.condition.is_finite() {
        format!(
            "tells all {} base parameters and the friction of each joint apart, condition number {}",
            base.len(),
            digits(planned.condition)
        )
    } else {
        format!(
            "leaves some base parameters untold: {} too narrow",
            if room.is_open() { "the limits are" } else { "limits or surroundings are" }
        )
    };
    let nearest: Vec<Nearest> = [true, false].into_iter().filter_map(|of| planned.nearest(&room, of)).collect();
    let text = format!(
        "A motion of {} s, to be repeated, {told}. {} Run it slowly in simulation first.\n",
        digits(planned.period_s),
        clearance::text(&room, around, &nearest)
    );
    Ok(Advised { trajectory, text, condition: planned.condition, nearest })
}

fn limits(known: &Joint, of_file: Option<[f64; 2]>, name: &str) -> Result<Limits> {
    let missing = |what: &str| {
        let message =
            format!("planning a motion needs `{what}` under [limits] of arm.toml, or under [joints.{name}.limits]");
        Error::new(&codes::MISSING_PARAMETER, message).with_value(name)
    };
    let of = &known.limits;
    let low = of.lowest_position_rad.or(of_file.map(|[low, _]| low));
    let high = of.highest_position_rad.or(of_file.map(|[_, high]| high));
    Ok(Limits {
        position: [
            low.ok_or_else(|| missing("lowest_position_rad"))?,
            high.ok_or_else(|| missing("highest_position_rad"))?,
        ],
        velocity: of.velocity_rad_s.ok_or_else(|| missing("velocity_rad_s"))?,
        acceleration: of.acceleration_rad_s2.ok_or_else(|| missing("acceleration_rad_s2"))?,
    })
}
