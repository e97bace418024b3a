//! The drive in closed loop with a joint: what a compensator is for, tried before it meets a machine.
//!
//! The joint moves in `f64`, the drive is the firmware's code in `f32`, and both exchange counts and torques in lockstep, the torque one
//! sample late. Knows no command line and no files.

mod joint;
mod lockstep;
mod motion;
mod nominal;
mod scores;
mod settings;

pub use joint::{JointState, LuGreJoint};
pub use lockstep::{Bench, drive_of, run};
pub use motion::Motion;
pub use nominal::nominal_model;
pub use scores::{Row, Scores, trace_bytes};
pub use settings::{joint_of, limits_of, settings_of, supervision_of};
