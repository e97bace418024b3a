//! What a law is learnt from: rows in motion with their rigid-body columns, the inputs that explain them, and which blocks are held
//! out in turn. Knows no law.

pub(in crate::fit) mod gather;
pub(in crate::fit) mod inputs;
pub(in crate::fit) mod rigid;
pub(in crate::fit) mod turns;
