//! From recordings and what they are compared with to a diagnosis that tells itself.

mod commanded;
mod compare;
mod improvement;
mod one_joint;
mod request;
mod sealed;
mod searched;
mod summary;
mod trajectory;

use std::time::Instant;

use serde_json::Value;

use super::actuator;
use super::recordings::{Warning, load_all, load_with_faults, units};
use super::source::Reading;
use crate::diagnose::advice::{Limits, Plan, Question, plan};
use crate::diagnose::answer::finding::tell_first;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::preparation::searched::searched as stretches_to_search;
use crate::diagnose::request::{Options, Refusal};
use crate::diagnose::run;
use crate::diagnose::search::thresholds::Settings;
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::fit::OtherForces;
use crate::joint::Joint;
use crate::parameter::Parameter;
use crate::physics::JointState;
use crate::physics::names::capital;
use crate::physics::units::Units;
use crate::recording::{Quantity, Recording};
use crate::report::tell::evidence::planned_motion;
use crate::report::tell::{Story, tell};
use crate::report::{self, DiagnosisPage};
use crate::samples::PositionNoise;
use crate::servo::{Identified, Load};
pub use commanded::signals;
use commanded::{Commands, under_torque};
use compare::{Compared, Simulated, comparison};
use improvement::improved_image;
pub use improvement::{Improvement, Written};
pub use request::{Against, BaseKind, Request, Told};
pub use searched::Searched;
use summary::{Summarised, summary};

/// A diagnosis with what was made of it.
#[derive(Debug)]
pub struct Diagnosed {
    /// What was found.
    pub diagnosis: Diagnosis,
    /// The improved model.
    pub improvement: Improvement,
    /// Name of the first recording.
    pub label: String,
    /// Name and CRC-64/XZ of the content of each recording, then of the simulation.
    pub sources: Vec<(String, u64)>,
    /// Samples that were read.
    pub samples: usize,
    /// What of a long recording was searched; `None` where all was.
    pub searched: Option<Searched>,
    /// Time that it took, s.
    pub seconds: f64,
    forces: OtherForces,
    advice: Option<Plan>,
    story: Story,
    units: Units,
    seed: u64,
    /// What is known of the actuator of a joint that reports no torque.
    actuator: Option<Identified>,
}

