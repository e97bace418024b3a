//! What to record next, so that effects which this recording cannot tell apart come apart.
//!
//! A library of excitations, within the limits of the joint, is weighed by the evidence that each would bring (Box and
//! Hill 1967; T-optimality of Atkinson and Fedorov 1975): half the whitened energy of one effect's torque that neither the
//! base nor its rival can hold, over the recording and the planned motion together. The least evidence over both
//! directions and all pairs that can be told apart at all counts; the excitation with the most of it is proposed.

mod excitation;
mod future;
mod outlook;

use crate::diagnose::answer::outcome::{Diagnosis, Finding};
use crate::diagnose::comparison::reference::{Comparison, Reference};
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::preparation::states::Prepared;
use crate::diagnose::search::thresholds::AMBIGUITY_MARGIN_NATS;
use crate::numerics::statistics::quantile;
use crate::physics::{EffectId, JointState};
use excitation::{Envelope, Excitation};
use future::Future;
use outlook::Outlook;
use rayon::prelude::*;

/// Predicts the reference's torque at given states.
pub type ReferenceAt<'a> = dyn Fn(&JointState) -> Option<Reference> + Sync + 'a;

/// Everything from which a plan is made.
pub struct Question<'a> {
    /// The recording that was diagnosed, and what it was compared with.
    pub comparison: &'a Comparison,
    /// What came of it.
    pub diagnosis: &'a Diagnosis,
    /// Limits within which the joint may move.
    pub limits: Limits,
    /// The reference of [`super::BaseKind::Reference`] at other states.
    pub reference: Option<&'a ReferenceAt<'a>>,
}

/// Limits within which a joint may move; SI units, rotary or linear. What is absent is taken from the recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lowest position, rad or m.
    pub lowest_position: Option<f64>,
    /// Highest position.
    pub highest_position: Option<f64>,
    /// Largest speed.
    pub speed: Option<f64>,
    /// Largest acceleration.
    pub acceleration: Option<f64>,
}

impl Limits {
    /// The limits that are given, filled in with what the recording shows.
    fn envelope(&self, state: &JointState) -> Envelope {
        let (low, high) = state.travel();
        let (low, high) = (self.lowest_position.unwrap_or(low), self.highest_position.unwrap_or(high));
        let common = |series: &[f64]| quantile(series.iter().map(|x| x.abs()), ENVELOPE_QUANTILE);
        let home = state.position.last().copied().unwrap_or(low);
        Envelope {
            low,
            high,
            home: home.clamp(low.min(high), high),
            speed: self.speed.unwrap_or_else(|| common(&state.velocity)),
            acceleration: self.acceleration.unwrap_or_else(|| common(&state.acceleration)),
            resolution: state.resolution,
        }
    }
}

/// Quantile of recorded speed and acceleration up to which a joint may be moved where no limit is given: it was moved
/// so already. Chosen by judgement: the largest value itself may be noise of the derivative.
const ENVELOPE_QUANTILE: f64 = 0.995;

/// A motion to record next.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Pairs of effects that it is to tell apart.
    pub pairs: Vec<(EffectId, EffectId)>,
    /// Pairs that no motion of the library tells apart within the limits.
    pub left_open: Vec<(EffectId, EffectId)>,
    /// The motion in words, with payload and rest before it.
    pub words: String,
    /// Rest before the motion, s.
    pub rest_before_s: f64,
    /// Load torque while it is followed, one value a sample, where the payload is part of the plan.
    pub load: Option<Vec<f64>>,
    /// Sample period, s.
    pub period: f64,
    /// Position, one value a sample; from rest to rest, rad or m.
    pub position: Vec<f64>,
    /// Expected evidence in nats between the least separated pair, after the motion was recorded.
    pub expected_nats: f64,
    /// The same of the recording as it is.
    pub present_nats: f64,
}

impl Plan {
    /// Length of the motion, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.position.len() as f64 * self.period
    }

    /// Whether the motion is expected to tell the effects apart.
    #[must_use]
    pub fn suffices(&self) -> bool {
        self.expected_nats >= AMBIGUITY_MARGIN_NATS
    }
}

/// Excitations, best first, whose expected evidence is worked out again with the shapes of the rivals refined. A limit
/// of the computing time: fewer may miss the best one, more cost a search each.
const REFINED_EXCITATIONS: usize = 3;

