//! What the tables need of an outcome, and rates with intervals.

use super::intervals::{Held, held};
use super::{Case, Hidden, Outcome};
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::physics::EffectId;

/// The models that a diagnosis may start from.
pub const BASES: [BaseKind; 3] = [BaseKind::CoulombViscous, BaseKind::Spline, BaseKind::Reference];

/// A base model in words.
pub fn base_name(base: BaseKind) -> &'static str {
    match base {
        BaseKind::CoulombViscous => "Coulomb and viscous friction",
        BaseKind::Spline => "a spline of nine coefficients",
        BaseKind::Reference => "a Stribeck law fitted to the recording",
    }
}

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
    /// Channels that an unnamed finding states, likeliest first.
    pub unknown_channels: Vec<&'static str>,
    /// Share of the removable error that is removed on locked rows, from Coulomb and viscous friction.
    pub removed_share: Option<f64>,
    /// Parameters of a right finding of which the truth is known.
    pub held: Vec<Held>,
}

impl Row {
    /// Keeps what the tables need.
    pub fn of(outcome: &Outcome) -> Self {
        let d = &outcome.diagnosis;
        let strength = outcome.concealed.strength.as_ref();
        let findings = d
            .findings
            .iter()
            .map(|f| (f.effect, f.alternatives.iter().map(|(e, _)| *e).collect(), f.probability))
            .collect();
        Self {
            case: outcome.case.clone(),
            lambda: strength.map_or(0.0, |s| s.lambda),
            effect_to_noise: strength.map_or(0.0, |s| s.effect_to_noise),
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

    /// Whether an effect was hidden at a non-centrality of 50 or more: as wanted, for a fault of the measurement has none.
    pub fn is_strong(&self) -> bool {
        matches!(self.case.hidden, Hidden::Effect(_, wanted) | Hidden::Pair(_, _, wanted) if wanted >= 50.0)
    }

    /// Whether a one-off event was hidden.
    pub fn is_one_off(&self) -> bool {
        matches!(self.case.hidden, Hidden::Effect("transient_event", _))
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

    /// Whether a structure outside the catalogue is said to hang on a channel on which it depends: on the first that is stated,
    /// or on any of them.
    pub fn channels_are_right(&self) -> [bool; 2] {
        let Hidden::Effect(name, _) = self.case.hidden else { return [false; 2] };
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
        let right = |found: &&str| channels.contains(found);
        [self.unknown_channels.first().is_some_and(right), self.unknown_channels.iter().any(right)]
    }
}

/// What the baseline leaves besides the noise, less what the improved model leaves of it, over what somebody who knows the
/// hidden torque could take away. The noise is known here, so that its chance on the locked rows hides nothing.
fn removed_share(outcome: &Outcome) -> Option<f64> {
    let strength = outcome.strength_as_diagnosed()?;
    let traces = &outcome.diagnosis.traces;
    // What is found of a delay is put back too: such a recording may keep other rows.
    if strength.noise.len() != traces.len() {
        return None;
    }
    let left = |rest: &[f64]| -> f64 {
        (0..rest.len()).filter(|&i| traces.locked[i]).map(|i| (rest[i] - strength.noise[i]).powi(2)).sum()
    };
    let before = left(&traces.before);
    Some((before - left(&traces.after)) / (before - left(&strength.rest_without)))
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

/// The mean; zero of none.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// The upper of the middle values; `None` of none.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
