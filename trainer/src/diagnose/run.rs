//! One diagnosis from signals to outcome.

use crate::diagnose::answer::finding::{base_parameters, finding, measurement_finding, unexplained_finding};
use crate::diagnose::answer::outcome::{DetectionLimit, Diagnosis, Finding, Given, Score, Verdict};
use crate::diagnose::answer::traces::Traces;
use crate::diagnose::checks::command_beyond_limit::Command;
use crate::diagnose::checks::health::{
    AsRecorded, HealthNote, coarse_position, examine, scattered_sampling, unexplained_event,
};
use crate::diagnose::comparison::base::{Base, BaseKind, Delay};
use crate::diagnose::evidence::measurement_noise::MeasurementNoise;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::prepare::Prepared;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::proof::discarded::{
    FORMULA_ERROR, least_torque, set_aside_doubtful, set_aside_minor, set_aside_negligible, withdraw_unproven,
};
use crate::diagnose::proof::locked_rows::{prove, rest};
use crate::diagnose::proof::refit::{Refit, polish, refit};
use crate::diagnose::proof::rollout::roll_out;
use crate::diagnose::realign::diagnose_in_step;
use crate::diagnose::search::forward_backward::{Search, SearchOutcome};
use crate::diagnose::search::round::Scored;
use crate::diagnose::search::thresholds::Settings;
use crate::numerics::least_squares::{rows_in, weighted};
use crate::physics::{EffectId, catalogue};

/// What a diagnosis is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The base model.
    pub base: BaseKind,
    /// Which blocks are locked.
    pub lock: Lock,
    /// Limits of the search.
    pub settings: Settings,
}

impl Default for Options {
    fn default() -> Self {
        Self { base: BaseKind::CoulombViscous, lock: Lock::Spread, settings: Settings::default() }
    }
}

/// Why no diagnosis is possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Too few rows of motion behind the filter.
    #[error("only {rows} rows of motion are left behind the filter at {cut_off_hz} Hz; at least {least} are needed")]
    TooLittleMotion {
        /// Rows that are left.
        rows: usize,
        /// Rows that are needed.
        least: usize,
        /// Cut-off of the filter in Hz.
        cut_off_hz: f64,
    },
    /// The torque is the same in every row.
    #[error("the torque is {torque} in every row: it was not measured")]
    NotMeasured {
        /// That torque.
        torque: f64,
    },
    /// The base model cannot be determined.
    #[error("the motion does not determine even the base model (one velocity, or no change of direction)")]
    Undetermined,
}

/// Least rows of evidence.
const LEAST_ROWS: usize = 150;
/// What a locked stretch is left with over what any open one is, root mean square, from which other blocks are locked.
const STICKS_OUT: f64 = 1.5;
/// The same from which it is no noise, whatever it is.
const NO_NOISE: f64 = 6.0;
/// Non-centrality that is found with 90 % probability.
const FOUND_WITH_NINETY_PERCENT: f64 = 40.0;

/// Diagnoses one recording. `actuator` is the text of the actuator's unit ("N m", "N" or "A").
///
/// A torque that was recorded at another time than the motion is a finding of its own; physics is looked for once it is
/// put back. Up to about a sample it is the sampling's own: put back and no finding.
///
/// # Errors
/// [`Refusal`] when the recording holds too little motion for any answer, or no torque.
pub fn diagnose(signals: &Signals, actuator: &str, options: &Options) -> Result<Diagnosis, Refusal> {
    if let Some(&torque) = signals.torque.first().filter(|first| signals.torque.iter().all(|torque| torque == *first)) {
        return Err(Refusal::NotMeasured { torque });
    }
    let request = Request { actuator, options: *options, as_recorded: &AsRecorded::of(signals, actuator) };
    let diagnose =
        |signals: &Signals| diagnose_in_step(signals, options, &|aligned| diagnose_aligned(aligned, &request));
    let Some(command) = Command::of(signals) else { return diagnose(signals) };
    let mut diagnosis = diagnose(&command.given(signals))?;
    command.tell(&mut diagnosis);
    Ok(diagnosis)
}

