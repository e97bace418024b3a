//! How strongly the rows ask for a candidate. Knows nothing of the order in which candidates are tried.

pub(crate) mod law_uncertainty;
pub(crate) mod measurement_noise;
pub(crate) mod overdispersion;
pub(crate) mod score;
pub(crate) mod strength;
pub(crate) mod workbench;
