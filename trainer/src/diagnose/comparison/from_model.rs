//! A fitted model image evaluated at the recorded states, in the arithmetic of the drive, with what its parameters may move.

use crate::diagnose::comparison::columns::{BaseKind, friction_basis};
use crate::diagnose::comparison::reference::{Outside, Reference, coulomb_and_viscous, tabulated_velocities};
use crate::error::{Error, Result, codes};
use crate::numerics::hat_functions::law_error_hats;
use crate::numerics::least_squares::{dot, project_out};
use crate::physics::JointState;
use crate::samples::blocks::rests;
use frikan_runtime::evaluate::evaluate;
use frikan_runtime::friction::{FrictionState, Measurement, rigid_body_torque};
use frikan_shared::expression::Operation;
use frikan_shared::image::Image;
use frikan_shared::model::{Law, LawError, Model, RIGID_BODY_CONSTANTS, RigidBody, RigidBodyError, SLOW_SHARE};
use frikan_shared::table::Symmetry;
use frikan_shared::units::Quantity;

/// Relative step of the central differences of a model in `f32`. The optimum is the cube root of its roundoff (6e-8),
/// 0.004; more than twice that chosen by judgement: the error of a step is quadratic, that of roundoff grows without
/// bound.
pub(crate) const DIFFERENCE_STEP_SHARE: f64 = 1e-2;

/// The model at the states of a recording. `given` is a rigid-body torque that the recording carries.
///
/// # Errors
/// `FRK-D009` when the model reads a channel that the recording does not have.
pub fn at<const CELLS: usize>(model: &Model<CELLS>, state: &JointState, given: Option<&[f64]>) -> Result<Reference> {
    for input in &model.inputs {
        let missing = match input.quantity {
            Quantity::Velocity | Quantity::Position | Quantity::Acceleration => false,
            Quantity::Load => state.load.is_none(),
            Quantity::Temperature => state.temperature.is_none(),
            Quantity::Other(_) => true,
        };
        if missing {
            let name = input.quantity.name();
            let message = format!("the model reads `{name}`, which the recording does not have");
            return Err(Error::new(&codes::MISSING_COLUMN, message).in_column(name));
        }
    }
    let rigid_body = rigid_body(&model.rigid_body, state, given);
    let friction = friction(model, state);
    Ok(Reference {
        torque: friction.iter().zip(&rigid_body).map(|(f, b)| f + b).collect(),
        rigid_body,
        jacobian: jacobian(model, state),
        outside: outside(model, state),
        friction: curve(model, state),
        is_fitted: true,
        ..Reference::default()
    })
}

/// Distance beyond a trained range, over its width, up to which a channel counts as inside. Chosen by judgement: noise
/// of the recorded channel; more asks the model for what it never learned.
const RANGE_MARGIN_SHARE: f64 = 0.01;

/// Where the recording leaves the ranges that the model was fitted on.
fn outside<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Outside {
    let mut outside = Outside::default();
    for (place, input) in model.inputs.iter().enumerate() {
        let (low, high) = (f64::from(input.low), f64::from(input.high));
        let slack = RANGE_MARGIN_SHARE * (high - low);
        let is_beyond = |i: usize| {
            let value = f64::from(measurement(state, i).channels(&model.inputs)[place]);
            value < low - slack || value > high + slack
        };
        let beyond: Vec<bool> = (0..state.len()).map(is_beyond).collect();
        if beyond.contains(&true) {
            outside.channels.push((input.quantity.name().to_string(), [low, high], input.unit.symbol().to_string()));
            outside.samples.resize(state.len(), false);
            outside.samples.iter_mut().zip(beyond).for_each(|(all, beyond)| *all |= beyond);
        }
    }
    outside
}

#[allow(clippy::field_reassign_with_default)] // struct update trips the compiler over the length of `other`
fn measurement(state: &JointState, i: usize) -> Measurement {
    let channel = |series: &Option<Vec<f64>>| series.as_ref().map_or(0.0, |values| values[i] as f32);
    let mut measurement = Measurement::ZERO;
    measurement.velocity = state.velocity[i] as f32;
    measurement.position = state.position[i] as f32;
    measurement.acceleration = state.acceleration[i] as f32;
    measurement.load = channel(&state.load);
    measurement.temperature = channel(&state.temperature);
    measurement
}

/// Law and effects over the recording; memories restart at each segment, but for the warmth that the rest before it leaves.
fn friction<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Vec<f64> {
    let mut friction = vec![0.0; state.len()];
    let mut memory = FrictionState::new();
    for (segment, rest) in state.segments.iter().zip(rests(&state.time, &state.segments)) {
        memory = memory.after_rest(&model.effects, rest as f32);
        for i in segment.clone() {
            let dt = if i > segment.start { state.period as f32 } else { 0.0 };
            friction[i] = f64::from(memory.step(model, &measurement(state, i), dt).torque);
        }
    }
    friction
}

