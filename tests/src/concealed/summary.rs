//! From outcomes to tables: rates with intervals, confusions, reliability, misses.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::intervals::{Held, held};
use super::{Case, Concealed, Hidden, Outcome, signals};
use frikan_trainer::diagnose::{BaseKind, Lock, Prepared};
use frikan_trainer::physics::EffectId;

/// What is kept of an outcome.
#[derive(Clone, Debug)]
pub struct Row {
    /// The case.
    pub case: Case,
    /// Reached non-centrality.
    pub lambda: f64,
    /// Effect-to-noise ratio behind the filter.
    pub effect_to_noise: f64,
    /// Findings in order, each with its ambiguity set and stated probability.
    pub findings: Vec<(EffectId, Vec<EffectId>, f64)>,
    /// Channels of an unnamed finding.
    pub unknown_channels: Vec<String>,
    /// Share of the removable error that is removed on locked rows, from Coulomb and viscous friction.
    pub removed_share: Option<f64>,
    /// Parameters of a right finding of which the truth is known.
    pub held: Vec<Held>,
}

impl Row {
    /// Keeps what the tables need.
    pub fn of(outcome: &Outcome) -> Self {
        let d = &outcome.diagnosis;
        let findings = d
            .findings
            .iter()
            .map(|f| (f.effect, f.alternatives.iter().map(|(e, _)| *e).collect(), f.probability))
            .collect();
        Self {
            case: outcome.case.clone(),
            lambda: outcome.concealed.lambda,
            effect_to_noise: outcome.concealed.effect_to_noise,
            findings,
            unknown_channels: outcome.unknown_channels(),
            removed_share: removed_share(outcome),
            held: held(outcome),
        }
    }

    fn truths(&self) -> Vec<&'static str> {
        match &self.case.hidden {
            Hidden::Nothing => Vec::new(),
            Hidden::Effect(name, _) => vec![name],
            Hidden::Pair(first, second, _) => vec![first, second],
        }
    }

    /// Whether the first name is the hidden effect.
    pub fn first_is_right(&self) -> bool {
        self.findings.first().is_some_and(|(effect, _, _)| self.truths().first().is_some_and(|t| *t == effect.name()))
    }

    /// Whether the hidden effect is the first name or in its ambiguity set.
    pub fn in_set(&self) -> bool {
        self.truths().iter().all(|truth| {
            self.findings
                .iter()
                .any(|(effect, set, _)| effect.name() == *truth || set.iter().any(|e| e.name() == *truth))
        })
    }

    /// Whether an effect is named and its set does not hold the truth.
    pub fn wrongly_named(&self) -> bool {
        self.findings.first().is_some_and(|(effect, _, _)| *effect != EffectId::Unknown) && !self.in_set()
    }

    /// Whether a structure outside the catalogue is located along a channel on which it depends.
    fn channels_are_right(&self) -> bool {
        let Hidden::Effect(name, _) = self.case.hidden else { return false };
        let channels: &[&str] = match name {
            "unknown_acceleration_sign" | "unknown_acceleration_square" => &["acceleration"],
            "unknown_load_position" => &["load", "position"],
            "unknown_load_squared_viscous" => &["load"],
            "unknown_load_temperature" => &["load", "temperature"],
            "unknown_temperature_bump" => &["temperature"],
            "unknown_other_drag" => &["other_velocity"],
            "unknown_other_position" | "unknown_viscous_other_cosine" => &["other_position"],
            "unknown_slow_wave" => &["time"],
            "unknown_speed_band" => &["velocity"],
            _ => &["position"],
        };
        self.unknown_channels.last().is_some_and(|found| channels.contains(&found.as_str()))
    }
}

