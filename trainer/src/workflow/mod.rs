//! What the command line, the Python package and the tasks of a fleet call: recordings in, results out that tell themselves as text,
//! JSON, page and image. Reads recordings, writes nothing.

mod actuator;
pub mod arm;
pub mod check;
pub(crate) mod columns;
pub mod diagnose;
pub mod fit;
pub mod predict;
pub mod recordings;
pub mod rollout;
pub(crate) mod source;

pub use recordings::Warning;
pub use source::Source;
