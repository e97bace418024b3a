//! From signals to states and working rows behind one filter for all channels. Knows no base model and no candidate.

pub(crate) mod commanded_noise;
pub(crate) mod cut_off;
pub(crate) mod gravity;
pub(crate) mod position_error;
pub(crate) mod rows;
pub(crate) mod sampling_jitter;
pub(crate) mod searched;
pub(crate) mod states;
pub(crate) mod two_encoders;
