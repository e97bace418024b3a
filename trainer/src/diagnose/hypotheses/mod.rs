//! Every candidate as regressors: the effects of the catalogue, and structures without a name. Knows neither noise nor evidence.

pub(crate) mod channel;
pub(crate) mod design;
pub(crate) mod fitted;
pub(crate) mod function_form;
pub(crate) mod label;
pub(crate) mod refine;
pub(crate) mod unnamed;
