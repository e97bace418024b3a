//! The improved model: base law as refitted, rigid body as corrected, and every finding that a drive can run.

mod friction_table;
mod moved_formula;
mod origin;
mod refitted_law;

use self::friction_table::{OCTAVE_CELLS_LOG2, THINNED_SHARE, deviation, table_model};
use self::origin::Friction;
pub use self::origin::Origin;
use self::refitted_law::{Form, RefittedLaw, refitted_law};
use crate::compile::effects::{Context, Room, Terms, has_room_for_position};
use crate::compile::host_model::HostModel;
use crate::compile::profile::Profile;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::comparison::columns::{BaseKind, friction_basis};
use crate::diagnose::comparison::from_model::moving_constants;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::proof::refit::Refit;
use crate::law::significant;
use crate::numerics::statistics::quantile;
use crate::physics::names::name_in_model;
use crate::physics::{EffectId, JointState};
use frikan_shared::model::{Input, Law, MAX_INPUTS, RigidBody};
use frikan_shared::pool::Pool;
use frikan_shared::units::{Quantity, Unit};

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

/// Room of the output limit above the largest recorded torque.
const OUTPUT_ROOM: f64 = 2.0;

/// Why a diagnosis gives no model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotWritten {
    /// Law, findings and channels make no valid model.
    #[error("the findings and the law together make no valid model")]
    Invalid,
    /// The law alone takes more cells than the drive has.
    #[error("the law takes {needed} cells, and `{}` has room for {}: `--target` names a larger drive", target.name, target.cells)]
    TooLarge {
        /// Cells of the law.
        needed: usize,
        /// The drive.
        target: Profile,
    },
}

/// Writes the findings of a diagnosis into a model for which `target` has room: tables are thinned within their bound, and findings for which
/// there is no room are left out and named.
///
/// # Errors
/// [`NotWritten`] where the law itself has no room, or law and channels together make no valid model.
pub fn improve(
    diagnosis: &Diagnosis,
    comparison: &Comparison,
    origin: Origin<'_>,
    unit: Unit,
    target: Profile,
) -> Result<Improved, NotWritten> {
    let state = comparison.prepare(Lock::Nothing).state;
    let places = if let Origin::Model(model) = origin { moving_constants(model, &state) } else { Vec::new() };
    let writer = Writer { diagnosis, signals: &comparison.signals, origin, unit, state, places, target };
    let (model, remarks) = writer.model_of(&diagnosis.improved_refit)?;
    Ok(Improved { model, compared_with: writer.compared_with(), remarks })
}

/// A model with a table of friction as fine as was tried.
struct Attempt {
    model: Box<HostModel>,
    remarks: Vec<String>,
    /// Cells of the law.
    law_cells: usize,
    /// Whether every finding with a table had room.
    has_room: bool,
    /// Whether the table is the finest, or off by no more than its bound.
    is_within_bound: bool,
}

/// What an attempt is worth, the least first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    BeyondBound,
    WithoutSomeFindings,
    Whole,
}

impl Attempt {
    fn rank(&self) -> Rank {
        match (self.is_within_bound, self.has_room) {
            (true, true) => Rank::Whole,
            (true, false) => Rank::WithoutSomeFindings,
            (false, _) => Rank::BeyondBound,
        }
    }
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
    /// The drive that has to have room.
    target: Profile,
}

