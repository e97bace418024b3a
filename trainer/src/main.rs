//! The command line `trainer`: one subcommand a file of the library's `commands`.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use frikan_trainer::commands::output::print;
use frikan_trainer::commands::{closed_loop, diagnose, explain, export, fit, init, predict, show, simulate, verify};
use frikan_trainer::error::Result;

/// Learns, explains and diagnoses the friction of a joint from recordings.
///
/// Exit status: 0 fine, 1 `diagnose`, `verify` or `show --compare` found something, 2 usage, 3 bad input data, 4 fitted but not
/// identifiable or not converged, 5 input or output.
#[derive(Parser)]
#[command(name = "trainer", version, arg_required_else_help = true)]
struct Trainer {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Init(init::Init),
    Fit(fit::Fit),
    Show(show::Show),
    Predict(predict::Predict),
    Verify(verify::Verify),
    Export(export::Export),
    Diagnose(diagnose::Diagnose),
    Simulate(simulate::Simulate),
    Loop(closed_loop::Loop),
    Explain(explain::Explain),
}

fn run(command: &Command) -> Result<u8> {
    match command {
        Command::Init(arguments) => init::run(arguments).map(|()| 0),
        Command::Fit(arguments) => fit::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Predict(arguments) => predict::run(arguments).map(|()| 0),
        Command::Verify(arguments) => verify::run(arguments),
        Command::Export(arguments) => export::run(arguments).map(|()| 0),
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments).map(|()| 0),
        Command::Loop(arguments) => closed_loop::run(arguments).map(|()| 0),
        Command::Explain(arguments) => arguments.run().and_then(|text| print(&text)).map(|()| 0),
    }
}

fn main() -> ExitCode {
    match run(&Trainer::parse().command) {
        Ok(status) => ExitCode::from(status),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_status())
        }
    }
}
