//! What a recording is compared with: a simulation, a model, or the best static model of itself.

use super::commanded::Commands;
use super::one_joint::{refuse_diverged, refuse_other_joint};
use super::request::Against;
use crate::diagnose::comparison::from_model;
use crate::diagnose::comparison::reference::{Comparison, Reference};
use crate::diagnose::comparison::simulation::{InverseLaw, learn_static};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::position_error::BIASING_SHARE;
use crate::diagnose::run::learn_simulation;
use crate::error::{Error, Result, codes};
use crate::fit::CELLS;
use crate::joint::{self, Joint};
use crate::numerics::statistics::root_mean_square;
use crate::physics::JointState;
use crate::physics::units::Units;
use crate::recording::{Quantity, Recording};
use crate::workflow::recordings::{motion, units};
use crate::workflow::source::Reading;
use frikan_shared::image::Image;
use frikan_shared::model::RigidBody;

/// Time over which a filter of about 22 Hz, the widest of most recordings, averages, s.
const PASSED_S: f64 = 0.02;

/// What the recording is compared with.
pub(super) enum Compared {
    Itself(Box<RigidBody>),
    /// Its law, the rigid body given beside it, name and fingerprint of its file.
    Simulation(Box<InverseLaw>, RigidBody, (String, u64)),
    Model(Box<Image<CELLS>>),
}

impl Compared {
    /// The law at other states; `recorded_body` says that the recording carries a rigid-body torque of its own.
    pub(super) fn at(&self, state: &JointState, recorded_body: bool) -> Option<Reference> {
        match self {
            Self::Itself(_) => None,
            Self::Simulation(law, ..) => Some(law.at(state)),
            Self::Model(image) => of_model(image, state, state.rigid_body.as_deref().filter(|_| recorded_body)).ok(),
        }
    }

    /// The law of a simulation.
    pub(super) fn law(&self) -> Option<&InverseLaw> {
        match self {
            Self::Simulation(law, ..) => Some(law),
            Self::Itself(_) | Self::Model(_) => None,
        }
    }

    /// Name and fingerprint of the file of a simulation.
    pub(super) fn source(&self) -> Option<(String, u64)> {
        match self {
            Self::Simulation(_, _, source) => Some(source.clone()),
            Self::Itself(_) | Self::Model(_) => None,
        }
    }
}

/// A simulation: as its simulator computed it, from which its law is learned; of a commanded joint as the recording would have measured it, whose rows
/// stand beside the recording's, with noise and with its negative; and what its actuator was told.
pub(super) struct Simulated {
    pub(super) computed: Recording,
    pub(super) measured_alike: Option<[Recording; 2]>,
    pub(super) told: Option<Commands>,
}

/// The real recordings, with what the actuators of commanded joints were told, and what they are compared with; `in_one_model` puts the rows of a
/// simulation beside theirs.
pub(super) fn comparison(
    against: &Against<'_>,
    (real, told): (&[Recording], &[Commands]),
    simulation: Option<Simulated>,
    joint: &Joint,
    in_one_model: bool,
) -> Result<(Comparison, Compared)> {
    if let Some(simulated) = simulation {
        with_simulation(simulated, (real, told), joint, in_one_model)
    } else if let Against::Model(image) = against {
        // The image carries the rigid body of the joint file already; what is recorded is handed to it.
        let bare = Joint { rigid_body: joint::RigidBody::default(), ..joint.clone() };
        let mut signals = joined((real, told), &bare)?;
        let state = states(&signals, &real[0])?;
        let reference =
            of_model(image, &state, state.rigid_body.as_deref()).map_err(|error| error.in_file(real[0].file()))?;
        // The law was told what the actuator put out; of the effects beside it that would explain itself.
        if !told.is_empty() {
            signals.load = Some(load_by_law(&signals, &reference));
        }
        Ok((Comparison::with(signals, reference), Compared::Model(image.clone())))
    } else {
        Ok((joined((real, told), joint)?.into(), Compared::Itself(Box::new(given_rigid_body(&real[0], joint)?))))
    }
}

