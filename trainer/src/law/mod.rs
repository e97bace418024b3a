//! Symbolic laws of friction, found in samples alone: what a law is, how it is fitted, which one the data support. Knows no
//! files, no networks, no recordings.
//!
//! [`discover()`] searches the structures that `model` can say, fits each with all its constants at once, judges it by its
//! evidence and names what it finds. The rooms know each other in one direction: `model`, then `fitting` and `render`, then
//! `judge`, then `search`.

mod fitting;
mod judge;
mod model;
mod render;
mod search;

pub use judge::choice::FrontEntry;
pub use judge::description::{Law, NuisanceCoefficient, Parameter};
pub use judge::uncertainty::{Interval, Uncertainty};
pub use model::canonical::canonical;
pub use model::data::{Channel, ChannelRole, LawData, LawError, Nuisance, States};
pub use model::expression::{Expr, Step, Unary};
pub use model::program::expression_of;
pub use model::structure::{Layout, Modulation, Nonlinear, Shape, SignForm, Structure, Term};
pub use render::{Language, latex, render, significant};
pub use search::discover::{Discovery, SearchOptions, discover};
pub use search::known_forms::{
    FormFit, KnownForm, Remainder, fit_form, fit_structure, rank_forms, refit_structure, remainder, settle,
};
pub use search::matching::{Function, Match, matches};
pub use search::proposals::{Activation, Start, proposals};
