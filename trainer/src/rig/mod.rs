//! The drive in closed loop with a joint: what a compensator is for, tried before it meets a machine.
//!
//! The joint moves in `f64` as the simulator moves it, the drive is the firmware's code in `f32`, on the host or on an emulated
//! microcontroller, and both exchange counts and torques in lockstep, the torque one sample late. An actuator that reports no torque is told of
//! it in its own form. Knows no command line and no files.

mod course;
mod drive;
mod fed;
mod lockstep;
mod motion;
mod nominal;
mod scores;
mod settings;

pub use course::Course;
pub use drive::{Answer, DriveUnderTest, host_drive};
pub use fed::usual_form;
pub use lockstep::{Bench, run};
pub use motion::Motion;
pub use nominal::nominal_model;
pub use scores::{Fed, Row, Scores, trace_bytes};
pub use settings::{adaptation_settings, drive_settings, with_contact};
