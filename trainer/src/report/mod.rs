//! Pages to read in a browser: one HTML file each, nothing loaded from anywhere, pictures as inline SVG, the same bytes for the
//! same result. Knows results, not how they came about.

mod axis;
mod chart;
mod closed_loop;
mod diagnosis;
mod finding;
mod fit;
mod fleet;
mod graph;
mod heat_map;
mod on_the_drive;
mod page;
pub mod picture;
pub mod tell;

pub use closed_loop::closed_loop;
pub use diagnosis::{DiagnosisPage, diagnosis};
pub use fit::fit;
pub use fleet::fleet;
