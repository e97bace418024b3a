//! From a network or a law to the model that a drive evaluates, with a certified error.
