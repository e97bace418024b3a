//! A diagnosis in plain words: one sentence a finding, with numbers and confidence. Knows no terminal and no page.

use super::localise::Region;
use super::outcome::{Diagnosis, Finding, Verdict};
use crate::parameter::Parameter;
use crate::physics::{Action, EffectId};

/// Quantile of the effect's torque that "up to" stands for.
const UP_TO: f64 = 0.98;
/// Least surplus of the share of evidence over the share of samples at which a region is worth naming.
const TELLING_REGION: f64 = 0.12;
/// Share of the torque that has to point one way before a sentence says "more" or "less".
const ONE_WAY: f64 = 0.5;

/// What the recording is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units {
    /// Unit of the actuator as printed: `N m`, `N` or `A`.
    pub actuator: &'static str,
    /// Whether the axis turns (else it slides).
    pub rotary: bool,
}

impl Units {
    /// Unit of a channel or derived axis, as printed.
    #[must_use]
    pub fn of_channel(self, channel: &str) -> String {
        let position = if self.rotary { "rad" } else { "m" };
        match channel {
            "velocity" | "other_joint" => format!("{position}/s"),
            "position" | "distance_since_reversal" => position.to_string(),
            "acceleration" => format!("{position}/s2"),
            "load" => self.actuator.to_string(),
            "temperature" => "degC".to_string(),
            "time" | "time_since_reversal" | "dwell" => "s".to_string(),
            _ => String::new(),
        }
    }
}

/// Everything there is to say, in the order in which it should be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Story {
    /// The answer in one sentence.
    pub headline: String,
    /// What is wrong with the measurement.
    pub health: Vec<String>,
    /// One sentence a finding.
    pub findings: Vec<String>,
    /// Error before and after on locked data.
    pub proof: Option<String>,
    /// What was found beside the findings and accounts for little.
    pub minor: Option<String>,
    /// What was found at first and then withdrawn.
    pub withdrawn: Option<String>,
    /// What would have been seen.
    pub limits: Option<String>,
}

/// Tells a diagnosis.
#[must_use]
pub fn tell(diagnosis: &Diagnosis, units: Units) -> Story {
    Story {
        headline: headline(diagnosis, units),
        health: diagnosis.health.iter().map(|note| capital(&format!("{}.", note.sentence))).collect(),
        findings: (0..diagnosis.findings.len()).map(|index| finding(diagnosis, index, units)).collect(),
        proof: proof(diagnosis, units),
        minor: minor(diagnosis),
        withdrawn: withdrawn(diagnosis),
        limits: limits(diagnosis, units),
    }
}

fn headline(diagnosis: &Diagnosis, units: Units) -> String {
    let noise = quantity(diagnosis.noise_rmse, units.actuator);
    match diagnosis.verdict {
        Verdict::Consistent => {
            format!("Nothing is missing that this recording could show: what the model leaves, {noise}, is noise.")
        }
        Verdict::MissingPhysics => {
            let count = diagnosis.findings.len();
            let effects = if count == 1 { "One effect is".to_string() } else { format!("{count} effects are") };
            format!(
                "{effects} missing from the model: it is wrong by {}, of which {noise} is noise.",
                quantity(diagnosis.baseline.rmse, units.actuator)
            )
        }
        Verdict::Unexplained => format!(
            "Something structured is missing that the catalogue does not hold: the model is wrong by {}, of which \
             {noise} is noise.",
            quantity(diagnosis.baseline.rmse, units.actuator)
        ),
        Verdict::BadData => "The measurement has to be put right before anything can be said of the physics.".into(),
    }
}

/// The sentence of one finding.
#[must_use]
pub fn finding(diagnosis: &Diagnosis, index: usize, units: Units) -> String {
    let found = &diagnosis.findings[index];
    if found.fitted.coefficients.is_empty() {
        return format!("{}. {}{}", capital(plain_name(found.effect)), certainty(found), action(found));
    }
    let telling = found.location.regions.first().filter(|r| r.share_of_excess - r.share_of_samples > TELLING_REGION);
    let place = telling.map_or_else(|| "Over the whole motion".to_string(), |region| place(region, units));
    let amount = amount(diagnosis, index, telling, units);
    let name = match found.effect {
        EffectId::Unknown => format!("{} ({})", plain_name(found.effect), found.equation),
        effect => plain_name(effect).to_string(),
    };
    let figures = figures(found);
    let certainty = certainty(found);
    format!("{place} {amount}: {name}{figures}. {certainty}{}", action(found))
}

