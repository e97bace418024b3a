//! What a model has to satisfy before it may be evaluated. A model that passes cannot fail: no index leaves its pool, no
//! program runs out of operands, no coefficient is infinite, NaN or subnormal (so that flush-to-zero changes nothing).

mod network;

use crate::effect::{Effect, Kind};
use crate::integer_table::{IntegerTable, MAX_CONSTANT, largest_value, segment_starts};
pub use crate::invalid::InvalidModel;
use crate::invalid::{bounded, ensure, scale};
use crate::model::{Input, Law, Model, RigidBody};
use crate::table::{Cell, Table};
use crate::units::Quantity;

/// Slowest and fastest decay of a viscosity over temperature, 1/K: below, `f32` does not tell it from a line; above, there is no grease.
const SLOWEST_DECAY: f32 = 1.0e-4;
const FASTEST_DECAY: f32 = 10.0;

impl<const CELLS: usize> Model<CELLS> {
    /// Checks everything that evaluation relies on.
    ///
    /// # Errors
    /// The first fault found, in the order of the model's fields.
    pub fn validate(&self) -> Result<(), InvalidModel> {
        check_inputs(&self.inputs)?;
        ensure(scale(self.output_limit), InvalidModel::OutputLimit)?;
        let RigidBody { inertia, gravity_sin, gravity_cos, offset, given_scale } = self.rigid_body;
        ensure(
            [inertia, gravity_sin, gravity_cos, offset, given_scale].into_iter().all(bounded),
            InvalidModel::RigidBody,
        )?;
        match &self.law {
            Law::Geometric(layout) => self.check_only_table(Table::Geometric(*layout))?,
            Law::Uniform(layout) => self.check_only_table(Table::Uniform(*layout))?,
            Law::Network(network) => network.check(self.inputs.len(), &self.cells, self.output_limit)?,
            Law::Expression(program) => program.check(self.inputs.len()).map_err(InvalidModel::Program)?,
            Law::IntegerTable(table) => check_integer_table(table, &self.cells)?,
        }
        self.check_effects()
    }

    fn check_only_table(&self, table: Table) -> Result<(), InvalidModel> {
        check_table(&table, &self.cells)?;
        let mut column = rows(&self.cells, table.first_cell(), table.cells(), 1)?.iter();
        ensure(column.all(|cell| cell.bound() <= self.output_limit), InvalidModel::OutputLimit)
    }

    fn check_effects(&self) -> Result<(), InvalidModel> {
        let has = |quantity: Quantity| self.inputs.iter().any(|input| input.quantity == quantity);
        for effect in &self.effects {
            ensure(!needs_velocity(effect) || has(Quantity::Velocity), InvalidModel::EffectInput)?;
            let (holds, channel) = check_coefficients(effect);
            ensure(holds, InvalidModel::EffectCoefficient)?;
            if let Some(channel) = channel {
                ensure(has(channel), InvalidModel::EffectInput)?;
            }
            if let Effect::PositionTable { table, .. } = effect {
                check_table(table, &self.cells)?;
            }
        }
        let late_lag = self.effects.iter().skip(1).any(|effect| matches!(effect, Effect::FrictionalLag { .. }));
        ensure(!late_lag, InvalidModel::LagNotFirst)
    }
}

fn check_inputs(inputs: &[Input]) -> Result<(), InvalidModel> {
    ensure(!inputs.is_empty(), InvalidModel::NoInput)?;
    for (index, input) in inputs.iter().enumerate() {
        let ordered = bounded(input.low) && bounded(input.high) && input.low < input.high;
        ensure(ordered, InvalidModel::InputRange)?;
        let repeated = inputs.iter().skip(index + 1).any(|other| other.quantity == input.quantity);
        ensure(!repeated, InvalidModel::DuplicateInput)?;
    }
    Ok(())
}

fn check_layout(table: &Table) -> Result<(), InvalidModel> {
    let holds = match table {
        Table::Geometric(layout) => layout.shape().is_within_range() && layout.fits(),
        Table::Uniform(layout) => {
            let shape = layout.shape();
            shape.cells >= 1 && bounded(shape.low) && bounded(shape.high) && scale(shape.high - shape.low)
        }
    };
    ensure(holds, InvalidModel::TableShape)
}

fn check_table(table: &Table, cells: &[Cell]) -> Result<(), InvalidModel> {
    check_layout(table)?;
    let cells = rows(cells, table.first_cell(), table.cells(), 1)?;
    ensure(cells.iter().all(Cell::is_usable), InvalidModel::Coefficient)
}

