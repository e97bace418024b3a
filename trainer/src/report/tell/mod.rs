//! A diagnosis in plain words: one sentence a finding, with numbers and confidence. Knows no terminal and no page.

pub(super) mod certainty;
mod discarded;
pub mod evidence;
pub mod folded;
pub mod measurement;
pub mod recording_note;
#[cfg(test)]
mod tests;

use crate::diagnose::answer::outcome::{Diagnosis, Estimate, Finding, Verdict};
use crate::diagnose::answer::region::{Region, Side};
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::checks::note::{HealthNote, Observation};
use crate::figures::{digits, pair, quantity};
use crate::parameter::Parameter;
use crate::physics::names::{capital, plain_name};
use crate::physics::units::Units;
use crate::physics::{Action, EffectId};
use crate::report::tell::certainty::certainty;
use discarded::{doubtful, listed, minor, negligible};
use evidence::{parameter, parameters, sealed_sentence};
use folded::{Noted, folded};
use measurement::observation;

/// Quantile of the effect's torque that a sentence states as its largest. Chosen by judgement: the largest value itself may be
/// that of a single sample.
const LARGEST_TORQUE_QUANTILE: f64 = 0.98;
/// Share (0..1) of an effect's torque in one direction, above which a sentence says so. Chosen by judgement: three quarters against
/// one quarter; lower calls a ripple a direction.
const ONE_DIRECTION_SHARE: f64 = 0.5;

/// Error of a given model over that after a refit of its parameters, above which the change is stated. Chosen by judgement: a refit
/// gains some per cent by noise.
const LEAST_CHANGE_RATIO: f64 = 1.05;

/// Everything there is to say, in the order in which it should be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Story {
    /// The answer in one sentence.
    pub headline: String,
    /// The simulation or model as it was given: what it holds itself, and what its own parameters have to change by.
    pub given: Vec<String>,
    /// What is wrong with the measurement.
    pub health: Vec<String>,
    /// One sentence a finding.
    pub findings: Vec<String>,
    /// Error of the written model on rows that decided nothing, where there is one.
    pub sealed: Option<String>,
    /// Error before and after on locked data.
    pub proof: Option<String>,
    /// What was found beside the findings and accounts for little.
    pub minor: Option<String>,
    /// What was found and may be an error of the law that the recording is compared with.
    pub doubtful: Option<String>,
    /// What was found and is too small to matter.
    pub negligible: Option<String>,
    /// What was found at first and then withdrawn.
    pub withdrawn: Option<String>,
    /// What was found and may be no torque at all.
    pub undetermined: Option<String>,
    /// What would have been seen.
    pub limits: Option<String>,
}

impl Story {
    /// What follows the findings.
    pub fn rest(&self) -> impl Iterator<Item = &String> {
        [&self.sealed, &self.proof].into_iter().flatten().chain(self.beside()).chain(&self.limits)
    }

    /// What was found and is no finding.
    pub fn beside(&self) -> impl Iterator<Item = &String> {
        [&self.minor, &self.doubtful, &self.negligible, &self.withdrawn, &self.undetermined].into_iter().flatten()
    }
}

const WITHDRAWN: &str = "Withdrawn, because held-out data did not confirm it";
const UNDETERMINED: &str = "Not named, because the 95 % interval of its size includes zero on this recording";

/// Tells a diagnosis, with the error of the written model on rows that decided nothing where there is one.
#[must_use]
pub fn tell(diagnosis: &Diagnosis, sealed: Option<&SealedScore>, units: Units) -> Story {
    Story {
        sealed: sealed.filter(|_| !diagnosis.findings.is_empty()).map(|score| sealed_sentence(score, units)),
        headline: headline(diagnosis, units),
        given: given(diagnosis, units),
        health: health(diagnosis, units),
        findings: (0..diagnosis.findings.len()).map(|index| finding(diagnosis, index, units)).collect(),
        proof: proof(diagnosis, units),
        minor: minor(diagnosis),
        doubtful: doubtful(diagnosis, units),
        negligible: negligible(diagnosis, units),
        withdrawn: listed(WITHDRAWN, &diagnosis.discarded.withdrawn),
        undetermined: listed(UNDETERMINED, &diagnosis.discarded.undetermined),
        limits: limits(diagnosis, units),
    }
}

