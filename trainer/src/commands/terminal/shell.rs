//! `trainer completions` and `trainer man`: what a shell and a manual know of the command line, made from the command line itself.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;

use super::output::{Outputs, print};
use crate::error::{Error, Result, codes};
use crate::files::create_folder;

/// Print completions for a shell: `source <(trainer completions bash)`.
#[derive(Args, Clone, Debug)]
pub struct Completions {
    /// Shell that is to complete
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Write man pages, one for the program and one for each command.
#[derive(Args, Clone, Debug)]
pub struct Man {
    /// Folder for them; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
}

/// Prints the completions of a program.
///
/// # Errors
/// `FRK-I001` when standard output cannot be written.
pub fn completions(arguments: &Completions, mut program: Command) -> Result<()> {
    let mut script = Vec::new();
    let name = program.get_name().to_owned();
    clap_complete::generate(arguments.shell, &mut program, name, &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Writes the man pages of a program.
///
/// # Errors
/// `FRK-I...` when they cannot be written.
pub fn man(arguments: &Man, mut program: Command) -> Result<()> {
    create_folder(&arguments.output)?;
    program.build();
    let mut outputs = Outputs::default();
    let name = program.get_name().to_owned();
    let pages = program.get_subcommands().filter(|command| command.get_name() != "help");
    let mut pages: Vec<(String, Command)> =
        pages.map(|command| (format!("{name}-{}", command.get_name()), command.clone())).collect();
    pages.push((name, program));
    for (name, command) in pages {
        let mut page = Vec::new();
        let rendered = clap_mangen::Man::new(command).title(name.to_uppercase()).render(&mut page);
        rendered.map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))?;
        outputs.add(&arguments.output.join(format!("{name}.1")), page);
    }
    outputs.write()
}
