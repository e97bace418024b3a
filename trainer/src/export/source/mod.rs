//! An image as source code without dependency, state and range hold included: C and Rust with the very bits of the runtime, Python in double
//! precision. One list of statements is written in the three languages; integer tables have a form in C.

pub mod c;
mod effects;
pub mod integers;
mod language;
mod law;
mod library;
mod lookup;
mod network;
mod program;
pub mod python;
pub mod rust;

use frikan_shared::model::Model;

pub(super) use self::law::{identifier, parameters};
use crate::fit::CELLS;

/// Whether an effect adds to the position of the link.
pub(super) fn moves_link(model: &Model<CELLS>) -> bool {
    model.effects.iter().any(effects::moves_link)
}
