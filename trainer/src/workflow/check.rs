//! What recordings are worth before anything is fitted to them.

use serde_json::{Value, json};

use super::actuator;
use super::recordings::{Warning, load_all, load_with_faults};
use super::source::{Reading, Source};
use crate::actuator::Kind;
use crate::checks::survey::{Fact, Motion, Seen, survey};
use crate::error::{Error, Result, codes};
use crate::figures::{digits, quantity};
use crate::fit::{Identifiable, identifiable};
use crate::joint::Joint;
use crate::recording::{Axis, Quantity, Recording};
use crate::report::tell::folded::{Noted, folded};
use crate::servo::{AsTorque, identify_or_start};

/// The quality of recordings, what can be identified from them and what to record next.
#[derive(Clone, Debug)]
pub struct Checked {
    verdict: &'static str,
    items: Vec<Item>,
    identified: Identifiable,
    /// Constants of an actuator that stands for a recorded torque.
    actuator: Option<Value>,
    /// 0 good or usable, 3 a recording is at fault, 4 nothing can be identified.
    pub status: u8,
}

/// One line of the result.
#[derive(Clone, Debug)]
struct Item {
    code: &'static str,
    severity: Severity,
    message: String,
    /// The recording that the message names, where it names one.
    recording: Option<String>,
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

/// Checks recordings of one joint. Where it reports no torque, that of its actuator is looked at, as `fit` takes it.
///
/// # Errors
/// Whatever reading a recording reports, and what keeps a recording from being looked at at all.
pub fn check(recordings: &[Source<'_>], joint: &Joint) -> Result<Checked> {
    let (recordings, warnings) = load_all(recordings.iter().copied(), |source| {
        load_with_faults(source, joint, Reading::of(&[], None, recordings.len()))
    })?;
    let mut items: Vec<Item> = warnings.iter().map(of_warning).collect();
    let survey_all = |recordings: &[Recording], is_told: &dyn Fn(&Seen) -> bool| {
        let one = |recording: &Recording| {
            let name = (recordings.len() > 1).then(|| recording.label.clone());
            let facts = survey(recording).into_iter().filter(|fact| is_told(&fact.seen));
            facts.map(|fact| of_fact(&fact, recording, name.as_deref())).collect::<Vec<_>>()
        };
        recordings.iter().flat_map(one).collect::<Vec<_>>()
    };
    let notes =
        recordings.iter().flat_map(|recording| recording.health.notes.iter().map(move |note| (recording, note)));
    items.extend(notes.map(|(recording, note)| Item {
        recording: (recordings.len() > 1).then(|| recording.label.clone()),
        ..Item::of_all(codes::CLOCK.id, Severity::Info, note)
    }));
    items.extend(survey_all(&recordings, &|_| true));
    let is_at_fault = items.iter().any(|item| item.severity == Severity::Error);
    // Beside a fault that cannot be put right no figure means anything.
    let (found, actuator) = if is_at_fault {
        (Ok(Identifiable::default()), None)
    } else if joint.actuator.kind == Kind::Torque {
        (identifiable(&recordings, joint), None)
    } else {
        match commanded(&recordings, joint) {
            Ok(Commanded { known, bare, constants, told }) => {
                items.extend(told);
                items.extend(survey_all(&known, &is_of_torque));
                (identifiable(&known, &bare), Some(constants))
            }
            Err(error) => (Err(error), None),
        }
    };
    let (identified, status) = match found {
        Ok(identified) => (identified, if is_at_fault { 3 } else { 0 }),
        Err(error) => {
            let status = error.exit_status();
            items.push(of_error(&error, Severity::Error));
            (Identifiable::default(), status)
        }
    };
    items.extend(identified.shares.iter().filter(|(_, share)| *share >= 1.0).map(of_unknown));
    let verdict = match items.iter().map(|item| item.severity).max() {
        Some(Severity::Error) => "unusable",
        Some(Severity::Warning) => "usable",
        _ => "good",
    };
    Ok(Checked { verdict, items, identified, actuator, status })
}

/// Recordings of commands under the torque of their actuator.
struct Commanded {
    known: Vec<Recording>,
    /// The joint that this torque moves.
    bare: Joint,
    constants: Value,
    told: Vec<Item>,
}

/// Takes the torque that the actuator makes of its commands, with constants that the recordings leave open where they start.
fn commanded(recordings: &[Recording], joint: &Joint) -> Result<Commanded> {
    let (identified, undetermined) = identify_or_start(recordings, joint)?;
    let way = AsTorque::of(recordings, joint, &identified);
    let sentence = actuator::sentence(&identified);
    let mut told = vec![Item::of_all(codes::ACTUATOR_TORQUE.id, Severity::Info, sentence.trim_end_matches('.'))];
    if let Some(error) = undetermined {
        told.push(of_error(&error, Severity::Warning));
    }
    let remarks = identified.remarks.iter().map(|remark| remark.trim_end_matches('.'));
    told.extend(remarks.map(|remark| Item::of_all(codes::ACTUATOR_TORQUE.id, Severity::Info, remark)));
    let (known, constants) = (way.known(recordings)?, actuator::constants(&identified));
    Ok(Commanded { known, bare: way.bare, constants, told })
}

/// Whether something is of the torque and not of the motion, which was looked at as it was recorded. A torque that is computed has no resolution of its own.
fn is_of_torque(seen: &Seen) -> bool {
    match seen {
        Seen::Constant { channel, .. } | Seen::AtLimit { channel, .. } => {
            [Quantity::Torque, Quantity::Force].iter().any(|quantity| channel == quantity.name())
        }
        Seen::Clock { .. }
        | Seen::Gaps { .. }
        | Seen::Resolution { .. }
        | Seen::Motion(_)
        | Seen::Temperature { .. } => false,
    }
}

impl Item {
    /// One that is of all recordings.
    fn of_all(code: &'static str, severity: Severity, message: &str) -> Self {
        Self { code, severity, message: message.to_owned(), recording: None, when_s: Vec::new() }
    }

    /// The message with the name of its recording.
    fn named(&self) -> String {
        let name = self.recording.as_ref().map_or_else(String::new, |name| format!("{name}: "));
        name + &self.message
    }
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
    let Noted { recording, sentence } = warning.noted();
    Item { code: warning.code(), severity, message: sentence, recording, when_s: warning.when_s().to_vec() }
}

/// An error with the place that it names: a column of the recording, or a key of joint.toml.
fn of_error(error: &Error, severity: Severity) -> Item {
    let place = error.column().map_or_else(String::new, |column| format!("{column}: "));
    Item::of_all(error.code().id, severity, &(place + error.message()))
}

fn of_unknown((name, _): &(String, f64)) -> Item {
    let message = format!("this motion says nothing of {name}: it may be nothing or all of the friction");
    Item::of_all(codes::UNIDENTIFIED.id, Severity::Warning, &message)
}

fn of_fact(fact: &Fact, recording: &Recording, name: Option<&str>) -> Item {
    let severity = if fact.is_poor { Severity::Warning } else { Severity::Info };
    let message = sentence(&fact.seen, recording);
    let recording = name.map(str::to_owned);
    Item { code: fact.seen.code().id, severity, message, recording, when_s: fact.when_s.clone() }
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
fn summary(Checked { verdict, items, identified, actuator, .. }: &Checked) -> Value {
    let item = |item: &Item| json!({"code": item.code, "severity": item.severity.name(), "message": item.named(), "when_s": item.when_s});
    let of = |is_known: bool| {
        let chosen = identified.shares.iter().filter(move |(_, share)| (*share < 1.0) == is_known);
        chosen.map(|(name, share)| json!({"name": name, "within_share_of_friction": share})).collect::<Vec<_>>()
    };
    let mut summary = json!({
        "schema": "frikan.check/1",
        "verdict": verdict,
        "items": items.iter().map(item).collect::<Vec<_>>(),
        "identifiable": of(true),
        "not_identifiable": of(false),
        "record_next": identified.record_next,
    });
    if let Some(constants) = actuator {
        summary["actuator"] = constants.clone();
    }
    summary
}

fn text(Checked { verdict, items, identified, .. }: &Checked) -> String {
    let mut text = format!("{verdict}\n\n");
    let mut groups: Vec<((Severity, &str), Vec<Noted>)> = Vec::new();
    for item in items {
        let (group, noted) =
            ((item.severity, item.code), Noted { recording: item.recording.clone(), sentence: item.message.clone() });
        match groups.iter_mut().find(|(other, _)| *other == group) {
            Some((_, notes)) => notes.push(noted),
            None => groups.push((group, vec![noted])),
        }
    }
    for ((severity, code), notes) in groups {
        for sentence in folded(&notes) {
            text += &format!("{:<8} {code} {sentence}\n", severity.name());
        }
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
