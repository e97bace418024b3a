//! What was found in torque space, moved until the simulated joint moves as the recorded one did.

use frikan_shared::model::{Input, Law, RigidBody};
use frikan_shared::pool::Pool;
use frikan_shared::units::{Quantity, Unit};

use super::candidate::{Candidate, What, place};
use super::commanded::Commanded;
use super::friction::{GearFriction, Terms};
use super::identified::Identified;
use super::moved::{Moved, moved};
use super::shooting::{Shot, shoot};
use super::torque_space::open_constants;
use crate::actuator::{Constant, Open};
use crate::compile::host_model::HostModel;
use crate::compile::program::compile_program;
use crate::error::{Error, Result, codes};
use crate::fit::formula_of;
use crate::joint::Joint;
use crate::law::{Expr, canonical};
use crate::numerics::statistics::root_mean_square;
use crate::parameter::Parameter;
use crate::recording::Recording;
use crate::rollout::{Instant, Split, default_window_s};
use crate::samples::top_speed;

/// First the joint is put back to the recorded state after so long, s: the way to the right constants is then short and straight.
const FIRST_WINDOW_S: f64 = 0.5;
/// Where the search begins beside what torque space says: a gear that turns this share of the torque into friction, with gains so much larger.
/// In torque space the gain makes up for friction that is proportional to it, and from there the way is long.
const LOSSY: (f64, f64) = (0.5, 1.4);
/// Where the search for the limit of a motor begins, over the largest torque that its commands ask for: below it, so that it shows.
const FIRST_LIMIT: f64 = 0.9;
/// The model never puts out more than this multiple of the largest friction that the recordings ask for.
const LIMIT_OVER_LARGEST: f64 = 1.5;

/// A joint by its trajectories.
#[derive(Clone, Debug)]
pub(super) struct ByTrajectory {
    /// Its actuator.
    pub(super) identified: Identified,
    /// The law, over velocity and the torque of the actuator.
    pub(super) expression: Expr,
    /// The model of the joint without payload.
    pub(super) model: Box<HostModel>,
    /// Constants of actuator, law and rigid body with their 95 % intervals.
    pub(super) parameters: Vec<Parameter>,
    /// Whether the search came to an end.
    pub(super) converged: bool,
    /// Mean absolute error of the simulated position over all recordings, rad.
    pub(super) mae: f64,
}

/// Moves actuator, inertia and the `terms` of friction from what `identified` and the image `start` of the joint without payload say.
///
/// # Errors
/// `FRK-N004` where no start can be simulated, `FRK-D020` where the model would be refused.
pub(super) fn by_trajectory(
    recordings: &[Recording],
    joint: &Joint,
    identified: &Identified,
    start: &HostModel,
    terms: Terms,
) -> Result<ByTrajectory> {
    let commanded = recordings.iter().map(|recording| Commanded::of(recording, joint)).collect::<Result<Vec<_>>>()?;
    let (all, open) = (open_constants(&commanded), identified.open.as_slice());
    let applied: Vec<f64> = commanded.iter().flat_map(|one| torques(one, identified)).collect();
    let velocities: Vec<f64> = commanded.iter().flat_map(Commanded::velocities).collect();
    let (torque, speed) = (root_mean_square(&applied), top_speed(&velocities));
    let is_open = |constant| joint.actuator.constants.get(&constant).is_none_or(|known| known.given().is_none());
    let kind = joint.actuator.kind;
    let follows = kind.follows_position();
    let known_feedback = joint.actuator.constants.get(&Constant::FeedbackDelay).copied();
    let feedback = if follows { Moved::feedback_delay(known_feedback) } else { None };
    let range = applied.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
    let limit = (kind.is_motor() && is_open(Constant::TorqueLimit)).then_some(FIRST_LIMIT * range);
    let window_s = default_window_s(kind);
    let mut best: Option<Shot> = None;
    let mut failure = None;
    let own = identified.load.clamp(0.0, LOSSY.0);
    let begins = if terms.load { vec![(own, 1.0), LOSSY] } else { vec![(0.0, 1.0)] };
    for (load, gain) in begins {
        let mut begin = begin(start, identified, &all, (load, gain), torque);
        if !terms.stribeck {
            begin.friction.stribeck = 0.0;
        }
        let begin = Candidate { torque_limit: limit.map(|limit| gain * limit), ..begin };
        let moved = moved(
            &begin,
            open,
            [torque, speed],
            terms,
            identified.has_own_gravity,
            follows && is_open(Constant::Delay),
            feedback,
        );
        let first = shoot(&commanded, begin, &moved, Some(FIRST_WINDOW_S));
        let whole = first.and_then(|first| match window_s {
            Some(window) if window <= FIRST_WINDOW_S => Ok(first),
            window => shoot(&commanded, first.candidate, &moved, window),
        });
        let whole = whole.map(|mut shot| {
            shot.forget_unlearned(&moved);
            shot
        });
        match whole {
            Ok(shot) if best.as_ref().is_none_or(|best| shot.mae < best.mae) => best = Some(shot),
            Ok(_) => {}
            Err(error) => failure = Some(error),
        }
    }
    let Some(mut shot) = best else {
        return Err(failure.unwrap_or_else(|| Error::new(&codes::DIVERGED, "no start could be simulated")));
    };
    shot.forget_unreached_limit();
    let model = model(start, &shot.candidate, speed, range)?;
    let identified = told(identified, &shot, open);
    let parameters = parameters(&shot, joint);
    let expression = canonical(&shot.candidate.friction.expression(speed));
    Ok(ByTrajectory { identified, expression, model, parameters, converged: shot.converged, mae: shot.mae })
}

