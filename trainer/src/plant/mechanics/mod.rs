//! The parts of a drive and its joint: transmission, controller, housing, neighbouring joint. Knows no campaign, no
//! concealed effect and no sensor.

pub mod channels;
pub mod contact;
pub mod control;
pub mod servo;
pub mod transmission;
