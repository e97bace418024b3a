//! The page of a fleet: who differs from its siblings, by what, and all joints beside each other.

use std::collections::HashMap;

use super::ink::Ink;
use super::page::{Origin, Page, Plot, Size, columns};
use crate::figures::{digits, quantity};
use crate::fleet::{Kind, Member, Quantity, Survey};

/// Joints in the table of a page at most, the most conspicuous first; the table in CSV has all.
const MOST_ROWS: usize = 1000;
/// Friction curves of a picture at most, outliers not counted.
const MOST_CURVES: usize = 200;

/// The page as one HTML file; `lines` tell kinds, outliers and failures in sentences, `friction` are the friction curves by joint.
#[must_use]
pub fn fleet(
    survey: &Survey,
    headline: &str,
    lines: &[String],
    friction: &[(&str, &[[f64; 3]])],
    origin: &Origin<'_>,
) -> String {
    let mut page = Page::new("Fleet", &format!("{} joints.", survey.members.len()));
    page.lead(headline);
    page.list(lines, "findings");
    for (index, kind) in survey.kinds.iter().enumerate() {
        let members: Vec<&Member> = survey.members.iter().filter(|member| member.kind == index).collect();
        page.heading(if kind.name.is_empty() { "All joints" } else { &kind.name });
        page.plot(&curves(kind, &members, friction), "Friction over velocity, outliers in colour.");
        let pictures = (0..Quantity::ALL.len()).filter_map(|quantity| side_by_side(kind, &members, quantity));
        page.plots(&pictures.collect::<Vec<_>>());
        constants(&mut page, &members);
    }
    page.finish(origin)
}

fn curves(kind: &Kind, members: &[&Member], friction: &[(&str, &[[f64; 3]])]) -> Plot {
    let points = |curve: &[[f64; 3]]| curve.iter().map(|[v, friction, _]| [*v, *friction]).collect::<Vec<_>>();
    let outlier: HashMap<&str, bool> =
        members.iter().map(|member| (member.joint.as_str(), member.is_outlier)).collect();
    let of_kind = friction.iter().filter_map(|(joint, curve)| Some((*outlier.get(joint)?, points(curve))));
    let (outliers, others): (Vec<_>, Vec<_>) = of_kind.partition(|curve| curve.0);
    let stride = others.len().div_ceil(MOST_CURVES).max(1);
    let shown: Vec<&(bool, Vec<[f64; 2]>)> = others.iter().step_by(stride).chain(&outliers).collect();
    let mut plot = Plot::new("friction over velocity", Size::Wide, ["velocity", &format!("friction ({})", kind.unit)]);
    for (is_outlier, curve) in shown {
        let (velocity, friction) = columns(curve);
        plot.lines(&velocity, &[(&friction, if *is_outlier { Ink::Two } else { Ink::Data }, "")]);
    }
    plot
}

/// A quantity of all joints, one dot each, from the smallest on.
fn side_by_side(kind: &Kind, members: &[&Member], quantity: usize) -> Option<(Plot, String)> {
    let value = |member: &&&Member| {
        member.compared[quantity].value.map(|value| (value.value, member.compared[quantity].stands_out))
    };
    let mut values: Vec<(f64, bool)> = members.iter().filter_map(|member| value(&member)).collect();
    if values.len() < 2 {
        return None;
    }
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let dots = |which: bool| -> Vec<[f64; 2]> {
        let numbered = values.iter().enumerate().filter(|(_, value)| value.1 == which);
        numbered.map(|(rank, value)| [rank as f64, value.0]).collect()
    };
    let name = Quantity::ALL[quantity].name().replace('_', " ");
    let unit = if Quantity::ALL[quantity] == Quantity::Trend { "share a year" } else { &kind.unit };
    let mut plot = Plot::new(&name, Size::Low, ["joints, by rank", &format!("{name} ({unit})")]);
    for (which, ink, label) in [(false, Ink::Data, "like its siblings"), (true, Ink::Two, "stands out")] {
        let (rank, value) = columns(&dots(which));
        plot.dots(&rank, &[(&value, ink, label)]);
    }
    let caption = match (Quantity::ALL[quantity], kind.levels.0) {
        (Quantity::Friction(level), speeds) => format!("Friction at a speed of {}.", digits(speeds[level])),
        (Quantity::Ripple, _) => "Amplitude of the strongest wave over position in the residual.".to_string(),
        (Quantity::Residual, _) => {
            "What the image leaves of the recorded torque in motion (root mean square).".to_string()
        }
        (Quantity::Trend, _) => "How the friction changes with the date.".to_string(),
    };
    Some((plot, caption))
}

/// The constants of the common law, joint by joint.
fn constants(page: &mut Page, members: &[&Member]) {
    let mut members = members.to_vec();
    members.sort_by(|a, b| a.adjusted.total_cmp(&b.adjusted));
    let Some(first) = members.first() else { return };
    let names: Vec<String> = first.constants.iter().map(|(own, _)| own.name.replace('_', " ")).collect();
    let header: Vec<&str> = ["joint", "false alarm"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let row = |member: &&Member| {
        let constants = first.constants.iter().map(|(of_first, _)| {
            let own = member.constants.iter().find(|(own, _)| own.name == of_first.name);
            own.map_or_else(String::new, |(own, _)| {
                format!("{} ({} to {})", quantity(own.value, &own.unit), digits(own.ci95[0]), digits(own.ci95[1]))
            })
        });
        [member.joint.clone(), format!("{:.2} %", 100.0 * member.adjusted)].into_iter().chain(constants).collect()
    };
    page.subheading("The law that all share, with 95 % intervals; the most conspicuous joints first");
    page.table(&header, &members.iter().take(MOST_ROWS).map(row).collect::<Vec<Vec<String>>>());
}
