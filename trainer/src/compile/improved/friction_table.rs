//! Friction over velocity as a table, as fine as the drive has room for.

use frikan_runtime::table::evaluate_geometric;
use frikan_shared::effect::Effect;
use frikan_shared::model::{Input, Law, RigidBody};
use frikan_shared::pool::Pool;
use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table};
use frikan_shared::units::{Quantity, Unit};

use super::origin::{Friction, Origin};
use crate::compile::formula::{Parity, Sampled};
use crate::compile::host_model::{CELLS, HostModel};
use crate::compile::tables::{CompiledTable, compile_layout};
use crate::physics::JointState;

/// Cells for each doubling of the speed, as a power of two, where there is room.
pub(super) const OCTAVE_CELLS_LOG2: u8 = 3;
/// Error bound of a thinner table, as a share of the largest friction: a tenth of the 2 % from which on a friction level is a finding.
pub(super) const THINNED_SHARE: f64 = 0.002;
/// Speeds of each direction at which the error of a thinner table is looked for.
const DEVIATION_SPEEDS: usize = 2000;

/// A model whose law is a table of the refitted friction, without effects, and the cells of its pool. Behind the table it reads
/// what the effects of its origin read; their tables stay where they are.
pub(super) fn table_model(
    friction: &Friction<'_>,
    origin: Origin<'_>,
    state: &JointState,
    (unit, octave_cells_log2): (Unit, u8),
) -> (Box<HostModel>, Vec<Cell>) {
    let has_table = |effect: &Effect| matches!(effect, Effect::PositionTable { .. });
    let (inputs, mut cells) = match origin {
        Origin::Model(model) if model.effects.iter().any(has_table) => (&model.inputs[..], model.cells.to_vec()),
        Origin::Model(model) => (&model.inputs[..], Vec::new()),
        _ => (&[][..], Vec::new()),
    };
    let law =
        velocity_table(friction, 1.1 * fastest(state), state.sign_velocity, (cells.len() as u16, octave_cells_log2));
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

fn velocity_input(state: &JointState) -> Input {
    let reach = 1.1 * fastest(state) as f32;
    let unit = if state.rotary { Unit::RadianPerSecond } else { Unit::MetrePerSecond };
    Input { quantity: Quantity::Velocity, unit, low: -reach, high: reach }
}

fn fastest(state: &JointState) -> f64 {
    state.velocity.iter().fold(1e-6, |most, v| most.max(v.abs()))
}

/// Largest difference of a table model from the friction that it is made of, and the largest friction, over the speeds of its table.
pub(super) fn deviation(friction: &Friction<'_>, model: &HostModel, cells: &[Cell]) -> (f64, f64) {
    let Some(pool) = Pool::<CELLS>::from_slice(cells).ok() else { return (f64::INFINITY, 0.0) };
    let (Law::Geometric(layout), Some(input)) = (&model.law, model.inputs.first()) else { return (0.0, 0.0) };
    let speeds = (1..=DEVIATION_SPEEDS).map(|index| {
        // As many at each doubling of the speed, for that is how the cells lie.
        input.high * 2f32.powf(-16.0 * (1.0 - index as f32 / DEVIATION_SPEEDS as f32))
    });
    speeds.flat_map(|speed| [speed, -speed]).fold((0.0, 0.0), |(error, largest): (f64, f64), velocity| {
        let wanted = friction(f64::from(velocity));
        let value = f64::from(evaluate_geometric(layout, &pool, velocity));
        (error.max((value - wanted).abs()), largest.max(wanted.abs()))
    })
}

/// Friction over velocity as a table whose cells grow with speed, `2^octave_cells_log2` for each doubling beyond the smoothed sign's width.
fn velocity_table(
    friction: &Friction<'_>,
    reach: f64,
    sign_velocity: f64,
    (first_cell, octave_cells_log2): (u16, u8),
) -> CompiledTable {
    let odd = [0.01, 0.1, 0.5, 1.0].iter().all(|share| {
        let (up, down) = (friction(share * reach), friction(-share * reach));
        (up + down).abs() <= 1e-9 * (up.abs() + down.abs())
    });
    let layout = GeometricShape {
        first_cell,
        offset_exponent: sign_velocity.log2().floor() as i8,
        octave_cells_log2,
        symmetry: if odd { Symmetry::Odd } else { Symmetry::Sided },
        reach: reach as f32,
        reach_negative: reach as f32,
    };
    let parity = if odd { Parity::Odd } else { Parity::Neither };
    compile_layout(&Sampled { value: friction, parity }, Table::Geometric(Geometric::new(layout)))
}
