//! Pages whose commands run as they stand there, and show what they print. `FRIKAN_WRITE=1` writes what they print into the page.

use std::fmt::Write as _;
use std::path::Path;

/// What a command stands behind that shows what it prints.
const PROMPT: &str = "    $ ";
/// What a command begins with that is only run.
const PROGRAMS: [&str; 3] = ["trainer ", "hq ", "FRIKAN_"];

/// Runs the commands of a page in their order and compares what they print with what is shown below them; `print` runs one, or returns `None`
/// of one that is not run here. Returns how many commands there are.
///
/// # Panics
/// Where a command prints something else, or the page cannot be read.
pub fn prints_what_it_shows(page: &Path, print: impl FnMut(&str) -> Option<String>) -> usize {
    let text = std::fs::read_to_string(page).expect("the page is there");
    let (written, count) = printed_anew(&text, print);
    if std::env::var_os("FRIKAN_WRITE").is_some() {
        std::fs::write(page, &written).expect("the page can be written");
        return count;
    }
    let page = page.display();
    assert!(written == text, "{page} shows what is no longer printed; FRIKAN_WRITE=1 writes it again:\n{written}");
    count
}

/// The page with what its commands print now, and how many they are.
fn printed_anew(text: &str, mut print: impl FnMut(&str) -> Option<String>) -> (String, usize) {
    let mut written = String::new();
    let mut lines = text.lines().peekable();
    let mut count = 0;
    while let Some(line) = lines.next() {
        // Writing to a string cannot fail.
        let _ = writeln!(written, "{line}");
        let shown = line.strip_prefix(PROMPT);
        let only_run = || line.strip_prefix("    ").filter(|line| PROGRAMS.iter().any(|start| line.starts_with(start)));
        let Some(mut command) = shown.or_else(only_run).map(str::to_owned) else { continue };
        while command.ends_with('\\') {
            let next = lines.next().expect("a line that goes on");
            let _ = writeln!(written, "{next}");
            command = format!("{} {}", command.trim_end_matches('\\'), next.trim_start());
        }
        count += 1;
        let Some(printed) = print(&command).filter(|_| shown.is_some()) else { continue };
        while lines.next_if(|next| next.starts_with("    ") && !next.starts_with(PROMPT)).is_some() {}
        printed.lines().for_each(|line| {
            let _ = writeln!(written, "    {line}");
        });
    }
    (written, count)
}

#[test]
fn what_is_printed_takes_the_place_of_what_is_shown() {
    let page =
        "    $ one\n    old\n    $ two \\\n        more\n\ntext\n\n    trainer three\n    kept\n    $ four\n    kept\n";
    let mut run = Vec::new();
    let (written, count) = printed_anew(page, |command| {
        run.push(command.to_owned());
        (command != "four").then(|| "new\n".to_owned())
    });
    assert_eq!(run, ["one", "two  more", "trainer three", "four"]);
    assert_eq!(count, 4);
    let expected = "    $ one\n    new\n    $ two \\\n        more\n    new\n\ntext\n\n    trainer three\n    kept\n    $ four\n    kept\n";
    assert_eq!(written, expected);
}
