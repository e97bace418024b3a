//! One diagnosis, from a recording and what it is compared with to an answer:
//! recording -> preparation -> base -> checks -> search -> proof -> answer, again for each delay of the torque that is tried and, where
//! a one-off event was locked away, with other rows locked.

use crate::diagnose::answer::detection_limit::detection_limits;
use crate::diagnose::answer::finding::{base_parameters, finding, measurement_finding, misalignment};
use crate::diagnose::answer::friction_level::FrictionLevel;
use crate::diagnose::answer::goodness_of_fit::{score, score_as_given};
use crate::diagnose::answer::outcome::{Diagnosis, Finding, Verdict};
use crate::diagnose::answer::traces::Traces;
use crate::diagnose::checks::command_beyond_limit::Command;
use crate::diagnose::checks::health::{AsRecorded, coarse_position, examine, late_torque, scattered_sampling};
use crate::diagnose::checks::note::HealthNote;
use crate::diagnose::comparison::base::{Base, Delay};
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::delay::{delay_by_shifting, position_error_energy};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::comparison::simulation::{InverseLaw, Unlearnable, learn};
use crate::diagnose::confirmed::Confirmed;
use crate::diagnose::evidence::measurement_noise::MeasurementNoise;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::infer::answer::LEAST_NAMED_SHARE;
use crate::diagnose::infer::beside_simulation::{of_simulation, turn_over_as_simulated, whole_law};
use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::delay::{TorqueDelay, shifted, torque_delay};
use crate::diagnose::infer::inferred::{Inferred, infer};
use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::weighing::{Weighing, friction_of};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::proof::discarded::{
    Discarded, least_determined, set_aside_doubtful, set_aside_minor, set_aside_negligible, withdraw_without_shown_gain,
};
use crate::diagnose::proof::locked_rows::{Proof, prove, rest};
use crate::diagnose::proof::part::tell_by_a_part;
use crate::diagnose::proof::refit::{polish, refit};
use crate::diagnose::proof::rollout::roll_out;
use crate::diagnose::realign::{Realignment, Trial, is_better, joined, next_delay_s};
use crate::diagnose::relock::{add_locked_event, locked_event, names_more};
use crate::diagnose::request::{LEAST_EFFECT_SHARE, Options, Refusal};
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::setup::Search;
use crate::numerics::least_squares::rows_in;
use crate::physics::{EffectId, catalogue};
use crate::samples::delay::LONGEST_SAMPLING_DELAY;

/// Working rows below which a diagnosis is refused. Chosen by judgement: fifteen in each of the ten blocks of the
/// held-out evidence; fewer do not tell the noise from the base.
const LEAST_ROWS: usize = 150;

/// Diagnoses one recording.
///
/// A torque that was recorded at another time than the motion is a finding of its own; physics is looked for once it is
/// put back. Up to about a sample it is the sampling's own: put back and no finding.
///
/// # Errors
/// [`Refusal`] when the recording holds too little motion for any answer, or no torque.
pub fn diagnose(comparison: &Comparison, options: &Options) -> Result<Diagnosis, Refusal> {
    diagnose_with(comparison, None, *options)
}

/// Diagnoses one recording beside its simulation, both in one model, whose static `law` it is compared with; what the simulation shows
/// beside that is told as its own.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_beside(comparison: &Comparison, law: &InverseLaw, options: &Options) -> Result<Diagnosis, Refusal> {
    let base = BaseKind::Reference;
    diagnose_with(comparison, Some(law), Options { by_likelihood: true, base, ..*options })
}

fn diagnose_with(comparison: &Comparison, law: Option<&InverseLaw>, options: Options) -> Result<Diagnosis, Refusal> {
    let signals = &comparison.signals;
    if let Some(&torque) = signals.torque.first().filter(|first| signals.torque.iter().all(|torque| torque == *first)) {
        return Err(Refusal::NotMeasured { torque });
    }
    let request = Request { options, as_recorded: &AsRecorded::of(signals), law };
    let Some(command) = Command::of(signals) else { return diagnose_in_step(comparison, &request) };
    let limited = Comparison { signals: command.given(signals), ..comparison.clone() };
    let mut diagnosis = diagnose_in_step(&limited, &request)?;
    let note = command.note();
    diagnosis.put_first(measurement_finding(&note), Vec::new());
    diagnosis.health.insert(0, note);
    Ok(diagnosis)
}

