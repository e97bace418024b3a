//! The command line `trainer`: one subcommand a file of the library's `commands`.

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use frikan_trainer::commands::fit::watch;
use frikan_trainer::commands::fleet::{gather, plan, run as run_task};
use frikan_trainer::commands::output::{print, say};
use frikan_trainer::commands::terminal::{configuration, shell};
use frikan_trainer::commands::{
    arm, check, closed_loop, diagnose, explain, export, fit, init, predict, rollout, show, simulate, verify,
};
use frikan_trainer::error::Result;
use frikan_trainer::recording::silence_readers_panics;

/// Learns, explains and diagnoses the friction of a joint from recordings.
///
/// Exit status: 0 fine, 1 `diagnose`, `verify`, `gather` or `show --compare` found something, 2 usage, 3 bad input data, 4 fitted but not
/// identifiable or not converged, 5 input or output. Options that are not given are those of the environment (`FRIKAN_FIT_SEED` for
/// `fit --seed`), then those of `trainer.toml` here (`[fit] seed = 3`, or `seed = 3` for all commands; `FRIKAN_CONFIG` names another file).
#[derive(Parser)]
#[command(name = "trainer", version, arg_required_else_help = true)]
struct Trainer {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Init(init::Init),
    Check(check::Check),
    Fit(fit::Fit),
    Watch(watch::Watch),
    Arm(arm::Arm),
    Show(show::Show),
    Predict(predict::Predict),
    Rollout(rollout::Rollout),
    Verify(verify::Verify),
    Export(export::Export),
    Diagnose(diagnose::Diagnose),
    Simulate(simulate::Simulate),
    Loop(closed_loop::Loop),
    Plan(plan::Plan),
    Run(run_task::Run),
    Gather(gather::Gather),
    Explain(explain::Explain),
    Completions(shell::Completions),
    Man(shell::Man),
}

fn run(command: &Command) -> Result<u8> {
    match command {
        Command::Init(arguments) => init::run(arguments).map(|()| 0),
        Command::Check(arguments) => check::run(arguments),
        Command::Fit(arguments) => fit::run(arguments),
        Command::Watch(arguments) => watch::run(arguments).map(|()| 0),
        Command::Arm(arguments) => arm::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Predict(arguments) => predict::run(arguments).map(|()| 0),
        Command::Rollout(arguments) => rollout::run(arguments).map(|()| 0),
        Command::Verify(arguments) => verify::run(arguments),
        Command::Export(arguments) => export::run(arguments).map(|()| 0),
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments).map(|()| 0),
        Command::Loop(arguments) => closed_loop::run(arguments).map(|()| 0),
        Command::Plan(arguments) => plan::run(arguments).map(|()| 0),
        Command::Run(arguments) => run_task::run(arguments),
        Command::Gather(arguments) => gather::run(arguments),
        Command::Completions(arguments) => shell::completions(arguments, Trainer::command()).map(|()| 0),
        Command::Man(arguments) => shell::man(arguments, Trainer::command()).map(|()| 0),
        Command::Explain(arguments) => arguments.run().and_then(|text| print(&text)).map(|()| 0),
    }
}

/// The command line, with what environment and `trainer.toml` add to it.
fn parsed() -> Result<Command> {
    let mut program = Trainer::command();
    program.build();
    let completed = configuration::complete(std::env::args_os().collect(), &program)?;
    let matches = Trainer::command().get_matches_from(&completed.words);
    if let Some((name, matches)) = matches.subcommand()
        && let Some(command) = program.find_subcommand(name)
    {
        completed.keep(command, matches);
    }
    Ok(Trainer::from_arg_matches(&matches).unwrap_or_else(|error| error.exit()).command)
}

fn main() -> ExitCode {
    silence_readers_panics();
    match parsed().and_then(|command| run(&command)) {
        Ok(status) => ExitCode::from(status),
        Err(error) => {
            say(&error.to_string());
            ExitCode::from(error.exit_status())
        }
    }
}