/// The same with a simulation.
fn with_simulation(
    Simulated { computed, measured_alike, told: told_simulation }: Simulated,
    (real, told): (&[Recording], &[Commands]),
    joint: &Joint,
    in_one_model: bool,
) -> Result<(Comparison, Compared)> {
    let simulated = as_recorded(computed, &real[0], joint)?;
    let mut signals = joined((real, told), joint)?;
    let told_simulation = told_simulation.as_slice();
    let mut simulation = joined((std::slice::from_ref(&simulated), told_simulation), joint)?;
    if told.is_empty() {
        // What the grain of the encoder makes of the recording's law it makes of the simulation's.
        simulation = simulation.read_in_steps(signals.position_resolution);
    }
    let state = states(&signals, &real[0])?;
    // What a commanded joint has to put out, which is what its gear carries, is all of the law.
    let is_static = in_one_model && told_simulation.is_empty();
    let learned = if is_static { learn_static(&simulation, &signals) } else { learn_simulation(&simulation, &signals) };
    let law = learned.map_err(|error| Error::new(&codes::NO_MOTION, error.to_string()).in_file(simulated.file()))?;
    let given = given_rigid_body(&real[0], joint)?;
    let reference = law.at(&state);
    if !told.is_empty() {
        signals.load = Some(load_by_law(&signals, &reference));
    }
    let friction = reference.torque.iter().zip(&reference.rigid_body).map(|(torque, body)| torque - body);
    let friction = root_mean_square(&friction.collect::<Vec<f64>>());
    let mut comparison = Comparison::with(signals, reference);
    let measured = match measured_alike {
        Some(both) => {
            let [one, other] = both.map(|measured| as_recorded(measured, &real[0], joint));
            Some(measured_both_ways([&[one?], &[other?]], told_simulation, joint)?)
        }
        None => None,
    };
    let is_biased = |measured: &Signals| noise_torque(&simulation, measured) > BIASING_SHARE * friction;
    if in_one_model || measured.as_ref().is_some_and(is_biased) {
        let is_measured = measured.is_some();
        let mut rows = measured.unwrap_or(simulation);
        let of_simulation = law.at(&rows.states());
        if !told_simulation.is_empty() {
            rows.load = Some(load_by_law(&rows, &of_simulation));
        }
        let simulation = Comparison::with(rows, of_simulation);
        comparison = if is_measured { comparison.beside_both_ways(simulation) } else { comparison.beside(simulation) };
    }
    Ok((comparison, Compared::Simulation(Box::new(law), given, simulated.source())))
}

/// Torque, root mean square over what a filter passes, that the noise of the position makes through the law of the commands. Where it is little beside the
/// least effect, columns by the recorded position are those of the joint itself, and no row of a simulation has to tell what noise makes of them.
fn noise_torque(computed: &Signals, measured: &Signals) -> f64 {
    let together = ((PASSED_S / computed.period).round() as usize).max(1);
    let noise: Vec<f64> =
        computed.torque.iter().zip(&measured.torque).map(|(computed, noisy)| noisy - computed).collect();
    let means = noise.chunks(together).map(|part| part.iter().sum::<f64>() / part.len() as f64);
    root_mean_square(&means.collect::<Vec<f64>>())
}

/// What the gear of a commanded joint carries, N m a sample: the rigid body by a law, beside what a payload takes. What the actuator did put
/// out is the torque that is explained.
fn load_by_law(signals: &Signals, law: &Reference) -> Vec<f64> {
    signals.commanded.as_ref().map_or_else(|| law.rigid_body.clone(), |commanded| commanded.needed(&law.rigid_body))
}

/// A model at the states of a recording, with the error that its law has by the image.
fn of_model(image: &Image<CELLS>, state: &JointState, given: Option<&[f64]>) -> Result<Reference> {
    let uncertainty = from_model::uncertainty(image, state, given);
    Ok(Reference { uncertainty, ..from_model::at(&image.model, state, given)? })
}

/// The recording of the simulation that is compared with, where there is one.
pub(super) fn simulation(against: &Against<'_>, joint: &Joint, reading: Reading<'_>) -> Result<Option<Recording>> {
    let Against::Simulation(source) = against else { return Ok(None) };
    let joint = joint.of_simulation();
    Ok(Some(motion(source.read_numbers(&joint, reading)?, &joint)?.0))
}

