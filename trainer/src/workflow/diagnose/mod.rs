//! From recordings and what they are compared with to a diagnosis that tells itself.

mod commanded;
mod compare;
mod one_joint;
mod request;
mod sealed;
mod summary;
mod trajectory;

use std::time::Instant;

use frikan_shared::image::Image;
use frikan_shared::model::RigidBody;
use frikan_shared::units::Unit;
use serde_json::Value;

use super::recordings::{Warning, load_all, load_with_faults, units};
use crate::compile::cost::in_floats;
use crate::compile::improved::{Origin, improve};
use crate::diagnose::advice::{Limits, Plan, Question, plan};
use crate::diagnose::answer::finding::tell_first;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::request::{Options, Refusal};
use crate::diagnose::run;
use crate::diagnose::search::thresholds::Settings;
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::fit;
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
use crate::servo::{Identified, Load};
use commanded::{Commands, under_torque};
use compare::{Compared, comparison};
pub use request::{Against, BaseKind, Request, Told};
use sealed::sealed_score;
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

/// The improved model of a diagnosis.
#[derive(Clone, Debug)]
pub enum Improvement {
    /// It was made.
    Written(Written),
    /// It cannot be written as an image.
    Refused(Error),
    /// The measurement has to be put right first.
    Blocked,
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
    let (recordings, warnings) =
        load_all(request.recordings.iter().copied(), |source| load_with_faults(source, joint))?;
    if recordings.is_empty() {
        return Err(Error::new(&codes::USAGE, "there is no recording to diagnose"));
    }
    let simulation = compare::simulation(&request.against, joint)?;
    let actuator = commanded::actuator(&recordings, simulation.as_ref(), joint)?;
    // A commanded joint is compared with the law of its simulation, whose rows stand in the model only where that is asked for.
    let by_likelihood = request.by_likelihood || actuator.is_some() && simulation.is_some();
    // An image may hold friction of the load; other effects of the load are looked for in what follows from the motion.
    let load = if matches!(request.against, Against::Model(_)) { Load::OfActuator } else { Load::OfPayload };
    let simulation =
        simulation.map(|simulation| under_torque(simulation, &joint.of_simulation(), actuator.as_ref(), load));
    // From here on the constants of the actuator are known.
    let joint = &actuator.as_ref().map_or_else(|| joint.clone(), |actuator| actuator.joint(joint));
    let told = recordings.iter().filter_map(|recording| Commands::of(recording, joint).transpose());
    let told = told.collect::<Result<Vec<_>>>()?;
    let recordings = recordings.into_iter().map(|recording| under_torque(recording, joint, actuator.as_ref(), load));
    let recordings = recordings.collect::<Result<Vec<_>>>()?;
    let forces = OtherForces::of(&recordings, joint)?;
    let recordings = recordings.into_iter().map(|recording| forces.taken_off(recording)).collect::<Result<Vec<_>>>()?;
    let real = &recordings[0];
    let (comparison, compared) =
        comparison(&request.against, (&recordings, &told), simulation.transpose()?, joint, request.by_likelihood)?;
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
    let mut diagnosis = run::diagnose(&comparison, &options).map_err(|refusal| refused(&refusal, real))?;
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
    let story = tell(&diagnosis, sealed_of(&improvement), units);
    Ok(Diagnosed {
        label: real.label.clone(),
        sources: recordings.iter().map(Recording::source).chain(compared.source()).collect(),
        samples: comparison.signals.time.len(),
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
        let actuator = self.actuator.as_ref().map(|actuator| format!("{}\n", commanded::sentence(actuator)));
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
        text_of(&self.story, self.advice.as_ref()) + &actuator.unwrap_or_default() + &forces + &untold
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
            summary["actuator"] = commanded::constants(actuator);
        }
        summary
    }

    /// The result as one HTML page; `compared_with` names what the recording was compared with.
    #[must_use]
    pub fn report(&self, compared_with: &str, told: Told<'_>) -> String {
        let actuator = self.actuator.as_ref().map(|actuator| format!(" {}", commanded::sentence(actuator)));
        let settings = format!("Seed {}.{}", self.seed, actuator.unwrap_or_default());
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
        sealed_of(&self.improvement)
    }

    /// The motion that would tell apart what cannot be told, as CSV.
    #[must_use]
    pub fn trajectory(&self) -> Option<String> {
        self.advice.as_ref().map(|plan| trajectory::to_csv(plan, self.units.rotary))
    }
}

fn sealed_of(improvement: &Improvement) -> Option<&SealedScore> {
    match improvement {
        Improvement::Written(written) => written.sealed.as_ref(),
        Improvement::Refused(_) | Improvement::Blocked => None,
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

/// An improved image, what it holds in sentences, and how much better it is on rows that decided nothing.
#[derive(Clone, Debug)]
pub struct Written {
    /// The image.
    pub image: Vec<u8>,
    /// What it holds, in sentences.
    pub remarks: Vec<String>,
    /// Rigid body of the model compared with, where that is a model.
    pub compared_with: Option<RigidBody>,
    /// How much better it is on rows that decided nothing, where there are such.
    pub sealed: Option<SealedScore>,
}

fn improved_image(
    request: &Request<'_>,
    (recordings, joint): (&[Recording], &Joint),
    diagnosis: &Diagnosis,
    comparison: &Comparison,
    compared: &Compared,
) -> Result<Written> {
    let mut provenance = fit::model::provenance(joint.name.as_deref().unwrap_or_default(), recordings, request.seed);
    let origin = match compared {
        Compared::Itself(body) => Origin::Recording(**body),
        Compared::Simulation(law, given, _) => Origin::Simulation(law, *given),
        Compared::Model(image) => {
            provenance.law_error = image.provenance.law_error;
            provenance.rigid_body_error = image.provenance.rigid_body_error;
            Origin::Model(&image.model)
        }
    };
    let unit = match units(&recordings[0]).actuator {
        "N" => Unit::Newton,
        "A" => Unit::Ampere,
        _ => Unit::NewtonMetre,
    };
    let mut improved = improve(diagnosis, comparison, origin, unit, request.target.unwrap_or_default())
        .map_err(|why| Error::new(&codes::BAD_IMAGE, why.to_string()))?;
    // Of a drive that nobody named there is nothing to say.
    improved.remarks.extend(request.target.and_then(|target| in_floats(target, &improved.model)));
    let image = fit::model::to_bytes(&Image { provenance, model: *improved.model })?;
    // What is scored is what a drive would decode.
    let after = fit::model::from_bytes(&image)?.model;
    let compared_with = improved.compared_with.as_ref().map(|before| before.rigid_body);
    let sealed = improved
        .compared_with
        .and_then(|before| sealed_score(&diagnosis.sealed_s, recordings, comparison.signals.period, [&before, &after]));
    Ok(Written { image, remarks: improved.remarks, compared_with, sealed })
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
