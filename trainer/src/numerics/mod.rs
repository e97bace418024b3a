//! Numerics that every room uses: filters, least squares over runs of rows, covariances, statistics, random draws. Knows no physics.

pub mod averages;
pub(crate) mod between_samples;
pub(crate) mod covariance;
pub(crate) mod derivatives;
pub(crate) mod dry_friction;
pub mod filter;
pub(crate) mod hat_functions;
pub(crate) mod jackknife;
pub(crate) mod least_squares;
pub(crate) mod pattern_search;
pub(crate) mod products;
pub(crate) mod random;
pub mod regression;
pub(crate) mod resolution;
pub(crate) mod statistics;

/// What a simulation computes with: plain numbers, or dual numbers that carry the derivative by one parameter along (forward accumulation, Griewank &
/// Walther 2008). Dual numbers compare by their values and take the same branches.
pub trait Number: num_dual::DualNum<Primitive = f64> + Copy {}

impl<T: num_dual::DualNum<Primitive = f64> + Copy> Number for T {}
