//! Signs of position and torque: lost, read as a digit, turned for a while, wrong all along; and a motion that has one only.

pub(super) mod lost;
pub(super) mod one_way;
pub(super) mod read_as_digit;
pub(super) mod turned;
pub(super) mod wrong;
