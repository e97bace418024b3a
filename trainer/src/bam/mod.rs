//! The parameter files of Rhoban's BAM, "Better Actuator Models" (Duclusaud et al. 2024): motor, armature and friction of a servo.
//!
//! [`Parameters`] are a file, read or to be written; [`image`] makes an image of their friction, [`recognised`] finds them again in one, and
//! [`joint_file`] says in joint.toml what they know of the servo. Knows no command line and no files.

mod image;
mod joint_file;
mod law;
mod parameters;
#[cfg(test)]
mod tests;
mod variant;

pub use image::{Surroundings, image};
pub use joint_file::joint_file;
pub use law::recognised;
pub use parameters::Parameters;
pub use variant::{LoadFriction, Variant};
