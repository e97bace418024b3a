//! Confounded pairs: recordings that cannot tell two effects apart, the motion that the diagnosis proposes for them, and
//! what the two recordings together tell.

use std::fmt::Write;

use super::summary::share;
use super::{set_of, signals};
use frikan_trainer::diagnose::{
    AMBIGUITY_MARGIN_NATS, Comparison, Diagnosis, Limits, Lock, Options, Plan, Question, diagnose, plan,
};
use frikan_trainer::physics::EffectId;
use frikan_trainer::plant::{self, Campaign, Motion, Trajectory};

/// A joint in which one effect is hidden and recorded with motions that confound it with another.
#[derive(Clone, Debug)]
pub struct Confounded {
    /// Effect that is hidden.
    pub truth: &'static str,
    /// Effect that it is mistaken for.
    pub rival: &'static str,
    /// Its amplitude.
    pub amplitude: f64,
    /// Motions of the recording.
    pub motions: Vec<Motion>,
    /// Gravity torque of the payload, N m.
    pub gravity_nm: f64,
}

/// What came of a confounded pair.
#[derive(Clone, Debug)]
pub struct Advised {
    /// Diagnosis of the recording alone.
    pub before: Diagnosis,
    /// The proposed motion, where there was one.
    pub plan: Option<Plan>,
    /// Diagnosis of the recording and the proposed motion together.
    pub after: Option<Diagnosis>,
}

/// Limits of the joint beyond what was recorded.
const LIMITS: Limits =
    Limits { lowest_position: Some(-1.6), highest_position: Some(1.6), speed: Some(3.5), acceleration: Some(25.0) };

/// Small multisines about zero, `reach` rad wide.
fn small_multisines(reach: f64, lowest_hz: f64, highest_hz: f64, lines: usize) -> Vec<Motion> {
    let one =
        |share: f64| Motion::Multisine { amplitude_rad: share * reach, lowest_hz, highest_hz, speed_rad_s: 3.5, lines };
    vec![one(1.0), one(0.8), one(0.9)]
}

/// The pairs of the proof: recordings in which the rival explains nearly as much as the truth.
#[must_use]
pub fn pairs() -> Vec<Confounded> {
    let narrow = || small_multisines(0.35, 0.3, 1.2, 5);
    let quick = || small_multisines(0.12, 1.0, 3.0, 5);
    let one_tone = || small_multisines(0.6, 0.7, 0.8, 1);
    let slow = || small_multisines(0.5, 0.1, 0.3, 5);
    let steady = || {
        let triangles = Motion::Triangles { amplitude_rad: 1.0, speed_rad_s: 1.2 };
        [vec![triangles], small_multisines(1.0, 0.2, 0.8, 5)].concat()
    };
    let starts = || vec![Motion::StopAndGo { step_rad: 0.25, speed_rad_s: 1.1, dwells_s: vec![0.4] }];
    let pair =
        |truth, rival, amplitude, motions, gravity_nm| Confounded { truth, rival, amplitude, motions, gravity_nm };
    vec![
        pair("gravity_error", "spring", 1.0, narrow(), 4.0),
        pair("spring", "gravity_error", 1.0, narrow(), 4.0),
        pair("torque_scale", "inertia_error", 1.0, quick(), 2.0),
        pair("inertia_error", "torque_scale", 1.0, quick(), 2.0),
        pair("temperature", "warm_up", 2.0, steady(), 4.0),
        pair("warm_up", "temperature", 1.0, steady(), 4.0),
        pair("slow_drift", "warm_up", 1.0, steady(), 4.0),
        pair("temperature", "slow_drift", 0.5, steady(), 4.0),
        pair("load_friction", "position_friction", 0.5, steady(), 4.0),
        pair("viscous_nonlinearity", "stribeck", 0.25, slow(), 4.0),
        pair("inertia_error", "spring", 0.2, one_tone(), 4.0),
        pair("spring", "inertia_error", 0.2, one_tone(), 4.0),
        pair("direction_asymmetry", "torque_offset", 0.3, narrow(), 4.0),
        pair("torque_offset", "direction_asymmetry", 0.3, narrow(), 4.0),
        pair("frictional_lag", "presliding", 1.0, quick(), 4.0),
        pair("dwell_breakaway", "stribeck", 0.5, starts(), 4.0),
        pair("kinematic_error", "inertia_error", 0.3, quick(), 4.0),
    ]
}

