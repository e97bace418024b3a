//! Symbolic laws: known forms, function library, search, simplification, names, rendering. Knows no files.
//!
//! A law is looked for in samples alone: [`discover()`] searches the structures that [`structure`] can say, fits each with
//! all its constants at once ([`mod@fit`]), prices it ([`price`]) and names what it finds ([`naming`]).

pub mod canonical;
pub mod choice;
pub mod data;
pub mod discover;
pub mod expression;
pub mod fit;
pub mod known_forms;
pub mod library;
pub mod matching;
pub mod naming;
pub mod price;
pub mod program;
pub mod projection;
pub mod proposals;
pub mod ranges;
pub mod render;
mod rounding;
pub mod search;
mod settle;
pub mod structure;
pub mod tape;
pub mod uncertainty;

pub use choice::FrontEntry;
pub use data::{Channel, ChannelRole, LawData, LawError, Nuisance};
pub use discover::{Discovery, Law, NuisanceCoefficient, Parameter, SearchOptions, discover};
pub use expression::{Expr, Step, Unary};
pub use known_forms::{FormFit, KnownForm, fit_form, rank_forms};
pub use proposals::Start;
pub use render::{Language, render};
