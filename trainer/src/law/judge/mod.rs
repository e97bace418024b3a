//! What the data say of fitted laws: criterion, held-out error, uncertainty, digits, names. Knows no way to new structures.

pub mod choice;
pub mod criterion;
pub mod description;
pub mod rounding;
pub mod uncertainty;
pub mod undetermined;
