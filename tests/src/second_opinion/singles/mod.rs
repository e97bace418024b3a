//! One effect hidden in the recording of a joint whose motion is prescribed, or none.

mod bench;
mod body;
mod cases;
mod catalogue;
mod controls;
mod coupling;
mod load;
mod mechanical;
mod memory;
mod position;
mod setup;
mod state;
mod velocity;

pub use bench::Bench;
pub use cases::cases;
pub use catalogue::Effect;
pub use controls::controls;
pub use memory::dahl;
pub use setup::{Decoy, RigidBody, Setup, VelocityColumn};