/// Diagnoses recordings of one joint; `stage` is told what is being done.
///
/// ```no_run
/// use frikan_trainer::joint::Joint;
/// use frikan_trainer::workflow::diagnose::{Against, Request};
/// let against = Against::Simulation("simulated.csv".into());
/// let request = Request::of(&["real.csv".into()], against);
/// let found = frikan_trainer::diagnose(&request, &Joint::default(), &|_| {})?;
/// print!("{}", found.text());
/// # Ok::<(), frikan_trainer::error::Error>(())
/// ```
///
/// # Errors
/// Whatever reading a recording reports; `FRK-D016`, `FRK-D017` or `FRK-D023` where the motion determines nothing.
pub fn diagnose(request: &Request<'_>, joint: &Joint, stage: &dyn Fn(&str)) -> Result<Diagnosed> {
    let begin = Instant::now();
    let reading = Reading::of(&[], request.memory_mb, request.recordings.len()).beside_search();
    let (recordings, warnings) =
        load_all(request.recordings.iter().copied(), |source| load_with_faults(source, joint, reading))?;
    if recordings.is_empty() {
        return Err(Error::new(&codes::USAGE, "there is no recording to diagnose"));
    }
    let simulation = compare::simulation(&request.against, joint, reading)?;
    let actuator = commanded::actuator(&recordings, simulation.as_ref(), joint)?;
    let by_likelihood = request.by_likelihood || actuator.is_some() && simulation.is_some();
    // A law of the load has to be told all of it; else the load follows from the motion, so that the torque does not explain itself.
    let load = if request.against.reads_load() { Load::OfActuator } else { Load::OfPayload };
    // From here on the constants of the actuator are known.
    let joint = &actuator.as_ref().map_or_else(|| joint.clone(), |actuator| actuator.joint(joint));
    // What reads the position of a commanded joint is biased by its noise, and has to be on both sides.
    let noise = PositionNoise::of(&recordings[0]).filter(|_| actuator.is_some());
    let simulation = simulation.map(|simulation| -> Result<_> {
        let joint = joint.of_simulation();
        let told = Commands::of(&simulation, &joint, load)?;
        let searched = |simulation: Recording| -> Result<Recording> {
            let simulation = under_torque(simulation, &joint, actuator.as_ref(), load)?;
            let excerpt = stretches_to_search(std::slice::from_ref(&simulation), reading.share_of_default());
            Ok(excerpt.map_or(simulation, |mut excerpt| excerpt.swap_remove(0)))
        };
        let measured_alike = match noise {
            Some(noise) => {
                let [one, other] = noise.on_both_ways(&simulation).map(searched);
                Some([one?, other?])
            }
            None => None,
        };
        Ok(Simulated { computed: searched(simulation)?, measured_alike, told })
    });
    let simulation = simulation.transpose()?;
    let told = recordings.iter().filter_map(|recording| Commands::of(recording, joint, load).transpose());
    let told = told.collect::<Result<Vec<_>>>()?;
    let recordings = recordings.into_iter().map(|recording| under_torque(recording, joint, actuator.as_ref(), load));
    let recordings = recordings.collect::<Result<Vec<_>>>()?;
    let forces = OtherForces::of(&recordings, joint)?;
    let recordings = recordings.into_iter().map(|recording| forces.taken_off(recording)).collect::<Result<Vec<_>>>()?;
    let real = &recordings[0];
    let excerpt = stretches_to_search(&recordings, reading.share_of_default());
    let real_searched = excerpt.as_deref().unwrap_or(&recordings);
    let (comparison, compared) =
        comparison(&request.against, (real_searched, &told), simulation, joint, request.by_likelihood)?;
    let told_searched = excerpt.is_some().then(|| Searched::new(comparison.signals.time.len(), &recordings));
    let units = units(real);
    let options = Options {
        base: match request.against {
            Against::Itself(base) => base,
            _ => BaseKind::Reference,
        },
        lock: request.lock,
        settings: Settings { seed: request.seed, ..Settings::default() },
        least_effect: request.least_effect,
        by_likelihood,
        measured_wrong: warnings.iter().any(Warning::is_blocking),
    };
    stage("weighing every effect against the noise");
    // That of a commanded joint is whole already.
    let static_law = compared.law().filter(|_| request.by_likelihood && told.is_empty());
    let diagnosis = match static_law {
        Some(law) => run::diagnose_beside(&comparison, law, &options),
        None => run::diagnose(&comparison, &options),
    };
    let mut diagnosis = diagnosis.map_err(|refusal| refused(&refusal, real))?;
    tell_measurement(&mut diagnosis, &warnings);
    stage("choosing what to record next");
    let advice = advice(&comparison, &diagnosis, joint, (&compared, real));
    let improvement = if diagnosis.is_blocked() {
        Improvement::Blocked
    } else {
        match improved_image(request, (&recordings, joint), &diagnosis, &comparison, &compared) {
            Ok(written) => Improvement::Written(written),
            Err(error) => Improvement::Refused(error),
        }
    };
    let story = tell(&diagnosis, improvement.sealed(), units);
    Ok(Diagnosed {
        label: real.label.clone(),
        sources: recordings.iter().map(Recording::source).chain(compared.source()).collect(),
        samples: told_searched.map_or(comparison.signals.time.len(), |searched| searched.of),
        searched: told_searched,
        seconds: begin.elapsed().as_secs_f64(),
        seed: request.seed,
        diagnosis,
        improvement,
        forces,
        advice,
        story,
        units,
        actuator,
    })
}

impl Diagnosed {
    /// The result for a terminal.
    #[must_use]
    pub fn text(&self) -> String {
        let actuator = self.actuator.as_ref().map(|actuator| format!("{}\n", actuator::sentence(actuator)));
        let factor = |factor: &Parameter| {
            format!(
                "Taken off: {} {} ({} to {}).\n",
                digits(factor.value),
                factor.unit,
                digits(factor.ci95[0]),
                digits(factor.ci95[1])
            )
        };
        let forces: String = self.forces.factors.iter().map(factor).collect();
        let untold: String = self.forces.remarks.iter().map(|remark| format!("{remark}\n")).collect();
        let searched = self.searched.map(|searched| searched.sentence() + "\n");
        text_of(&self.story, self.advice.as_ref())
            + &actuator.unwrap_or_default()
            + &forces
            + &untold
            + &searched.unwrap_or_default()
    }

