//! What a law is and what it is found from: structure, expression, names, samples, ranges of constants. Knows no fit and no
//! score.

pub mod admissible;
pub mod canonical;
pub mod data;
pub mod expression;
pub mod naming;
pub mod program;
pub mod ranges;
pub mod structure;
pub mod tape;
