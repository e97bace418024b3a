//! What a diagnosis says: verdict, findings with their evidence, gain, and what would have been seen.

use super::advise::Advice;
use super::base::BaseKind;
use super::blocks::Lock;
use super::channel::Channel;
use super::conclude::{Fitted, Refit};
use super::findings::measurement_finding;
use super::health::HealthNote;
use super::localise::Location;
use super::prove::Proof;
use super::rollout::Rollout;
use super::round::Scored;
use super::traces::Traces;
use crate::parameter::Parameter;
use crate::physics::{Action, EffectId};
use serde::Serialize;

/// The overall answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing is missing that this recording could show.
    Consistent,
    /// Named effects are missing.
    MissingPhysics,
    /// Something structured is missing that the catalogue does not hold.
    Unexplained,
    /// The measurement is at fault.
    BadData,
}

/// One finding.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Which effect.
    pub effect: EffectId,
    /// Calibrated probability that the effect is the named one.
    pub probability: f64,
    /// What this recording cannot tell from it, with probabilities.
    pub alternatives: Vec<(EffectId, f64)>,
    /// What to do about it.
    pub action: Action,
    /// The equation it adds.
    pub equation: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Where it sits.
    pub location: Location,
    /// One sentence of evidence.
    pub evidence: String,
    /// An excitation that would tell the alternatives apart.
    pub separate_by: Advice,
    /// The fitted term.
    pub fitted: Fitted,
    /// Score in nats.
    pub score: f64,
    /// Margin in nats to the best rival outside the set.
    pub margin: f64,
    /// Every other named effect with its distance in nats when this one was accepted, nearest first.
    pub standings: Vec<(EffectId, f64)>,
    /// Of a structure without a name: its channel, then those that cannot be told from it. Empty for a named effect.
    pub channels: Vec<Channel>,
    /// Of a structure without a name: the effect with a name that explains most of it, with the share of its energy, 0.5..1.
    pub nearest: Option<(EffectId, f64)>,
    /// Gain on locked data in nats when this effect alone is left out.
    pub locked_gain_nats: Option<f64>,
}

/// The amplitude that would have been seen.
#[derive(Clone, Debug, Serialize)]
pub struct DetectionLimit {
    /// Which effect.
    pub effect: EffectId,
    /// Root mean square of its torque that would have been found with 90 % probability, in the actuator's unit.
    pub torque_rms: f64,
}

/// A whole diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// Notes on the measurement, before any physics.
    pub health: Vec<HealthNote>,
    /// Findings in the order in which they were accepted.
    pub findings: Vec<Finding>,
    /// Effects that were found beside larger ones but account for little, with their share of the removable error; they are
    /// not in the improved model.
    pub minor: Vec<(EffectId, f64)>,
    /// Effects that were found but explain no more than the formulas of the reference get wrong, with the root mean square of what
    /// they explain.
    pub doubtful: Vec<(EffectId, f64)>,
    /// Effects that were found but are too small to matter, with the root mean square of what they explain.
    pub negligible: Vec<(EffectId, f64)>,
    /// Effects that were found but withdrawn, because locked data did not confirm them.
    pub withdrawn: Vec<EffectId>,
    /// What would have been seen.
    pub limits: Vec<DetectionLimit>,
    /// Which base the recording was compared with.
    pub base: BaseKind,
    /// Which rows the proof was kept away from.
    pub lock: Lock,
    /// The simulation or model as it was given, before any of its parameters moved; `None` where the base is the recording's own.
    pub given: Option<Given>,
    /// Names of the base's physical parameters, as far as they have one, with their refitted values; of a simulation or a model
    /// with what they have to change by.
    pub base_parameters: Vec<Parameter>,
    /// Root mean square of the noise that is left.
    pub noise_rmse: f64,
    /// Root mean square and R2 (against the recorded torque) of the base on all rows.
    pub baseline: Score,
    /// The same with the effects.
    pub improved: Score,
    /// Proof on locked rows.
    pub proof: Option<Proof>,
    /// Open-loop rollout over locked rows.
    pub rollout: Option<Rollout>,
    /// The last round's table: every hypothesis that was not accepted.
    pub rivals: Vec<Scored>,
    /// Refit of the base alone.
    pub baseline_refit: Refit,
    /// Refit with the effects.
    pub improved_refit: Refit,
    /// Cut-off of the common filter in Hz.
    pub cut_off_hz: f64,
    /// Rows of evidence.
    pub rows: usize,
    /// Delay of the torque against the position in s, as far as it is the sampling's own.
    pub sampling_delay_s: f64,
    /// Delay by which the torque was put back before anything was fitted, in s.
    pub put_back_s: f64,
    /// Series for pictures and sentences.
    pub traces: Traces,
}

impl Diagnosis {
    /// Whether the measurement kept physics from being looked for.
    #[must_use]
    pub fn is_blocked(&self) -> bool {
        self.health.iter().any(|note| note.blocking)
    }
}

impl Verdict {
    /// What findings amount to; where the measurement is `blocked` nothing can be said of the physics.
    pub(super) fn of(findings: &[Finding], blocked: bool) -> Self {
        if blocked {
            return Self::BadData;
        }
        if findings.is_empty() {
            return Self::Consistent;
        }
        if findings.iter().all(|found| found.action == Action::Measurement) {
            return Self::BadData;
        }
        let is_without_name = |found: &Finding| found.effect == EffectId::Unknown;
        if findings.iter().all(is_without_name) { Self::Unexplained } else { Self::MissingPhysics }
    }
}

impl Diagnosis {
    /// Puts a fault of the measurement, which adds no torque, before the other findings.
    pub(super) fn put_first(&mut self, fault: Finding) {
        self.findings.insert(0, fault);
        self.traces.effects.insert(0, vec![0.0; self.traces.len()]);
        self.verdict = Verdict::of(&self.findings, self.health.iter().any(|note| note.blocking));
    }

    /// Puts a note on the measurement before all others; as a finding too, where it is one and no other says the same.
    pub fn tell_first(&mut self, note: HealthNote, is_finding: bool) {
        let is_said =
            self.findings.iter().any(|found| found.effect == note.effect && found.action == Action::Measurement);
        let finding = measurement_finding(&note);
        self.health.insert(0, note);
        if is_finding && !is_said {
            self.put_first(finding);
        }
    }
}

/// A simulation or model as it was given.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Given {
    /// What it explains of the recording without a change.
    #[serde(flatten)]
    pub score: Score,
    /// Effects of the catalogue that were found in a simulation, and that the recording is therefore not asked for.
    pub holds: Vec<EffectId>,
}

/// Goodness of fit on the working rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Score {
    /// Root mean square error in the actuator's unit.
    pub rmse: f64,
    /// Coefficient of determination against the filtered recorded torque.
    pub r2: f64,
}
