//! One finding at a glance: what, where, how much, how sure, what to do, and the picture that shows it.

use super::changes;
use super::content::{DiagnosisPage, axis_label};
use crate::diagnose::answer::location::own_axis;
use crate::diagnose::answer::outcome::{Diagnosis, Finding};
use crate::diagnose::answer::region::Region;
use crate::figures::quantity;
use crate::markup::escape;
use crate::physics::names::{capital, plain_name};
use crate::physics::units::Units;
use crate::physics::{Action, EffectId};
use crate::report::ink::Ink;
use crate::report::page::{Page, Plot, Size};
use crate::report::tell::certainty::certainty;
use crate::report::tell::evidence::separate_by;
use crate::report::tell::{adds_torque, amount, whereabouts};

/// Axes along which what happens near zero matters.
const BY_DECADES: [&str; 3] = ["distance_since_reversal", "time_since_reversal", "dwell"];

/// The card of a finding.
pub(super) fn card(page: &mut Page, content: &DiagnosisPage<'_>, index: usize) {
    let DiagnosisPage { diagnosis, units, .. } = *content;
    let found = &diagnosis.findings[index];
    let name = capital(plain_name(found.effect));
    let place = page.place(&name);
    page.html(&format!(
        "<article class=\"card\"><div><h2 id=\"{place}\">{}. {} <small>{:.0} %</small></h2><dl>",
        index + 1,
        escape(&name),
        100.0 * found.probability
    ));
    if adds_torque(found) {
        answer(page, "Where", &format!("{}.", capital(&whereabouts(found, units))));
        answer(page, "How much", &format!("{}.", capital(&amount(diagnosis, index, units))));
    }
    answer(page, "How sure", &certainty(found));
    answer(page, "What to do", &what_to_do(found, content));
    // Said once, of the first effect that an image holds.
    let first = diagnosis.findings.iter().position(Finding::is_of_the_image);
    if let Some(command) = content.put_right.filter(|_| first == Some(index)) {
        // Lines break between words, not within an option.
        let words: Vec<String> = command.split(' ').map(|word| format!("<span>{}</span>", escape(word))).collect();
        page.html(&format!("<dd class=\"command\">In the simulator: <code>{}</code></dd>", words.join(" ")));
    }
    page.html("</dl>");
    let body = content.rigid_body.as_ref();
    page.table(&changes::HEADER, &changes::of_finding(diagnosis, found, body, units));
    page.html("</div>");
    if let Some((plot, caption)) = over_its_axis(diagnosis, index, units) {
        let figure = page.figure_of(&plot, &caption);
        page.html(&figure);
    }
    page.html("</article>");
}

fn answer(page: &mut Page, question: &str, text: &str) {
    page.html(&format!("<dt>{question}</dt><dd>{}</dd>", escape(text)));
}

fn what_to_do(found: &Finding, content: &DiagnosisPage<'_>) -> String {
    let act = match found.action {
        Action::FeedForward => "Add it to the model: the improved image has it, for a drive as for a simulator.",
        Action::Parameter if found.effect.is_of_actuator() => {
            "Correct the constant of the actuator in joint.toml and in the simulator; no image holds it."
        }
        Action::Parameter => "Correct the parameter of the model; the improved image has it corrected.",
        Action::Measurement => "Put the measurement right; it is not compensated.",
        Action::Maintenance if found.effect == EffectId::Unknown => {
            "It is not compensated; look at what happens there."
        }
        Action::Maintenance => "Inspect the joint; it is not compensated.",
    };
    if found.alternatives.is_empty() {
        return act.to_string();
    }
    format!("{act} To be sure of the name: {}.", separate_by(found, content.plan))
}

/// What all other terms leave and the torque of this one, over its own axis or else the one that locates it.
fn over_its_axis(diagnosis: &Diagnosis, index: usize, units: Units) -> Option<(Plot, String)> {
    let traces = &diagnosis.traces;
    let found = &diagnosis.findings[index];
    let torque = traces.effects.get(index).filter(|torque| torque.iter().any(|value| *value != 0.0))?;
    let regions = || found.location.regions.iter().map(|region: &Region| &region.side);
    // Drawn over the axis along which the card says where it is.
    let named = found.location.named().map(|region| region.side.channel);
    let axes = named.into_iter().chain(own_axis(found.effect)).chain(regions().map(|side| side.channel));
    let (channel, values) = axes.into_iter().find_map(|name| Some((name, traces.channel(name)?)))?;
    let without: Vec<f64> = traces.after.iter().zip(torque).map(|(rest, effect)| rest + effect).collect();
    let labels = [axis_label(channel, units), format!("torque ({})", units.actuator)];
    let by_decades = BY_DECADES.contains(&channel);
    let name = format!("{} over {}", found.effect.name(), channel);
    let mut plot = Plot::new(&name, Size::Low, [&labels[0], &labels[1]]).logarithmic(by_decades);
    if let Some(side) = regions().find(|side| side.channel == channel) {
        plot.band(side.from, side.to);
    }
    plot.dots(
        values,
        &[(&without, Ink::Data, "recorded, less all other terms"), (torque, Ink::Two, plain_name(found.effect))],
    );
    let largest = quantity(torque.iter().fold(0.0, |most: f64, value| most.max(value.abs())), units.actuator);
    let over = channel.replace('_', " ");
    Some((
        plot,
        format!(
            "Torque over {over}: what was recorded less all other terms of the model, and this effect, up to {largest}."
        ),
    ))
}