/// What the baseline leaves besides the noise, less what the improved model leaves of it, over what somebody who knows the
/// hidden torque could take away. The noise is known here, so that its chance on the locked rows hides nothing.
fn removed_share(outcome: &Outcome) -> Option<f64> {
    let Concealed { recording, joint, rest_without, .. } = &outcome.concealed;
    let noise = Prepared::new(&signals(recording, joint), Lock::Spread).filtered(&recording.truth.noise_torque);
    let traces = &outcome.diagnosis.traces;
    // A realigned recording has other rows, another base another rest.
    if noise.len() != traces.len() || rest_without.len() != noise.len() || outcome.case.base != BaseKind::CoulombViscous
    {
        return None;
    }
    let left = |rest: &[f64]| -> f64 {
        (0..rest.len()).filter(|&i| traces.locked[i]).map(|i| (rest[i] - noise[i]).powi(2)).sum()
    };
    let before = left(&traces.before);
    Some((before - left(&traces.after)) / (before - left(rest_without)))
}

/// A share with its Wilson 95 % interval, as text.
pub fn share(hits: usize, of: usize) -> String {
    if of == 0 {
        return "-".into();
    }
    let (n, p, z) = (of as f64, hits as f64 / of as f64, 1.96f64);
    let centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    format!(
        "{hits}/{of} = {:.1} % ({:.1}-{:.1})",
        100.0 * p,
        100.0 * (centre - half).max(0.0),
        100.0 * (centre + half).min(1.0)
    )
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// The whole report as Markdown.
pub fn report(rows: &[Row], errors: &[String], command: &str) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "# Effects concealed in simulated recordings\n\nRegenerated by `{command}`; every figure below is measured by that command.\nBrackets are 95 % intervals (Wilson). \"Set\" = the named effect with the alternatives that the diagnosis states.\n"
    );
    controls(rows, &mut text);
    for base in [BaseKind::CoulombViscous, BaseKind::Spline, BaseKind::Reference] {
        by_strength(rows, base, &mut text);
    }
    removed(rows, &mut text);
    intervals(rows, &mut text);
    by_effect(rows, &mut text);
    confusions(rows, &mut text);
    reliability(rows, &mut text);
    outside(rows, &mut text);
    pairs(rows, &mut text);
    misses(rows, &mut text);
    if !errors.is_empty() {
        let _ = writeln!(text, "\n## Cases that could not be run\n");
        for error in errors {
            let _ = writeln!(text, "* {error}");
        }
    }
    text
}

fn controls(rows: &[Row], text: &mut String) {
    let controls: Vec<&Row> = rows.iter().filter(|r| r.case.hidden == Hidden::Nothing).collect();
    let _ = writeln!(text, "## Controls: nothing is missing\n\n| kind | false alarms |\n|---|---|");
    let mut kinds: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for row in &controls {
        let entry = kinds.entry(format!("{:?}", row.case.noise)).or_default();
        entry.0 += usize::from(!row.findings.is_empty());
        entry.1 += 1;
    }
    for (kind, (hits, of)) in &kinds {
        let _ = writeln!(text, "| {kind} | {} |", share(*hits, *of));
    }
    let hits = controls.iter().filter(|r| !r.findings.is_empty()).count();
    let _ = writeln!(text, "| all | {} |", share(hits, controls.len()));
}

fn singles(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows.iter().filter(|r| matches!(r.case.hidden, Hidden::Effect(name, _) if EffectId::from_name(name).is_some()))
}

fn by_strength(rows: &[Row], base: BaseKind, text: &mut String) {
    let own: Vec<&Row> = singles(rows).filter(|row| row.case.base == base).collect();
    if own.is_empty() {
        return;
    }
    let name = match base {
        BaseKind::CoulombViscous => "Coulomb and viscous friction",
        BaseKind::Spline => "a spline of nine coefficients",
        BaseKind::Reference => "a Stribeck law fitted to the recording",
    };
    let _ = writeln!(
        text,
        "\n## By strength, starting from {name}\n\nlambda is the non-centrality of the hidden torque on the rows that were not locked away. Faults of the measurement, which\nhave none, are left out.\n\n| lambda | runs | detected | first name right | in set | mean set | named, truth not in set |\n|---|---|---|---|---|---|---|"
    );
    for (low, high) in [(0.0, 15.0), (15.0, 30.0), (30.0, 50.0), (50.0, 120.0), (120.0, 1e9), (50.0, 1e9)] {
        let bin: Vec<&Row> =
            own.iter().filter(|r| (low..high).contains(&r.lambda) && r.lambda > 0.0).copied().collect();
        if bin.is_empty() {
            continue;
        }
        let count = |f: &dyn Fn(&Row) -> bool| bin.iter().filter(|r| f(r)).count();
        let sets: Vec<f64> =
            bin.iter().filter_map(|r| r.findings.first().map(|(_, set, _)| 1.0 + set.len() as f64)).collect();
        let _ = writeln!(
            text,
            "| {low:.0}-{} | {} | {} | {} | {} | {:.2} | {} |",
            if high > 1e8 { "".to_string() } else { format!("{high:.0}") },
            bin.len(),
            share(count(&|r| !r.findings.is_empty()), bin.len()),
            share(count(&Row::first_is_right), bin.len()),
            share(count(&Row::in_set), bin.len()),
            sets.iter().sum::<f64>() / sets.len().max(1) as f64,
            share(count(&Row::wrongly_named), bin.len()),
        );
    }
}