/// Learns the law of a simulation, and which effects of the catalogue the simulator computes: those that a diagnosis of the simulation
/// finds beside its static law.
///
/// # Errors
/// [`Unlearnable`] for a simulation of rest or of one velocity.
pub fn learn_simulation(simulation: &Signals, real: &Signals) -> Result<InverseLaw, Unlearnable> {
    let options = Options { base: BaseKind::Reference, ..Options::default() };
    learn(simulation, real, &|comparison| {
        let found = diagnose(comparison, &options).map(|diagnosis| diagnosis.findings).unwrap_or_default();
        found.into_iter().map(|finding| finding.fitted).collect()
    })
}

/// What is asked for, whatever becomes of the signals on the way.
#[derive(Clone, Copy)]
struct Request<'a> {
    options: Options,
    /// What is wrong with the recording as it is: of a torque that was put back between its samples nobody can tell.
    as_recorded: &'a AsRecorded,
    /// Static law of a simulation.
    law: Option<&'a InverseLaw>,
}

/// Diagnoses with the torque put back to the time of the motion.
fn diagnose_in_step(comparison: &Comparison, request: &Request) -> Result<Diagnosis, Refusal> {
    let Options { base, lock, .. } = request.options;
    if request.options.by_likelihood {
        return diagnose_by_likelihood(comparison, request);
    }
    // A torque that follows from commands and motion has their time.
    let is_measured = comparison.signals.commanded.is_none();
    let shift_s = if is_measured { delay_by_shifting(comparison.prepare(lock), comparison, base) } else { 0.0 };
    let realignment = Realignment::new(shift_s, comparison.signals.period);
    let first = diagnose_from(realignment.first_delay_s(), comparison, request)?;
    let Some(delay_s) = realignment.second_delay_s(&first) else { return Ok(first) };
    match diagnose_from(delay_s, comparison, request) {
        Ok(second) if is_better(&second, &first) => Ok(second),
        _ => Ok(first),
    }
}

/// Diagnoses with the torque put back by a delay (s), and then by what is found of it.
fn diagnose_from(delay_s: f64, comparison: &Comparison, request: &Request) -> Result<Diagnosis, Refusal> {
    let with_delay = |delay_s: f64| {
        let diagnosis = if delay_s == 0.0 {
            diagnose_with_event_open(comparison, request)
        } else {
            diagnose_with_event_open(&comparison.realigned(delay_s), request)
        };
        diagnosis.map(|diagnosis| Trial { delay_s, diagnosis })
    };
    let mut trials = vec![with_delay(delay_s)?];
    while let Some(delay_s) = next_delay_s(&trials) {
        let Ok(trial) = with_delay(delay_s) else { break };
        trials.push(trial);
    }
    joined(trials, comparison.signals.period).ok_or(Refusal::Undetermined)
}

/// Diagnoses signals whose torque and motion belong together; with other rows locked where a one-off event lay in those that were.
fn diagnose_with_event_open(comparison: &Comparison, request: &Request) -> Result<Diagnosis, Refusal> {
    let mut first = diagnose_locked(comparison, request, None)?;
    let Some(event) = locked_event(&first) else { return Ok(first) };
    add_locked_event(&mut first, event);
    let elsewhere = Options { lock: Lock::SpreadElsewhere, ..request.options };
    match diagnose_locked(comparison, &Request { options: elsewhere, ..*request }, None) {
        Ok(second) if names_more(&second, &first, event) => Ok(second),
        _ => Ok(first),
    }
}

