//! Models of every kind, made of formulas and independent of the trainer, with which targets and runtimes are compared.

use frikan_runtime::shared::expression::{Operation, Program};
use frikan_runtime::shared::image::{Image, encode};
use frikan_runtime::shared::integer_table::{IntegerShape, IntegerTable, SEGMENT_BITS, SEGMENTS};
use frikan_runtime::shared::model::{Input, Law, Model, Provenance, RigidBody};
use frikan_runtime::shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table, Uniform, UniformShape};
use frikan_runtime::shared::units::{Quantity, Unit};

mod effects;
mod network;

pub use effects::{by_velocity, every_effect, table_with_presliding, with_effects, with_every_effect};
pub use network::{network, network_1_5_1, network_three_inputs, network_two_inputs};

/// Cells of the firmware's models.
pub const CELLS: usize = frikan_runtime::shared::pool::DRIVE_CELLS;

/// A model of the firmware's size.
pub type TestModel = Model<CELLS>;

/// `(22 + 8 exp(-|v / 0.1|)) tanh(50 v) + 0.03 v`: Coulomb, Stribeck and viscous friction, N m at rad/s.
#[must_use]
pub fn stribeck_friction(velocity: f64) -> f64 {
    (22.0 + 8.0 * (-(velocity / 0.1).abs()).exp()) * (50.0 * velocity).tanh() + 0.03 * velocity
}

/// A law whose two directions differ.
#[must_use]
pub fn asymmetric_friction(velocity: f64) -> f64 {
    stribeck_friction(velocity) * if velocity > 0.0 { 1.0 } else { 0.85 } + 0.4 * velocity
}

/// The cubic that meets value and slope of `f` at both ends of `[low, high]`, in powers of the way through it, from 0 to 1.
fn hermite(f: impl Fn(f64) -> f64, low: f64, high: f64) -> [f64; 4] {
    let width = high - low;
    let step = 1e-4 * width;
    let slope =
        |end: f64, inward: f64| (-3.0 * f(end) + 4.0 * f(end + inward) - f(end + 2.0 * inward)) / (2.0 * inward);
    let (start, end) = (f(low), f(high));
    let (rise, fall) = (slope(low, step) * width, slope(high, -step) * width);
    let c2 = 3.0 * (end - start) - 2.0 * rise - fall;
    let c3 = 2.0 * (start - end) + rise + fall;
    [start, rise, c2, c3]
}

/// The same as a cell, whose coordinate goes from 1 to 2.
fn hermite_cell(f: impl Fn(f64) -> f64, low: f64, high: f64) -> Cell {
    let [c0, c1, c2, c3] = hermite(f, low, high);
    let shifted = [c0 - c1 + c2 - c3, c1 - 2.0 * c2 + 3.0 * c3, c2 - 3.0 * c3, c3];
    Cell::from_floats(shifted.map(|coefficient| coefficient as f32))
}

/// The cells of one side of a geometric table.
fn geometric_side(layout: &Geometric, count: u32, f: impl Fn(f64) -> f64) -> Vec<Cell> {
    let magnitude =
        |position: u32| f64::from(f32::from_bits(layout.offset.to_bits() + position)) - f64::from(layout.offset);
    let shift = layout.shape().shift();
    let cell = |index: u32| hermite_cell(&f, magnitude(index << shift), magnitude((index + 1) << shift));
    (0..count).map(cell).collect()
}

/// A geometric table of `f` with its cells, of four cells an octave of `|v| + 2^-6`.
#[must_use]
pub fn geometric_table(f: impl Fn(f64) -> f64, symmetry: Symmetry, reach: f32) -> (Table, Vec<Cell>) {
    let layout = Geometric::new(GeometricShape {
        first_cell: 0,
        offset_exponent: -6,
        octave_cells_log2: 2,
        symmetry,
        reach,
        reach_negative: reach,
    });
    let [positive, negative] = layout.side_cells();
    let mut cells = geometric_side(&layout, positive, &f);
    if symmetry == Symmetry::Sided {
        cells.extend(geometric_side(&layout, negative, |magnitude| f(-magnitude)));
    }
    (Table::Geometric(layout), cells)
}