    /// The result as JSON, schema `frikan.diagnose/1`.
    #[must_use]
    pub fn json(&self) -> Value {
        let told = Summarised {
            diagnosis: &self.diagnosis,
            story: &self.story,
            plan: self.advice.as_ref(),
            sealed: self.sealed(),
            units: self.units,
        };
        let mut summary = summary(&told, self.seconds, self.seed);
        if let Some(actuator) = &self.actuator {
            summary["actuator"] = actuator::constants(actuator);
        }
        if let Some(searched) = self.searched {
            summary["searched"] = searched.to_json();
        }
        summary
    }

    /// The result as one HTML page; `compared_with` names what the recording was compared with.
    #[must_use]
    pub fn report(&self, compared_with: &str, told: Told<'_>) -> String {
        let actuator = self.actuator.as_ref().map(|actuator| format!(" {}", actuator::sentence(actuator)));
        let searched = self.searched.map(|searched| format!(" {}", searched.sentence()));
        let settings = format!("Seed {}.{}{}", self.seed, actuator.unwrap_or_default(), searched.unwrap_or_default());
        report::diagnosis(&DiagnosisPage {
            recording: &self.label,
            compared_with,
            diagnosis: &self.diagnosis,
            story: &self.story,
            units: self.units,
            plan: self.advice.as_ref(),
            rigid_body: match &self.improvement {
                Improvement::Written(written) => written.compared_with,
                Improvement::Refused(_) | Improvement::Blocked => None,
            },
            put_right: told.put_right,
            export: told.remarks,
            origin: report::Origin { command: told.command, recordings: &self.sources, settings: &settings },
        })
    }

    /// The improved image, where there is one that is no worse on sealed rows than the model compared with.
    #[must_use]
    pub fn image(&self) -> Option<&[u8]> {
        match &self.improvement {
            Improvement::Written(written) if !self.sealed().is_some_and(SealedScore::is_worse) => Some(&written.image),
            _ => None,
        }
    }

    /// How much better the improved image is on rows that decided nothing.
    #[must_use]
    pub fn sealed(&self) -> Option<&SealedScore> {
        self.improvement.sealed()
    }

    /// The motion that would tell apart what cannot be told, as CSV.
    #[must_use]
    pub fn trajectory(&self) -> Option<String> {
        self.advice.as_ref().map(|plan| trajectory::to_csv(plan, self.units.rotary))
    }
}

/// Puts what the checks of the recordings found before what was found behind them.
fn tell_measurement(diagnosis: &mut Diagnosis, warnings: &[Warning]) {
    for warning in warnings.iter().rev() {
        tell_first(diagnosis, warning.to_health(), warning.is_finding());
    }
}

/// The motion that would tell apart what cannot be told, within the limits of the joint.
fn advice(
    comparison: &Comparison,
    diagnosis: &Diagnosis,
    joint: &Joint,
    (compared, real): (&Compared, &Recording),
) -> Option<Plan> {
    let limits = Limits {
        lowest_position: joint.limits.lowest_position_rad,
        highest_position: joint.limits.highest_position_rad,
        speed: joint.limits.velocity_rad_s,
        acceleration: joint.limits.acceleration_rad_s2,
    };
    let recorded_body = real.channel(Quantity::RigidBodyTorque).is_some();
    let at = |state: &JointState| compared.at(state, recorded_body);
    plan(&Question { comparison, diagnosis, limits, reference: Some(&at) })
}

fn refused(refusal: &Refusal, recording: &Recording) -> Error {
    let code = match refusal {
        Refusal::TooLittleMotion { .. } => &codes::SEGMENTS_TOO_SHORT,
        Refusal::NotMeasured { .. } => &codes::NOT_MEASURED,
        Refusal::Undetermined => &codes::NO_MOTION,
    };
    Error::new(code, refusal.to_string()).in_file(recording.file())
}

/// A story for a terminal.
fn text_of(story: &Story, advice: Option<&Plan>) -> String {
    let health = story.health.iter().map(|sentence| format!("  - Measurement: {sentence}\n"));
    let bullets = health.chain(story.findings.iter().map(|sentence| format!("  * {sentence}\n")));
    let rest = story.rest().map(|sentence| format!("{sentence}\n"));
    let advice = advice.map(|plan| format!("{}.\n", capital(&planned_motion(plan))));
    let given = story.given.iter().map(|sentence| format!("{sentence}\n"));
    std::iter::once(format!("{}\n", story.headline)).chain(given).chain(bullets).chain(rest).chain(advice).collect()
}
