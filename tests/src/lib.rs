//! What the cross-crate tests share.

pub mod arm;
pub mod c;
pub mod closed_loop;
pub mod command;
pub mod concealed;
pub mod cost;
pub mod coverage;
pub mod fixtures;
pub mod inertia;
pub mod laws;
pub mod models;
pub mod pages;
pub mod paper;
pub mod published;
pub mod second_opinion;
pub mod servo_draws;
pub mod table;
pub mod training_cost;
pub mod vectors;

/// Whether `FRIKAN_EXHAUSTIVE=1` asks for every draw, input or row instead of a few.
#[must_use]
pub fn exhaustive() -> bool {
    std::env::var("FRIKAN_EXHAUSTIVE").is_ok_and(|value| value == "1")
}

/// The folder of other people's recordings, whether it is there or not.
#[must_use]
pub fn recordings_folder() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/recordings")
}

/// The folder of other people's recordings; `None`, said aloud, where it is absent.
///
/// # Panics
/// Where it is absent in CI.
#[must_use]
pub fn recordings() -> Option<std::path::PathBuf> {
    let folder = recordings_folder();
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var_os("CI").is_none(), "{} is absent", folder.display());
    eprintln!("skipped: {} is absent", folder.display());
    None
}
