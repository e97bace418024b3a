//! Static laws: inputs in, friction out, without memory and without limits.

#[cfg(feature = "models")]
pub mod evaluate;
#[cfg(feature = "models")]
pub mod expression;
#[cfg(any(feature = "models", feature = "integer"))]
pub mod integer_table;
#[cfg(feature = "models")]
pub mod network;
pub mod table;
