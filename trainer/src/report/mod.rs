//! Pages to read in a browser: one HTML file each, nothing loaded from anywhere, charts drawn by a script within, the same bytes for
//! the same result. Knows results, not how they came about.

mod closed_loop;
mod diagnosis;
mod fit;
mod fleet;
mod graph;
mod ink;
mod page;
pub mod picture;
pub mod tell;

pub use closed_loop::closed_loop;
pub use diagnosis::{DiagnosisPage, diagnosis};
pub use fit::fit;
pub use fleet::fleet;
pub use page::Origin;
