//! What an actuator makes of its command and of the motion: the torque on the joint, with its constants, the command that a torque takes, and
//! which constants a recording may leave open. Knows no command line, no files and no recordings.

mod applied;
mod commanded;
mod constants;
mod feed_forward;
mod kind;
mod open;
mod presets;

pub use applied::{Actuator, Applied, Command, Limits, Motion};
pub use commanded::{Commanded, RateLimited};
pub use constants::{Constant, Constants, Known};
pub use feed_forward::FeedForward;
pub use kind::Kind;
pub use open::{Open, Partial};
pub use presets::{PRESETS, Preset};
