//! Every command of README.md and of docs/demo.md runs in a checkout as a user has it, and prints what is shown.

use std::path::PathBuf;

use frikan_tests::command::{checkout, printed};
use frikan_tests::fixtures::folder;
use frikan_tests::pages::commands::prints_what_it_shows;

fn readme() -> PathBuf {
    folder().join("../README.md")
}

/// What stands at the start of a command by which a machine gets what the tests have already.
const ALREADY_DONE: [&str; 2] = ["git clone ", "cargo install "];

#[test]
fn every_command_prints_what_is_shown() {
    let checkout = checkout();
    assert!(prints_what_it_shows(&readme(), |line| Some(printed(checkout.path(), line))) >= 3);
}

/// In a checkout of its own, whose files are those of this one.
#[test]
fn a_demo_in_c_takes_few_commands() {
    let checkout = tempfile::tempdir().unwrap();
    let (at, root) = (checkout.path(), std::fs::canonicalize(folder().join("..")).unwrap());
    for name in ["Cargo.toml", "Cargo.lock", "fixtures", "shared", "runtime", "trainer", "tests"] {
        std::os::unix::fs::symlink(root.join(name), at.join(name)).unwrap();
    }
    let is_done = |line: &str| ALREADY_DONE.iter().any(|start| line.starts_with(start));
    let commands = prints_what_it_shows(&root.join("docs/demo.md"), |line| (!is_done(line)).then(|| printed(at, line)));
    assert!((2..=5).contains(&commands), "{commands}");
    // An image that it cannot use is refused with the reason: a formula, and the friction of a joint of another size.
    let run = |image: &str| printed(at, &format!("cmake -DIMAGE={image} -P runtime/c/example/demo.cmake"));
    let told = run("fixtures/elbow.frk");
    assert!(told.contains("status 16: ") && told.contains("--representation table"), "{told}");
    let crane = "[columns]\ntorque = { name = \"torque_Nm\", unit = \"Nm\", scale = 1000 }\n";
    std::fs::write(at.join("crane.toml"), crane).unwrap();
    let _ =
        printed(at, "trainer fit fixtures/elbow.csv --joint crane.toml --representation table -o crane.frk --quiet");
    let told = run("crane.frk");
    assert!(told.starts_with("the image is of a joint of another size") && !told.contains("tracking"), "{told}");
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
