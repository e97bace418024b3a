//! What a finding rests on: equation, evidence, its torque over time, its regions, its rivals, the drive. Folded at first.

use super::content::TIME;
use super::on_the_drive::on_the_drive;
use crate::diagnose::advice::Plan;
use crate::diagnose::answer::outcome::{Diagnosis, Finding};
use crate::diagnose::answer::region::Side;
use crate::diagnose::answer::traces::Traces;
use crate::figures::digits;
use crate::physics::names::{capital, plain_name};
use crate::physics::units::Units;
use crate::physics::{Action, EffectId};
use crate::report::ink::Ink;
use crate::report::page::{PARAMETER_HEADER, Page, Plot, Size, parameter_rows};
use crate::report::tell::evidence::{evidence, parameters, separate_by};

/// Names in the chart of one finding's rivals, its own included.
const MOST_STANDINGS: usize = 6;

/// One finding: equation, parameters, torque over time, regions.
pub(super) fn section(page: &mut Page, diagnosis: &Diagnosis, index: usize, units: Units, plan: Option<&Plan>) {
    let found = &diagnosis.findings[index];
    let code = if found.effect == EffectId::Unknown { "" } else { found.effect.code() };
    let name = format!("{code} {}", found.effect.name());
    let heading = format!("{}. {} ({}) in detail", index + 1, capital(plain_name(found.effect)), name.trim());
    page.folded(&heading, |page| details(page, (diagnosis, found, index), units, plan));
}

fn details(
    page: &mut Page,
    (diagnosis, found, index): (&Diagnosis, &Finding, usize),
    units: Units,
    plan: Option<&Plan>,
) {
    page.paragraph(&format!("{}.", capital(&evidence(found, units))));
    page.equation(&found.equation);
    page.table(&PARAMETER_HEADER, &parameter_rows(&parameters(&found.parameters, units), "fixed"));
    over_time(page, (diagnosis, found, index), units);
    let regions: Vec<Vec<String>> = found
        .location
        .regions
        .iter()
        .take(5)
        .map(|region| {
            let joined = |text: &dyn Fn(&Side) -> String| region.sides().map(text).collect::<Vec<_>>().join(" and ");
            vec![
                joined(&|side| side.channel.replace('_', " ")),
                joined(&|side| digits(side.from)),
                joined(&|side| digits(side.to)),
                joined(&|side| units.of_channel(side.channel)),
                format!("{:.0} %", 100.0 * region.share_of_excess),
                format!("{:.0} %", 100.0 * region.share_of_samples),
            ]
        })
        .collect();
    if !regions.is_empty() {
        page.subheading("Where it sits");
    }
    page.table(&["channel", "from", "to", "unit", "of the evidence", "of the samples"], &regions);
    standings(page, found);
    page.subheading("On the drive");
    page.paragraph(on_the_drive(found.effect));
    if found.effect.action() == Action::FeedForward {
        page.paragraph("To count the instructions of the whole image: trainer verify IMPROVED.frk --target cortex-m4f");
    }
    if !found.alternatives.is_empty() {
        page.subheading("What would distinguish the alternatives");
        page.paragraph(&format!("{}.", capital(&separate_by(found, plan))));
    }
}

/// Residual without this effect and its torque over the time where it is densest.
fn over_time(page: &mut Page, (diagnosis, found, index): (&Diagnosis, &Finding, usize), units: Units) {
    let traces = &diagnosis.traces;
    let Some(torque) = traces.effects.get(index) else { return };
    let without: Vec<f64> = traces.after.iter().zip(torque).map(|(rest, effect)| rest + effect).collect();
    let (from, to) = window(traces, found);
    let inside: Vec<usize> = (0..traces.len()).filter(|&i| traces.time[i] >= from && traces.time[i] <= to).collect();
    if inside.len() <= 4 {
        return;
    }
    let at = |series: &[f64]| inside.iter().map(|&i| series[i]).collect::<Vec<_>>();
    let name = format!("{} over time", found.effect.name());
    let label = format!("torque ({})", units.actuator);
    let mut plot = Plot::new(&name, Size::Half, ["time (s)", &label]).linked(TIME);
    for [begin, end] in found.location.when_s.iter().filter(|[begin, end]| *end > from && *begin < to) {
        plot.band(begin.max(from), end.min(to));
    }
    let series =
        [(&*at(&without), Ink::Data, "recorded, less all other terms"), (&*at(torque), Ink::Two, "this effect")];
    plot.lines(&at(&traces.time), &series);
    page.plot(&plot, "The stretch of time with the densest evidence: what was recorded less all other terms of the model, and this effect.");
}

/// A stretch of time around the densest evidence, at most a tenth of the recording.
fn window(traces: &Traces, found: &Finding) -> (f64, f64) {
    let (Some(&first), Some(&last)) = (traces.time.first(), traces.time.last()) else { return (0.0, 0.0) };
    let width = (0.1 * (last - first)).max(1.0).min(last - first);
    let centre = found.location.when_s.first().map_or(0.5 * (first + last), |w| 0.5 * (w[0] + w[1]));
    let from = (centre - 0.5 * width).clamp(first, last - width);
    (from, from + width)
}

/// The rivals of one finding when it was accepted.
fn standings(page: &mut Page, found: &Finding) {
    let mut rows = vec![(found.effect.name().to_string(), found.score, true)];
    let close = found.standings.iter().map(|(effect, distance)| (effect, found.score - distance));
    rows.extend(
        close.filter(|(_, score)| *score > 0.0).map(|(effect, score)| (effect.name().to_string(), score, false)),
    );
    if rows.len() > 1 {
        rows.truncate(MOST_STANDINGS);
        page.subheading("Its rivals");
        page.bars(&rows, "nats", "What each name alone would have explained when this one was accepted.");
    }
}