/// What was seen of the measurement, each once.
fn health(diagnosis: &Diagnosis, units: Units) -> Vec<String> {
    let noted = |note: &HealthNote| match &note.observation {
        Observation::Recording(found) => recording_note::noted(found, units),
        other => Noted { recording: None, sentence: observation(other, units) },
    };
    let notes: Vec<Noted> = diagnosis.health.iter().map(noted).collect();
    folded(&notes).iter().map(|sentence| capital(&format!("{sentence}."))).collect()
}

fn headline(diagnosis: &Diagnosis, units: Units) -> String {
    let noise = quantity(diagnosis.noise_rmse, units.actuator);
    match diagnosis.verdict {
        Verdict::Consistent => {
            let beside = if diagnosis.discarded.doubtful.is_empty() { "" } else { " or the error of its law" };
            format!(
                "Nothing is missing that this recording could show: what the model leaves, {noise}, is noise{beside}."
            )
        }
        Verdict::MissingPhysics => {
            let count = diagnosis.findings.len();
            let effects = if count == 1 { "One effect is".to_string() } else { format!("{count} effects are") };
            format!(
                "{effects} missing from the model: its error is {} (root mean square), and noise alone would leave {noise}.",
                quantity(diagnosis.baseline.rmse, units.actuator)
            )
        }
        Verdict::Unexplained => format!(
            "A structure is missing that no effect of the catalogue explains: the model's error is {} (root mean square), and \
             noise alone would leave {noise}.",
            quantity(diagnosis.baseline.rmse, units.actuator)
        ),
        Verdict::BadData if diagnosis.is_blocked() => {
            "The measurement has to be put right before anything can be said of the physics.".into()
        }
        Verdict::BadData => {
            "The measurement is at fault; beside that nothing is missing that this recording could show.".into()
        }
    }
}

/// What a simulation or a model holds itself, and how far it is wrong before its own parameters move.
fn given(diagnosis: &Diagnosis, units: Units) -> Vec<String> {
    let Some(given) = &diagnosis.given else { return Vec::new() };
    let mut sentences = Vec::new();
    if !given.holds.is_empty() {
        // An effect that repeats, a ripple of several orders, is said once.
        let is_first = |(index, effect): &(usize, &EffectId)| !given.holds[..*index].contains(effect);
        let once = given.holds.iter().enumerate().filter(is_first);
        let names: Vec<&str> = once.map(|(_, effect)| plain_name(*effect)).collect();
        sentences.push(format!("Found in the simulation itself, and so not missing from it: {}.", names.join(", ")));
    }
    let (as_given, refitted) = (given.score.rmse, diagnosis.baseline.rmse);
    if as_given > LEAST_CHANGE_RATIO * refitted {
        let [as_given, refitted] = [as_given, refitted].map(|rmse| quantity(rmse, units.actuator));
        let changes: Vec<String> = parameters(&diagnosis.base_parameters, units).iter().filter_map(change).collect();
        let changes = if changes.is_empty() { String::new() } else { format!(": {}", changes.join(", ")) };
        sentences.push(format!(
            "As it was given, the model is wrong by {as_given}; refitting its own parameters leaves {refitted}{changes}."
        ));
    }
    sentences
}

/// How far a parameter of the given model is off, where that is certain.
fn change(parameter: &Parameter) -> Option<String> {
    let name = parameter.name.strip_suffix("_change")?.replace('_', " ");
    let is_certain = parameter.ci95[0] * parameter.ci95[1] > 0.0;
    let direction = if parameter.value > 0.0 { "too low" } else { "too high" };
    let [size, half] = [parameter.value.abs(), 0.5 * (parameter.ci95[1] - parameter.ci95[0])];
    let [size, half] = [size, half].map(|figure| quantity(figure, &parameter.unit));
    is_certain.then(|| format!("its {name} is {size} (\u{b1} {half}) {direction}"))
}

