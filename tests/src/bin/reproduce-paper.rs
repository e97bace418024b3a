//! Runs the paper's experiments and writes `docs/paper.md` with its pictures; `reproduce-paper --short` runs few draws and prints
//! the page only.

use std::path::Path;

use frikan_tests::paper::Effort;
use frikan_tests::paper::page::files;
use frikan_trainer::error::Result;
use frikan_trainer::files::write_whole;

fn main() -> Result<()> {
    let short = std::env::args().any(|argument| argument == "--short");
    for (name, content) in files(if short { Effort::SHORT } else { Effort::FULL })? {
        let path = Path::new("docs").join(&name);
        if name.ends_with(".md") {
            print!("{content}");
        }
        if !short {
            if let Some(folder) = path.parent() {
                let made = std::fs::create_dir_all(folder);
                made.map_err(|error| frikan_trainer::error::Error::from_io(folder, &error))?;
            }
            write_whole(&path, content.as_bytes())?;
        }
    }
    Ok(())
}