/// What is asked for, whatever becomes of the signals on the way.
#[derive(Clone, Copy)]
struct Request<'a> {
    actuator: &'a str,
    options: Options,
    /// What is wrong with the recording as it is: of a torque that was put back between its samples nobody can tell.
    as_recorded: &'a AsRecorded,
}

/// Diagnoses signals whose torque and motion belong together; with other blocks locked where a one-off event lay in those that
/// were.
fn diagnose_aligned(signals: &Signals, request: &Request) -> Result<Diagnosis, Refusal> {
    let Request { actuator, options, .. } = *request;
    let mut first = diagnose_locked(signals, request)?;
    let worst = first.traces.worst_locked().filter(|worst| worst.over_open > STICKS_OUT);
    let (Lock::Spread, Some(worst)) = (options.lock, worst) else { return Ok(first) };
    if worst.over_open > NO_NOISE {
        match first.verdict {
            Verdict::BadData => {}
            Verdict::Consistent => {
                first.verdict = Verdict::Unexplained;
                first.findings.push(unexplained_finding(worst, &first.traces, actuator));
                first.traces.effects.push(first.traces.left_within(worst.when_s));
            }
            Verdict::MissingPhysics | Verdict::Unexplained => first.health.push(unexplained_event(worst, actuator)),
        }
    }
    let elsewhere = Request { options: Options { lock: Lock::SpreadElsewhere, ..options }, ..*request };
    let Ok(second) = diagnose_locked(signals, &elsewhere) else { return Ok(first) };
    let events = |diagnosis: &Diagnosis| {
        diagnosis.findings.iter().filter(|finding| finding.effect == EffectId::TransientEvent).count()
    };
    let sticks_out_less = || second.traces.worst_locked().is_some_and(|left| left.over_open < worst.over_open);
    let is_better = events(&second) > events(&first)
        || events(&second) == events(&first) && events(&first) > 0 && sticks_out_less();
    Ok(if is_better { second } else { first })
}

fn diagnose_locked(signals: &Signals, request: &Request) -> Result<Diagnosis, Refusal> {
    let Request { actuator, options, as_recorded } = *request;
    let mut prepared = Prepared::new(signals, options.lock);
    let rows = rows_in(&prepared.open_runs());
    if rows < LEAST_ROWS {
        return Err(Refusal::TooLittleMotion { rows, least: LEAST_ROWS, cut_off_hz: prepared.filter.cut_off_hz });
    }
    let base = Base::fit(&mut prepared, signals, options.base).ok_or(Refusal::Undetermined)?;
    let hypotheses = catalogue();
    let settings = if prepared.grain_limited { options.settings.behind_grain() } else { options.settings };
    let workbench = &Workbench::new(&prepared, &base, &hypotheses);
    let measurement_noise = MeasurementNoise::of(&prepared, signals, &base.residual);
    let search = Search { workbench, measurement_noise: measurement_noise.as_ref(), settings };
    let baseline = refit(workbench, &[]).ok_or(Refusal::Undetermined)?;
    let mut health: Vec<HealthNote> = as_recorded.notes(baseline.noise.rms, actuator).collect();
    health.extend(examine(signals));
    health.extend(coarse_position(signals, &prepared));
    health.extend(scattered_sampling(signals, &prepared));
    // What the measurement got wrong is not dressed up as friction: then no physics is looked for.
    let blocked = health.iter().any(|note| note.blocking);
    let SearchOutcome { mut accepted, last_round, noise } = if blocked { search.nothing() } else { search.run() };
    polish(workbench, &mut accepted, &noise);
    let withdrawn = withdraw_unproven(workbench, &settings, &mut accepted);
    let doubtful = set_aside_doubtful(workbench, &mut accepted);
    let minor = set_aside_minor(workbench, &mut accepted, &baseline);
    let negligible = set_aside_negligible(workbench, &mut accepted);
    if !(withdrawn.is_empty() && doubtful.is_empty() && minor.is_empty() && negligible.is_empty()) {
        polish(workbench, &mut accepted, &noise);
    }
    let improved = refit(workbench, &accepted).ok_or(Refusal::Undetermined)?;
    let proof = prove(workbench, &baseline, &improved);
    let findings: Vec<Finding> = accepted
        .iter()
        .enumerate()
        .map(|(index, found)| finding(workbench, found, &accepted, index, &improved, actuator))
        .collect();
    let faults = health.iter().filter(|note| note.blocking).map(measurement_finding);
    let findings = if blocked { faults.collect() } else { findings };
    let verdict = Verdict::of(&findings, blocked);
    let given = (options.base == BaseKind::Reference).then(|| given(workbench, &baseline));
    let score = |refit: &Refit| score(workbench, &rest(workbench, refit));
    let mut traces = Traces::of(workbench, &baseline, &improved);
    // A fault of the measurement adds no torque.
    traces.effects.resize(findings.len(), vec![0.0; traces.time.len()]);
    Ok(Diagnosis {
        verdict,
        health,
        limits: limits(workbench, &last_round, &improved),
        base: options.base,
        lock: options.lock,
        given,
        base_parameters: base_parameters(&base, &improved, signals, actuator),
        noise_rmse: improved.noise.rms,
        traces,
        baseline: score(&baseline),
        improved: score(&improved),
        proof,
        rollout: roll_out(workbench, &baseline, &improved),
        findings,
        minor,
        doubtful,
        negligible,
        withdrawn,
        rivals: last_round,
        cut_off_hz: prepared.filter.cut_off_hz,
        rows,
        sampling_delay_s: if let Delay::OfSampling(delay) = base.delay { delay } else { 0.0 },
        put_back_s: 0.0,
        baseline_refit: baseline,
        improved_refit: improved,
    })
}

