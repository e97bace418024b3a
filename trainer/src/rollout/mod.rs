//! Forward simulation of a joint under what a recording commanded: actuator, rigid body and friction law. Knows no command line, no
//! files, and nothing of the simulator that makes recordings.
//!
//! [`Series`] is what the actuator was told, [`Body`] what it moves, a [`Resistance`] the friction; [`simulate`] moves the joint through
//! a recording, begun anew from the recorded state as often as is asked for, and [`Score`] says how far it came off.

mod body;
mod image;
mod of_image;
mod resistance;
mod score;
mod series;
mod simulate;

pub use body::{Body, FREE_FALL_M_S2, payload};
pub use image::{ImageFriction, law};
pub use of_image::{Rollout, default_window_s, of_image, score_of_image};
pub use resistance::{Instant, Levels, Resistance, Split};
pub use score::Score;
pub use series::Series;
pub use simulate::{Rig, State, recorded, simulate, starts};
