//! What recordings are worth before anything is fitted to them.

use serde_json::{Value, json};

use super::recordings::{Reading, Source, Warning, load_all, load_with_faults};
use crate::checks::survey::{Fact, Motion, Seen, survey};
use crate::error::{Error, Result, codes};
use crate::figures::{digits, quantity};
use crate::fit::{Identifiable, identifiable};
use crate::joint::Joint;
use crate::recording::{Axis, Recording};

/// The quality of recordings, what can be identified from them and what to record next.
#[derive(Clone, Debug)]
pub struct Checked {
    verdict: &'static str,
    items: Vec<Item>,
    identified: Identifiable,
    /// 0 good or usable, 3 a recording is at fault, 4 nothing can be identified.
    pub status: u8,
}

/// One line of the result.
#[derive(Clone, Debug)]
struct Item {
    code: &'static str,
    severity: Severity,
    message: String,
    when_s: Vec<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Severity {
    Info,
    Warning,
    Error,
}

impl Severity {
    fn name(self) -> &'static str {
        ["info", "warning", "error"][self as usize]
    }
}

/// Checks recordings of one joint.
///
/// # Errors
/// Whatever reading a recording reports, and what keeps a recording from being looked at at all.
pub fn check(recordings: &[Source<'_>], joint: &Joint) -> Result<Checked> {
    let (recordings, warnings) = load_all(recordings.iter().copied(), |source| {
        load_with_faults(source, joint, Reading::of(&[], None, recordings.len()))
    })?;
    let mut items: Vec<Item> = warnings.iter().map(of_warning).collect();
    for recording in &recordings {
        let name = if recordings.len() > 1 { format!("{}: ", recording.label) } else { String::new() };
        items.extend(survey(recording).iter().map(|fact| of_fact(fact, recording, &name)));
    }
    let is_at_fault = items.iter().any(|item| item.severity == Severity::Error);
    // Beside a fault that cannot be put right no figure means anything.
    let found = if is_at_fault { Ok(Identifiable::default()) } else { identifiable(&recordings, joint) };
    let (identified, status) = match found {
        Ok(identified) => (identified, if is_at_fault { 3 } else { 0 }),
        Err(error) => {
            let status = error.exit_status();
            items.push(of_error(&error));
            (Identifiable::default(), status)
        }
    };
    items.extend(identified.shares.iter().filter(|(_, share)| *share >= 1.0).map(of_unknown));
    let verdict = match items.iter().map(|item| item.severity).max() {
        Some(Severity::Error) => "unusable",
        Some(Severity::Warning) => "usable",
        _ => "good",
    };
    Ok(Checked { verdict, items, identified, status })
}

impl Checked {
    /// The result as JSON, schema `frikan.check/1`.
    #[must_use]
    pub fn json(&self) -> Value {
        summary(self)
    }

    /// The result for a terminal.
    #[must_use]
    pub fn text(&self) -> String {
        text(self)
    }
}

fn of_warning(warning: &Warning) -> Item {
    let severity = if warning.is_blocking() { Severity::Error } else { Severity::Warning };
    Item { code: warning.code(), severity, message: warning.message().to_owned(), when_s: warning.when_s().to_vec() }
}

fn of_error(error: &Error) -> Item {
    Item { code: error.code().id, severity: Severity::Error, message: error.message().to_owned(), when_s: Vec::new() }
}

fn of_unknown((name, _): &(String, f64)) -> Item {
    let message = format!("this motion says nothing of {name}: it may be nothing or all of the friction");
    Item { code: codes::UNIDENTIFIED.id, severity: Severity::Warning, message, when_s: Vec::new() }
}

fn of_fact(fact: &Fact, recording: &Recording, name: &str) -> Item {
    let severity = if fact.is_poor { Severity::Warning } else { Severity::Info };
    let message = format!("{name}{}", sentence(&fact.seen, recording));
    Item { code: fact.seen.code().id, severity, message, when_s: fact.when_s.clone() }
}

fn sentence(seen: &Seen, recording: &Recording) -> String {
    let percent = |share: f64| format!("{} %", digits(100.0 * share));
    let unit = if recording.axis == Axis::Rotary { "rad" } else { "m" };
    match seen {
        Seen::Clock { rows, period_s, jitter } => {
            format!(
                "{rows} rows at {}, steps of the clock within {} of a period",
                quantity(1.0 / period_s, "Hz"),
                percent(*jitter)
            )
        }
        Seen::Gaps { count } => format!("the clock is interrupted {count} times"),
        Seen::Resolution { channel, unit, step, range } if *step > 0.0 => {
            format!("{channel} in steps of {}, {} of them over its range", quantity(*step, unit), digits(range / step))
        }
        Seen::Resolution { channel, unit, range, .. } => {
            format!("{channel} without steps over {}", quantity(*range, unit))
        }
        Seen::Constant { channel, value } => format!("{channel} is {} in every row", digits(*value)),
        Seen::AtLimit { channel, share } => {
            format!("{channel} stands at its largest or smallest value in {} of the rows", percent(*share))
        }
        Seen::Motion(Motion { travel, top_speed, at_rest, slow, reversals }) => format!(
            "{} of travel, up to {}, {reversals} reversals, {} of the time at rest and {} below a tenth of the top speed",
            quantity(*travel, unit),
            quantity(*top_speed, &format!("{unit}/s")),
            percent(*at_rest),
            percent(*slow)
        ),
        Seen::Temperature { range: [low, high] } => format!("{} to {} degrees Celsius", digits(*low), digits(*high)),
    }
}

/// The object of schema `frikan.check/1`.
fn summary(Checked { verdict, items, identified, .. }: &Checked) -> Value {
    let item = |item: &Item| json!({"code": item.code, "severity": item.severity.name(), "message": item.message, "when_s": item.when_s});
    let of = |is_known: bool| {
        let chosen = identified.shares.iter().filter(move |(_, share)| (*share < 1.0) == is_known);
        chosen.map(|(name, share)| json!({"name": name, "within_share_of_friction": share})).collect::<Vec<_>>()
    };
    json!({
        "schema": "frikan.check/1",
        "verdict": verdict,
        "items": items.iter().map(item).collect::<Vec<_>>(),
        "identifiable": of(true),
        "not_identifiable": of(false),
        "record_next": identified.record_next,
    })
}

fn text(Checked { verdict, items, identified, .. }: &Checked) -> String {
    let mut text = format!("{verdict}\n\n");
    for item in items {
        text += &format!("{:<8} {} {}\n", item.severity.name(), item.code, item.message);
    }
    if identified.shares.iter().any(|(_, share)| *share < 1.0) {
        text += "\ncan be identified                    within, of the friction\n";
    }
    for (name, share) in identified.shares.iter().filter(|(_, share)| *share < 1.0) {
        text += &format!("  {name:<34} {:>6} %\n", digits(100.0 * share));
    }
    for next in &identified.record_next {
        text += &format!("\nrecord next  {next}");
    }
    text.trim_end().to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    fn checked(text: &str) -> (u8, Value) {
        let recording = Source::Bytes { label: "log.csv", bytes: text.as_bytes() };
        let checked = check(&[recording], &Joint::default()).unwrap();
        (checked.status, checked.json())
    }

    /// A swing, or strokes of one speed, of a joint with Coulomb and viscous friction; `sign` is that of the torque.
    fn driven(position: impl Fn(f64) -> f64, sign: f64) -> String {
        let mut text = String::from("time_s,position_rad,torque_Nm,temperature_C\n");
        for row in 0..6000 {
            let time = 0.01 * f64::from(row);
            let velocity = (position(time + 1e-4) - position(time - 1e-4)) / 2e-4;
            let noise = 0.05 * (37.0 * time * time).sin();
            let torque = 0.8 * (velocity / 0.01).tanh() + 0.3 * velocity + noise;
            writeln!(text, "{time},{:.5},{},25", position(time), sign * torque).unwrap();
        }
        text
    }

    fn codes_of(value: &Value, severity: &str) -> Vec<String> {
        let items = value["items"].as_array().unwrap().iter().filter(|item| item["severity"] == severity);
        items.map(|item| item["code"].as_str().unwrap().to_owned()).collect()
    }

    #[test]
    fn a_good_motion_tells_the_constants_and_a_channel_that_never_changes_is_told() {
        let swing = |t: f64| (0.7 * t).sin() + 0.3 * (1.9 * t).sin();
        let (status, value) = checked(&driven(swing, 1.0));
        assert_eq!((status, value["verdict"].as_str()), (0, Some("usable")), "{value}");
        let known: Vec<&str> =
            value["identifiable"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
        assert!(known.contains(&"Coulomb friction") && known.contains(&"viscous friction"), "{value}");
        assert!(codes_of(&value, "warning").contains(&"FRK-W013".to_owned()), "{value}");
    }

    #[test]
    fn strokes_of_one_speed_do_not_tell_viscous_friction() {
        let saw = |t: f64| 0.2 * ((t / 2.0).rem_euclid(2.0) - 1.0).abs();
        let (status, value) = checked(&driven(saw, 1.0));
        assert_eq!(status, 0, "{value}");
        let next = value["record_next"].to_string();
        assert!(next.contains("two speeds"), "{value}");
    }

    #[test]
    fn a_fault_that_cannot_be_put_right_is_unusable() {
        let swing = |t: f64| (0.7 * t).sin() + 0.3 * (1.9 * t).sin();
        let (status, value) = checked(&driven(swing, -1.0));
        assert_eq!((status, value["verdict"].as_str()), (3, Some("unusable")), "{value}");
        assert_eq!(codes_of(&value, "error"), ["FRK-D024"]);
    }
}
