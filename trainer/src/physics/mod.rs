//! The catalogue of effects: one file an effect, with its equation, regressors and states.
