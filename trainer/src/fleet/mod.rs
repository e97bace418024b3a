//! Many joints of one construction: what they have in common, and which of them differ from their siblings. Knows neither files nor
//! command line.
//!
//! [`survey()`] takes what was measured of every joint ([`Measured`]) and finds for each kind of joint the law that describes all of them,
//! what its joints have in common of every quantity ([`Siblings`]), the joints that differ at a stated share of false alarms, and
//! how their friction changes with the date ([`Trend`]).

mod common_law;
mod discoveries;
mod level;
mod measured;
mod ripple;
mod siblings;
mod survey;
#[cfg(test)]
mod tests;
mod trend;

pub use level::Levels;
pub use measured::{FittedLaw, Measured};
pub use ripple::{Ripple, Rows, ripple};
pub use siblings::{Departure, Estimate, Siblings};
pub use survey::{Comparison, Kind, Member, Quantity, Survey, survey};
pub use trend::{Dated, Trend};