/// Where a region is, as the start of a sentence.
fn place(region: &Region, units: Units) -> String {
    let unit = units.of_channel(region.channel);
    let between = interval(region.from, region.to, &unit);
    let from_zero = region.from.abs() < 0.03 * region.to.abs();
    match region.channel {
        "velocity" => format!("Between {between}"),
        "position" => format!("At positions between {between}"),
        "load" => format!("Under loads between {between}"),
        "temperature" => format!("At temperatures between {between}"),
        "acceleration" => format!("At accelerations between {between}"),
        "time" => format!("Between {between} of the recording"),
        "dwell" => format!("After stops between {between}"),
        "distance_since_reversal" | "time_since_reversal" if from_zero => {
            format!("Within {} after each reversal", quantity(region.to, &unit))
        }
        "distance_since_reversal" | "time_since_reversal" => format!("Between {between} after each reversal"),
        _ => format!("While the other joint moves between {between}"),
    }
}

/// How much torque the real joint needs, and in which direction.
fn amount(diagnosis: &Diagnosis, index: usize, region: Option<&Region>, units: Units) -> String {
    let traces = &diagnosis.traces;
    let Some(effect) = traces.effects.get(index) else { return "the real joint differs".to_string() };
    let inside: Vec<usize> = match region.and_then(|r| traces.channel(r.channel).map(|values| (r, values))) {
        Some((r, values)) => (0..effect.len()).filter(|&i| values[i] >= r.from && values[i] <= r.to).collect(),
        None => (0..effect.len()).collect(),
    };
    let mut sizes: Vec<f64> = inside.iter().map(|&i| effect[i].abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let largest = sizes.get(((sizes.len().max(1) - 1) as f64 * UP_TO).round() as usize).copied().unwrap_or(0.0);
    let total: f64 = sizes.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let along: f64 = inside.iter().map(|&i| effect[i] * traces.velocity[i].signum()).sum::<f64>() / total;
    let upward: f64 = inside.iter().map(|&i| effect[i]).sum::<f64>() / total;
    let size = quantity(largest, units.actuator);
    if along.abs() > ONE_WAY && along.abs() >= upward.abs() {
        format!("the real joint needs up to {size} {}", if along > 0.0 { "more" } else { "less" })
    } else if upward.abs() > ONE_WAY {
        let direction = if upward > 0.0 { "positive" } else { "negative" };
        format!("the real joint needs up to {size} more in the {direction} direction")
    } else {
        format!("the real joint needs up to {size} more or less")
    }
}

/// The parameters that say most, at most two.
fn figures(found: &Finding) -> String {
    let told: Vec<String> = telling_parameters(found).into_iter().map(figure).collect();
    if told.is_empty() { String::new() } else { format!(", {}", told.join(", ")) }
}

/// Shapes say more than amplitudes, which the sentence has given already.
fn telling_parameters(found: &Finding) -> Vec<&Parameter> {
    let linear = found.fitted.coefficients.len().min(found.parameters.len());
    let (amplitudes, shapes) = found.parameters.split_at(linear);
    let shapes: Vec<&Parameter> = shapes.iter().take(2).collect();
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

fn certainty(found: &Finding) -> String {
    let sure = format!("Probability {:.0} %", 100.0 * found.probability);
    let others: Vec<String> = found
        .alternatives
        .iter()
        .map(|(effect, probability)| format!("{} ({})", plain_name(*effect), percent(*probability)))
        .collect();
    if others.is_empty() {
        format!("{sure}.")
    } else {
        format!("{sure}; this recording cannot rule out {}.", others.join(" or "))
    }
}

fn percent(share: f64) -> String {
    if share < 0.01 { "below 1 %".to_string() } else { format!("{:.0} %", 100.0 * share) }
}

fn action(found: &Finding) -> &'static str {
    match found.action {
        Action::FeedForward => "",
        Action::Parameter => " A parameter of the model is to be corrected.",
        Action::Measurement => " The measurement is to be repaired, not compensated.",
        Action::Maintenance if found.effect == EffectId::Unknown => " It is not compensated.",
        Action::Maintenance => " Have the joint looked at; it is not compensated.",
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
    Some(format!(
        "Held-out error {} -> {} on {} rows that took no part in fitting or choosing (ratio {}{interval}).",
        digits(proof.baseline_rmse),
        quantity(proof.improved_rmse, units.actuator),
        proof.rows,
        digits(ratio),
    ))
}

fn minor(diagnosis: &Diagnosis) -> Option<String> {
    let named = |(effect, share): &(EffectId, f64)| {
        format!("{} ({:.1} % of the removable error)", plain_name(*effect), 100.0 * share.max(0.0))
    };
    let names: Vec<String> = diagnosis.minor.iter().map(named).collect();
    (!names.is_empty()).then(|| format!("Of little account beside it, and not modelled: {}.", names.join(", ")))
}

fn withdrawn(diagnosis: &Diagnosis) -> Option<String> {
    let names: Vec<&str> = diagnosis.withdrawn.iter().map(|effect| plain_name(*effect)).collect();
    (!names.is_empty()).then(|| format!("Withdrawn, because held-out data did not confirm it: {}.", names.join(", ")))
}

/// The three effects that would have been seen soonest, of those a user asks for first.
fn limits(diagnosis: &Diagnosis, units: Units) -> Option<String> {
    let mut limits: Vec<_> = diagnosis.limits.iter().collect();
    limits.sort_by(|a, b| a.torque_rms.total_cmp(&b.torque_rms));
    let told: Vec<String> = limits
        .iter()
        .take(3)
        .map(|limit| format!("{} above {}", plain_name(limit.effect), quantity(limit.torque_rms, units.actuator)))
        .collect();
    (!told.is_empty()).then(|| format!("Would have been seen (root mean square): {}.", told.join(", ")))
}

/// An effect's name for people.
#[must_use]
pub fn plain_name(effect: EffectId) -> &'static str {
    use EffectId::*;
    match effect {
        Stribeck => "Stribeck friction",
        ViscousNonlinearity => "viscous friction that grows with a power of speed",
        DirectionAsymmetry => "friction that differs between the directions",
        Temperature => "friction that depends on temperature",
        WarmUp => "friction that falls as the joint warms itself up",
        LoadFriction => "load-dependent friction",
        DriveBackdrive => "gear losses that differ between driving and backdriving",
        SlowDrift => "friction that drifts with time",
        Presliding => "presliding hysteresis",
        FrictionalLag => "frictional lag",
        DwellBreakaway => "break-away that grows with the stop before it",
        PositionRipple => "torque ripple over position",
        KinematicError => "kinematic error of the gear",
        PositionFriction => "friction that depends on position",
        GravityError => "wrong gravity torque",
        InertiaError => "wrong inertia",
        TorqueScale => "wrong torque constant",
        TorqueOffset => "torque offset",
        Spring => "spring of a cable, hose or balancer",
        Coupling => "inertial coupling with another joint",
        Saturation => "saturated actuator",
        Contact => "hard stop or contact",
        TransientEvent => "one-off event",
        RecurrentFault => "local fault that comes back at one angle",
        Backlash => "backlash",
        Elasticity => "elastic transmission",
        WindupHysteresis => "windup hysteresis of the transmission",
        TimeMisalignment => "torque and position recorded out of step",
        Quantisation => "encoder too coarse",
        UnitOrSign => "wrong unit or sign",
        Unknown => "a structure that the catalogue does not hold",
    }
}

/// A value with its unit, three digits, in milli or micro where that reads better.
#[must_use]
pub fn quantity(value: f64, unit: &str) -> String {
    if unit == "1" || unit.is_empty() {
        return digits(value);
    }
    let (factor, prefix) = prefix(value, unit);
    format!("{} {prefix}{unit}", digits(value * factor))
}

fn interval(from: f64, to: f64, unit: &str) -> String {
    let (factor, prefix) = prefix(from.abs().max(to.abs()), unit);
    format!("{} and {} {prefix}{unit}", digits(from * factor), digits(to * factor))
}

fn prefix(value: f64, unit: &str) -> (f64, &'static str) {
    let plain = matches!(unit, "rad" | "m" | "s" | "N" | "N m" | "A" | "rad/s" | "m/s");
    match value.abs() {
        size if !plain || size == 0.0 => (1.0, ""),
        size if size < 1e-4 => (1e6, "u"),
        size if size < 0.02 => (1e3, "m"),
        _ => (1.0, ""),
    }
}

/// Three significant digits; powers of ten only where plain digits would be long.
#[must_use]
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_string() } else { format!("{value}") };
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.2e}");
    }
    let decimals = (2 - size.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

pub(crate) fn capital(sentence: &str) -> String {
    let mut characters = sentence.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::{Advice, BaseKind, Fitted, Label, Location, Proof, Refit, Score, Traces};

    const ROTARY: Units = Units { actuator: "N m", rotary: true };

    fn region(channel: &'static str, from: f64, to: f64) -> Region {
        Region { channel, from, to, share_of_excess: 0.9, share_of_samples: 0.1 }
    }

    fn presliding(channel: &'static str, from: f64, to: f64) -> Finding {
        let distance = Parameter {
            name: "breakaway_distance".into(),
            symbol: "delta".into(),
            value: 1.2e-3,
            unit: "rad".into(),
            ci95: [1.1e-3, 1.3e-3],
        };
        let torque = Parameter { name: "presliding_torque".into(), value: 3.1, unit: "N m".into(), ..distance.clone() };
        let fitted = Fitted {
            label: Label::Named(EffectId::Presliding),
            shape: vec![1.2e-3],
            shape_deviation: vec![None],
            coefficients: vec![3.1],
            deviation: vec![0.1],
        };
        Finding {
            effect: EffectId::Presliding,
            probability: 0.97,
            alternatives: vec![(EffectId::FrictionalLag, 0.02)],
            action: Action::FeedForward,
            equation: String::new(),
            parameters: vec![torque, distance],
            location: Location { regions: vec![region(channel, from, to)], when_s: Vec::new() },
            evidence: String::new(),
            separate_by: Advice { sentence: String::new() },
            fitted,
            score: 40.0,
            margin: 9.0,
            standings: Vec::new(),
            locked_gain_nats: Some(20.0),
        }
    }

    fn diagnosis(found: Finding) -> Diagnosis {
        let refit = || Refit {
            base: Vec::new(),
            base_deviation: Vec::new(),
            effects: Vec::new(),
            noise: crate::diagnose::Noise::white(0),
            plain: false,
        };
        let velocity: Vec<f64> = (-50..50).map(|k| 0.002 * f64::from(k) + 0.001).collect();
        let effect: Vec<f64> = velocity.iter().map(|v| -3.1 * v.signum() * f64::from(v.abs() < 0.05)).collect();
        let traces = Traces { time: velocity.clone(), velocity, effects: vec![effect], ..Traces::default() };
        Diagnosis {
            verdict: Verdict::MissingPhysics,
            health: Vec::new(),
            findings: vec![found],
            minor: vec![(EffectId::Presliding, 0.042)],
            withdrawn: vec![EffectId::Spring],
            limits: Vec::new(),
            base: BaseKind::CoulombViscous,
            base_parameters: Vec::new(),
            noise_rmse: 0.4,
            baseline: Score { rmse: 0.92, r2: 0.9 },
            improved: Score { rmse: 0.41, r2: 0.98 },
            proof: Some(Proof {
                baseline_rmse: 0.92,
                improved_rmse: 0.41,
                ratio_ci95: [0.4, 0.5],
                gain_nats: 20.0,
                rows: 300,
            }),
            rollout: None,
            rivals: Vec::new(),
            baseline_refit: refit(),
            improved_refit: refit(),
            cut_off_hz: 20.0,
            rows: 1500,
            sampling_delay_s: 0.0,
            traces,
        }
    }

    #[test]
    fn a_finding_reads_as_a_sentence() {
        let story = tell(&diagnosis(presliding("velocity", -0.05, 0.05)), ROTARY);
        assert_eq!(
            story.findings[0],
            "Between -0.05 and 0.05 rad/s the real joint needs up to 3.1 N m less: presliding hysteresis, breakaway \
             distance 1.2 mrad (\u{b1} 100 urad). Probability 97 %; this recording cannot rule out frictional lag (2 %)."
        );
        assert_eq!(
            story.headline,
            "One effect is missing from the model: it is wrong by 0.92 N m, of which 0.4 N m is noise."
        );
        assert_eq!(
            story.proof.unwrap(),
            "Held-out error 0.92 -> 0.41 N m on 300 rows that took no part in fitting or choosing (ratio 0.446, 95 % \
             interval 0.4 to 0.5)."
        );
        assert!(story.withdrawn.unwrap().contains("spring"));
        assert!(story.minor.unwrap().contains("4.2 %"));
    }

    #[test]
    fn a_region_from_a_reversal_on_says_so() {
        let sentence = finding(&diagnosis(presliding("distance_since_reversal", 1e-6, 0.004)), 0, ROTARY);
        assert!(sentence.starts_with("Within 4 mrad after each reversal the real joint needs up to"), "{sentence}");
    }

    #[test]
    fn figures_have_three_digits_and_a_fitting_prefix() {
        let shown: Vec<String> =
            [0.0, 1.0, -12.345, 1234.5, 2.5e-5].into_iter().map(|value| quantity(value, "rad")).collect();
        assert_eq!(shown, ["0 rad", "1 rad", "-12.3 rad", "1234 rad", "25 urad"]);
        assert_eq!(quantity(0.0021, "N m s/rad"), "0.0021 N m s/rad");
    }
}
