//! Draws joints that report no torque, fits and diagnoses them, and writes `docs/servo-draws.md`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use clap::Parser;
use frikan_tests::concealed::page;
use frikan_tests::servo_draws::{Found, Hidden, Joint, Kind};
use frikan_trainer::files::write_whole;

/// Where the tables go, from the root of the repository.
const PAGE: &str = "docs/servo-draws.md";

/// What is hidden, each in as many draws.
const HIDDEN: [Hidden; 9] = [
    Hidden::Nothing,
    Hidden::WeakGain(0.1),
    Hidden::Limit(0.6),
    Hidden::Delay(0.02),
    Hidden::DeadBand(0.5),
    Hidden::Effect("load_friction"),
    Hidden::Effect("stribeck"),
    Hidden::Effect("presliding"),
    Hidden::Effect("position_ripple"),
];

const HEAD: &str = "\
# Joints that report no torque, drawn

Written by `COMMAND`; nothing below the line is typed by hand.

Joints with drawn inertia, friction, gains and torque constants are simulated ([Simulating a joint](simulate.md)) for 40 s under drives of 20 kHz that log
positions and commands at 500 Hz, currents and duties as their means, and no torque. `trainer fit` gets two recordings with a weighed payload each and has to find the
constants of the actuator too, of a motor all but its resistance; `trainer diagnose` gets one recording beside its simulation and knows the constants.

---
";

#[derive(Parser)]
struct Arguments {
    /// Draws of each kind that are fitted
    #[arg(long, default_value_t = 20)]
    draws: u64,
    /// Draws of each kind and each hidden effect that are diagnosed
    #[arg(long, default_value_t = 2)]
    diagnosed: u64,
    /// First seed
    #[arg(long, default_value_t = 7001)]
    seed: u64,
}

fn main() {
    let arguments = Arguments::parse();
    let mut page = HEAD.replace("COMMAND", &page::command("servo-draws"));
    append_fits(&mut page, &arguments);
    append_diagnoses(&mut page, &arguments);
    write_whole(Path::new(PAGE), page.as_bytes()).expect("the page is written");
}

/// How near the constants come.
fn append_fits(page: &mut String, arguments: &Arguments) {
    page.push_str(
        "\n## Constants\n\nOf each constant: the median of what is found over the truth, how many are within 2 %, of how many the 95 % interval holds \
         the truth, and in how many it was\ntold that the recordings do not determine it.\n\n\
         | kind | constant | draws | median | within 2 % | interval holds | not determined |\n|---|---|---|---|---|---|---|\n",
    );
    let mut refused: Vec<(Kind, String)> = Vec::new();
    for kind in Kind::ALL {
        let mut of_draws: Vec<Vec<Found>> = Vec::new();
        for seed in arguments.seed..arguments.seed + arguments.draws {
            let folder = tempfile::tempdir().expect("there is a place for temporary files");
            match Joint::drawn(kind, seed).fitted(folder.path()) {
                Ok(found) => of_draws.push(found),
                Err(message) => refused.push((kind, message.lines().last().unwrap_or_default().to_owned())),
            }
            eprintln!("{} {seed}: {:?} {:?}", kind.name(), of_draws.last(), refused.last());
        }
        let names: BTreeSet<&str> = of_draws.iter().flatten().map(|found| found.name).collect();
        for name in names {
            let named = of_draws.iter().flatten().filter(|found| found.name == name);
            let mut shares: Vec<(f64, bool)> = named.filter_map(|found| found.value).collect();
            shares.sort_by(|a, b| a.0.total_cmp(&b.0));
            let median = shares.get(shares.len() / 2).map_or(f64::NAN, |(share, _)| *share);
            let near = shares.iter().filter(|(share, _)| (share - 1.0).abs() <= 0.02).count();
            let held = shares.iter().filter(|(_, is_held)| *is_held).count();
            let open = of_draws.len() - shares.len();
            let _ = writeln!(
                page,
                "| `{}` | {name} | {} | {median:.3} | {near} | {held} | {open} |",
                kind.name(),
                of_draws.len()
            );
        }
    }
    for (kind, message) in refused {
        let _ = writeln!(page, "\nA `{}` was refused: {message}", kind.name());
    }
}

/// What is named.
fn append_diagnoses(page: &mut String, arguments: &Arguments) {
    page.push_str(
        "\n## What is named\n\nOf so many draws, in how many what is hidden is named first, is named or may stand in for what is, and in how many something \
         else is\nnamed beside or instead; of nothing, in how many nothing is.\n\n\
         | kind | hidden | draws | first | among | other names |\n|---|---|---|---|---|---|\n",
    );
    for kind in Kind::ALL {
        for hidden in HIDDEN.into_iter().filter(|hidden| hidden.is_of(kind)) {
            let (mut first, mut among) = (0, 0);
            let mut other: Vec<String> = Vec::new();
            for seed in arguments.seed..arguments.seed + arguments.diagnosed {
                let folder = tempfile::tempdir().expect("there is a place for temporary files");
                let sets = Joint::drawn(kind, seed).diagnosed(folder.path(), hidden);
                eprintln!("{} {hidden:?} {seed}: {sets:?}", kind.name());
                let holds = |set: &Vec<String>| hidden.name().is_some_and(|name| set.iter().any(|of| of == name));
                let is_nothing = hidden == Hidden::Nothing && sets.is_empty();
                first += u64::from(is_nothing || sets.first().is_some_and(holds));
                among += u64::from(is_nothing || sets.iter().any(holds));
                other.extend(sets.iter().filter(|set| !holds(set)).map(|set| set[0].clone()));
            }
            let name = hidden.name().unwrap_or("nothing");
            let other = if other.is_empty() { "none".to_owned() } else { other.join(", ") };
            let _ = writeln!(
                page,
                "| `{}` | {name} | {} | {first} | {among} | {other} |",
                kind.name(),
                arguments.diagnosed
            );
        }
    }
}
