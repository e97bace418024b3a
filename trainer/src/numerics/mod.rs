//! Numerics that every room uses: least squares over runs of rows, covariances, statistics, random draws. Knows no physics.

pub(crate) mod covariance;
pub(crate) mod derivatives;
pub(crate) mod least_squares;
pub(crate) mod pattern_search;
pub(crate) mod products;
pub(crate) mod random;
pub(crate) mod statistics;