impl Writer<'_> {
    /// The model after a refit, and in sentences what of its effects it holds: the finest table of friction that leaves room for every
    /// finding within its bound, else the finest within its bound, else the finest that the drive has room for.
    fn model_of(&self, refit: &Refit) -> Result<(Box<HostModel>, Vec<String>), NotWritten> {
        let Self { diagnosis, origin, ref state, ref places, target, .. } = *self;
        let [before, law] = [&diagnosis.baseline_refit, refit]
            .map(|refit| refitted_law(diagnosis.base, refit, (origin, places), state));
        let context = self.context([&before.friction, &law.friction]);
        let (mut needed, mut best) = (usize::MAX, None::<Attempt>);
        for octave_cells_log2 in (0..=OCTAVE_CELLS_LOG2).rev() {
            let Some(attempt) = self.attempt(refit, &law, &context, octave_cells_log2)? else { break };
            needed = needed.min(attempt.law_cells);
            let is_better = best.as_ref().is_none_or(|best| attempt.rank() > best.rank());
            if attempt.law_cells <= target.cells && is_better {
                let is_whole = attempt.rank() == Rank::Whole;
                best = Some(attempt);
                if is_whole {
                    break;
                }
            }
        }
        best.map(|attempt| (attempt.model, attempt.remarks)).ok_or(NotWritten::TooLarge { needed, target })
    }

    /// What terms are written with, from the friction `before` the findings and with them.
    fn context(&self, [before, with]: [&Friction<'_>; 2]) -> Context {
        let Self { origin, ref state, .. } = *self;
        let dissipated =
            |friction: &Friction<'_>| -> Vec<f64> { state.velocity.iter().map(|v| (friction(*v) * v).abs()).collect() };
        let [measured, evaluated] = [before, with].map(dissipated);
        Context {
            smoothing_velocity: state.sign_velocity,
            load_scale: quantile_of_load(state),
            longest_dwell: state.memory.dwell.iter().copied().fold(0.0, f64::max),
            power_limit: evaluated.iter().copied().fold(1e-6, f64::max),
            power_ratio: measured.iter().sum::<f64>() / evaluated.iter().sum::<f64>().max(f64::MIN_POSITIVE),
            duration: state.time.last().zip(state.time.first()).map_or(0.0, |(last, first)| last - first),
            may_read_position: !matches!(origin, Origin::Model(model) if !has_room_for_position(model)),
        }
    }

    /// The model with a table of friction of `2^octave_cells_log2` cells for each doubling of the speed; `None` where the law
    /// is a formula or a network, which no table can thin.
    fn attempt(
        &self,
        refit: &Refit,
        law: &RefittedLaw<'_>,
        context: &Context,
        octave_cells_log2: u8,
    ) -> Result<Option<Attempt>, NotWritten> {
        let Self { diagnosis, origin, ref state, .. } = *self;
        let friction = &law.friction;
        let rigid_body = rigid_body((diagnosis.base, refit), self.signals, origin);
        let mut terms = Terms { rigid_body, ..Terms::default() };
        if let Origin::Model(model) = origin {
            terms.effects.extend(model.effects.iter().cloned());
        }
        let mut remarks = Vec::new();
        let is_finest = octave_cells_log2 == OCTAVE_CELLS_LOG2;
        let mut is_within_bound = true;
        let (mut model, mut cells) = match law.form.as_ref().ok_or(NotWritten::Invalid)? {
            Form::Model(..) if !is_finest => return Ok(None),
            Form::Model(model, beside) => {
                terms.effects.extend(beside.clone());
                (model.clone(), model.cells.to_vec())
            }
            Form::Table => {
                let (model, cells) = table_model(friction, origin, state, (self.unit, octave_cells_log2));
                if !is_finest {
                    let (error, largest) = deviation(friction, &model, &cells);
                    is_within_bound = error <= THINNED_SHARE * largest;
                    let unit = self.unit.symbol();
                    let error = significant(error, 2);
                    remarks.push(format!(
                        "The table of friction is thinned to {} cells, by which it is off by {error} {unit} at most.",
                        cells.len()
                    ));
                }
                (model, cells)
            }
        };
        let law_cells = cells.len();
        terms.first_cell = law_cells as u16;
        terms.inputs = model.inputs.iter().map(|input| input.quantity.clone()).collect();
        let is_fixed = matches!(model.law, Law::Network(_));
        terms.room =
            Room { channels: if is_fixed { terms.inputs.len() } else { MAX_INPUTS }, cells: self.target.cells };
        if let Origin::Simulation(law, _) = origin {
            let written = |effect| write_term(&mut terms, context, effect, ", as the simulation holds it");
            remarks.extend(law.effects().map(written));
        }
        remarks.extend(write_findings(refit, &mut terms, context));
        model.rigid_body = terms.rigid_body;
        cells.extend(&terms.cells);
        model.cells = Pool::from_slice(&cells).map_err(|_| NotWritten::Invalid)?;
        model.effects = terms.effects.iter().cloned().collect();
        add_channels(&mut model, &terms.channels, state).ok_or(NotWritten::Invalid)?;
        let largest = self.signals.torque.iter().fold(0.0f64, |most, torque| most.max(torque.abs()));
        let sliding = state.velocity.iter().map(|v| friction(*v).abs()).fold(0.0, f64::max);
        model.output_limit = (OUTPUT_ROOM * largest.max(2.0 * sliding)).max(f64::from(model.output_limit)) as f32;
        model.validate().map_err(|_| NotWritten::Invalid)?;
        Ok(Some(Attempt { model, remarks, law_cells, has_room: !terms.lacks_cells, is_within_bound }))
    }

    /// The model that the recording was compared with; `None` where that is no valid model.
    fn compared_with(&self) -> Option<Box<HostModel>> {
        let mut baseline = self.diagnosis.baseline_refit.clone();
        match self.origin {
            Origin::Model(model) => return Some(Box::new(model.clone())),
            Origin::Simulation(..) => baseline.base.fill(0.0),
            Origin::Recording(_) => {}
        }
        self.model_of(&baseline).ok().map(|(model, _)| model)
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
        Ok(()) => format!("In the image: {}{origin}{}.", name_in_model(effect), of_position(effect)),
        Err(why) => format!("Not in the image: {}{origin} ({why}).", name_in_model(effect)),
    }
}

/// What is said of a term that puts out a position in place of a torque.
fn of_position(effect: EffectId) -> &'static str {
    match effect {
        EffectId::KinematicError | EffectId::Backlash => {
            " (a correction of the position, which the firmware has to allow)"
        }
        _ => "",
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
        Origin::Simulation(law, given) => {
            let [inertia, offset, gravity_sin, gravity_cos, given_scale] = law.rigid_body().map(|p| p as f32);
            RigidBody {
                inertia: inertia + given_scale * given.inertia,
                gravity_sin: gravity_sin + given_scale * given.gravity_sin,
                gravity_cos: gravity_cos + given_scale * given.gravity_cos,
                offset,
                given_scale: given_scale * given.given_scale,
            }
        }
        Origin::Model(model) => model.rigid_body,
    }
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

fn quantile_of_load(state: &JointState) -> f64 {
    state.load.as_ref().map_or(0.0, |load| quantile(load.iter().map(|l| l.abs()), 0.9))
}