/// Torques of the actuator along a recording, N m.
fn torques(one: &Commanded<'_>, identified: &Identified) -> Vec<f64> {
    let applied = one.applied(&identified.complete(&one.partial).actuator);
    applied.iter().zip(one.velocities()).map(|(applied, velocity)| applied.at(velocity)).collect()
}

/// Where the search begins: rigid body and friction of the image, some of it made over to the load.
fn begin(
    start: &HostModel,
    identified: &Identified,
    open: &[Open],
    (load, gain): (f64, f64),
    torque: f64,
) -> Candidate {
    let body = &start.rigid_body;
    let top = f64::from(start.top_speed().unwrap_or(1.0));
    let law = |velocity: f64| crate::rollout::law(start, &Instant { velocity, load: 0.0, ..Instant::default() });
    let split = Split::of(law, top);
    let rest = split.levels(law, 0.0).dry;
    let level = 0.5 * (rest.forward + rest.backward);
    let mut values = [None; 3];
    for constant in open {
        values[place(*constant)] = identified.value(*constant).map(|value| gain * value);
    }
    Candidate {
        friction: GearFriction {
            coulomb: (level - load * torque).max(0.1 * level),
            stribeck: 0.1 * level,
            stribeck_velocity: 0.05 * top,
            viscous: split.viscous,
            load,
        },
        inertia: f64::from(body.inertia).max(0.0),
        offset: f64::from(body.offset),
        gravity: [f64::from(body.gravity_sin), f64::from(body.gravity_cos)],
        open: values,
        back_emf: identified.back_emf,
        delay_s: identified.partial.actuator.delay_s,
        feedback_delay_s: identified.partial.actuator.feedback_delay_s,
        torque_limit: None,
    }
}

/// The model of the joint without payload.
fn model(start: &HostModel, candidate: &Candidate, speed: f64, torque: f64) -> Result<Box<HostModel>> {
    let refused = |what: String| Error::new(&codes::BAD_IMAGE, what);
    let law = candidate.friction.expression(speed);
    let reads_load = candidate.friction.load > 0.0;
    let program = compile_program(&formula_of(&canonical(&law)), if reads_load { 2 } else { 1 });
    let program = program.map_err(|error| refused(error.to_string()))?;
    let range = |quantity, unit, most: f64| Input { quantity, unit, low: -most as f32, high: most as f32 };
    let mut inputs = heapless::Vec::new();
    // Two inputs at most, of four.
    let _ = inputs.push(range(Quantity::Velocity, Unit::RadianPerSecond, speed));
    if reads_load {
        let _ = inputs.push(range(Quantity::Load, Unit::NewtonMetre, torque));
    }
    let friction = &candidate.friction;
    let largest = friction.coulomb + friction.stribeck + friction.load * torque + friction.viscous * speed;
    let model = HostModel {
        law: Law::Expression(program),
        cells: Pool::from_slice(&[]).map_err(|_| refused("no cells".to_owned()))?,
        inputs,
        output_unit: start.output_unit,
        output_limit: (LIMIT_OVER_LARGEST * largest).max(1e-6) as f32,
        rigid_body: RigidBody {
            inertia: candidate.inertia as f32,
            offset: candidate.offset as f32,
            gravity_sin: candidate.gravity[0] as f32,
            gravity_cos: candidate.gravity[1] as f32,
            ..start.rigid_body
        },
        effects: heapless::Vec::new(),
    };
    Ok(Box::new(model))
}

/// What is known of the actuator afterwards.
fn told(identified: &Identified, shot: &Shot, open: &[Open]) -> Identified {
    let mut after = identified.clone();
    for constant in open {
        if let Some(value) = shot.candidate.open[place(*constant)] {
            after.set(*constant, value);
        }
    }
    after.set_rest(&shot.candidate);
    after
}

fn parameters(shot: &Shot, joint: &Joint) -> Vec<Parameter> {
    let kind = joint.actuator.kind;
    let of = |(what, half): &(What, f64)| {
        let (name, symbol, unit) = match what {
            What::Actuator(constant) => super::torque_space::described(kind, *constant),
            What::BackEmf => ("back_emf", "k²/R", "N m s/rad"),
            What::Delay => ("delay", "T_d", "s"),
            What::FeedbackDelay => ("feedback_delay", "T_f", "s"),
            What::TorqueLimit => ("torque_limit", "τ_max", "N m"),
            What::Inertia => ("inertia", "J", "kg m²"),
            What::Offset => ("torque_offset", "τ_0", "N m"),
            What::GravitySin => ("gravity_sine", "G_s", "N m"),
            What::GravityCos => ("gravity_cosine", "G_c", "N m"),
            What::Coulomb => ("coulomb_torque", "F_c", "N m"),
            What::Stribeck => ("stribeck_torque", "F_s", "N m"),
            What::StribeckVelocity => ("stribeck_velocity", "v_s", "rad/s"),
            What::Viscous => ("viscous_coefficient", "F_v", "N m s/rad"),
            What::Load => ("load_coefficient", "μ", "1"),
        };
        let value = shot.candidate.value(*what);
        let (name, symbol, unit) = (name.to_owned(), symbol.to_owned(), unit.to_owned());
        Parameter { name, symbol, value, unit, ci95: [value - half, value + half] }
    };
    shot.half_widths.iter().map(of).collect()
}
