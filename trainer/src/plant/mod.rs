//! The simulator of a joint: continuous-time truth under a sampled drive, with effects to hide in it.
//!
//! Users rehearse with it; the proof on concealed data draws its recordings from it. It knows neither `physics` nor
//! `diagnose`, and they do not know it: a proof in which both sides share equations would prove nothing.
//!
//! A recording is made in one direction: a [`Campaign`] of motions becomes a reference, the drive (`control`) turns it
//! into torque held over each sample, the joint (`bench`, `friction`, `transmission`, `effects`) moves in continuous time, and the
//! sensors (`noise`, `sensors`) write down what a drive would have seen.

mod bench;
mod campaign;
mod channels;
mod concealed;
mod control;
mod description;
pub mod effects;
mod friction;
mod joint;
mod motion;
mod moves;
mod noise;
mod random;
mod recording;
mod sensors;
mod simulate;
mod transmission;

pub use campaign::{Campaign, Trajectory};
pub use effects::{CATALOGUE, Entry, OUTSIDE, find};
pub use joint::{Base, Control, Drive, Friction, Hidden, Joint, LoadChannel, Noise, NoiseKind, OtherJoint, Thermal};
pub use motion::{Motion, Reference};
pub use recording::{Column, SimulatedRecording, Truth};
pub use simulate::{PlantError, conceal, simulate};
