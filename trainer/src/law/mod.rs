//! Symbolic laws: known forms, function library, search, simplification, names, rendering. Knows no files.

pub mod canonical;
pub mod data;
pub mod discover;
pub mod expression;
pub mod fit;
pub mod known_forms;
pub mod library;
pub mod naming;
pub mod price;
pub mod projection;
pub mod ranges;
pub mod search;
pub mod structure;
pub mod tape;
pub mod uncertainty;
