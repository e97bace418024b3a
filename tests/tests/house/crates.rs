//! The crates of the repository: their roots, modules and imports, files named from the top of the repository.

use std::path::{Path, PathBuf};

use super::names::{Imports, imports};
use super::source::{Module, modules};

/// Folders that hold a crate. `tests/firmware` and `tests/fuzz` are workspaces of their own.
const CRATES: [&str; 6] = ["shared", "runtime", "runtime/c", "trainer", "trainer/python", "tests"];

/// A crate from one of its roots.
pub struct Crate {
    pub modules: Vec<Module>,
    pub imports: Imports,
}

/// Every library and program of the workspace.
pub fn crates() -> Vec<Crate> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the repository");
    let roots = CRATES.iter().flat_map(|folder| roots(&top.join(folder).join("src")));
    roots.map(|root| read(&root, top)).collect()
}

/// A crate from its root, files named from `top`.
pub fn read(root: &Path, top: &Path) -> Crate {
    let mut modules = modules(root);
    for module in &mut modules {
        module.file = module.file.strip_prefix(top).expect("a module lies in the repository").to_owned();
    }
    Crate { imports: imports(&modules), modules }
}

fn roots(source: &Path) -> Vec<PathBuf> {
    let mut roots: Vec<PathBuf> = ["lib.rs", "main.rs"].map(|name| source.join(name)).into();
    if let Ok(programs) = std::fs::read_dir(source.join("bin")) {
        roots.extend(programs.map(|entry| entry.expect("the folder can be listed").path()));
    }
    roots.retain(|root| root.is_file());
    roots.sort();
    roots
}