/// The most telling excitation for the findings that have rivals; `None` where every name is certain or nothing in the
/// library can be moved.
#[must_use]
pub fn plan(question: &Question) -> Option<Plan> {
    let pairs = pairs(question.diagnosis);
    if pairs.is_empty() {
        return None;
    }
    let Comparison { signals, .. } = question.comparison;
    let known = question.comparison.known();
    let past = Prepared::at_cut_off(signals, question.diagnosis.cut_off_hz, known, question.diagnosis.lock);
    let future = Future::new(signals, &past.state);
    let present = Outlook::new(question, question.comparison.clone())?.evidence(&pairs, true);
    let weigh = |candidates: Vec<Candidate>, refined: bool| -> Vec<Weighed> {
        candidates
            .into_par_iter()
            .filter_map(|candidate| {
                let outlook = Outlook::new(question, future.with(&candidate).into())?;
                Some(Weighed { nats: outlook.evidence(&pairs, refined), candidate })
            })
            .collect()
    };
    let mut weighed = weigh(candidates(question, &future, &past.state, &pairs), false);
    let separable = separable(&weighed, pairs.len());
    weighed.sort_by(|a, b| least(&b.nats, &separable).total_cmp(&least(&a.nats, &separable)));
    weighed.truncate(REFINED_EXCITATIONS);
    let weighed = weigh(weighed.into_iter().map(|weighed| weighed.candidate).collect(), true);
    let separable = self::separable(&weighed, pairs.len());
    let better = |a: Weighed, b: Weighed| if least(&b.nats, &separable) > least(&a.nats, &separable) { b } else { a };
    let Weighed { nats, candidate } = weighed.into_iter().reduce(better)?;
    let named = |told: bool| {
        (0..pairs.len()).filter(|pair| separable.contains(pair) == told).map(|k| (pairs[k].0, pairs[k].2)).collect()
    };
    Some(Plan {
        pairs: named(true),
        left_open: named(false),
        words: candidate.words(),
        rest_before_s: candidate.rest_before_s,
        load: candidate.payload.map(|_| future.load(&candidate)),
        period: signals.period,
        expected_nats: least(&nats, &separable),
        present_nats: least(&present, &separable),
        position: candidate.excitation.position,
    })
}

/// A candidate with its expected evidence for every pair, in nats.
struct Weighed {
    nats: Vec<f64>,
    candidate: Candidate,
}

/// Pairs that some candidate is expected to tell apart; all of them where there is none. Some effects coincide whatever
/// the motion: those must not decide.
fn separable(weighed: &[Weighed], pairs: usize) -> Vec<usize> {
    let told: Vec<usize> =
        (0..pairs).filter(|&pair| weighed.iter().any(|weighed| weighed.nats[pair] >= AMBIGUITY_MARGIN_NATS)).collect();
    if told.is_empty() { (0..pairs).collect() } else { told }
}

/// Least evidence among some pairs.
fn least(nats: &[f64], among: &[usize]) -> f64 {
    among.iter().map(|&pair| nats[pair]).fold(f64::INFINITY, f64::min)
}

/// A finding's effect, its fitted term and a rival.
type Pair<'a> = (EffectId, &'a Fitted, EffectId);

fn pairs(diagnosis: &Diagnosis) -> Vec<Pair<'_>> {
    let named =
        |found: &&Finding| matches!(found.fitted.label, Label::Named(_)) && !found.fitted.coefficients.is_empty();
    let rivals = |found: &'_ Finding| found.alternatives.iter().map(|(rival, _)| *rival).collect::<Vec<_>>();
    diagnosis
        .findings
        .iter()
        .filter(named)
        .flat_map(|found| rivals(found).into_iter().map(move |rival| (found.effect, &found.fitted, rival)))
        .collect()
}

/// One excitation under one payload, behind one rest.
#[derive(Clone, Debug)]
struct Candidate {
    excitation: Excitation,
    /// Share of the typical recorded load torque; as recorded last where `None`.
    payload: Option<f64>,
    rest_before_s: f64,
}

impl Candidate {
    fn words(&self) -> String {
        let payload = match self.payload {
            None => String::new(),
            Some(0.0) => " without payload".to_string(),
            Some(share) => format!(" with {share:.2} times the usual payload"),
        };
        let rest = match self.rest_before_s {
            0.0 => String::new(),
            rest => format!(" after a rest of {rest:.0} s"),
        };
        format!("{}{payload}{rest}", self.excitation.words)
    }
}

/// Shortest and longest planned motion, s; between the two as long as the recording. Chosen by judgement: less holds
/// too few blocks for held-out evidence, more is asked of nobody for one pair of effects.
const DURATION_S: (f64, f64) = (20.0, 60.0);

fn candidates(question: &Question, future: &Future, state: &JointState, pairs: &[Pair]) -> Vec<Candidate> {
    let signals = &question.comparison.signals;
    let duration = (signals.period * signals.time.len() as f64).clamp(DURATION_S.0, DURATION_S.1);
    let motions = excitation::library(&question.limits.envelope(state), duration, signals.period);
    let slow = [EffectId::Temperature, EffectId::WarmUp, EffectId::SlowDrift];
    let cooling = pairs.iter().any(|(effect, _, rival)| slow.contains(effect) || slow.contains(rival));
    let rests: Vec<f64> = if cooling { vec![0.0, future.cooling_s()] } else { vec![0.0] };
    let payloads: Vec<Option<f64>> = std::iter::once(None).chain(future.payloads().into_iter().map(Some)).collect();
    let mut candidates = Vec::new();
    for excitation in motions {
        for &payload in &payloads {
            for &rest_before_s in &rests {
                candidates.push(Candidate { excitation: excitation.clone(), payload, rest_before_s });
            }
        }
    }
    candidates
}
