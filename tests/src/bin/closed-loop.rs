//! Runs the drive in closed loop over joints, motions, frictions, concealed effects and targets, and writes `docs/closed-loop.md`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use frikan_runtime::shared::model::Model;
use frikan_runtime::supervised::{DEFAULT_GAIN, VelocitySource};
use frikan_tests::closed_loop::{Compensation, every_joint, joints, own_model, rows, scores};
use frikan_tests::command::run;
use frikan_trainer::files::write_whole;
use frikan_trainer::fit::model::{CELLS, load};
use frikan_trainer::plant::{Friction, Hidden, Joint};
use frikan_trainer::rig::{Motion, Scores};
use serde_json::Value;

/// Where the table goes, from the root of the repository.
const PAGE: &str = "docs/closed-loop.md";

/// Frictions over that of the model.
const SCALES: [f64; 4] = [0.7, 0.9, 1.0, 1.2];

/// Effects that are concealed, each at twice a plausible strength.
const EFFECTS: [&str; 6] =
    ["presliding", "load_friction", "position_ripple", "temperature", "warm_up", "frictional_lag"];
const STRENGTH: f64 = 2.0;
/// Seeds of the recordings, drawn for this page and used nowhere else.
const SEEDS: [u64; 2] = [9101, 9102];
/// Length of a recording, s.
const RECORDED_S: &str = "120";

const HEAD: &str = "\
# Compensation in closed loop

Written by `cargo run --release -p frikan-tests --bin closed-loop`; nothing below the line is typed by hand.

`trainer loop JOINT.toml --image MODEL.frk --motion reversals` closes the loop between a simulated joint and the drive's own code: position
loop, encoder filter and supervised compensator, on the host or on an emulated microcontroller (`--target cortex-m4f`), one sample of delay
between measurement and torque. `--effect NAME=STRENGTH --seed N` hides the effect that `trainer simulate` hides for the same seed.

**Which velocity.** Through zero and at rest that of the reference, in sliding that of the joint (Olsson et al. 1998): the measured velocity at rest
is noise whose sign switches the torque, and the reference knows nothing of a joint that sticks. At rest the torque is held.

**Which gain.** 0.95 of the model unless the firmware sets another: a model that is too strong by a twentieth still leaves
friction that dissipates. Beyond that a passivity monitor (after Hannaford & Ryu 2002) watches the energy that the compensation feeds
the joint, and lowers the gain within 20 ms of sliding where it does; it rises again over half a second. Without a position loop nothing
else would stop a joint whose friction has fallen below the model's.

**A friction that changes.** `--adapt` lets the drive learn level, a viscous part and an offset while it slides: least squares with
exponential forgetting (Astrom & Wittenmark 1995), within bounds that the firmware sets, from the loop's torque and the filtered velocity, without an
acceleration. A change is followed to a tenth in three times its memory (1.5 s of sliding here). It learns nothing at rest, without a
reference, or from a sample that is refused; a push from outside under a position loop is taken for friction within the bounds.

**Which encoder.** The supervisor is told the angle of a count: what a count looks like is neither torque nor motion. With 12 and 13 bits it
cannot tell below 20 mrad/s whether the joint sticks, and says so (`degraded`); so does a drive of which the monitor leaves less than
half ([encoders.md](encoders.md)).

**Faults.** Torque falls to zero within the slew limit where a channel is missing or not finite or the image is none, and ramps down where
velocity and position contradict each other for 0.2 s (one stands still, another sign, another scale); that stays until the firmware clears it. A
new image goes on from the torque of the one before, within the slew limit, and without what was learnt on it.

Errors are root mean squares of reference less position after the first second. *Coulomb + viscous* is the joint's own law without its
Stribeck peak, *static* what `trainer fit` makes of a recording, *diagnosed* what `trainer diagnose` makes of the same recording.

---
";

fn main() {
    let mut page = String::from(HEAD);
    own_laws(&mut page);
    nudges(&mut page);
    concealed(&mut page);
    targets(&mut page);
    write_whole(Path::new(PAGE), page.as_bytes()).expect("the page is written");
}

/// The law without its Stribeck peak.
fn coulomb_and_viscous(joint: &Joint) -> Model<16> {
    let friction = Friction { stribeck_torque_nm: 0.0, ..joint.friction.clone() };
    own_model(&Joint { friction, ..joint.clone() })
}

fn own_laws(page: &mut String) {
    page.push_str("\n## The joint's own law, friction of 70 to 120 % of it\n");
    for (name, joint) in every_joint() {
        eprintln!("{name}");
        let _ = write!(
            page,
            "\n**{name}**, tracking error in mrad (range at rest where the reference stands)\n\n| motion | friction | none | Coulomb + viscous | own law | own law, adaptive |\n|---|---|---|---|---|---|\n"
        );
        let simple = coulomb_and_viscous(&joint);
        let own = own_model(&joint);
        for motion in Motion::ALL.into_iter().filter(|motion| *motion != Motion::Nudge) {
            for scale in SCALES {
                let none = scores(&joint, motion, scale, &own, 0.0);
                let adaptive = Compensation { adapts: true, ..Compensation::supervised(&own, DEFAULT_GAIN) };
                let adaptive = Scores::of(&rows(&joint, motion, scale, 1, adaptive), None);
                let [simple, own] = [&simple, &own].map(|model| scores(&joint, motion, scale, model, DEFAULT_GAIN));
                let cells = [none, simple, own, adaptive].map(|scores| error_cell(&scores));
                let _ = writeln!(page, "| {} | {scale} | {} |", motion.name(), cells.join(" | "));
            }
        }
    }
}

