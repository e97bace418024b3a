//! The improved model: base law as refitted, rigid body as corrected, and every finding that a drive can run.

use crate::compile::effects::{Context, Terms, has_room_for_position};
use crate::compile::formula::{Curve, Parity};
use crate::compile::host_model::HostModel;
use crate::compile::interval::Interval;
use crate::compile::series::{ORDERS, Series};
use crate::compile::tables::compile_layout;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::comparison::columns::{BaseKind, friction_basis};
use crate::diagnose::comparison::from_model::{
    Movement, hats, is_odd, law_at, mean_measurement, movement, moving_constants,
};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::comparison::simulation::InverseLaw;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::proof::refit::Refit;
use crate::numerics::statistics::quantile;
use crate::physics::names::plain_name;
use crate::physics::{EffectId, JointState};
use frikan_shared::effect::Effect;
use frikan_shared::model::{Input, Law, RigidBody};
use frikan_shared::pool::Pool;
use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table};
use frikan_shared::units::{Quantity, Unit};

mod moved_formula;

use moved_formula::{MovedFormula, moved_formula};

/// Where the base law comes from.
#[derive(Clone, Copy, Debug)]
pub enum Origin<'a> {
    /// The static model of the recording itself, with the rigid body that the joint file gives.
    Recording(RigidBody),
    /// The learned law of a simulation.
    Simulation(&'a InverseLaw),
    /// A fitted model.
    Model(&'a HostModel),
}

/// An improved model, and in sentences what it holds and what not.
#[derive(Clone, Debug)]
pub struct Improved {
    /// The model.
    pub model: Box<HostModel>,
    /// What the recording was compared with, as an image can hold it: a fitted model itself, the law of a simulation as it was given,
    /// or the static model of the recording. `None` where that is no valid model.
    pub compared_with: Option<Box<HostModel>>,
    /// One sentence a finding.
    pub remarks: Vec<String>,
}

/// Cells for each doubling of the speed, as a power of two.
const OCTAVE_CELLS_LOG2: u8 = 3;
/// Room of the output limit above the largest recorded torque.
const OUTPUT_ROOM: f64 = 2.0;

/// Writes the findings of a diagnosis into a model. `None` where law and channels together make no valid model.
pub fn improve(diagnosis: &Diagnosis, comparison: &Comparison, origin: Origin<'_>, unit: Unit) -> Option<Improved> {
    let state = comparison.prepare(Lock::Nothing).state;
    let places = if let Origin::Model(model) = origin { moving_constants(model, &state) } else { Vec::new() };
    let writer = Writer { diagnosis, signals: &comparison.signals, origin, unit, state, places };
    let (model, remarks) = writer.model_of(&diagnosis.improved_refit)?;
    Some(Improved { model, compared_with: writer.compared_with(), remarks })
}

/// What the models of one diagnosis are written from.
struct Writer<'a> {
    diagnosis: &'a Diagnosis,
    signals: &'a Signals,
    origin: Origin<'a>,
    unit: Unit,
    state: JointState,
    /// Places of a formula's constants that move.
    places: Vec<usize>,
}

impl Writer<'_> {
    /// The model after a refit, and in sentences what of its effects it holds.
    fn model_of(&self, refit: &Refit) -> Option<(Box<HostModel>, Vec<String>)> {
        let Self { diagnosis, origin, ref state, ref places, .. } = *self;
        let [before, friction] = [&diagnosis.baseline_refit, refit]
            .map(|refit| refitted_friction(diagnosis.base, refit, (origin, places), state));
        let dissipated =
            |friction: &Friction<'_>| -> Vec<f64> { state.velocity.iter().map(|v| (friction(*v) * v).abs()).collect() };
        let [measured, evaluated] = [&before, &friction].map(dissipated);
        let context = Context {
            smoothing_velocity: state.sign_velocity,
            load_scale: quantile_of_load(state),
            longest_dwell: state.memory.dwell.iter().copied().fold(0.0, f64::max),
            power_limit: evaluated.iter().copied().fold(1e-6, f64::max),
            power_ratio: measured.iter().sum::<f64>() / evaluated.iter().sum::<f64>().max(f64::MIN_POSITIVE),
            duration: state.time.last()? - state.time.first()?,
            may_read_position: !matches!(origin, Origin::Model(model) if !has_room_for_position(model)),
        };
        let rigid_body = rigid_body((diagnosis.base, refit), self.signals, origin);
        let mut terms = Terms { rigid_body, ..Terms::default() };
        if let Origin::Model(model) = origin {
            terms.effects.extend(model.effects.iter().cloned());
        }
        let as_formula = match origin {
            Origin::Model(model) => moved_law(&refit.base, (model, places), &mut terms, state)?,
            _ => None,
        };
        let (mut model, mut cells) = match as_formula {
            Some(model) => {
                let cells = model.cells.to_vec();
                (model, cells)
            }
            None => table_model(&friction, origin, state, self.unit),
        };
        terms.first_cell = cells.len() as u16;
        let mut remarks = Vec::new();
        if let Origin::Simulation(law) = origin {
            let written = |effect| write_term(&mut terms, &context, effect, ", as the simulation holds it");
            remarks.extend(law.effects().map(written));
        }
        remarks.extend(write_findings(refit, &mut terms, &context));
        model.rigid_body = terms.rigid_body;
        cells.extend(&terms.cells);
        model.cells = Pool::from_slice(&cells).ok()?;
        model.effects = terms.effects.iter().cloned().collect();
        add_channels(&mut model, &terms.channels, state)?;
        let largest = self.signals.torque.iter().fold(0.0f64, |most, torque| most.max(torque.abs()));
        let law = state.velocity.iter().map(|v| friction(*v).abs()).fold(0.0, f64::max);
        model.output_limit = (OUTPUT_ROOM * largest.max(2.0 * law)).max(f64::from(model.output_limit)) as f32;
        model.validate().ok()?;
        Some((model, remarks))
    }

    /// The model that the recording was compared with; `None` where that is no valid model.
    fn compared_with(&self) -> Option<Box<HostModel>> {
        let mut baseline = self.diagnosis.baseline_refit.clone();
        match self.origin {
            Origin::Model(model) => return Some(Box::new(model.clone())),
            Origin::Simulation(_) => baseline.base.fill(0.0),
            Origin::Recording(_) => {}
        }
        self.model_of(&baseline).map(|(model, _)| model)
    }
}

