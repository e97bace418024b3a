//! The supervised drive of a joint with LuGre friction.

mod encoders;
mod joint;
mod safety;