/// Diagnoses with some rows locked.
fn diagnose_locked(
    comparison: &Comparison,
    request: &Request,
    inferred: Option<&Inferred>,
) -> Result<Diagnosis, Refusal> {
    let Request { options, as_recorded, .. } = *request;
    let signals = &comparison.signals;
    let mut prepared = comparison.prepare(options.lock);
    if options.by_likelihood {
        turn_over_as_simulated(&mut prepared, comparison);
    }
    let rows = rows_in(&prepared.open_runs());
    if rows < LEAST_ROWS {
        return Err(Refusal::TooLittleMotion { rows, least: LEAST_ROWS, cut_off_hz: prepared.filter.cut_off_hz });
    }
    let base = Base::fit(&mut prepared, comparison, options.base).ok_or(Refusal::Undetermined)?;
    let hypotheses = catalogue();
    let settings =
        if prepared.quantisation_limited { options.settings.behind_quantisation() } else { options.settings };
    let workbench = &Workbench::new(&prepared, &base, &hypotheses);
    let measurement_noise = MeasurementNoise::of(&prepared, comparison, &base.residual);
    let mut search = Search { workbench, measurement_noise: measurement_noise.as_ref(), settings, refused: Vec::new() };
    let baseline = refit(workbench, &[]).ok_or(Refusal::Undetermined)?;
    let mut health: Vec<HealthNote> = as_recorded.notes().collect();
    health.extend(examine(comparison));
    health.extend(coarse_position(signals, &prepared));
    health.extend(scattered_sampling(signals, &prepared));
    // What the measurement got wrong is not dressed up as friction: then no physics is looked for.
    let blocked = options.measured_wrong || health.iter().any(|note| note.blocking);
    let found = match inferred {
        _ if blocked || as_recorded.explains(baseline.noise.rms) => Confirmed::nothing(&search),
        Some(inferred) => Confirmed::by_likelihood(inferred),
        None => Confirmed::of(&mut search, &baseline),
    };
    let Confirmed { mut accepted, withdrawn, negligible, last_round, noise } = found;
    let mut discarded = Discarded { withdrawn, negligible, ..Discarded::default() };
    if !options.by_likelihood {
        // In this order: what is set aside later is weighed beside what stays.
        discarded.doubtful = set_aside_doubtful(workbench, &mut accepted);
        discarded.minor = set_aside_minor(workbench, &mut accepted, &baseline);
        discarded.negligible = set_aside_negligible(workbench, &mut accepted, options.least_effect);
        if comparison.is_with_fitted_model() {
            discarded.withdrawn.extend(withdraw_without_shown_gain(workbench, &baseline, &mut accepted));
        }
    }
    let is_plainer = !options.by_likelihood && tell_by_a_part(workbench, &mut accepted, &baseline);
    if is_plainer || !discarded.is_empty() {
        polish(workbench, &mut accepted, &noise);
    }
    let mut improved = refit(workbench, &accepted).ok_or(Refusal::Undetermined)?;
    while let Some(index) = least_determined(&improved.effects) {
        discarded.undetermined.push(accepted.remove(index).effect());
        polish(workbench, &mut accepted, &noise);
        improved = refit(workbench, &accepted).ok_or(Refusal::Undetermined)?;
    }
    let proof = prove(workbench, &baseline, &improved);
    let shows_gain = proof.as_ref().is_none_or(Proof::shows_gain);
    let findings: Vec<Finding> = if blocked {
        health.iter().filter(|note| note.blocking).map(measurement_finding).collect()
    } else {
        let found = accepted.iter().enumerate();
        let told = |(index, effect)| finding(workbench, effect, &accepted, index, &improved);
        let is_weighed = inferred.is_some();
        found.map(told).map(|f| if is_weighed || shows_gain { f } else { f.without_shown_gain() }).collect()
    };
    let verdict = Verdict::of(&findings, blocked);
    let mut traces = Traces::of(workbench, &baseline, &improved);
    // A fault of the measurement adds no torque.
    traces.effects.resize(findings.len(), vec![0.0; traces.time.len()]);
    let mut diagnosis = Diagnosis {
        verdict,
        health,
        limits: detection_limits(workbench, &last_round, &improved),
        base: options.base,
        lock: options.lock,
        sealed_s: prepared.sealed_s(),
        given: (options.base == BaseKind::Reference).then(|| score_as_given(workbench, &baseline)),
        base_parameters: base_parameters(&base, &improved),
        noise_rmse: improved.noise.rms,
        traces,
        baseline: score(workbench, &baseline),
        improved: score(workbench, &improved),
        proof,
        rollout: roll_out(workbench, &baseline, &improved),
        findings,
        sets: inferred.map(Inferred::sets).unwrap_or_default(),
        discarded,
        rivals: last_round,
        cut_off_hz: prepared.filter.cut_off_hz,
        rows,
        sampling_delay_s: if let Delay::OfSampling(delay) = base.delay { delay } else { 0.0 },
        realigned_by_s: 0.0,
        baseline_refit: baseline,
        improved_refit: improved,
        law: None,
    };
    if options.base == BaseKind::Reference && !blocked {
        judge_friction_level(&mut diagnosis, workbench, &accepted, options.least_effect);
    }
    Ok(diagnosis)
}

