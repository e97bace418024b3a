//! The check itself: which imports it sees, and that it fails where it has to.

use std::path::Path;

use super::circles::{of_files, of_rooms};
use super::crates::{Crate, read};
use super::exempt::{Violation, none_but};
use super::wrong_directions;

/// A crate of the given files below `src`.
fn crate_of(files: &[(&str, &str)]) -> Crate {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let file = folder.path().join("src").join(name);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, text).unwrap();
    }
    read(&folder.path().join("src/lib.rs"), folder.path())
}

/// The imports of `src/user.rs` beside a room with a re-exported function, as `defining file: names`.
fn seen(user: &str) -> Vec<String> {
    let of = crate_of(&[
        ("lib.rs", "pub mod room; pub mod user; pub mod other;"),
        ("room/mod.rs", "mod inner; pub use inner::work; pub use inner::Kind as Sort; pub fn own() {}"),
        ("room/inner.rs", "pub fn work() {} pub fn hidden() {} pub enum Kind { First }"),
        ("other.rs", "pub fn other() {}"),
        ("user.rs", user),
    ]);
    let from_user = of.imports.files.iter().filter(|((from, _), _)| from == Path::new("src/user.rs"));
    from_user
        .map(|((_, to), names)| format!("{}: {}", to.display(), names.iter().cloned().collect::<Vec<_>>().join(" ")))
        .collect()
}

#[test]
fn imports_lead_to_the_file_that_defines_the_name() {
    let inner = ["src/room/inner.rs: work"];
    assert_eq!(seen("use crate::room::work;"), inner);
    assert_eq!(seen("use super::room::work as labour;"), inner);
    assert_eq!(seen("fn f() { crate::room::work() }"), inner);
    assert_eq!(seen("use crate::room; fn f() { room::work() }"), inner);
    assert_eq!(seen("use crate::room::*; fn f() { work() }"), inner);
    assert_eq!(seen("fn f() { println!(\"{}\", crate::room::work()) }"), inner);
    assert_eq!(seen("fn f() { self::g::h() } mod g { use crate::room; pub fn h() { room::work() } }"), inner);
    assert_eq!(seen("use crate::room::Sort; fn f() { Sort::First; }"), ["src/room/inner.rs: Kind"]);
    assert_eq!(seen("struct S { field: Option<crate::room::Sort> }"), ["src/room/inner.rs: Kind"]);
    assert_eq!(
        seen("use crate::{other::{self, other as o}, room::{own, work}};"),
        ["src/other.rs: other", "src/room/inner.rs: work", "src/room/mod.rs: own"]
    );
}

#[test]
fn declarations_re_exports_and_tests_are_no_imports() {
    assert!(seen("use crate::room; use crate::room::*;").is_empty());
    assert!(seen("pub use crate::room::work;").is_empty());
    assert!(seen("pub(super) fn f(work: u8) -> u8 { work }").is_empty());
    assert!(seen("#[cfg(test)] mod tests { use crate::room::work; }").is_empty());
    assert!(seen("#[cfg(test)] use crate::room::work;").is_empty());
    assert!(seen("#[cfg(all(test, feature = \"models\"))] mod tests { use crate::room::work; }").is_empty());
    assert!(seen("struct S; impl S { #[cfg(test)] fn f() { crate::room::work() } }").is_empty());
    assert_eq!(seen("pub use crate::room::work; fn f() { work() }"), ["src/room/inner.rs: work"]);
}

#[test]
fn paths_into_other_crates_are_found_through_imports() {
    let of = crate_of(&[("lib.rs", "use std::fs as files; fn f() { files::read(\"\"); }")]);
    assert!(of.imports.outside.iter().any(|(_, path)| path == "std::fs::read"));
}

#[test]
fn circles_are_found_between_files_and_between_rooms() {
    let circle = crate_of(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "pub fn a() { crate::b::b() }"),
        ("b.rs", "use crate::c::c; pub fn b() { c() }"),
        ("c.rs", "pub fn c() { crate::a::a() }"),
    ]);
    let [found] = &of_files(&circle)[..] else { panic!("one circle") };
    assert_eq!(found.places.len(), 3);
    assert!(found.text.contains("src/b.rs imports from src/c.rs: c"), "{}", found.text);

    let rooms = crate_of(&[
        ("lib.rs", "mod left; mod right;"),
        ("left/mod.rs", "pub mod lower; mod upper;"),
        ("left/lower.rs", "pub fn lower() {}"),
        ("left/upper.rs", "fn upper() { crate::right::right() }"),
        ("right.rs", "pub fn right() { crate::left::lower::lower() }"),
    ]);
    assert!(of_files(&rooms).is_empty());
    let [found] = &of_rooms(&rooms)[..] else { panic!("one circle") };
    assert_eq!(found.places.len(), 2);
}

#[test]
fn forbidden_imports_are_found_whether_of_files_or_of_other_crates() {
    let of = crate_of(&[
        ("lib.rs", "mod core; mod report; mod reporter;"),
        ("core/mod.rs", "mod a; mod b; use crate::reporter::told;"),
        ("core/a.rs", "use crate::report::page;"),
        ("core/b.rs", "use std::{fs, path::Path}; fn f(p: &Path) { fs::read(p); }"),
        ("report.rs", "pub fn page() { std::fs::read(\"\"); }"),
        ("reporter.rs", "pub fn told() {}"),
    ]);
    let found = wrong_directions(&of, &[("src/core", &["src/report", "std::fs"])]);
    let places: Vec<&str> = found.iter().map(|violation| violation.places[0].as_str()).collect();
    assert_eq!(
        places,
        ["src/core/a.rs", "src/core/b.rs", "src/core/b.rs"],
        "b imports std::fs and calls std::fs::read"
    );
}

fn violation() -> Violation {
    Violation { places: vec!["a/b.rs".into(), "a/c/d.rs".into()], text: "broken".into() }
}

#[test]
fn an_exempt_place_excuses_what_lies_in_it() {
    none_but(&["a"], &[violation()]);
    none_but(&[], &[]);
}

#[test]
#[should_panic(expected = "broken")]
fn a_violation_fails() {
    none_but(&["a/b"], &[violation()]);
}

#[test]
#[should_panic(expected = "take them off the list")]
fn an_exempt_place_that_keeps_the_rule_fails() {
    none_but(&["a", "e"], &[violation()]);
}
