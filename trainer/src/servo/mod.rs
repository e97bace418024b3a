//! Joints that report no torque: the constants of their actuators, identified together with rigid body and friction, and the law that makes
//! the simulated joint move as the recorded one did. Knows no command line and no files.
//!
//! `torque_space` finds the constants in one step, `known_torque` turns a recording of commands into one of a torque, which is fitted as any
//! other, `by_trajectory` moves what was found until the simulation comes closest, and [`fit_servo`] is all of it.

mod adopt;
mod as_torque;
mod by_trajectory;
mod candidate;
mod commanded;
mod friction;
#[cfg(test)]
mod hanging_leg;
mod identified;
mod intervals;
mod known_torque;
mod moved;
mod run;
mod shooting;
#[cfg(test)]
mod tests;
mod torque_space;

pub(crate) use as_torque::AsTorque;
pub use friction::FLANK_SHARE;
pub use identified::Identified;
pub(crate) use known_torque::{Load, known_torque};
pub use run::{ServoFit, Simulated, fit_servo};
pub(crate) use torque_space::{as_given, identify, identify_or_start};
