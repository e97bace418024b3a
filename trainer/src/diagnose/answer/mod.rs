//! What a diagnosis says, as typed values. Makes no sentence.

pub(crate) mod detection_limit;
pub(crate) mod finding;
pub(crate) mod formula;
pub(crate) mod friction_level;
pub(crate) mod goodness_of_fit;
pub(crate) mod location;
pub(crate) mod nearest_named;
pub(crate) mod outcome;
pub(crate) mod region;
pub(crate) mod sealed;
pub(crate) mod stated_probability;
pub(crate) mod traces;
