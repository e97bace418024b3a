//! How far an arm keeps from what is around it and from itself: solids of its links and boxes of its surroundings, and the distances of these along
//! a motion. Distances are those of the library parry (Gilbert, Johnson & Keerthi 1988, for what has no closed form).

mod links;
mod path;
mod room;
mod solid;

pub use links::Looked;
pub use path::{Nearest, Path};
pub use room::Room;