/// The reference before its parameters moved; differentiation bias and the sampling's delay are none of its errors.
fn given(workbench: &Workbench, baseline: &Refit) -> Given {
    let moved = workbench.base.names.len();
    let change = weighted(&workbench.base.columns[..moved], &baseline.base[..moved]);
    let unmoved: Vec<f64> = rest(workbench, baseline).iter().zip(change).map(|(rest, change)| rest + change).collect();
    Given { score: score(workbench, &unmoved), holds: workbench.base.held.clone() }
}

fn score(workbench: &Workbench, rest: &[f64]) -> Score {
    let torque = workbench.prepared.filtered(&workbench.prepared.torque);
    let count = rest.len() as f64;
    let mean = torque.iter().sum::<f64>() / count;
    let energy: f64 = rest.iter().map(|r| r * r).sum();
    let spread: f64 = torque.iter().map(|t| (t - mean).powi(2)).sum();
    Score { rmse: (energy / count).sqrt(), r2: 1.0 - energy / spread.max(f64::MIN_POSITIVE) }
}

/// Torque of each effect that was not found at which it would have been found nine times in ten.
fn limits(workbench: &Workbench, table: &[Scored], refit: &Refit) -> Vec<DetectionLimit> {
    let bench = workbench.bench(workbench.base.columns.clone(), &refit.noise);
    let doubt = workbench.law_uncertainty(&bench, &refit.noise);
    let least = least_torque(workbench).max(FORMULA_ERROR * workbench.base.formula_error);
    table
        .iter()
        .filter_map(|scored| {
            let Label::Named(effect) = scored.label else { return None };
            let columns = workbench.filtered_columns(&scored.label, &scored.shape);
            let first = columns.first()?;
            // The statistic of the column itself as target: its non-centrality per squared amplitude.
            let white = workbench.whitened(&columns[..1], &refit.noise);
            let visible = doubt.trust(&white) * bench.visible_energy(&white[0])?;
            let amplitude = (FOUND_WITH_NINETY_PERCENT / visible).sqrt();
            let rms = (first.iter().map(|v| v * v).sum::<f64>() / first.len() as f64).sqrt();
            Some(DetectionLimit { effect, torque_rms: (amplitude * rms).max(least) })
        })
        .filter(|limit| limit.torque_rms.is_finite())
        .collect()
}
