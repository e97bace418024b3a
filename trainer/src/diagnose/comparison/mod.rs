//! What a recording is compared with: a static model of itself, a fitted image or the law of a simulation. Knows no candidate's evidence.

pub(crate) mod base;
pub(crate) mod columns;
pub(crate) mod delay;
pub mod from_model;
pub(crate) mod reference;
pub mod simulation;
pub(crate) mod soft_sign;
pub(crate) mod turn_over;