/// The simulation in the units of the recording: joint torque beside a current becomes current by the constants of the drive.
fn as_recorded(mut simulated: Recording, real: &Recording, joint: &Joint) -> Result<Recording> {
    let actuator = |recording: &Recording| recording.actuator().map(|channel| channel.unit);
    let beside_current = actuator(real) == Some("A") && matches!(actuator(&simulated), Some("Nm" | "N"));
    if beside_current && joint.drive.torque_constant_nm_a.is_some() {
        simulated = simulated.with_torque_as_current(joint.actuator_per_torque("A")?);
    }
    same_units(real, &simulated)?;
    refuse_diverged(real, &simulated)?;
    Ok(simulated)
}

/// Signals of recordings of one joint, one behind the other, with what its actuator was told where that makes the torque.
fn joined((real, told): (&[Recording], &[Commands]), joint: &Joint) -> Result<Signals> {
    let commanded = |place: usize, signals: &Signals| told.get(place).map(|told: &Commands| told.at(signals));
    let mut first = Signals::of(&real[0], joint)?;
    first.commanded = commanded(0, &first);
    let mut all = first.clone();
    for (place, next) in real.iter().enumerate().skip(1) {
        same_units(&real[0], next)?;
        let mut signals = Signals::behind(Some(&first), next, joint)?;
        signals.commanded = commanded(place, &signals);
        refuse_other_joint(&first, &signals, [&real[0], next])?;
        all.append(signals)
            .map_err(|error| Error::new(&codes::RECORDINGS_DISAGREE, error.to_string()).in_file(next.file()))?;
    }
    Ok(all)
}

/// Signals of recordings that were measured with noise and with its negative.
fn measured_both_ways(both: [&[Recording]; 2], told: &[Commands], joint: &Joint) -> Result<Signals> {
    let [one, other] = both.map(|recordings| joined((recordings, told), joint));
    one?.repeated(other?).map_err(|error| Error::new(&codes::RECORDINGS_DISAGREE, error.to_string()))
}

/// The rigid body of the joint file, where it stands for the recording's own, in the unit of the actuator: then nobody else gives one.
fn given_rigid_body(real: &Recording, joint: &Joint) -> Result<RigidBody> {
    let given = &joint.rigid_body;
    let actuator = real.actuator().filter(|_| real.channel(Quantity::RigidBodyTorque).is_none());
    let Some(actuator) = actuator.filter(|_| given.inertia_kgm2.or(given.gravity_torque_nm).is_some()) else {
        let recorded = real.channel(Quantity::RigidBodyTorque).is_some();
        return Ok(RigidBody { given_scale: f32::from(u8::from(recorded)), ..RigidBody::default() });
    };
    let per_torque = joint.actuator_per_torque(actuator.unit)?;
    let (gravity, phase) = (given.gravity_torque_nm.unwrap_or(0.0), given.gravity_phase_rad.unwrap_or(0.0));
    Ok(RigidBody {
        inertia: (per_torque * given.inertia_kgm2.unwrap_or(0.0)) as f32,
        gravity_sin: (per_torque * gravity * phase.cos()) as f32,
        gravity_cos: (per_torque * gravity * phase.sin()) as f32,
        offset: 0.0,
        given_scale: f32::from(u8::from(
            joint.load_stands_for_gravity() && real.channel(Quantity::LoadTorque).is_some(),
        )),
    })
}

/// The states of the recording, which need a segment longer than its filter.
fn states(signals: &Signals, real: &Recording) -> Result<JointState> {
    let moving = signals.position.iter().any(|q| *q != signals.position[0]);
    if moving {
        return Ok(signals.states());
    }
    Err(Error::new(&codes::NO_MOTION, "the joint does not move in this recording").in_file(real.file()))
}

fn same_units(real: &Recording, other: &Recording) -> Result<()> {
    if units(real) == units(other) {
        return Ok(());
    }
    let said = |recording: &Recording| {
        let Units { actuator, rotary } = units(recording);
        format!("{actuator} of a {} axis", if rotary { "rotary" } else { "linear" })
    };
    let mut message = format!(
        "this gives {}, {} gives {}; both have to be of one axis and one actuator quantity",
        said(other),
        real.file(),
        said(real)
    );
    if units(real).actuator == "A" && units(real).rotary == units(other).rotary {
        message += ", or `torque_constant_Nm_A` and `gear_ratio` under [drive] of joint.toml have to say what a current is worth";
    }
    Err(Error::new(&codes::RECORDINGS_DISAGREE, message).in_file(other.file()))
}
