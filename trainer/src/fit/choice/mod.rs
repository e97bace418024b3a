//! Which candidate goes into the image: errors on held-out blocks, what physics forbids, what the drive has room for.

pub(in crate::fit) mod choose;
pub(in crate::fit) mod physical;
pub(in crate::fit) mod rivals;
pub(in crate::fit) mod shipped;
pub(in crate::fit) mod turn;
