//! Runs the supervised drive of several joints with encoders of 12 to 21 bits, and writes `docs/encoders.md`.

use std::fmt::Write as _;
use std::path::Path;

use frikan_runtime::supervised::DEFAULT_GAIN;
use frikan_tests::closed_loop::{Compensation, every_joint, joints, own_model, rows};
use frikan_trainer::files::write_whole;
use frikan_trainer::plant::Joint;
use frikan_trainer::rig::{Motion, Row, Scores};
use rayon::prelude::*;

/// Where the table goes, from the root of the repository.
const PAGE: &str = "docs/encoders.md";

const BITS: [u32; 8] = [12, 13, 14, 15, 16, 17, 19, 21];
/// Frictions over that of the model.
const SCALES: [f64; 3] = [0.3, 0.7, 1.0];
const MOTIONS: [Motion; 5] = [Motion::Hold, Motion::Creep, Motion::Reversals, Motion::Dwells, Motion::Sine];
/// Rates of the drive, Hz, and with what they are run.
const RATES_HZ: [f64; 4] = [250.0, 1000.0, 4000.0, 20_000.0];
const BITS_OF_RATES: [u32; 4] = [12, 14, 17, 21];
const SCALES_OF_RATES: [f64; 3] = [0.2, 1.0, 1.3];
/// Number of the status of a drive that compensates less than it was set to.
const DEGRADED: u32 = 4;

const HEAD: &str = "\
# Encoders of 12 to 21 bits

Written by `cargo run --release -p frikan-tests --bin encoders`; nothing below the line is typed by hand.

A supervised drive compensates by the joint's own law. The supervisor knows the angle of a count: behind the two stages of its observer, each
of time constant `T`, a count looks like a torque of `inertia count / T^2`, and `T` is as long as it takes for that to stay within the least
friction; the velocity that is compensated is that of the reference and, behind a low-pass, what the measured one has beside it. Cells:
tracking error (RMS) without and with compensation, mrad; in brackets the range at rest. *d*: the drive says `Degraded` in more than half of
the samples, since it compensates less than half or its encoder has fewer than four counts in the way over which the contact yields.
**Bold**: worse than without compensation by more than a fiftieth.

---
";

fn main() {
    let mut page = String::from(HEAD);
    let (mut worse, mut unsaid) = (0, 0);
    for (name, joint) in every_joint() {
        let head: String = BITS.iter().map(|bits| format!(" {bits} |")).collect();
        let line = "---|".repeat(BITS.len());
        let _ = write!(page, "\n**{name}**\n\n| motion | friction |{head}\n|---|---|{line}\n");
        for motion in MOTIONS {
            for scale in SCALES {
                let cells: Vec<Cell> = BITS.par_iter().map(|bits| Cell::of(&joint, *bits, motion, scale)).collect();
                worse += cells.iter().filter(|cell| cell.is_worse).count();
                unsaid += cells.iter().filter(|cell| cell.is_worse && !cell.is_degraded).count();
                let cells: Vec<&str> = cells.iter().map(|cell| cell.text.as_str()).collect();
                let _ = writeln!(page, "| {} | {scale} | {} |", motion.name(), cells.join(" | "));
            }
        }
    }
    let cells = every_joint().len() * MOTIONS.len() * SCALES.len() * BITS.len();
    let _ = writeln!(
        page,
        "\nOf {cells} cells {worse} are worse than without compensation, {unsaid} of them without saying so."
    );
    append_rates(&mut page);
    write_whole(Path::new(PAGE), page.as_bytes()).expect("the page is written");
}

/// The same joints at other rates of the drive.
fn append_rates(page: &mut String) {
    let head: String = BITS_OF_RATES.iter().map(|bits| format!(" {bits} |")).collect();
    let line = "---|".repeat(BITS_OF_RATES.len());
    let _ = write!(
        page,
        "\n## Rates of 250 Hz to 20 kHz\n\nThe five motions with frictions of 0.2, 1 and 1.3, 15 runs a cell: how many are worse than without compensation, in \
         brackets how many of\nthem without saying so; then by how much the tracking error is better with the friction of the model, at least and in the \
         median of the motions.\n\n| joint | rate, Hz |{head}\n|---|---|{line}\n"
    );
    for (name, joint) in joints() {
        for rate in RATES_HZ {
            let mut joint = joint.clone();
            joint.drive.rate_hz = rate;
            let cells = BITS_OF_RATES.map(|bits| rate_cell(&joint, bits));
            let _ = writeln!(page, "| {name} | {rate} | {} |", cells.join(" | "));
        }
    }
}

fn rate_cell(joint: &Joint, bits: u32) -> String {
    let runs: Vec<(Motion, f64)> =
        MOTIONS.iter().flat_map(|motion| SCALES_OF_RATES.map(|scale| (*motion, scale))).collect();
    let cells: Vec<(f64, Cell)> =
        runs.par_iter().map(|(motion, scale)| (*scale, Cell::of(joint, bits, *motion, *scale))).collect();
    let worse = cells.iter().filter(|(_, cell)| cell.is_worse);
    let unsaid = worse.clone().filter(|(_, cell)| !cell.is_degraded).count();
    let mut better: Vec<f64> =
        cells.iter().filter(|(scale, _)| *scale == 1.0).map(|(_, cell)| cell.times_better).collect();
    better.sort_by(f64::total_cmp);
    format!("{} ({unsaid}) {:.1} {:.1}", worse.count(), better[0], better[better.len() / 2])
}

/// One joint, encoder, motion and friction.
struct Cell {
    text: String,
    is_worse: bool,
    is_degraded: bool,
    /// Tracking error without compensation over that with it.
    times_better: f64,
}

impl Cell {
    fn of(joint: &Joint, bits: u32, motion: Motion, scale: f64) -> Self {
        let mut joint = joint.clone();
        joint.drive.counts_per_turn = f64::from(1_u32 << bits);
        let own = own_model(&joint);
        let run = |gain| rows(&joint, motion, scale, 1, Compensation::supervised(&own, gain));
        let (off, on) = (run(0.0), run(DEFAULT_GAIN));
        let [before, after] = [&off, &on].map(|rows: &Vec<Row>| Scores::of(rows, None));
        let is_worse =
            after.rms_error > 1.02 * before.rms_error || after.hold_peak_to_peak > 1.02 * before.hold_peak_to_peak;
        let is_degraded = 2 * on.iter().filter(|row| row.answer.status == DEGRADED).count() > on.len();
        let mut text = format!("{:.2} {:.2}", 1e3 * before.rms_error, 1e3 * after.rms_error);
        if before.hold_peak_to_peak > 0.0 {
            let _ = write!(text, " ({:.2} {:.2})", 1e3 * before.hold_peak_to_peak, 1e3 * after.hold_peak_to_peak);
        }
        if is_worse {
            text = format!("**{text}**");
        }
        if is_degraded {
            text += " *d*";
        }
        Self { text, is_worse, is_degraded, times_better: before.rms_error / after.rms_error }
    }
}
