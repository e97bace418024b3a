//! What a diagnosis says: verdict, findings with their evidence, gain, and what would have been seen.

use crate::diagnose::answer::location::Location;
use crate::diagnose::answer::traces::Traces;
use crate::diagnose::checks::note::{HealthNote, Observation};
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::simulation::InverseLaw;
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::infer::answer::ProbableSet;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::proof::discarded::Discarded;
use crate::diagnose::proof::locked_rows::Proof;
use crate::diagnose::proof::refit::Refit;
use crate::diagnose::proof::rollout::Rollout;
use crate::diagnose::search::scored::Scored;
use crate::numerics::statistics::NORMAL_95;
use crate::physics::{Action, Dimension, EffectId};
use serde::Serialize;

/// The overall answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing is missing that this recording could show.
    Consistent,
    /// Named effects are missing.
    MissingPhysics,
    /// A structure is missing that no effect of the catalogue explains.
    Unexplained,
    /// The measurement is at fault.
    BadData,
}

/// A parameter with its interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The field's name, e.g. `coulomb_torque`.
    pub name: &'static str,
    /// Symbol in the equation.
    pub symbol: &'static str,
    /// The dimension, from which the unit follows.
    pub dimension: Dimension,
    /// Estimate in SI units, joint side.
    pub value: f64,
    /// 95 % confidence interval.
    pub ci95: [f64; 2],
}

impl Estimate {
    /// A normally distributed estimate with its standard deviation.
    pub(crate) fn of(
        name: &'static str,
        symbol: &'static str,
        dimension: Dimension,
        value: f64,
        deviation: f64,
    ) -> Self {
        let half = NORMAL_95 * deviation;
        Self { name, symbol, dimension, value, ci95: [value - half, value + half] }
    }
}

/// What speaks for a finding.
#[derive(Clone, Debug, PartialEq)]
pub enum Evidence {
    /// The recorded rows.
    Rows {
        /// Gain in nats of the held-out folds.
        held_out_gain_nats: f64,
        /// Family-wise probability when nothing is missing.
        family_wise: f64,
        /// Named effects within reach.
        rivals: usize,
    },
    /// What was seen of the measurement.
    Measurement(Observation),
}

/// One finding.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Which effect.
    pub effect: EffectId,
    /// Probability that the effect is the named one, by the frequency of right names on the simulated suite.
    pub probability: f64,
    /// What this recording cannot tell from it, with probabilities.
    pub alternatives: Vec<(EffectId, f64)>,
    /// What to do about it.
    pub action: Action,
    /// The equation it adds.
    pub equation: String,
    /// Its parameters.
    pub parameters: Vec<Estimate>,
    /// Where it sits.
    pub location: Location,
    /// What speaks for it.
    pub evidence: Evidence,
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
    /// Sets of effects that may be missing together, each with its probability, likeliest first; no effect is a set too. Sets of less
    /// than one in a hundred are left out. Empty where sets were not weighed.
    pub sets: Vec<ProbableSet>,
    /// What was found and is no finding.
    pub discarded: Discarded,
    /// Torque of each effect from which it would have been found.
    pub limits: Vec<DetectionLimit>,
    /// Which base the recording was compared with.
    pub base: BaseKind,
    /// Stretches of the recording, from and to in s, that decided nothing: what is told of a written model is computed on them.
    pub sealed_s: Vec<[f64; 2]>,
    /// Which rows the proof was kept away from.
    pub lock: Lock,
    /// The simulation or model as it was given, before any of its parameters moved; `None` where the base is the recording's own.
    pub given: Option<Given>,
    /// Names of the base's physical parameters, as far as they have one, with their refitted values; of a simulation or a model
    /// with what they have to change by.
    pub base_parameters: Vec<Estimate>,
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
    pub realigned_by_s: f64,
    /// Series for pictures and sentences.
    pub traces: Traces,
    /// The law of a simulation with what it shows beside its static law; `None` where it shows nothing.
    pub law: Option<Box<InverseLaw>>,
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
    pub(crate) fn of(findings: &[Finding], blocked: bool) -> Self {
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
    /// Puts a finding before the others where its torque is larger than that of each of them, else behind them.
    pub(crate) fn put_by_size(&mut self, finding: Finding, torque: Vec<f64>) {
        let size = |torque: &Vec<f64>| torque.iter().map(|value| value * value).sum::<f64>();
        if self.traces.effects.iter().all(|other| size(other) < size(&torque)) {
            self.put_first(finding, torque);
        } else {
            self.findings.push(finding);
            self.traces.effects.push(torque);
        }
    }

    /// Puts a finding before the others, with its torque at every working row: none (empty) of a fault of the measurement.
    pub(crate) fn put_first(&mut self, finding: Finding, mut torque: Vec<f64>) {
        torque.resize(self.traces.len(), 0.0);
        self.findings.insert(0, finding);
        self.traces.effects.insert(0, torque);
        self.verdict = Verdict::of(&self.findings, self.health.iter().any(|note| note.blocking));
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