/// The sentence of one finding.
#[must_use]
pub fn finding(diagnosis: &Diagnosis, index: usize, units: Units) -> String {
    let found = &diagnosis.findings[index];
    if !adds_torque(found) {
        let name = capital(plain_name(found.effect));
        return format!("{name}{}. {}{}", figures(found, units), certainty(found), action(found));
    }
    let (place, amount) = (whereabouts(found, units), amount(diagnosis, index, units));
    let name = match found.effect {
        EffectId::Unknown => format!("{} ({})", plain_name(found.effect), found.equation),
        effect => plain_name(effect).to_string(),
    };
    let figures = figures(found, units);
    let certainty = certainty(found);
    format!("{} {amount}: {name}{figures}. {certainty}{}", capital(&place), action(found))
}

/// Whether a finding adds torque of which to say where and how much; a fault of the measurement does not.
pub(super) fn adds_torque(found: &Finding) -> bool {
    let is_of_measurement = found.fitted.coefficients.is_empty() && found.effect != EffectId::Unknown;
    !is_of_measurement && found.effect != EffectId::TimeMisalignment
}

/// Where a finding is, in small letters and without a full stop.
pub(super) fn whereabouts(found: &Finding, units: Units) -> String {
    found.location.named().map_or_else(|| "over the whole motion".to_string(), |region| place(region, units))
}

/// Where a region is, as a sentence begins, in small letters.
fn place(region: &Region, units: Units) -> String {
    region.sides().map(|side| place_along(side, units)).collect::<Vec<_>>().join(" and ")
}

/// Where an interval is, as a sentence begins, in small letters.
fn place_along(side: &Side, units: Units) -> String {
    let unit = units.of_channel(side.channel);
    let between = pair(side.from, "and", side.to, &unit);
    let from_zero = side.from.abs() < 0.03 * side.to.abs();
    match side.channel {
        "velocity" => format!("between {between}"),
        "position" => format!("at positions between {between}"),
        "load" => format!("under loads between {between}"),
        "temperature" => format!("at temperatures between {between}"),
        "acceleration" => format!("at accelerations between {between}"),
        "time" => format!("between {between} of the recording"),
        "dwell" if side.to <= 0.0 => "after reversals without a stop".to_string(),
        "dwell" => format!("after stops between {between}"),
        "distance_since_reversal" | "time_since_reversal" if from_zero => {
            format!("within {} after each reversal", quantity(side.to, &unit))
        }
        "distance_since_reversal" | "time_since_reversal" => format!("between {between} after each reversal"),
        _ => format!("while the other joint moves between {between}"),
    }
}