fn error_cell(scores: &Scores) -> String {
    let error = format!("{:.3}", 1e3 * scores.rms_error);
    let range = 1e3 * scores.hold_peak_to_peak;
    if range > 0.0 { format!("{error} ({range:.4})") } else { error }
}

fn nudges(page: &mut String) {
    page.push_str("\n## Nudged without a position loop\n\nSpeed when the joint is let go and the largest after it, rad/s; without the monitor at the measured velocity, and supervised.\n\n| joint | friction | let go | largest, unsupervised | largest, supervised | at the end |\n|---|---|---|---|---|---|\n");
    for (name, joint) in every_joint() {
        let own = own_model(&joint);
        for scale in [0.5, 0.7, 0.9, 1.0, 1.2] {
            let of = |source| {
                let compensation = Compensation { source, ..Compensation::supervised(&own, DEFAULT_GAIN) };
                Scores::of(&rows(&joint, Motion::Nudge, scale, 1, compensation), Motion::Nudge.nudge_end())
            };
            let [bare, watched] = [VelocitySource::Measured, VelocitySource::Blended].map(of);
            let let_go = watched.max_speed_after_nudge - watched.speed_gain_after_nudge;
            let _ = writeln!(
                page,
                "| {name} | {scale} | {let_go:.3} | {:.3} | {:.3} | {:.4} |",
                bare.max_speed_after_nudge, watched.max_speed_after_nudge, watched.final_speed
            );
        }
    }
}

fn concealed(page: &mut String) {
    let _ = write!(
        page,
        "\n## Concealed physics: recorded, diagnosed, compensated\n\nThe elbow of 0.5 kg m2 with 6 N m of gravity and one effect at {STRENGTH} times a plausible strength, recorded for {RECORDED_S} s (seeds {SEEDS:?}). Tracking error in mrad.\n\n| effect | seed | named | motion | none | static | diagnosed |\n|---|---|---|---|---|---|---|\n"
    );
    let [(_, elbow), ..] = joints();
    let joint = Joint { gravity_torque_nm: vec![6.0], ..elbow };
    for effect in EFFECTS {
        for seed in SEEDS {
            eprintln!("{effect} {seed}");
            concealed_rows(page, &joint, effect, seed);
        }
    }
}

fn concealed_rows(page: &mut String, joint: &Joint, effect: &str, seed: u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let text = toml::to_string(&BTreeMap::from([("plant", joint)])).expect("a joint");
    std::fs::write(folder.join("joint.toml"), text).expect("a file");
    let strength = format!("{effect}={STRENGTH}");
    let seed_text = seed.to_string();
    let did = |arguments: &[&str]| run(folder, arguments).status;
    let simulate = [
        "simulate",
        "joint.toml",
        "-o",
        "r.csv",
        "--effect",
        &strength,
        "--seed",
        &seed_text,
        "--duration",
        RECORDED_S,
    ];
    assert_eq!(did(&simulate), 0, "{effect} is simulated");
    did(&["fit", "r.csv", "-o", "static.frk", "--force", "--quiet"]);
    did(&["diagnose", "r.csv", "-o", "diagnosed.frk", "--json", "d.json", "--quiet"]);
    let diagnosis: Value =
        serde_json::from_slice(&std::fs::read(folder.join("d.json")).expect("a diagnosis")).expect("JSON");
    let names: Vec<&str> = diagnosis["findings"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|finding| finding["effect"].as_str())
        .collect();
    let mut joint = joint.clone();
    joint.effects.push(Hidden { name: effect.to_owned(), amplitude: STRENGTH });
    for motion in [Motion::Reversals, Motion::Sine] {
        let error = |file: &str, gain| -> Option<String> {
            let image = load(&folder.join(file)).ok()?.1;
            let model: &Model<CELLS> = &image.model;
            let compensation = Compensation::supervised(model, gain);
            Some(format!("{:.3}", 1e3 * Scores::of(&rows(&joint, motion, 1.0, seed, compensation), None).rms_error))
        };
        let cells = [("static.frk", 0.0), ("static.frk", DEFAULT_GAIN), ("diagnosed.frk", DEFAULT_GAIN)]
            .map(|(file, gain)| error(file, gain).unwrap_or_else(|| "no image".to_owned()));
        let _ =
            writeln!(page, "| {effect} | {seed} | {} | {} | {} |", names.join(", "), motion.name(), cells.join(" | "));
    }
}

fn targets(page: &mut String) {
    page.push_str("\n## On the emulated drives\n\n`fixtures/elbow.toml` with `fixtures/elbow.frk`, 10 s of reversals: the same trace, bit for bit, on every target.\n\n| target | trace CRC-32 | instructions of a sample: loop, compensator, monitor |\n|---|---|---|\n");
    let folder = frikan_tests::fixtures::folder();
    for target in ["host", "cortex-m4f", "cortex-m7", "cortex-m33", "cortex-m0plus", "riscv32imac"] {
        eprintln!("{target}");
        let line =
            ["loop", "elbow.toml", "--image", "elbow.frk", "--duration", "10", "--json", "--quiet", "--target", target];
        let json: Value = serde_json::from_str(&run(&folder, &line).output).expect("JSON");
        let count = &json["instructions"];
        let count =
            if count.is_null() { "not counted".to_owned() } else { format!("{} to {}", count["min"], count["max"]) };
        let _ = writeln!(page, "| {target} | {} | {count} |", json["trace_crc32"].as_str().unwrap_or("none"));
    }
}