/// Share of the removable error that is removed on locked rows, by effect-to-noise ratio.
fn removed(rows: &[Row], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Removable error removed on locked rows, where the first name is right\n\n| effect-to-noise | runs | median | lower decile |\n|---|---|---|---|"
    );
    for (low, high) in [(0.0, 0.1), (0.1, 0.15), (0.15, 0.3), (0.3, 0.6), (0.6, 1e9)] {
        let mut shares: Vec<f64> = singles(rows)
            .filter(|r| (low..high).contains(&r.effect_to_noise) && r.first_is_right())
            .filter_map(|row| row.removed_share)
            .collect();
        shares.sort_by(f64::total_cmp);
        if let Some(middle) = shares.get(shares.len() / 2) {
            let end = if high > 1e8 { String::new() } else { format!("{high}") };
            let (count, least) = (shares.len(), shares[shares.len() / 10]);
            let _ = writeln!(text, "| {low}-{end} | {count} | {:.1} % | {:.1} % |", 100.0 * middle, 100.0 * least);
        }
    }
}

/// How often the 90 % intervals hold the truth, by parameter.
fn intervals(rows: &[Row], text: &mut String) {
    let mut table: BTreeMap<&str, Vec<&Held>> = BTreeMap::new();
    for held in rows.iter().filter(|r| r.lambda >= 50.0).flat_map(|r| &r.held) {
        table.entry(&held.parameter).or_default().push(held);
    }
    let _ = writeln!(
        text,
        "\n## 90 % intervals against the drawn truth, lambda of 50 and more\n\n| parameter | held | median deviation, in stated standard deviations |\n|---|---|---|"
    );
    let within = |of: &[&Held]| share(of.iter().filter(|h| h.within_ninety()).count(), of.len());
    for (parameter, of) in &table {
        let middle = median(of.iter().map(|h| h.deviations).collect()).unwrap_or(0.0);
        let _ = writeln!(text, "| {parameter} | {} | {middle:+.2} |", within(of));
    }
    let all: Vec<&Held> = table.values().flatten().copied().collect();
    let _ = writeln!(text, "| all | {} | |", within(&all));
}

fn by_effect(rows: &[Row], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## By effect, lambda of 50 and more\n\n| effect | first name right | in set |\n|---|---|---|"
    );
    for effect in EffectId::ALL {
        let own: Vec<&Row> = singles(rows)
            .filter(
                |r| matches!(r.case.hidden, Hidden::Effect(name, wanted) if name == effect.name() && wanted >= 50.0),
            )
            .collect();
        if !own.is_empty() {
            let right = own.iter().filter(|r| r.first_is_right()).count();
            let inside = own.iter().filter(|r| r.in_set()).count();
            let _ = writeln!(text, "| {} | {right}/{} | {inside}/{} |", effect.name(), own.len(), own.len());
        }
    }
}

