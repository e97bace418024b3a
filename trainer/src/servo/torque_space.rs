//! The constants of an actuator in one step with rigid body and friction: the torque is linear in them, so that
//! `known + sum of constant * column = rigid body + friction` is one problem of least squares. What a payload, an inertia or a gravity
//! torque is known of says how large all of it is.

use super::commanded::Commanded;
use super::identified::Identified;
use crate::actuator::{Constant, Kind, Known, Open, Partial};
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::numerics::hat_functions::law_error_hats;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::regression::{LinearFit, least_squares};
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;
use crate::recording::{Quantity, Recording};
use crate::rollout::Body;
use crate::samples::rigid_body::{TermKind, given_torque, terms};
use crate::samples::{Preparation, Request, Samples, prepare, top_speed};

/// Below this share of the top speed friction is no function of velocity; such samples do not enter.
const REST_SHARE: f64 = 0.01;
/// The columns depend on the constants where a limit is reached: so often they are taken anew.
const PASSES: usize = 3;
/// A constant whose standard error is more than this share of it is not determined.
const MOST_ERROR: f64 = 0.2;
/// The loss by back-EMF shows beside viscous friction where the joint moves in this share of the samples without being driven.
const COASTING_SHARE: f64 = 0.02;

/// Names of the channels that carry the columns through the filter.
const KNOWN: &str = "actuator_known";
const BACK_EMF: &str = "actuator_back_emf";
const ENABLED: &str = "actuator_enabled";

/// Identifies what is open of the actuator of `joint` in recordings of its commands.
///
/// # Errors
/// `FRK-D009` and `FRK-D014` for columns and constants that are missing, `FRK-N005` for a constant that the recordings do not determine.
pub(crate) fn identify(recordings: &[Recording], joint: &Joint) -> Result<Identified> {
    match identify_or_start(recordings, joint)? {
        (identified, None) => Ok(identified),
        (_, Some(undetermined)) => Err(undetermined),
    }
}

/// The same; where the recordings do not determine a constant, all that are open are where they start, beside the error that says so.
///
/// # Errors
/// As [`identify`], `FRK-N005` only where nothing says where an open constant starts.
pub(crate) fn identify_or_start(recordings: &[Recording], joint: &Joint) -> Result<(Identified, Option<Error>)> {
    let commanded = recordings.iter().map(|recording| Commanded::of(recording, joint)).collect::<Result<Vec<_>>>()?;
    let first = commanded.first().ok_or_else(|| Error::new(&codes::RECORDINGS_DISAGREE, "no recording is given"))?;
    let all = open_constants(&commanded);
    // Without a reference velocity the velocity gain of a controller acts as viscous friction does.
    let is_told = |open: &Open| *open != Open::Kd || commanded.iter().any(|one| one.has(Quantity::ReferenceVelocity));
    let (open, untold): (Vec<Open>, Vec<Open>) = all.into_iter().partition(is_told);
    let untold: Vec<(Open, f64)> = untold.into_iter().map(|open| (open, 0.0)).collect();
    let preparation = preparation(&commanded, &open)?;
    let mut identified = Identified::unsolved(first.partial.clone(), preparation);
    identified.values.clone_from(&untold);
    identified.open.clone_from(&open);
    let kind = first.partial.actuator.kind;
    let mut problem = None;
    for _ in 0..PASSES {
        let parts =
            commanded.iter().map(|one| prepare(&columns(one, &identified.complete(&one.partial), &open), &preparation));
        let samples = Samples::join(parts.collect::<Result<Vec<_>>>()?)?;
        let found = Problem::of(&samples, &commanded, joint, &open)?;
        let coefficients = found.fit.coefficients.iter().map(|value| value.max(0.0));
        identified.values = open.iter().copied().zip(coefficients).chain(untold.iter().copied()).collect();
        identified.back_emf = found.back_emf.map(|(value, _)| value.max(0.0));
        identified.load = found.load;
        problem = Some(found);
        if open.is_empty() {
            break;
        }
    }
    let told = problem.map_or(Ok(()), |problem| problem.tell(kind, &open, joint, &mut identified));
    if !untold.is_empty() {
        let sentence = "The velocity gain of the controller is counted as viscous friction: without a reference velocity nothing tells them apart.";
        identified.remarks.push(sentence.to_owned());
    }
    if let Err(undetermined) = &told {
        let start = |open: &Open| Some((*open, open.start(kind, &joint.actuator.constants)?));
        let Some(started) = open.iter().map(start).collect::<Option<Vec<_>>>() else {
            return Err(undetermined.clone());
        };
        identified.values = started.into_iter().chain(untold).collect();
        identified.back_emf = None;
        identified.parameters.clear();
    }
    identified.partial = identified.complete(&first.partial);
    Ok((identified, told.err()))
}

