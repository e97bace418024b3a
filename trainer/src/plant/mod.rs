//! The simulator of a joint: continuous-time truth under a sampled drive, with effects to conceal in it. Knows no diagnosis and no
//! hypothesis of one.
//!
//! Users rehearse with it; the proof on concealed data draws its recordings from it. Simulator and diagnosis are independent
//! code from the same literature: neither imports the other, so that a slip in one is not repeated in the other.
//!
//! A recording is made in one direction: a [`Campaign`] of motions becomes a reference (`trajectory`), the drive turns it into
//! torque held over each sample, the joint (`mechanics`, `effects`) moves in continuous time (`integrator`), and the sensors
//! (`measurement`) write down what a drive would have recorded.

mod concealed;
mod description;
pub mod effects;
mod error;
mod friction;
mod integrator;
mod joint;
mod measurement;
mod mechanics;
mod moving;
mod random;
mod simulate;
mod trajectory;

pub use effects::{CATALOGUE, Entry, OUTSIDE, find};
pub use error::{MOST_SAMPLES, PlantError};
pub use friction::Friction;
pub use joint::{Base, Control, Drive, Hidden, Joint, LoadChannel, Noise, NoiseKind, OtherJoint, Thermal};
pub use measurement::recording::{Column, SimulatedRecording, Truth};
pub(crate) use measurement::sensors::encoder_step;
pub(crate) use mechanics::servo::Servo;
pub(crate) use mechanics::transmission::Load;
pub(crate) use simulate::at_rest;
pub use simulate::{conceal, refuse_length, simulate, simulate_again};
pub use trajectory::campaign::{Campaign, Trajectory};
pub use trajectory::motion::Motion;
pub use trajectory::reference::Reference;