/// Torque of each direction in which a model is not sure of itself, at one standard deviation, as its image says: hats over speed for the
/// law, of their own where the joint speeds up and where it slows down, and the independent errors of the rigid body. `given` is a
/// rigid-body torque that the recording carries.
pub fn uncertainty<const CELLS: usize>(
    image: &Image<CELLS>,
    state: &JointState,
    given: Option<&[f64]>,
) -> Vec<Vec<f64>> {
    let mut directions = law_uncertainty(&image.model, image.provenance.law_error, state);
    directions.extend(rigid_body_uncertainty(image.provenance.rigid_body_error, state, given));
    directions
}

fn law_uncertainty<const CELLS: usize>(model: &Model<CELLS>, error: LawError, state: &JointState) -> Vec<Vec<f64>> {
    if error == LawError::default() {
        return Vec::new();
    }
    let top = model.top_speed().map_or_else(|| state.top_speed(), f64::from);
    let mut directions = law_error_hats(&state.velocity, Some(&state.acceleration), top);
    let deviation = state.map(|i| {
        let is_slow = state.velocity[i].abs() <= SLOW_SHARE * top;
        f64::from(if is_slow { error.slow } else { error.sliding })
    });
    for direction in &mut directions {
        direction.iter_mut().zip(&deviation).for_each(|(hat, deviation)| *hat *= deviation);
    }
    directions
}

fn rigid_body_uncertainty(error: RigidBodyError, state: &JointState, given: Option<&[f64]>) -> Vec<Vec<f64>> {
    let rows = (0..RIGID_BODY_CONSTANTS).map(|k| error.row(k)).filter(|row| row.iter().any(|error| *error != 0.0));
    rows.map(|[inertia, gravity_sin, gravity_cos, offset, given_scale]| {
        let body = RigidBody { inertia, gravity_sin, gravity_cos, offset, given_scale };
        rigid_body(&body, state, given)
    })
    .collect()
}

/// Torque of a rigid body at the states of a recording.
fn rigid_body(body: &RigidBody, state: &JointState, given: Option<&[f64]>) -> Vec<f64> {
    state.map(|i| {
        let given = given.map_or(0.0, |torque| torque[i] as f32);
        f64::from(rigid_body_torque(body, state.position[i] as f32, state.acceleration[i] as f32, given))
    })
}

/// The channels of a recording at their mean; at no speed.
#[allow(clippy::field_reassign_with_default)]
pub(crate) fn mean_measurement(state: &JointState) -> Measurement {
    let mean = |series: &[f64]| (series.iter().sum::<f64>() / series.len().max(1) as f64) as f32;
    let mut measurement = Measurement::ZERO;
    measurement.position = mean(&state.position);
    measurement.load = state.load.as_deref().map_or(0.0, mean);
    measurement.temperature = state.temperature.as_deref().map_or(0.0, mean);
    measurement
}

/// The static law at a velocity, other channels as they are in `at`.
pub(crate) fn law_at<const CELLS: usize>(model: &Model<CELLS>, at: &Measurement, velocity: f64) -> f64 {
    let mut measurement = *at;
    measurement.velocity = velocity as f32;
    f64::from(evaluate(model, &measurement.channels(&model.inputs)))
}

/// The static law over velocity, other channels at their mean.
fn curve<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Vec<(f64, f64)> {
    let mean = mean_measurement(state);
    tabulated_velocities(1.2 * state.top_speed()).map(|velocity| (velocity, law_at(model, &mean, velocity))).collect()
}

/// What of a law may move when an effect is added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Movement {
    /// Every constant of a formula.
    Constants,
    /// A table of velocity, by local hats over it.
    Curve,
    /// Coulomb and viscous friction beside anything else.
    Beside,
}

/// What of a model's law may move.
pub(crate) fn movement<const CELLS: usize>(model: &Model<CELLS>) -> Movement {
    let is_by_velocity = model.inputs.first().is_some_and(|input| input.quantity == Quantity::Velocity);
    match &model.law {
        Law::Expression(_) => Movement::Constants,
        Law::Geometric(_) | Law::Uniform(_) if is_by_velocity => Movement::Curve,
        _ => Movement::Beside,
    }
}

