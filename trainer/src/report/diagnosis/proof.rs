//! How much better the model is with the findings, on rows that no fit has seen and as a simulation.

use super::content::axis_label;
use crate::diagnose::Motion;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::figures::{digits, quantity};
use crate::physics::units::Units;
use crate::report::ink::Ink;
use crate::report::page::{Page, Plot, Size};
use crate::report::tell::Story;

/// Rollouts in the chart of motions: so many can be told apart.
const MOST_MOTIONS: usize = 20;
/// Distance between the begins of two rollouts in that chart, in lengths of one.
const MOTION_PACE: f64 = 1.2;

pub(super) fn proof(page: &mut Page, diagnosis: &Diagnosis, story: &Story, units: Units) {
    page.heading("How much better");
    story.sealed.iter().for_each(|sentence| page.paragraph(sentence));
    let row = |name: &str, before: f64, after: f64, rows: usize| {
        vec![name.to_string(), quantity(before, units.actuator), quantity(after, units.actuator), rows.to_string()]
    };
    let mut rows = vec![row("all rows", diagnosis.baseline.rmse, diagnosis.improved.rmse, diagnosis.traces.len())];
    if let Some(proof) = &diagnosis.proof {
        rows.push(row("locked rows, which no fit has seen", proof.baseline_rmse, proof.improved_rmse, proof.rows));
    }
    page.table(&["rows", "before", "after", "number"], &rows);
    if let Some(rollout) = &diagnosis.rollout {
        let position = units.of_channel("position");
        page.paragraph(&format!(
            "Open-loop rollout: driven by the recorded torque alone from {} recorded states, the model strays from the \
             recorded position by {} before and {} after, root mean square over {} s.",
            rollout.starts,
            quantity(rollout.baseline_rmse, &position),
            quantity(rollout.improved_rmse, &position),
            digits(rollout.horizon_s)
        ));
        let caption = "The recorded motion and that of the model from the state at the begin of each stretch on, before and after; the \
                       stretches stand one behind the other.";
        page.plot(&motions(&rollout.motions, rollout.horizon_s, units), caption);
    }
    page.paragraph(&format!(
        "Share of the recorded torque's variance that is explained: {:.4} before, {:.4} after.",
        diagnosis.baseline.r2, diagnosis.improved.r2
    ));
}

/// Positions over time, one rollout behind the other with a break between.
fn motions(motions: &[Motion], horizon_s: f64, units: Units) -> Plot {
    let motions = &motions[..motions.len().min(MOST_MOTIONS)];
    let pace_s = MOTION_PACE * horizon_s;
    let mut columns: [Vec<f64>; 4] = Default::default();
    for (index, motion) in motions.iter().enumerate() {
        let begin = pace_s * index as f64;
        let behind = begin - motion.time[0];
        columns[0].extend(motion.time.iter().map(|time| time + behind));
        for (column, values) in columns[1..].iter_mut().zip([&motion.recorded, &motion.before, &motion.after]) {
            column.extend(values);
            column.push(f64::NAN);
        }
        columns[0].push(columns[0].last().copied().unwrap_or(begin));
    }
    let [time, recorded, before, after] = &columns;
    let mut plot = Plot::new("simulated motions", Size::Wide, ["time (s)", &axis_label("position", units)]);
    plot.lines(
        time,
        &[(recorded, Ink::Data, "recorded"), (before, Ink::Two, "model before"), (after, Ink::One, "model after")],
    );
    plot
}