fn write_findings(refit: &Refit, terms: &mut Terms, context: &Context) -> Vec<String> {
    refit
        .effects
        .iter()
        .map(|fitted| match &fitted.label {
            Label::Named(effect) => write_term(terms, context, (*effect, &fitted.shape, &fitted.coefficients), ""),
            Label::Generic(_) => format!("Not in the image: {} (it has no name).", fitted.label),
        })
        .collect()
}

/// Writes one effect with its shape and coefficients, and says so.
fn write_term(
    terms: &mut Terms,
    context: &Context,
    (effect, shape, coefficients): (EffectId, &[f64], &[f64]),
    origin: &str,
) -> String {
    match terms.add(effect, shape, coefficients, context) {
        Ok(()) => format!("In the image: {}{origin}.", plain_name(effect)),
        Err(why) => format!("Not in the image: {}{origin} ({why}).", plain_name(effect)),
    }
}

/// Friction over velocity.
type Friction<'a> = Box<dyn Fn(f64) -> f64 + Sync + 'a>;

/// Friction of the base over velocity after a refit; `places` are those of a formula's constants that move.
fn refitted_friction<'a>(
    base: BaseKind,
    refit: &'a Refit,
    (origin, places): (Origin<'a>, &[usize]),
    state: &JointState,
) -> Friction<'a> {
    let (eps, top) = (state.sign_velocity, state.top_speed());
    let sign = move |velocity: f64| (velocity / eps).tanh();
    let sum = |basis: Vec<f64>| -> f64 { basis.iter().zip(&refit.base).map(|(b, c)| b * c).sum() };
    let model = match origin {
        Origin::Recording(_) => return Box::new(move |v| sum(friction_basis(base, v, sign(v), top))),
        Origin::Simulation(law) => return Box::new(move |v| law.friction(v) + sum(vec![sign(v), v])),
        Origin::Model(model) => model,
    };
    let mean = mean_measurement(state);
    match movement(model) {
        Movement::Constants => match moved_formula(model, places, &refit.base, state) {
            Some(MovedFormula::Formula(law)) => Box::new(move |v| law_at(&law, &mean, v)),
            Some(MovedFormula::Curve(law)) => Box::new(move |v| law.at(v)),
            None => Box::new(move |v| law_at(model, &mean, v)),
        },
        Movement::Curve => {
            let is_odd = is_odd(&model.law);
            Box::new(move |v| law_at(model, &mean, v) + sum(hats(v, eps, top, is_odd)))
        }
        Movement::Beside => Box::new(move |v| law_at(model, &mean, v) + sum(vec![sign(v), v])),
    }
}

fn rigid_body((base, refit): (BaseKind, &Refit), signals: &Signals, origin: Origin<'_>) -> RigidBody {
    match origin {
        Origin::Recording(mut given) => {
            if signals.rigid_body.is_none() {
                let friction = friction_basis(base, 1.0, 1.0, 1.0).len();
                given.inertia += refit.base.get(friction).copied().unwrap_or(0.0) as f32;
            }
            given
        }
        Origin::Simulation(law) => {
            let [inertia, offset, gravity_sin, gravity_cos, given_scale] = law.rigid_body().map(|p| p as f32);
            RigidBody { inertia, gravity_sin, gravity_cos, offset, given_scale }
        }
        Origin::Model(model) => model.rigid_body,
    }
}

