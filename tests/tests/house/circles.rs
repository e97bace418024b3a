//! Import circles: between files, and between the modules side by side in one module, each with all that lies beneath it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

use super::crates::Crate;
use super::exempt::Violation;

/// Who imports whom, and by which names.
type Ties = BTreeMap<(String, String), BTreeSet<String>>;

/// Circles of files.
pub fn of_files(of: &Crate) -> Vec<Violation> {
    let name = |file: &Path| file.display().to_string();
    let files = of.imports.files.iter();
    circles(&files.map(|((from, to), names)| ((name(from), name(to)), names.clone())).collect())
}

/// Circles of modules that share their parent, in which one imports the other through any of the files beneath.
pub fn of_rooms(of: &Crate) -> Vec<Violation> {
    let mut outermost: BTreeMap<&PathBuf, &[String]> = BTreeMap::new();
    for module in &of.modules {
        let path = outermost.entry(&module.file).or_insert(&module.path);
        if module.path.len() < path.len() {
            *path = &module.path;
        }
    }
    let root = of.modules.iter().find(|module| module.path.is_empty()).expect("a crate has a root");
    let source = root.file.parent().expect("a root lies in a folder");
    let mut ties = Ties::new();
    for ((from, to), names) in &of.imports.files {
        let (from, to) = (outermost[from], outermost[to]);
        let shared = from.iter().zip(to).take_while(|(a, b)| a == b).count();
        if from.len() > shared && to.len() > shared {
            let room = |path: &[String]| source.join(path[..=shared].join("/")).display().to_string();
            ties.entry((room(from), room(to))).or_default().extend(names.iter().cloned());
        }
    }
    circles(&ties)
}

fn circles(ties: &Ties) -> Vec<Violation> {
    let graph: DiGraphMap<&str, ()> = ties.keys().map(|(from, to)| (from.as_str(), to.as_str())).collect();
    let components = tarjan_scc(&graph).into_iter().filter(|component| component.len() > 1);
    let describe = |members: Vec<&str>| {
        let inside = ties.iter().filter(|((from, to), _)| members.contains(&&**from) && members.contains(&&**to));
        let lines = inside.map(|((from, to), names)| {
            format!(
                "    {from} imports from {to}: {}\n",
                names.iter().map(String::as_str).collect::<Vec<_>>().join(", ")
            )
        });
        Violation { text: lines.collect(), places: members.into_iter().map(str::to_owned).collect() }
    };
    components.map(describe).collect()
}
