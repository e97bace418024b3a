//! The modules of a crate as its source declares them: items, imports and the paths that code mentions. Items under
//! `#[cfg(test)]` are left out.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItemFn, Item, ItemMod, ItemUse, Macro, Meta, Token, UseTree, VisRestricted, Visibility};

/// One leaf of a `use` declaration.
pub struct Import {
    /// Segments from the left, keywords (`crate`, `self`, `super`) included.
    pub path: Vec<String>,
    /// Name in the importing module; none for a glob.
    pub name: Option<String>,
    /// Whether the name is passed on to other modules.
    pub re_export: bool,
}

/// A module, whether in a file of its own or inline.
pub struct Module {
    /// Segments below the root of the crate.
    pub path: Vec<String>,
    /// File that holds it.
    pub file: PathBuf,
    /// Names that it defines.
    pub items: BTreeSet<String>,
    pub imports: Vec<Import>,
    /// Paths in its code, outside of `use` declarations.
    pub mentions: BTreeSet<Vec<String>>,
}

/// All modules below a crate root such as `src/lib.rs`.
///
/// # Panics
/// Where a file cannot be read or parsed, or a declared module has no file.
pub fn modules(root: &Path) -> Vec<Module> {
    let mut found = Vec::new();
    read(root, Vec::new(), root.parent().expect("a root lies in a folder"), &mut found);
    found
}

fn read(file: &Path, path: Vec<String>, children: &Path, found: &mut Vec<Module>) {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let syntax = syn::parse_file(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    collect(&syntax.items, Place { file, path, children }, found);
}

/// Where a module stands: its file, its path, and the folder in which the files of its children are looked for.
struct Place<'a> {
    file: &'a Path,
    path: Vec<String>,
    children: &'a Path,
}

fn collect(items: &[Item], place: Place, found: &mut Vec<Module>) {
    let mut reader = Reader::default();
    items.iter().for_each(|item| reader.visit_item(item));
    for child in &reader.children {
        let name = child.ident.to_string();
        let mut path = place.path.clone();
        path.push(name.clone());
        let folder = place.children.join(&name);
        match &child.content {
            Some((_, items)) => collect(items, Place { file: place.file, path, children: &folder }, found),
            None => {
                let candidates = [place.children.join(format!("{name}.rs")), folder.join("mod.rs")];
                let file = candidates.iter().find(|f| f.is_file());
                read(file.unwrap_or_else(|| panic!("no file of module {path:?}")), path, &folder, found);
            }
        }
    }
    let Reader { items, imports, mentions, .. } = reader;
    found.push(Module { path: place.path, file: place.file.to_owned(), items, imports, mentions });
}

#[derive(Default)]
struct Reader<'ast> {
    items: BTreeSet<String>,
    imports: Vec<Import>,
    mentions: BTreeSet<Vec<String>>,
    children: Vec<&'ast ItemMod>,
}

impl<'ast> Visit<'ast> for Reader<'ast> {
    fn visit_item(&mut self, item: &'ast Item) {
        let (attributes, name) = attributes_and_name(item);
        if is_test(attributes) {
            return;
        }
        match item {
            Item::Mod(module) => self.children.push(module),
            Item::Use(declaration) => self.read_use(declaration),
            _ => {
                self.items.extend(name);
                visit::visit_item(self, item);
            }
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        if !is_test(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.leading_colon.is_none() {
            self.mentions.insert(path.segments.iter().map(|s| s.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        visit::visit_macro(self, call);
        self.read_tokens(call.tokens.clone());
    }

    /// `pub(super)` is no use of the parent.
    fn visit_vis_restricted(&mut self, _: &'ast VisRestricted) {}
}

impl Reader<'_> {
    fn read_use(&mut self, declaration: &ItemUse) {
        let re_export = !matches!(declaration.vis, Visibility::Inherited);
        if declaration.leading_colon.is_none() {
            self.read_tree(&declaration.tree, Vec::new(), re_export);
        }
    }

    fn read_tree(&mut self, tree: &UseTree, mut path: Vec<String>, re_export: bool) {
        match tree {
            UseTree::Path(step) => {
                path.push(step.ident.to_string());
                self.read_tree(&step.tree, path, re_export);
            }
            UseTree::Group(group) => group.items.iter().for_each(|t| self.read_tree(t, path.clone(), re_export)),
            UseTree::Glob(_) => self.imports.push(Import { path, name: None, re_export }),
            UseTree::Name(leaf) => self.read_leaf(leaf.ident.to_string(), None, path, re_export),
            UseTree::Rename(leaf) => {
                self.read_leaf(leaf.ident.to_string(), Some(leaf.rename.to_string()), path, re_export);
            }
        }
    }

    fn read_leaf(&mut self, leaf: String, rename: Option<String>, mut path: Vec<String>, re_export: bool) {
        // `use a::{self}` names `a` itself.
        if leaf != "self" || path.is_empty() {
            path.push(leaf);
        }
        let name = rename.or_else(|| path.last().cloned());
        self.imports.push(Import { path, name, re_export });
    }

    /// Paths in the arguments of a macro: runs of identifiers joined by `::`. What follows a dot is a field or a method.
    fn read_tokens(&mut self, tokens: TokenStream) {
        let mut run: Vec<String> = Vec::new();
        let (mut colons, mut dot) = (0, false);
        for token in tokens {
            match token {
                TokenTree::Ident(name) => {
                    if colons != 2 || run.is_empty() {
                        self.mentions.extend((!run.is_empty()).then(|| std::mem::take(&mut run)));
                    }
                    if !dot {
                        run.push(name.to_string());
                    }
                    (colons, dot) = (0, false);
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                other => {
                    self.mentions.extend((!run.is_empty()).then(|| std::mem::take(&mut run)));
                    (colons, dot) = (0, matches!(&other, TokenTree::Punct(mark) if mark.as_char() == '.'));
                    if let TokenTree::Group(group) = other {
                        self.read_tokens(group.stream());
                    }
                }
            }
        }
        self.mentions.extend((!run.is_empty()).then_some(run));
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.parse_args::<Meta>().is_ok_and(|condition| holds_in_tests_alone(&condition))
    })
}

/// Whether a condition is `test`, or `all(...)` with `test` among its parts.
fn holds_in_tests_alone(condition: &Meta) -> bool {
    match condition {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("all") => list
            .parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)
            .is_ok_and(|parts| parts.iter().any(holds_in_tests_alone)),
        _ => false,
    }
}

fn attributes_and_name(item: &Item) -> (&[Attribute], Option<String>) {
    match item {
        Item::Const(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Enum(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Fn(i) => (&i.attrs, Some(i.sig.ident.to_string())),
        Item::Macro(i) => (&i.attrs, i.ident.as_ref().map(ToString::to_string)),
        Item::Static(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Struct(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Trait(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Type(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Union(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Impl(i) => (&i.attrs, None),
        Item::Mod(i) => (&i.attrs, None),
        Item::Use(i) => (&i.attrs, None),
        Item::ExternCrate(i) => (&i.attrs, None),
        Item::ForeignMod(i) => (&i.attrs, None),
        _ => (&[], None),
    }
}
