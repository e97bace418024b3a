//! Every command of README.md runs in a checkout as a user has it, and prints what README shows. `FRIKAN_WRITE=1` writes what it prints
//! into README.

use std::fmt::Write as _;
use std::path::PathBuf;

use frikan_tests::command::{checkout, printed};
use frikan_tests::fixtures::folder;

/// What a command stands behind.
const PROMPT: &str = "    $ ";

fn readme() -> PathBuf {
    folder().join("../README.md")
}

#[test]
fn every_command_prints_what_is_shown() {
    let checkout = checkout();
    let at = checkout.path();
    let text = std::fs::read_to_string(readme()).unwrap();
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
        while lines.next_if(|next| next.starts_with("    ") && !next.starts_with(PROMPT)).is_some() {}
        printed(at, &command).lines().for_each(|line| {
            let _ = writeln!(written, "    {line}");
        });
        count += 1;
    }
    assert!(count >= 3, "README shows commands");
    if std::env::var_os("FRIKAN_WRITE").is_some() {
        std::fs::write(readme(), &written).unwrap();
    }
    assert!(written == text, "README shows what is no longer printed; FRIKAN_WRITE=1 writes it again:\n{written}");
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
