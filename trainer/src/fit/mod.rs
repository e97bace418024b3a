//! The whole way from recordings to an image: samples, separation, inputs, network, law, choice, model. Prints nothing.

pub mod outcome;
