//! Every command of README.md and of docs/demo.md runs in a checkout as a user has it, and prints what is shown. `FRIKAN_WRITE=1` writes what it prints
//! into the page.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use frikan_tests::command::{checkout, printed};
use frikan_tests::fixtures::folder;

/// What a command stands behind.
const PROMPT: &str = "    $ ";

fn readme() -> PathBuf {
    folder().join("../README.md")
}

/// What stands at the start of a command by which a machine gets what the tests have already.
const ALREADY_DONE: [&str; 2] = ["git clone ", "cargo install "];

/// Runs the commands of a page in `at` and says how many it has.
fn prints_what_it_shows(page: &Path, at: &Path) -> usize {
    let text = std::fs::read_to_string(page).unwrap();
    let mut written = String::new();
    let mut lines = text.lines().peekable();
    let mut count = 0;
    while let Some(line) = lines.next() {
        // Writing to a string cannot fail.
        let _ = writeln!(written, "{line}");
        let Some(first) = line.strip_prefix(PROMPT) else { continue };
        let mut command = first.to_owned();
        while command.ends_with('\\') {
            let next = lines.next().expect("a line that goes on");
            let _ = writeln!(written, "{next}");
            command = format!("{} {}", command.trim_end_matches('\\'), next.trim_start());
        }
        count += 1;
        if ALREADY_DONE.iter().any(|start| command.starts_with(start)) {
            continue;
        }
        while lines.next_if(|next| next.starts_with("    ") && !next.starts_with(PROMPT)).is_some() {}
        printed(at, &command).lines().for_each(|line| {
            let _ = writeln!(written, "    {line}");
        });
    }
    if std::env::var_os("FRIKAN_WRITE").is_some() {
        std::fs::write(page, &written).unwrap();
    }
    let page = page.display();
    assert!(written == text, "{page} shows what is no longer printed; FRIKAN_WRITE=1 writes it again:\n{written}");
    count
}

#[test]
fn every_command_prints_what_is_shown() {
    let checkout = checkout();
    assert!(prints_what_it_shows(&readme(), checkout.path()) >= 3);
}

/// In a checkout of its own, whose files are those of this one.
#[test]
fn a_demo_in_c_takes_few_commands() {
    let checkout = tempfile::tempdir().unwrap();
    let (at, root) = (checkout.path(), std::fs::canonicalize(folder().join("..")).unwrap());
    for name in ["Cargo.toml", "Cargo.lock", "fixtures", "shared", "runtime", "trainer", "tests"] {
        std::os::unix::fs::symlink(root.join(name), at.join(name)).unwrap();
    }
    let commands = prints_what_it_shows(&root.join("docs/demo.md"), at);
    assert!((2..=5).contains(&commands), "{commands}");
}

#[test]
fn it_is_one_screen_and_its_links_lead_somewhere() {
    let text = std::fs::read_to_string(readme()).unwrap();
    let words = text.split_whitespace().count();
    assert!(words <= 600, "{words} words");
    let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    for link in links.filter(|link| !link.starts_with("https:")) {
        assert!(readme().with_file_name(link).exists(), "{link}");
    }
}