/// A uniform table of `f` with its cells.
#[must_use]
pub fn uniform_table(f: impl Fn(f64) -> f64, cells: u16, low: f32, high: f32) -> (Table, Vec<Cell>) {
    let layout = Uniform::new(UniformShape { first_cell: 0, cells, low, high });
    let width = (f64::from(high) - f64::from(low)) / f64::from(cells);
    let start = |index: u16| f64::from(low) + width * f64::from(index);
    let pieces = (0..cells).map(|index| hermite_cell(&f, start(index), start(index) + width)).collect();
    (Table::Uniform(layout), pieces)
}

fn model(reaches: &[f32], law: Law, cells: &[Cell]) -> TestModel {
    let quantities = [
        (Quantity::Velocity, Unit::RadianPerSecond),
        (Quantity::Load, Unit::NewtonMetre),
        (Quantity::Temperature, Unit::Celsius),
    ];
    let inputs = quantities.into_iter().zip(reaches);
    let inputs = inputs.map(|((quantity, unit), reach)| Input { quantity, unit, low: -reach, high: *reach });
    Model {
        inputs: inputs.collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: 100.0,
        rigid_body: RigidBody::default(),
        law,
        effects: heapless::Vec::new(),
        cells: cells.iter().copied().collect(),
    }
}

/// Symmetric friction in a geometric table.
#[must_use]
pub fn symmetric_table() -> TestModel {
    let (table, cells) = geometric_table(stribeck_friction, Symmetry::Odd, 2.0);
    model(&[2.0], table.into(), &cells)
}

/// Asymmetric friction in a geometric table.
#[must_use]
pub fn sided_table() -> TestModel {
    let (table, cells) = geometric_table(asymmetric_friction, Symmetry::Sided, 2.0);
    model(&[2.0], table.into(), &cells)
}

/// A smooth law in a uniform table.
#[must_use]
pub fn uniform() -> TestModel {
    let (table, cells) = uniform_table(|velocity| 20.0 * (2.0 * velocity).tanh(), 64, -2.0, 2.0);
    model(&[2.0], table.into(), &cells)
}

/// The formula of [`stribeck_friction`].
#[must_use]
pub fn stribeck_expression() -> TestModel {
    use Operation::{AddScaledInput, Exp, Multiply, Offset, Scale, ScaledInput, ScaledMagnitude, Tanh};
    let operations = [
        ScaledMagnitude(0, -10.0),
        Exp,
        Scale(8.0),
        Offset(22.0),
        ScaledInput(0, 50.0),
        Tanh,
        Multiply,
        AddScaledInput(0, 0.03),
    ];
    model(&[2.0], Law::Expression(Program { operations: operations.into_iter().collect() }), &[])
}

/// Friction in an integer table: 2^-17 rad/s a step in, 1/1000 N m a step out.
fn table_in_integers(friction: impl Fn(f64) -> f64, symmetry: Symmetry) -> TestModel {
    let step = 1.0 / 131_072.0;
    let mut cells = [1; SEGMENTS];
    cells[..3].copy_from_slice(&[16, 4, 2]);
    let shape = IntegerShape { first_cell: 0, cells, symmetry, input_step: step, output_step: 1e-3 };
    let side = |sign: f64| -> Vec<Cell> {
        let steps = |position: f64| friction(sign * position * f64::from(step)) / 1e-3;
        let cell = |start: f64, width: f64| {
            Cell::from_integers(hermite(steps, start, start + width).map(|coefficient| coefficient.round() as i32))
        };
        let of_segment = |(segment, count): (u32, u8)| {
            let width = f64::from(1 << SEGMENT_BITS) / f64::from(count);
            let start = f64::from(segment << SEGMENT_BITS);
            (0..count).map(|index| cell(start + width * f64::from(index), width)).collect::<Vec<_>>()
        };
        (0u32..).zip(cells).flat_map(of_segment).collect()
    };
    let sides = if symmetry == Symmetry::Sided { [side(1.0), side(-1.0)].concat() } else { side(1.0) };
    model(&[2.0], Law::IntegerTable(IntegerTable::new(shape)), &sides)
}