/// Records, diagnoses, asks for the next motion, follows it, and diagnoses both.
///
/// # Errors
/// What keeps the joint from being simulated or the recording from being diagnosed.
pub fn run(case: &Confounded, seed: u64) -> Result<Advised, String> {
    let mut joint = plant::Joint { gravity_torque_nm: vec![case.gravity_nm], ..plant::Joint::default() };
    joint.campaign = Campaign {
        trajectory_s: 6.0,
        sets: 1,
        trajectories: case.motions.iter().cycle().take(6).cloned().map(Trajectory::from).collect(),
    };
    joint.effects = vec![plant::Hidden { name: case.truth.to_owned(), amplitude: case.amplitude }];
    let options = Options { lock: Lock::Nothing, ..Options::default() };
    let diagnosed = |joint: &plant::Joint| {
        let recording = plant::simulate(joint, seed).map_err(|e| e.to_string())?;
        let comparison = Comparison::from(signals(&recording, joint));
        let diagnosis = diagnose(&comparison, &options).map_err(|e| e.to_string())?;
        Ok::<_, String>((comparison, diagnosis))
    };
    let (comparison, before) = diagnosed(&joint)?;
    let question = Question { comparison: &comparison, diagnosis: &before, limits: LIMITS, reference: None };
    let Some(plan) = plan(&question) else { return Ok(Advised { before, plan: None, after: None }) };
    let recorded_s = joint.campaign.duration_s();
    joint.campaign.trajectories.push(following(&plan, case));
    if case.truth == "slow_drift" {
        // The simulator draws the change over the whole campaign.
        joint.effects[0].amplitude *= joint.campaign.duration_s() / recorded_s;
    }
    let (_, after) = diagnosed(&joint)?;
    Ok(Advised { before, plan: Some(plan), after: Some(after) })
}

/// The planned motion as the simulator takes it.
fn following(plan: &Plan, case: &Confounded) -> Trajectory {
    let gravity = plan.load.as_ref().map_or(case.gravity_nm, |load| {
        let sum = |values: &dyn Fn(usize) -> f64| (0..load.len()).map(values).sum::<f64>();
        sum(&|i| load[i] * plan.position[i].sin()) / sum(&|i| plan.position[i].sin().powi(2))
    });
    Trajectory {
        duration_s: Some(plan.position.len() as f64 * plan.period),
        gravity_torque_nm: Some(gravity),
        pause_before_s: plan.rest_before_s,
        ..Trajectory::from(Motion::Samples { position_rad: plan.position.clone() })
    }
}

impl Advised {
    /// Whether the recording alone leaves the pair open: one of both is named, the other within its set.
    #[must_use]
    pub fn was_open(&self, case: &Confounded) -> bool {
        let pair = case.pair();
        self.before.findings.first().is_some_and(|found| {
            let in_set = |effect| set_of(found).any(|name| name == effect);
            in_set(pair.0) && in_set(pair.1)
        })
    }

    /// Whether the truth is the first name or in its set.
    #[must_use]
    pub fn holds_truth(&self, case: &Confounded) -> bool {
        let truth = case.pair().0;
        let first = self.before.findings.first();
        first.is_some_and(|found| set_of(found).any(|name| name == truth))
    }

    /// Distance in nats from the truth to its rival after the proposed motion; `None` where the truth is not found.
    #[must_use]
    pub fn reached_nats(&self, case: &Confounded) -> Option<f64> {
        let (truth, rival) = case.pair();
        let found = self.after.as_ref()?.findings.iter().find(|found| found.effect == truth)?;
        found.standings.iter().find(|(effect, _)| *effect == rival).map(|(_, nats)| *nats)
    }

    /// Whether truth and rival are told apart after the proposed motion.
    #[must_use]
    pub fn is_resolved(&self, case: &Confounded) -> bool {
        self.reached_nats(case).is_some_and(|nats| nats > AMBIGUITY_MARGIN_NATS)
    }
}

impl Confounded {
    fn pair(&self) -> (EffectId, EffectId) {
        let id = |name| EffectId::from_name(name).unwrap_or(EffectId::Unknown);
        (id(self.truth), id(self.rival))
    }
}

/// The results as a section of Markdown.
pub fn table(results: &[(Confounded, Advised)]) -> String {
    let mut text = String::from(
        "\n## Confounded recordings, and the motion that is proposed for them\n\nRecordings in which a rival explains nearly as much as the truth: only the set is right. Nats are the lead of the truth over\nthe rival once the proposed motion is recorded too.\n\n| hidden | rival | answer | truth in the set | both in the set | proposed | expected nats | reached nats |\n|---|---|---|---|---|---|---|---|\n",
    );
    let said = |yes| if yes { "yes" } else { "no" };
    let (mut open, mut proposed, mut resolved) = (0, 0, 0);
    for (case, advised) in results {
        let names = |found| set_of(found).map(EffectId::name).collect::<Vec<_>>().join(" or ");
        let answer: Vec<String> = advised.before.findings.iter().map(names).collect();
        let was_open = advised.was_open(case);
        open += usize::from(was_open);
        let (words, expected) =
            advised.plan.as_ref().map_or(("-", f64::NAN), |plan| (plan.words.as_str(), plan.expected_nats));
        if was_open && advised.plan.is_some() {
            proposed += 1;
            resolved += usize::from(advised.is_resolved(case));
        }
        let reached = advised.reached_nats(case).map_or("-".to_string(), |nats| format!("{nats:.0}"));
        let expected = if expected.is_nan() { "-".to_string() } else { format!("{expected:.0}") };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {words} | {expected} | {reached} |",
            case.truth,
            case.rival,
            answer.join(", "),
            said(advised.holds_truth(case)),
            said(was_open),
        );
    }
    let _ = writeln!(
        text,
        "\nThe truth in the set: {}. Both in the set: {}; of these told apart by the proposed motion: {}.",
        share(results.iter().filter(|(case, advised)| advised.holds_truth(case)).count(), results.len()),
        share(open, results.len()),
        share(resolved, proposed)
    );
    text
}
