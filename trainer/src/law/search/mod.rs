//! The way to a law: which structures are tried, from where, and in which order. Knows what the judge says, not how it is worked
//! out.

pub mod beam;
pub mod discover;
pub mod known_forms;
pub mod library;
pub mod matching;
pub mod proposals;