/// How much torque the real joint needs, and in which direction.
pub(super) fn amount(diagnosis: &Diagnosis, index: usize, units: Units) -> String {
    let region = diagnosis.findings[index].location.named();
    let traces = &diagnosis.traces;
    let Some(effect) = traces.effects.get(index) else { return "the real joint differs".to_string() };
    let sides: Vec<(&Side, &[f64])> = region
        .into_iter()
        .flat_map(Region::sides)
        .filter_map(|side| Some((side, traces.channel(side.channel)?)))
        .collect();
    let is_inside = |i: &usize| sides.iter().all(|(side, values)| (side.from..=side.to).contains(&values[*i]));
    let inside: Vec<usize> = (0..effect.len()).filter(is_inside).collect();
    let mut sizes: Vec<f64> = inside.iter().map(|&i| effect[i].abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let largest =
        sizes.get(((sizes.len().max(1) - 1) as f64 * LARGEST_TORQUE_QUANTILE).round() as usize).copied().unwrap_or(0.0);
    let total: f64 = sizes.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let along: f64 = inside.iter().map(|&i| effect[i] * traces.velocity[i].signum()).sum::<f64>() / total;
    let upward: f64 = inside.iter().map(|&i| effect[i]).sum::<f64>() / total;
    let size = quantity(largest, units.actuator);
    if along.abs() > ONE_DIRECTION_SHARE && along.abs() >= upward.abs() {
        format!("the real joint needs up to {size} {}", if along > 0.0 { "more" } else { "less" })
    } else if upward.abs() > ONE_DIRECTION_SHARE {
        let direction = if upward > 0.0 { "positive" } else { "negative" };
        format!("the real joint needs up to {size} more in the {direction} direction")
    } else {
        format!("the real joint differs by up to {size} in either direction")
    }
}

/// The parameters that say most, at most two.
fn figures(found: &Finding, units: Units) -> String {
    let stated: Vec<String> =
        main_parameters(found).into_iter().map(|estimate| figure(&parameter(estimate, units))).collect();
    if stated.is_empty() { String::new() } else { format!(", {}", stated.join(", ")) }
}

/// Shapes say more than amplitudes, which the sentence has given already.
fn main_parameters(found: &Finding) -> Vec<&Estimate> {
    let linear = found.fitted.coefficients.len().min(found.parameters.len());
    let (amplitudes, shapes) = found.parameters.split_at(linear);
    // Which joint it is says nothing of how much.
    let shapes: Vec<&Estimate> = shapes.iter().filter(|shape| shape.name != "other_joint").take(2).collect();
    if shapes.is_empty() && linear <= 3 { amplitudes.iter().take(2).collect() } else { shapes }
}

fn figure(parameter: &Parameter) -> String {
    let half = 0.5 * (parameter.ci95[1] - parameter.ci95[0]);
    let name = parameter.name.replace('_', " ");
    let value = quantity(parameter.value, &parameter.unit);
    if half > 0.0 && half.is_finite() {
        format!("{name} {value} (\u{b1} {})", quantity(half, &parameter.unit))
    } else {
        format!("{name} {value}")
    }
}

fn action(found: &Finding) -> &'static str {
    match found.action {
        Action::FeedForward => "",
        Action::Parameter if found.effect.is_of_actuator() => {
            " The constant of the actuator is to be corrected, in joint.toml and in the simulator."
        }
        Action::Parameter => " A parameter of the model is to be corrected.",
        Action::Measurement => " The measurement is to be repaired, not compensated.",
        Action::Maintenance if found.effect == EffectId::Unknown => " It is not compensated.",
        Action::Maintenance => " The joint is to be inspected; it is not compensated.",
    }
}

fn proof(diagnosis: &Diagnosis, units: Units) -> Option<String> {
    let proof = diagnosis.proof.as_ref()?;
    if diagnosis.findings.is_empty() || diagnosis.verdict == Verdict::BadData {
        return None;
    }
    let ratio = proof.improved_rmse / proof.baseline_rmse.max(f64::MIN_POSITIVE);
    let interval = if proof.ratio_ci95[1].is_finite() {
        format!(", 95 % interval {} to {}", digits(proof.ratio_ci95[0]), digits(proof.ratio_ci95[1]))
    } else {
        String::new()
    };
    Some(
        format!(
            "Held-out error {} on {} rows that took no part in fitting and could only withdraw a finding \
         (ratio {}{interval}).",
            pair(proof.baseline_rmse, "->", proof.improved_rmse, units.actuator),
            proof.rows,
            digits(ratio),
        ) + &rollout(diagnosis, units),
    )
}

/// How far a simulation comes off before and after, where there is one.
fn rollout(diagnosis: &Diagnosis, units: Units) -> String {
    let Some(rollout) = &diagnosis.rollout else { return String::new() };
    let unit = units.of_channel("position");
    format!(
        " Simulated under the recorded torque for {} s from {} recorded states of these rows, the joint comes off by {} (mean absolute error of \
         the position), {} (root mean square) and at most {}.",
        digits(rollout.horizon_s),
        rollout.starts,
        pair(rollout.baseline_mae, "->", rollout.improved_mae, &unit),
        pair(rollout.baseline_rmse, "->", rollout.improved_rmse, &unit),
        pair(rollout.baseline_max, "->", rollout.improved_max, &unit),
    )
}

/// The three effects that would have been seen soonest, of those a user asks for first.
fn limits(diagnosis: &Diagnosis, units: Units) -> Option<String> {
    let mut limits: Vec<_> = diagnosis.limits.iter().collect();
    limits.sort_by(|a, b| a.torque_rms.total_cmp(&b.torque_rms));
    let stated: Vec<String> = limits
        .iter()
        .take(3)
        .map(|limit| format!("{} above {}", plain_name(limit.effect), quantity(limit.torque_rms, units.actuator)))
        .collect();
    (!stated.is_empty()).then(|| format!("Detection limits (root mean square): {}.", stated.join(", ")))
}
