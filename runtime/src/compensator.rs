//! What the control loop calls: a measurement in, a torque out, within limits that the firmware sets and no image can change.

#[cfg(feature = "models")]
mod decoded;
mod exported;
mod limited;
mod limits;

#[cfg(feature = "models")]
pub use decoded::{Compensator, Decoded};
pub use exported::Exported;
pub use limited::{Compensate, FrictionModel, Limited};
pub use limits::{Compensation, LARGEST_TORQUE, LimitError, Limits, Status};

#[cfg(all(test, feature = "models"))]
mod faults;
#[cfg(all(test, feature = "models"))]
mod tests;
