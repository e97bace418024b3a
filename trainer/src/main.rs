//! The command line `trainer`.

use clap::{Parser, Subcommand};
use frikan_trainer::commands::{diagnose, simulate};
use std::process::ExitCode;

/// Friction models that run in the drive.
#[derive(Parser)]
#[command(name = "trainer", version)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Diagnose(diagnose::Diagnose),
    Simulate(simulate::Simulate),
}

fn main() -> ExitCode {
    let status = match &Line::parse().command {
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments).map(|()| 0),
    };
    status.map_or_else(
        |error| {
            eprintln!("{error}");
            ExitCode::from(error.exit_status())
        },
        ExitCode::from,
    )
}