/// The law of a formula or a network with its parameters where the refit moved them, `Some(None)` where that is a table of velocity, `None`
/// where it is no model.
fn moved_law(
    refitted: &[f64],
    (model, places): (&HostModel, &[usize]),
    terms: &mut Terms,
    state: &JointState,
) -> Option<Option<Box<HostModel>>> {
    match movement(model) {
        Movement::Curve => return Some(None),
        Movement::Constants => {
            return moved_formula(model, places, refitted, state).map(|moved| match moved {
                MovedFormula::Formula(model) => Some(model),
                MovedFormula::Curve(_) => None,
            });
        }
        Movement::Beside => {}
    }
    terms.effects.push(Effect::Coulomb {
        coulomb: refitted.first().copied().unwrap_or(0.0) as f32,
        viscous: refitted.get(1).copied().unwrap_or(0.0) as f32,
        smoothing_velocity: state.sign_velocity as f32,
    });
    Some(Some(Box::new(model.clone())))
}

/// A model whose law is a table of the refitted friction, without effects, and the cells of its pool. Behind the table it reads
/// what the effects of its origin read; their tables stay where they are.
fn table_model(
    friction: &Friction<'_>,
    origin: Origin<'_>,
    state: &JointState,
    unit: Unit,
) -> (Box<HostModel>, Vec<Cell>) {
    let has_table = |effect: &Effect| matches!(effect, Effect::PositionTable { .. });
    let (inputs, mut cells) = match origin {
        Origin::Model(model) if model.effects.iter().any(has_table) => (&model.inputs[..], model.cells.to_vec()),
        Origin::Model(model) => (&model.inputs[..], Vec::new()),
        _ => (&[][..], Vec::new()),
    };
    let law = velocity_table(friction, 1.1 * fastest(state), state.sign_velocity, cells.len() as u16);
    cells.extend(&law.cells);
    let others = inputs.iter().filter(|input| input.quantity != Quantity::Velocity).cloned();
    let model = Box::new(HostModel {
        law: Law::from(law.table),
        cells: Pool::default(),
        inputs: std::iter::once(velocity_input(state)).chain(others).collect(),
        output_unit: unit,
        output_limit: 1.0,
        rigid_body: RigidBody::default(),
        effects: heapless::Vec::new(),
    });
    (model, cells)
}

/// Adds the channels that the terms read; a table and a formula go on reading theirs, a network reads all.
fn add_channels(model: &mut HostModel, channels: &[Quantity], state: &JointState) -> Option<()> {
    for quantity in channels {
        if model.inputs.iter().any(|input| input.quantity == *quantity) {
            continue;
        }
        if matches!(model.law, Law::Network(_)) {
            return None;
        }
        model.inputs.push(channel_input(quantity, state, model.output_unit)?).ok()?;
    }
    Some(())
}

fn channel_input(quantity: &Quantity, state: &JointState, torque: Unit) -> Option<Input> {
    let (series, unit) = match quantity {
        Quantity::Position => (&state.position, if state.rotary { Unit::Radian } else { Unit::Metre }),
        Quantity::Load => (state.load.as_ref()?, torque),
        Quantity::Temperature => (state.temperature.as_ref()?, Unit::Celsius),
        _ => return None,
    };
    let (low, high) = series.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    (low < high).then(|| Input { quantity: quantity.clone(), unit, low: low as f32, high: high as f32 })
}

fn velocity_input(state: &JointState) -> Input {
    let reach = 1.1 * fastest(state) as f32;
    let unit = if state.rotary { Unit::RadianPerSecond } else { Unit::MetrePerSecond };
    Input { quantity: Quantity::Velocity, unit, low: -reach, high: reach }
}

fn fastest(state: &JointState) -> f64 {
    state.velocity.iter().fold(1e-6, |most, v| most.max(v.abs()))
}

fn quantile_of_load(state: &JointState) -> f64 {
    state.load.as_ref().map_or(0.0, |load| quantile(load.iter().map(|l| l.abs()), 0.9))
}

/// Friction over velocity as a table whose cells grow with speed, the finest an eighth of the smoothed sign's width at most.
fn velocity_table(
    friction: &Friction<'_>,
    reach: f64,
    sign_velocity: f64,
    first_cell: u16,
) -> crate::compile::tables::CompiledTable {
    let odd = [0.01, 0.1, 0.5, 1.0].iter().all(|share| {
        let (up, down) = (friction(share * reach), friction(-share * reach));
        (up + down).abs() <= 1e-9 * (up.abs() + down.abs())
    });
    let layout = GeometricShape {
        first_cell,
        offset_exponent: sign_velocity.log2().floor() as i8,
        octave_cells_log2: OCTAVE_CELLS_LOG2,
        symmetry: if odd { Symmetry::Odd } else { Symmetry::Sided },
        reach: reach as f32,
        reach_negative: reach as f32,
    };
    compile_layout(&Sampled(friction, odd), Table::Geometric(Geometric::new(layout)))
}

/// A curve of which only values are known; no enclosure is claimed.
struct Sampled<'a>(&'a (dyn Fn(f64) -> f64 + Sync), bool);

impl Curve for Sampled<'_> {
    fn value(&self, x: f64) -> f64 {
        (self.0)(x)
    }

    fn series(&self, _over: Interval) -> Series {
        Series([Interval::ENTIRE; ORDERS])
    }

    fn parity(&self) -> Parity {
        if self.1 { Parity::Odd } else { Parity::Neither }
    }
}