/// Diagnoses with the torque put back by its likeliest delay, which is a finding where it is longer than the sampling's own.
fn diagnose_by_likelihood(comparison: &Comparison, request: &Request) -> Result<Diagnosis, Refusal> {
    let options = request.options;
    let period = comparison.signals.period;
    let hypotheses = catalogue();
    let mut prepared = comparison.prepare(options.lock);
    turn_over_as_simulated(&mut prepared, comparison);
    let base = Base::fit(&mut prepared, comparison, options.base).ok_or(Refusal::Undetermined)?;
    let simulated = of_simulation(&prepared, comparison);
    let repeats = comparison.simulation.as_ref().map_or(1.0, |simulation| simulation.repeats);
    let side = simulated.as_ref().map(|(prepared, base)| Side::without_delay(prepared, base).standing_for(repeats));
    let real = Side::without_delay(&prepared, &base);
    let candidates = Candidates::new(&hypotheses, &real, side.as_ref());
    let (noise, delay) = torque_delay(&candidates, &real, side.as_ref(), LONGEST_SAMPLING_DELAY * period);
    // The drive answers to the grain of its encoder some samples later.
    let is_more_than_grain = |late: &TorqueDelay| {
        2.0 * late.gain_nats * noise.rms * noise.rms > position_error_energy(&prepared, comparison)
    };
    // A torque that follows from commands and motion has their time.
    let told = delay.filter(is_more_than_grain).filter(|_| comparison.signals.commanded.is_none());
    let late_s = told.map_or(0.0, |late| late.delay_s);
    let side = simulated.as_ref().map(|(prepared, base)| Side::new(prepared, base).standing_for(repeats));
    let real = shifted(&Side::new(&prepared, &base), late_s);
    let weighing = Weighing::new(&candidates, &real, side.as_ref(), &noise, friction_of(&real));
    // What a law gets wrong by itself is no effect; where the rows that it was learned from stand beside it, these tell.
    let law_error = if side.is_none() { base.law_error() } else { 0.0 };
    let least = (options.least_effect.unwrap_or(LEAST_NAMED_SHARE) * friction_of(&real)).max(law_error);
    let inferred =
        infer(&hypotheses, candidates, (&real, side.as_ref()), (weighing, noise), (options.settings.seed, least));
    let in_step = comparison.realigned(late_s);
    let law = whole_law(&in_step, request.law, &inferred);
    let in_step = match &law {
        Some(law) => Comparison { reference: Some(law.at(&in_step.signals.states())), ..in_step },
        None => in_step,
    };
    let mut diagnosis = diagnose_locked(&in_step, request, Some(&inferred))?;
    diagnosis.law = law.map(Box::new);
    diagnosis.realigned_by_s = late_s;
    match &told {
        Some(late) => diagnosis.put_first(misalignment(late), Vec::new()),
        None => {
            let is_late = diagnosis.sampling_delay_s != 0.0;
            diagnosis.health.extend(is_late.then(|| late_torque(diagnosis.sampling_delay_s, period)));
        }
    }
    Ok(diagnosis)
}

/// Adds a wrong friction level of the reference to the findings; the figures before are then those of the reference as given.
fn judge_friction_level(
    diagnosis: &mut Diagnosis,
    workbench: &Workbench,
    accepted: &[Accepted],
    least_effect: Option<f64>,
) {
    let (baseline, improved) = (&diagnosis.baseline_refit, &diagnosis.improved_refit);
    let least_effect = least_effect.unwrap_or(LEAST_EFFECT_SHARE);
    match FrictionLevel::of(workbench, accepted, baseline, improved, least_effect) {
        FrictionLevel::Unchanged => {}
        FrictionLevel::Small(torque) => diagnosis.discarded.negligible.push((EffectId::FrictionLevel, torque)),
        FrictionLevel::Wrong { finding, torque, as_given } => {
            diagnosis.proof = prove(workbench, &as_given, improved);
            diagnosis.baseline = score(workbench, &as_given);
            diagnosis.traces.before = rest(workbench, &as_given);
            diagnosis.baseline_refit = *as_given;
            diagnosis.put_by_size(*finding, torque);
        }
    }
}