/// The cells of `count` rows of `columns` cells.
fn rows(cells: &[Cell], first: u32, count: u32, columns: usize) -> Result<&[Cell], InvalidModel> {
    let first = first as usize;
    cells.get(first..first.saturating_add(count as usize * columns)).ok_or(InvalidModel::CellOutOfPool)
}

fn check_integer_table(table: &IntegerTable, cells: &[Cell]) -> Result<(), InvalidModel> {
    let shape = table.shape();
    let steps = [shape.input_step, shape.output_step];
    let shape_holds = segment_starts(&shape.cells, 0).is_some() && steps.into_iter().all(scale);
    ensure(shape_holds, InvalidModel::TableShape)?;
    let cells = rows(cells, u32::from(shape.first_cell), table.cells(), 1)?;
    let usable = |coefficients: [i32; 4]| {
        let [constant, ..] = coefficients;
        constant.unsigned_abs() <= MAX_CONSTANT && largest_value(coefficients).is_some()
    };
    ensure(cells.iter().all(|cell| usable(cell.integers())), InvalidModel::Coefficient)
}

/// Whether the effect reads the velocity.
fn needs_velocity(effect: &Effect) -> bool {
    match effect {
        Effect::Ripple { kind, .. } | Effect::PositionTable { kind, .. } => *kind == Kind::Friction,
        Effect::Play { .. } | Effect::Spring { .. } => false,
        _ => true,
    }
}

/// Whether the coefficients of an effect are usable, and the channel that it reads beside the velocity.
fn check_coefficients(effect: &Effect) -> (bool, Option<Quantity>) {
    let all = |coefficients: &[f32]| coefficients.iter().copied().all(bounded);
    let scales = |coefficients: &[f32]| coefficients.iter().copied().all(scale);
    match *effect {
        Effect::Coulomb { coulomb, viscous, smoothing_velocity }
        | Effect::Asymmetry { coulomb, viscous, smoothing_velocity } => {
            (all(&[coulomb, viscous]) && scale(smoothing_velocity), None)
        }
        Effect::Stribeck { amplitude, velocity, exponent, smoothing_velocity } => {
            (bounded(amplitude) && scales(&[velocity, exponent, smoothing_velocity]), None)
        }
        Effect::PowerViscous { coefficient, exponent, smoothing_velocity } => {
            (bounded(coefficient) && scales(&[exponent, smoothing_velocity]), None)
        }
        Effect::Temperature { reference, coulomb, viscous, decay, smoothing_velocity } => {
            let decays = decay == 0.0 || (SLOWEST_DECAY..=FASTEST_DECAY).contains(&decay);
            let usable = all(&[reference, coulomb, viscous]) && decays && scale(smoothing_velocity);
            (usable, Some(Quantity::Temperature))
        }
        Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity } => {
            (all(&[coulomb, viscous]) && scales(&[time_constant, power_limit, smoothing_velocity]), None)
        }
        Effect::Load { mean, difference, quadratic, stribeck, velocity, smoothing_velocity } => (
            all(&[mean, difference, quadratic, stribeck]) && scales(&[velocity, smoothing_velocity]),
            Some(Quantity::Load),
        ),
        Effect::FrictionalLag { time_constant } => (scale(time_constant), None),
        Effect::Presliding { smoothing_velocity, ref elements } => {
            let usable = elements.iter().all(|element| scales(&[element.torque, element.distance]));
            (usable && !elements.is_empty() && scale(smoothing_velocity), None)
        }
        Effect::DwellBreakaway { gain, time, distance, rest_velocity, dwell_limit, smoothing_velocity } => {
            (bounded(gain) && scales(&[time, distance, rest_velocity, dwell_limit, smoothing_velocity]), None)
        }
        Effect::Ripple { ref harmonics, smoothing_velocity, .. } => {
            let usable =
                scale(smoothing_velocity) && harmonics.iter().all(|line| all(&[line.order, line.cosine, line.sine]));
            (usable, Some(Quantity::Position))
        }
        Effect::PositionTable { smoothing_velocity, .. } => (scale(smoothing_velocity), Some(Quantity::Position)),
        Effect::Play { half_width, torque } => (scale(half_width) && bounded(torque), Some(Quantity::Position)),
        Effect::WindupHysteresis { torque, distance } => (bounded(torque) && scale(distance), None),
        Effect::Spring { stiffness, rest } => (all(&[stiffness, rest]), Some(Quantity::Position)),
    }
}
