//! Which of many candidate regressors a recording asks for beside a base: a linear mixed model with a likelihood.
//!
//! `y = B beta + sum_c W_c w_c + sum_k X_k(eta_k) gamma_k + e`, whitened: `beta` flat (restricted likelihood, Patterson and Thompson
//! 1971), `w_c` random effects that are always there, `gamma_k` of a few candidates with normal priors, `e` white. All that is needed
//! of the rows are the products of all columns: `products` -> `reduced` (base and random effects integrated out) ->
//! `evidence` of sets -> `sets` (beam) -> `posterior`, tempered by what `replay` and `temper` find. Knows no file, no effect by name and
//! no physics.

pub(crate) mod evidence;
pub(crate) mod posterior;
pub(crate) mod products;
pub(crate) mod reduced;
pub(crate) mod replay;
pub(crate) mod sets;
pub(crate) mod temper;