/// Symmetric friction in an integer table.
#[must_use]
pub fn integer_table() -> TestModel {
    table_in_integers(stribeck_friction, Symmetry::Odd)
}

/// Asymmetric friction in an integer table.
#[must_use]
pub fn sided_integer_table() -> TestModel {
    table_in_integers(asymmetric_friction, Symmetry::Sided)
}

/// A program that uses every operation, and makes a NaN of its own where the input is 0.
#[must_use]
pub fn every_operation() -> TestModel {
    use Operation::*;
    let operations = [
        &[Input(0), Input(0), Divide, Atan][..],
        &[ScaledInput(0, -3.0), Log, Add],
        &[Input(0), Sin, Input(0), Cos, Multiply, Add],
        &[Input(0), SquareRoot, Input(0), Sign, Multiply, Add],
        &[Input(0), PowerOf(1.5), Input(0), Absolute, Input(0), Power, Subtract, Add],
        &[Input(0), Reciprocal, Constant(5.0), Minimum, Constant(-5.0), Maximum, Add],
        &[Input(0), Negate, Exp, Input(0), Square, Tanh, Add, Scale(0.3), Add],
        &[ScaledMagnitude(0, 2.0), Offset(-1.0), Multiply, AddScaledInput(0, 0.1)],
    ];
    let operations = operations.into_iter().flatten().copied().collect();
    model(&[2.0], Law::Expression(Program { operations }), &[])
}

/// Every kind of model that is evaluated in floating point, by its name.
#[must_use]
pub fn every_kind() -> Vec<(&'static str, TestModel)> {
    vec![
        ("symmetric table", symmetric_table()),
        ("sided table", sided_table()),
        ("uniform table", uniform()),
        ("Stribeck expression", stribeck_expression()),
        ("network [1,5,1]", network_1_5_1()),
        ("network of two inputs", network_two_inputs()),
        ("network of three inputs", network_three_inputs()),
    ]
}

/// Every kind, and what else a floating-point interface can be put to.
#[must_use]
pub fn every_law() -> Vec<(&'static str, TestModel)> {
    let others = [("every operation", every_operation()), ("integer table", integer_table())];
    every_kind().into_iter().chain(others).collect()
}

/// The image file of a model.
///
/// # Panics
/// Where the model is not valid.
#[must_use]
pub fn image(model: &TestModel) -> Vec<u8> {
    let image = Image { provenance: Provenance::default(), model: model.clone() };
    let mut buffer = vec![0; 16 << 10];
    encode(&image, &mut buffer).expect("the tests' models are valid").to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use frikan_runtime::evaluate::evaluate;

    #[test]
    fn every_kind_makes_an_image() {
        for (name, model) in every_kind() {
            assert!(image(&model).len() > 50, "{name}");
        }
    }

    #[test]
    fn tables_and_expression_follow_the_formula() {
        for index in -400..=400 {
            let velocity = index as f32 / 200.0;
            let truth = stribeck_friction(f64::from(velocity));
            for (model, bound) in [(symmetric_table(), 0.01), (stribeck_expression(), 1e-4)] {
                let value = f64::from(evaluate(&model, &[velocity, 0.0, 0.0, 0.0]));
                assert!((value - truth).abs() < bound, "{velocity}: {value} instead of {truth}");
            }
            let asymmetric = f64::from(evaluate(&sided_table(), &[velocity, 0.0, 0.0, 0.0]));
            assert!((asymmetric - asymmetric_friction(f64::from(velocity))).abs() < 0.01, "{velocity}");
        }
    }
}