/// The actuator of a recording as joint.toml gives it, all of it.
///
/// # Errors
/// `FRK-D009` and `FRK-D014` for columns and constants that are missing.
pub(crate) fn as_given(recording: &Recording, joint: &Joint) -> Result<Identified> {
    let commanded = Commanded::of(recording, joint)?;
    if let Some(open) = commanded.partial.open.first() {
        let message = "the torque that the actuator makes of its commands needs this constant; `trainer fit` identifies it and writes it beside its image";
        let key = format!("actuator.{}", open.constant(commanded.partial.actuator.kind).key());
        return Err(Error::new(&codes::MISSING_PARAMETER, message).in_column(key).in_file(recording.file()));
    }
    let preparation = preparation(std::slice::from_ref(&commanded), &[])?;
    Ok(Identified::unsolved(commanded.partial, preparation))
}

/// The filter of recordings of commands: that of the torque with the constants as they are taken.
fn preparation(commanded: &[Commanded<'_>], open: &[Open]) -> Result<Preparation> {
    let provisional: Vec<Recording> = commanded.iter().map(|one| columns(one, &one.partial, open)).collect();
    Preparation::plan(&provisional.iter().collect::<Vec<_>>(), &Joint::default(), &Request::default())
}

/// What is open in any of the recordings.
pub(super) fn open_constants(commanded: &[Commanded<'_>]) -> Vec<Open> {
    let is_open = |constant: &Open| commanded.iter().any(|one| one.partial.open.contains(constant));
    [Open::Gain, Open::Kp, Open::Kd].into_iter().filter(is_open).collect()
}

/// A recording of what is known of the torque, and of the columns of what is open: the torque with the constants as they are taken is its
/// actuator, by which the filter is chosen.
fn columns(one: &Commanded<'_>, partial: &Partial, open: &[Open]) -> Recording {
    let actuator = &partial.actuator;
    let applied = one.applied(actuator);
    let of = |constant: Open| -> Vec<f64> {
        // A constant that is given in this recording is part of what is known.
        let is_open = one.partial.open.contains(&constant);
        let column = applied.iter().map(|applied| match constant {
            Open::Gain => applied.by_gain,
            Open::Kp => applied.by_kp,
            Open::Kd => applied.by_kd,
        });
        column.map(|value| if is_open { value } else { 0.0 }).collect()
    };
    let mut known: Vec<f64> =
        applied.iter().zip(one.velocities()).map(|(applied, velocity)| applied.at(velocity)).collect();
    let torque = known.clone();
    let mut named = Vec::new();
    for constant in open {
        let column = of(*constant);
        let value = match constant {
            Open::Gain => actuator.gain,
            Open::Kp => actuator.kp,
            Open::Kd => actuator.kd,
        };
        known.iter_mut().zip(&column).for_each(|(known, column)| *known -= value * column);
        named.push((name(*constant).to_owned(), column));
    }
    // What a motor loses by its velocity is told apart from viscous friction where it is off, if at all.
    let lost = applied.iter().map(|applied| applied.by_back_emf).collect::<Vec<_>>();
    known.iter_mut().zip(&lost).for_each(|(known, lost)| *known -= actuator.back_emf * lost);
    named.push((BACK_EMF.to_owned(), lost));
    named.push((ENABLED.to_owned(), one.enabled().collect()));
    named.push((KNOWN.to_owned(), known));
    one.recording.clone().with_torque(torque, named)
}

fn name(open: Open) -> &'static str {
    match open {
        Open::Gain => "actuator_gain",
        Open::Kp => "actuator_kp",
        Open::Kd => "actuator_kd",
    }
}

/// The problem of least squares at the samples in motion.
struct Problem {
    fit: LinearFit,
    /// With its standard error, where the recordings show it beside viscous friction.
    back_emf: Option<(f64, f64)>,
    /// Whether anything says how large all torques are.
    has_scale: bool,
    /// Whether the joint is taken to have no gravity beside that of its payload.
    own_gravity_left_out: bool,
    /// Friction per torque of the actuator, 0 where no load is known.
    load: f64,
}

impl Problem {
    fn of(samples: &Samples, commanded: &[Commanded<'_>], joint: &Joint, open: &[Open]) -> Result<Self> {
        let velocity = samples.require_velocity()?;
        let rest = REST_SHARE * top_speed(velocity);
        let moving: Vec<usize> = (0..velocity.len()).filter(|&row| velocity[row].abs() > rest).collect();
        let pick = |column: &[f64]| moving.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let channel = |name: &str| samples.input(name).unwrap_or_default();
        let known = pick(channel(KNOWN));
        let (given, load) = given(samples, commanded, joint)?;
        let (given, load) = (pick(&given), pick(&load));
        let known_gravity = load.iter().any(|torque| *torque != 0.0);
        let alike = commanded.windows(2).all(|pair| pair[0].payload == pair[1].payload);
        let own_gravity_left_out = known_gravity && alike && joint.rigid_body.gravity_torque_nm.is_none();
        let has_scale = open.is_empty() || known.iter().chain(&given).any(|torque| *torque != 0.0);

        let mut columns: Vec<Vec<f64>> = open.iter().map(|constant| pick(channel(name(*constant)))).collect();
        let enabled = pick(channel(ENABLED));
        let coasting = enabled.iter().filter(|share| **share < 0.5).count() as f64;
        let tied = commanded.iter().any(|one| one.partial.actuator.back_emf != 0.0);
        let is_motor = commanded.iter().any(|one| one.partial.actuator.kind.is_motor());
        let coasts = is_motor && coasting > COASTING_SHARE * enabled.len() as f64;
        let place_of_loss = columns.len();
        if coasts {
            let lost = pick(channel(BACK_EMF));
            columns.push(lost);
        }
        let minus = |column: Vec<f64>| column.into_iter().map(|x| -x).collect::<Vec<f64>>();
        let own = terms(samples, joint).into_iter().filter(|term| match term.kind {
            TermKind::GravitySine | TermKind::GravityCosine => !own_gravity_left_out,
            // The hats below are odd; what is even of the friction is the offset.
            _ => true,
        });
        columns.extend(own.map(|term| minus(pick(&term.column))));
        let speeds = pick(velocity);
        let hats = law_error_hats(&speeds, None, top_speed(&speeds));
        columns.extend(hats.into_iter().filter(|hat| hat.iter().any(|x| *x != 0.0)).map(minus));
        if known_gravity {
            // The load of the gear is the torque of its motor; how large that is in N m is the other factor of this column's coefficient.
            let torque = pick(samples.actuator.as_deref().unwrap_or_default());
            let by_load = speeds.iter().zip(&torque).map(|(v, torque)| -v.signum() * torque.abs()).collect();
            columns.push(by_load);
        }
        let target: Vec<f64> = given.iter().zip(&known).map(|(given, known)| given - known).collect();
        let fit = least_squares(&columns, &target, &even_blocks(target.len(), ERROR_BLOCKS));
        let back_emf = (coasts && !tied).then(|| (fit.coefficients[place_of_loss], fit.standard_error(place_of_loss)));
        let load = if known_gravity { fit.coefficients.last().copied().unwrap_or(0.0) } else { 0.0 };
        Ok(Self { fit, back_emf, has_scale, own_gravity_left_out, load })
    }

    /// Parameters and remarks, or which constant is not determined.
    fn tell(&self, kind: Kind, open: &[Open], joint: &Joint, identified: &mut Identified) -> Result<()> {
        identified.has_own_gravity = !self.own_gravity_left_out;
        for (index, constant) in open.iter().enumerate() {
            let (value, error) = (self.fit.coefficients[index], self.fit.standard_error(index));
            let (key, (name, symbol, unit)) = (constant.constant(kind), described(kind, *constant));
            // A damping that nothing tells from viscous friction is counted as such.
            let is_small = *constant == Open::Kd && value.abs() < 2.0 * error;
            if !self.has_scale || !is_small && (value <= 0.0 || error > MOST_ERROR * value) {
                return Err(undetermined(key, self.has_scale, value, error));
            }
            let ci95 = [value - NORMAL_95 * error, value + NORMAL_95 * error];
            identified.parameters.push(Parameter {
                name: name.to_owned(),
                symbol: symbol.to_owned(),
                value,
                unit: unit.to_owned(),
                ci95,
            });
            if let Some(Known::Between(low, high)) = joint.actuator.constants.get(&key)
                && (value < *low || value > *high)
            {
                let key = key.key();
                identified
                    .remarks
                    .push(format!("`{key}` was found to be {value:.4}, beyond its bounds {low} to {high}."));
            }
        }
        if let Some((value, error)) = self.back_emf {
            let ci95 = [value - NORMAL_95 * error, value + NORMAL_95 * error];
            let (name, symbol, unit) = ("back_emf".to_owned(), "k²/R".to_owned(), "N m s/rad".to_owned());
            identified.parameters.push(Parameter { name, symbol, value, unit, ci95 });
        } else if kind.is_motor() && identified.partial.counts_back_emf_as_friction() {
            let sentence = "Torque constant and resistance are known by their quotient only, and what the motor loses by its speed is counted as \
                            viscous friction: let the joint coast switched off for a while, or give one of them.";
            identified.remarks.push(sentence.to_owned());
        }
        if self.own_gravity_left_out {
            let sentence = "The joint is taken to have no gravity of its own beside the payload; a second recording with another payload would tell.";
            identified.remarks.push(sentence.to_owned());
        }
        Ok(())
    }
}

/// Torque of the rigid body that is known at every sample, and what of it is gravity.
fn given(samples: &Samples, commanded: &[Commanded<'_>], joint: &Joint) -> Result<(Vec<f64>, Vec<f64>)> {
    let mut torque = given_torque(samples, joint)?;
    let without_inertia = Joint {
        rigid_body: crate::joint::RigidBody { inertia_kgm2: None, ..joint.rigid_body.clone() },
        ..joint.clone()
    };
    let mut gravity = given_torque(samples, &without_inertia)?;
    let (position, acceleration) = (samples.position.as_deref(), samples.acceleration.as_deref());
    for (one, (_, rows)) in commanded.iter().zip(&samples.recordings) {
        let Some(payload) = &one.payload else { continue };
        let body = Body::of_payload(payload);
        for row in rows.clone() {
            let passed = samples.passed_share_of_sine(row);
            let pull = position.map_or(0.0, |position| passed * body.gravity(position[row]));
            gravity[row] += pull;
            torque[row] += pull + acceleration.map_or(0.0, |acceleration| body.inertia * acceleration[row]);
        }
    }
    Ok((torque, gravity))
}

/// Name, symbol and unit of a constant that is identified.
pub(super) fn described(kind: Kind, open: Open) -> (&'static str, &'static str, &'static str) {
    match (open, kind) {
        (Open::Gain, Kind::Current) => ("torque_constant", "k", "N m/A"),
        (Open::Gain, _) => ("torque_per_volt", "k/R", "N m/V"),
        (Open::Kp, _) => ("kp", "k_p", "N m/rad"),
        (Open::Kd, _) => ("kd", "k_d", "N m s/rad"),
    }
}

fn undetermined(constant: Constant, has_scale: bool, value: f64, error: f64) -> Error {
    let key = format!("actuator.{}", constant.key());
    let message = if has_scale {
        "these recordings do not determine this constant: record a second time with another gain or payload and fit both, or give it"
    } else {
        "nothing says how large the torque is: weigh the payload ([payload] mass_kg, distance_m), or give this constant, the inertia or the \
         gravity torque"
    };
    Error::new(&codes::NO_SCALE, message).in_column(key).with_value(format!("{value:.4} ± {:.4}", NORMAL_95 * error))
}