fn confusions(rows: &[Row], text: &mut String) {
    let _ = writeln!(text, "\n## Confusions, lambda of 50 and more\n\n| hidden | named first (runs) |\n|---|---|");
    let mut table: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for row in singles(rows) {
        if let Hidden::Effect(name, wanted) = row.case.hidden
            && wanted >= 50.0
        {
            let named = row.findings.first().map_or("nothing", |(effect, _, _)| effect.name());
            *table.entry(name).or_default().entry(named).or_default() += 1;
        }
    }
    for (hidden, named) in table {
        let list: Vec<String> = named.iter().map(|(name, count)| format!("{name} {count}")).collect();
        let _ = writeln!(text, "| {hidden} | {} |", list.join(", "));
    }
}

fn reliability(rows: &[Row], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Stated probability against frequency\n\n| stated | runs | first name right |\n|---|---|---|"
    );
    let mut bins: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
    for row in singles(rows) {
        if let Some((_, _, probability)) = row.findings.first() {
            let entry = bins.entry((probability * 100.0).round() as u32).or_default();
            entry.0 += usize::from(row.first_is_right());
            entry.1 += 1;
        }
    }
    for (stated, (hits, of)) in bins {
        let _ = writeln!(text, "| {stated} % | {of} | {} |", share(hits, of));
    }
}

fn outside(rows: &[Row], text: &mut String) {
    let outside: Vec<&Row> = rows
        .iter()
        .filter(|r| matches!(r.case.hidden, Hidden::Effect(name, _) if name.starts_with("unknown_")))
        .collect();
    if outside.is_empty() {
        return;
    }
    let _ = writeln!(text, "\n## Structures outside the catalogue\n\n| structure | answers |\n|---|---|");
    let mut table: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for row in &outside {
        if let Hidden::Effect(name, _) = row.case.hidden {
            let answer = row.findings.first().map_or("nothing".to_string(), |(effect, _, _)| {
                if *effect == EffectId::Unknown {
                    format!("unknown ({})", row.unknown_channels.join(", "))
                } else {
                    effect.name().to_string()
                }
            });
            table.entry(name).or_default().push(answer);
        }
    }
    for (name, answers) in table {
        let _ = writeln!(text, "| {name} | {} |", answers.join("; "));
    }
    let unknown =
        outside.iter().filter(|r| r.findings.first().is_some_and(|(e, _, _)| *e == EffectId::Unknown)).count();
    let right = outside.iter().filter(|r| r.channels_are_right()).count();
    let _ = writeln!(
        text,
        "\nAnswered \"unknown\": {}. With the right channel: {}.",
        share(unknown, outside.len()),
        share(right, outside.len())
    );
}

fn pairs(rows: &[Row], text: &mut String) {
    let pairs: Vec<&Row> = rows.iter().filter(|r| matches!(r.case.hidden, Hidden::Pair(..))).collect();
    if pairs.is_empty() {
        return;
    }
    let both = pairs.iter().filter(|r| r.in_set()).count();
    let surplus: usize = pairs.iter().map(|r| r.findings.len().saturating_sub(2)).sum();
    let _ = writeln!(
        text,
        "\n## Two effects at once\n\nBoth named up to their sets: {}; surplus terms a run: {:.2}.\n",
        share(both, pairs.len()),
        surplus as f64 / pairs.len() as f64
    );
}

fn misses(rows: &[Row], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Every miss at lambda of 50 and more\n\n| hidden | seed | lambda | answer |\n|---|---|---|---|"
    );
    for row in rows.iter().filter(|r| !r.in_set() && r.lambda >= 50.0) {
        let answer: Vec<String> = row
            .findings
            .iter()
            .map(|(effect, set, _)| {
                let set: Vec<&str> = set.iter().map(|e| e.name()).collect();
                if set.is_empty() {
                    effect.name().to_string()
                } else {
                    format!("{} or {}", effect.name(), set.join(", "))
                }
            })
            .collect();
        let hidden = match &row.case.hidden {
            Hidden::Effect(name, _) if name.starts_with("unknown_") => continue,
            Hidden::Effect(name, _) => (*name).to_string(),
            Hidden::Pair(a, b, _) => format!("{a} + {b}"),
            Hidden::Nothing => continue,
        };
        let _ = writeln!(
            text,
            "| {hidden} | {} | {:.0} | {} |",
            row.case.seed,
            row.lambda,
            if answer.is_empty() { "nothing".into() } else { answer.join(" + ") }
        );
    }
}
