//! Diagnoses other people's recordings from the command line and writes `docs/real-recordings.md`.

use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::command::run;
use frikan_tests::recordings_folder;
use frikan_trainer::error::{Error, Result};
use frikan_trainer::files::write_whole;

/// Where the page goes, from the root of the repository.
const PAGE: &str = "docs/real-recordings.md";

const HEAD: &str = "\
# What the diagnosis says of other people's recordings

Written by `cargo run --release -p frikan-tests --bin real-recordings`; the answers are the program's own, what is said above
each is what else is known of the recording. The recordings are not part of this repository: EMPS is by Janot, Gautier and
Brunot (2019), the KR300 by J. Weigand, the bare motor by G. Chen, the tribometer by J. Christopherson, the XL330 by Rhoban.
";

/// A recording, or several of one joint, and what is known of it from elsewhere.
struct Case {
    title: &'static str,
    arguments: &'static [&'static str],
    /// Description of the joint, where one is given.
    joint: Option<&'static str>,
    known: &'static str,
}

/// The arguments of the three passes of one axis.
macro_rules! kr300 {
    ($axis:literal) => {
        &[
            concat!("kr300/axis", $axis, "-A.csv"),
            concat!("kr300/axis", $axis, "-B.csv"),
            concat!("kr300/axis", $axis, "-C.csv"),
        ]
    };
}

const CASES: [Case; 10] = [
    Case {
        title: "EMPS, a linear axis driven by a screw",
        arguments: &["emps/train.csv"],
        joint: None,
        known: "Fitted by its owners with one Coulomb level for each direction, 3.11 % of the force are left; with one for both \
                and an offset, 4.08 %.",
    },
    Case {
        title: "A bare motor, turned slowly",
        arguments: &["odrive_cogging/slow2-nocomp_0.csv", "--lock", "tail:0.5"],
        joint: Some("[drive]\ncounts_per_turn = 8192\n"),
        known: "Seven pole pairs; its owner measured a cogging of about 0.4 A by standing still at every count. The ripple that \
                is found agrees with that map (`tests/tests/real_diagnosis.rs`). The motor moves in small jerks from slot to \
                slot: the lag among the ripples is how a controller with little gain answers the cogging, and no property of \
                the friction that anything else would confirm.",
    },
    Case {
        title: "A pin on a plate, stroke 0.24 mm",
        arguments: &["tribometer/reciprocating.csv", "--lock", "tail:0.5"],
        joint: None,
        known: "Most of the stroke is break-away. The later half is locked away: within one stroke every fifth block is a \
                memory of its neighbours, and the pin wears its place in as it runs.",
    },
    Case {
        title: "KR300, axis 1",
        arguments: kr300!("1"),
        joint: None,
        known: "The owner's rigid-body torque is that of the links. What it leaves out should come back on every axis: the \
                rotors, whose inertia counts with the square of a gear ratio above a hundred, as an inertia that is wrong, and \
                gravity, which over a third of a radian is a preload with a little stiffness. Axis 1 stands upright: no \
                gravity. Three passes of ten seconds hold few stops, all of them short: where break-away after a stop or \
                warm-up is named, its time lies at the lower bound: what decays within a pass of ten seconds need not be heat.",
    },
    Case {
        title: "KR300, axis 2",
        arguments: kr300!("2"),
        joint: None,
        known: "A hydraulic counterbalance pulls outside of the owner's model: a preload.",
    },
    Case {
        title: "KR300, axis 3",
        arguments: kr300!("3"),
        joint: None,
        known: "It carries the arm's weight, which the owner's model leaves out; it moves with axis 2, so that its gravity is no \
                function of its own position alone.",
    },
    Case {
        title: "KR300, axis 4",
        arguments: kr300!("4"),
        joint: None,
        known: "A wrist axis that turns under little weight.",
    },
    Case { title: "KR300, axis 5", arguments: kr300!("5"), joint: None, known: "A wrist axis that lifts the tool." },
    Case {
        title: "KR300, axis 6",
        arguments: kr300!("6"),
        joint: None,
        known: "It turns the flange about itself: the owner's model of it is all but nothing (0.03 of 230 N m).",
    },
    Case {
        title: "XL330, a hobby servo with a pendulum",
        arguments: &["xl330_pendulum/sin_sin-kp200.csv"],
        joint: None,
        known: "Neither torque nor current is recorded, only the voltage of the supply. Its torque could be guessed from the gain \
                of its firmware and the constants of its motor, and what is called friction then would hold the error of the \
                guess: these data support no diagnosis.",
    },
];

fn main() -> Result<()> {
    let mut page = String::from(HEAD);
    let joint_file = tempfile::NamedTempFile::new().map_err(|error| Error::from_io(&std::env::temp_dir(), &error))?;
    let joint = joint_file.path();
    let joint_path = joint.display().to_string();
    for case in CASES {
        let mut arguments = vec!["diagnose", "--quiet"];
        arguments.extend(case.arguments);
        if let Some(description) = case.joint {
            std::fs::write(joint, description).map_err(|error| Error::from_io(joint, &error))?;
            arguments.extend(["--joint", &joint_path]);
        }
        let answer = run(&recordings_folder(), &arguments);
        // Writing to a string cannot fail.
        let _ = tell(&mut page, &case, &(answer.output + &answer.messages));
    }
    write_whole(Path::new(PAGE), page.as_bytes())?;
    print!("{page}");
    Ok(())
}

fn tell(page: &mut String, case: &Case, answer: &str) -> std::fmt::Result {
    writeln!(page, "\n## {}\n", case.title)?;
    writeln!(page, "{}\n", case.known)?;
    let described = if case.joint.is_some() { " --joint joint.toml" } else { "" };
    writeln!(page, "    trainer diagnose {}{described}\n", case.arguments.join(" "))?;
    if let Some(description) = case.joint {
        writeln!(page, "with `{}` in `joint.toml`:\n", description.trim_end().replace('\n', " "))?;
    }
    answer.lines().enumerate().try_for_each(|(index, line)| match bullet(line) {
        Some(told) => writeln!(page, "> * {told}"),
        None if index == 0 => writeln!(page, "> {line}\n>"),
        None => writeln!(page, ">\n> {line}"),
    })
}

/// What a line of a list says.
fn bullet(line: &str) -> Option<&str> {
    ["* ", "- "].into_iter().find_map(|mark| line.trim_start().strip_prefix(mark))
}
