//! One joint's signals on an even clock, from one recording or several. Knows no filter, no model and no effect.

pub(crate) mod join;
pub(crate) mod other_joints;
pub(crate) mod signals;
