//! Which file defines the name that a path means: imports, globs and re-exports are followed within one crate.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::path::PathBuf;

use super::source::Module;

/// What a path means.
#[derive(Clone, PartialEq)]
enum Target {
    /// A module, by its number.
    Module(usize),
    /// An item of a module, by the module's number and the item's name.
    Item(usize, String),
    /// Something of another crate, by its path.
    Outside(Vec<String>),
}

/// What the files of a crate import.
#[derive(Default)]
pub struct Imports {
    /// Importing file, defining file, names that tie them.
    pub files: BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>,
    /// Importing file and path in another crate.
    pub outside: BTreeSet<(PathBuf, String)>,
}

/// Imports of a crate. A private `use` counts, and so does every path in code; a re-export and a module declaration
/// do not, for the file does nothing with them itself.
pub fn imports(modules: &[Module]) -> Imports {
    let names = Names { modules, numbers: modules.iter().enumerate().map(|(n, m)| (&m.path[..], n)).collect() };
    let mut found = Imports::default();
    for (number, module) in modules.iter().enumerate() {
        let used = module.imports.iter().filter(|import| !import.re_export).map(|import| &import.path);
        for path in module.mentions.iter().chain(used) {
            for target in names.resolve(number, path, &mut HashSet::new()) {
                match target {
                    Target::Item(of, name) if modules[of].file != module.file => {
                        let files = (module.file.clone(), modules[of].file.clone());
                        found.files.entry(files).or_default().insert(name);
                    }
                    Target::Outside(path) => {
                        found.outside.insert((module.file.clone(), path.join("::")));
                    }
                    Target::Item(..) | Target::Module(_) => {}
                }
            }
        }
    }
    found
}

struct Names<'a> {
    modules: &'a [Module],
    numbers: HashMap<&'a [String], usize>,
}

/// Names under way, by module: a second visit sees only what the module itself declares.
type UnderWay = HashSet<(usize, String)>;

impl Names<'_> {
    /// What a path means in a module. Items only in the last place mean themselves; before it they hold the rest (a variant,
    /// an associated function), unless a module of the same name does.
    fn resolve(&self, module: usize, path: &[String], under_way: &mut UnderWay) -> Vec<Target> {
        let Some((first, mut rest)) = path.split_first() else { return Vec::new() };
        let mut targets = match first.as_str() {
            "crate" => vec![Target::Module(self.numbers[&[][..]])],
            "self" => vec![Target::Module(module)],
            "super" => vec![Target::Module(self.parent(module))],
            _ => self.look_up(module, first, under_way),
        };
        if targets.is_empty() {
            return vec![Target::Outside(path.to_vec())];
        }
        while let Some((next, after)) = rest.split_first() {
            let mut deeper = Vec::new();
            for target in &targets {
                match target {
                    Target::Module(at) if next == "super" => deeper.push(Target::Module(self.parent(*at))),
                    Target::Module(at) => deeper.extend(self.look_up(*at, next, under_way)),
                    Target::Outside(start) => deeper.push(Target::Outside([start, rest].concat())),
                    Target::Item(..) => {}
                }
            }
            if deeper.is_empty() || matches!(deeper[0], Target::Outside(_)) {
                targets.retain(|target| matches!(target, Target::Item(..)));
                targets.extend(deeper);
                return targets;
            }
            (targets, rest) = (deeper, after);
        }
        targets
    }

    fn look_up(&self, module: usize, name: &str, under_way: &mut UnderWay) -> Vec<Target> {
        let of = &self.modules[module];
        let child = [&of.path[..], &[name.to_owned()]].concat();
        let mut targets: Vec<Target> = self.numbers.get(&child[..]).map(|&n| Target::Module(n)).into_iter().collect();
        targets.extend(of.items.contains(name).then(|| Target::Item(module, name.to_owned())));
        if !under_way.insert((module, name.to_owned())) {
            return targets;
        }
        for import in of.imports.iter().filter(|import| import.name.as_deref() == Some(name)) {
            targets.extend(self.resolve(module, &import.path, under_way));
        }
        if targets.is_empty() {
            for glob in of.imports.iter().filter(|import| import.name.is_none()) {
                for target in self.resolve(module, &glob.path, under_way) {
                    if let Target::Module(at) = target {
                        targets.extend(self.look_up(at, name, under_way));
                    }
                }
            }
        }
        under_way.remove(&(module, name.to_owned()));
        targets
    }

    fn parent(&self, module: usize) -> usize {
        let path = &self.modules[module].path;
        self.numbers[&path[..path.len().saturating_sub(1)]]
    }
}
