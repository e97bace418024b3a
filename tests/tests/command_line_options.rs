//! The table of commands in docs/command-line.md is what the program says of itself; `FRIKAN_WRITE=1` writes it anew.

use std::path::Path;

use frikan_tests::command::printed;
use frikan_tests::fixtures::folder;

/// Lines between which the table stands.
const BEGIN: &str = "| command | options |\n|---|---|\n";
const END: &str = "\n## ";

/// What an option line of a help text begins with, up to its description: `-o, --output <FILE>`; `None` of any other line.
fn option(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let (option, _) = line.split_once("  ").unwrap_or((line, ""));
    let is_option = option.starts_with("--") || option.as_bytes().get(2..4) == Some(b", ");
    (is_option && option.starts_with('-') && !option.ends_with("--help")).then_some(option)
}

/// A command with its arguments and options, as a row.
fn row(at: &Path, command: &str) -> String {
    let help = printed(at, &format!("trainer {command} -h"));
    let usage = help.lines().find_map(|line| line.strip_prefix("Usage: ")).unwrap();
    let options: Vec<String> = help.lines().filter_map(option).map(|option| format!("`{option}`")).collect();
    // A bar ends a cell of a table.
    let cell = |text: &str| text.replace('|', "\\|");
    let options = if options.is_empty() { "none".to_owned() } else { options.join(", ") };
    format!("| `{}` | {} |\n", cell(&usage.replace(" [OPTIONS]", "")), cell(&options))
}

fn table() -> String {
    let folder = tempfile::tempdir().unwrap();
    let help = printed(folder.path(), "trainer -h");
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = listed.filter_map(|line| line.strip_prefix("  ")?.split(' ').next().filter(|name| !name.is_empty()));
    names.filter(|name| *name != "help").map(|name| row(folder.path(), name)).collect()
}

#[test]
fn the_page_lists_every_option_of_every_command() {
    let page = folder().join("../docs/command-line.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let (before, rest) = text.split_once(BEGIN).expect("the page has the table");
    let (written, after) = rest.split_once(END).expect("a section follows the table");
    let table = table();
    assert!(table.lines().count() >= 19 && table.contains("`--simulation <SIM>`"), "{table}");
    if std::env::var_os("FRIKAN_WRITE").is_some() {
        std::fs::write(&page, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
        return;
    }
    assert_eq!(written, table, "FRIKAN_WRITE=1 writes it anew");
}
