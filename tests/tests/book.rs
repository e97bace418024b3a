//! The pages of `docs` as a book: every page is in its contents, every link leads to a file, and mdBook builds it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

/// Targets of the links of a page, without those to the web and within the page.
fn links(page: &str) -> Vec<String> {
    let targets = page.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    let files = targets.filter(|target| !target.contains("://") && !target.starts_with('#'));
    files.map(|target| target.split('#').next().unwrap_or_default().to_owned()).collect()
}

fn pages() -> BTreeSet<String> {
    let names =
        std::fs::read_dir(docs()).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".md") && name != "SUMMARY.md").collect()
}

#[test]
fn every_page_is_in_the_contents_once() {
    let named = links(&std::fs::read_to_string(docs().join("SUMMARY.md")).unwrap());
    assert_eq!(named.iter().cloned().collect::<BTreeSet<_>>(), pages());
    assert_eq!(named.len(), pages().len());
}

#[test]
fn every_link_leads_to_a_file() {
    for page in pages() {
        for target in links(&std::fs::read_to_string(docs().join(&page)).unwrap()) {
            assert!(docs().join(&target).exists(), "{page} links to {target}");
        }
    }
}

#[test]
fn the_book_is_built() {
    let mdbook = docs().join("../target/pages/bin/mdbook");
    if !mdbook.exists() {
        eprintln!("skipped: no mdBook under target/pages (tests/setup.sh installs it where there is a network)");
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let done = Command::new(mdbook).args(["build", "-d"]).arg(built.path()).arg(docs()).output().unwrap();
    let told = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success() && !told.contains("ERROR") && !told.contains("WARN"), "{told}");
    for page in pages() {
        assert!(built.path().join(page).with_extension("html").exists(), "{told}");
    }
}