/// Change of the torque with everything that may move.
fn jacobian<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Vec<(&'static str, Vec<f64>)> {
    let unnamed = |column: Vec<f64>| ("model_parameter", column);
    match movement(model) {
        Movement::Constants => moving_columns(model, state).into_iter().map(|(_, column)| unnamed(column)).collect(),
        Movement::Curve => {
            let odd = is_odd(&model.law);
            let top = state.top_speed();
            let rows: Vec<Vec<f64>> = state.velocity.iter().map(|v| hats(*v, state.sign_velocity, top, odd)).collect();
            let column = |j: usize| unnamed(rows.iter().map(|row| row[j]).collect());
            (0..hats(0.0, 1.0, 1.0, odd).len()).map(column).collect()
        }
        Movement::Beside => coulomb_and_viscous(&state.sign, &state.velocity),
    }
}

/// Least share of a column's energy that those before it may leave. Of two constants of which one does what the other does, such as the
/// factors of a quotient, only the first moves: a refit would move both without bound against each other. The columns are
/// differences in `f32` over a hundredth of the constant, good to about a thousandth; this is a hundredth of the column.
const OWN_ENERGY_SHARE: f64 = 1e-4;

/// Change of the friction with each constant of a formula that changes it as those before do not, by the constant's place.
fn moving_columns<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Vec<(usize, Vec<f64>)> {
    let all = [0..state.len()];
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let is_own = |(_, column): &(usize, Vec<f64>)| {
        let mut own = column.clone();
        project_out(&mut own, &basis, &all);
        let energy = dot(&own, &own, &all);
        if energy <= OWN_ENERGY_SHARE * dot(column, column, &all) {
            return false;
        }
        basis.push(own.iter().map(|value| value / energy.sqrt()).collect());
        true
    };
    changing_columns(model, state).into_iter().filter(is_own).collect()
}

/// Change of the friction with each constant of a formula that changes it at all, by the constant's place.
fn changing_columns<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Vec<(usize, Vec<f64>)> {
    let Law::Expression(program) = &model.law else { return Vec::new() };
    (0..program.operations.len())
        .filter_map(|place| {
            let step = DIFFERENCE_STEP_SHARE * constant_at(model, place)?.abs().max(1e-3);
            let shifted = |by: f64| moved(model.clone(), place, by).map(|model| friction(&model, state));
            let (up, down) = (shifted(step)?, shifted(-step)?);
            Some((place, up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * step)).collect::<Vec<f64>>()))
        })
        .filter(|(_, column)| column.iter().all(|v| v.is_finite()) && column.iter().any(|v| *v != 0.0))
        .collect()
}

/// Places of the constants that move, in the order of the columns.
pub(crate) fn moving_constants<const CELLS: usize>(model: &Model<CELLS>, state: &JointState) -> Vec<usize> {
    moving_columns(model, state).into_iter().map(|(place, _)| place).collect()
}

/// Local hat functions of a table of velocity: odd ones, and even ones where the table is not odd.
pub(crate) fn hats(velocity: f64, sign_velocity: f64, top_speed: f64, odd: bool) -> Vec<f64> {
    let mut hats = friction_basis(BaseKind::Spline, velocity, (velocity / sign_velocity).tanh(), top_speed);
    if !odd {
        let even: Vec<f64> = hats.iter().map(|hat| hat * (velocity / sign_velocity).tanh()).collect();
        hats.extend(even);
    }
    hats
}

/// Whether a table is odd in velocity by its layout.
pub(crate) fn is_odd(law: &Law) -> bool {
    matches!(law, Law::Geometric(layout) if layout.shape().symmetry == Symmetry::Odd)
}

fn constant(operation: &mut Operation) -> Option<&mut f32> {
    match operation {
        Operation::ScaledInput(_, value)
        | Operation::ScaledMagnitude(_, value)
        | Operation::AddScaledInput(_, value)
        | Operation::Constant(value)
        | Operation::Scale(value)
        | Operation::Offset(value)
        | Operation::PowerOf(value) => Some(value),
        _ => None,
    }
}

/// The constant at a place of a model's formula.
pub(crate) fn constant_at<const CELLS: usize>(model: &Model<CELLS>, place: usize) -> Option<f64> {
    let Law::Expression(program) = &model.law else { return None };
    let mut operation = *program.operations.get(place)?;
    constant(&mut operation).map(|value| f64::from(*value))
}

/// The model with one constant of its formula moved; `None` where that is no model.
pub(crate) fn moved<const CELLS: usize>(mut model: Model<CELLS>, place: usize, by: f64) -> Option<Model<CELLS>> {
    let Law::Expression(program) = &mut model.law else { return None };
    if let Some(value) = constant(program.operations.get_mut(place)?) {
        *value = (f64::from(*value) + by) as f32;
    }
    model.validate().ok()?;
    Some(model)
}
