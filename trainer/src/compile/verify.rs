//! Bit-for-bit comparison of the drive's runtime with the trainer's reference.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::{MAX_INPUTS, Model};
use rayon::prelude::*;

use super::reference::evaluate_one;

/// Patterns of an exhaustive comparison that one task takes.
const CHUNK: u64 = 1 << 20;

/// An input at which runtime and reference differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The input.
    pub inputs: [f32; MAX_INPUTS],
    /// What the runtime gives.
    pub runtime: f32,
    /// What the reference gives.
    pub reference: f32,
}

/// The outcome of a comparison, of the static law unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison<D = Difference> {
    /// Inputs compared.
    pub compared: u64,
    /// Inputs at which all bits agree.
    pub equal: u64,
    /// The first difference, in the order of the inputs.
    pub first_difference: Option<D>,
}

impl<D> Comparison<D> {
    /// Of nothing.
    pub const NONE: Self = Self { compared: 0, equal: 0, first_difference: None };

    /// Of one input, with the difference that it showed.
    #[must_use]
    pub fn of_one(difference: Option<D>) -> Self {
        Self { compared: 1, equal: u64::from(difference.is_none()), first_difference: difference }
    }

    /// Of the answers to `calls`, one after the other, with what is `expected` of each; a call without an answer counts as compared and not equal.
    /// `difference` has the number of a call, the call, what was answered and what was expected.
    pub fn of_answers<C, A: PartialEq>(
        calls: &[C],
        answers: impl IntoIterator<Item = A>,
        mut expected: impl FnMut(&C) -> A,
        difference: impl Fn(u64, &C, A, A) -> D,
    ) -> Self {
        let mut answers = answers.into_iter();
        let mut comparison = Self::NONE;
        for (step, call) in (0..).zip(calls) {
            let expected = expected(call);
            let Some(computed) = answers.next() else {
                comparison.compared += 1;
                continue;
            };
            let differs = computed != expected;
            comparison = comparison.then(Self::of_one(differs.then(|| difference(step, call, computed, expected))));
        }
        comparison
    }

    /// Whether every input agreed.
    #[must_use]
    pub fn identical(&self) -> bool {
        self.compared == self.equal
    }

    /// This comparison, then `other`.
    #[must_use]
    pub fn then(self, other: Self) -> Self {
        Self {
            compared: self.compared + other.compared,
            equal: self.equal + other.equal,
            first_difference: self.first_difference.or(other.first_difference),
        }
    }
}

fn compare_one<const CELLS: usize>(model: &Model<CELLS>, inputs: &[f32; MAX_INPUTS]) -> Comparison {
    let (runtime, reference) = (evaluate(model, inputs), evaluate_one(model, inputs));
    let equal = runtime.to_bits() == reference.to_bits();
    Comparison::of_one((!equal).then_some(Difference { inputs: *inputs, runtime, reference }))
}

/// Compares at each of `inputs`, for example those of a recording.
#[must_use]
pub fn compare<const CELLS: usize>(model: &Model<CELLS>, inputs: &[[f32; MAX_INPUTS]]) -> Comparison {
    inputs.iter().fold(Comparison::NONE, |so_far, inputs| so_far.then(compare_one(model, inputs)))
}

/// Values at which floating-point code goes wrong, if anywhere.
pub const SPECIAL_VALUES: [f32; 24] = [
    0.0,
    -0.0,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    f32::from_bits(1),
    -f32::from_bits(1),
    f32::from_bits(0x007F_FFFF),
    -f32::from_bits(0x007F_FFFF),
    1.0e-20,
    -1.0e-20,
    1.0,
    -1.0,
    16_777_216.0,
    -16_777_216.0,
    4_294_967_296.0,
    -4_294_967_296.0,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    -f32::NAN,
    f32::from_bits(0x7F80_0001),
    f32::from_bits(0xFFFF_FFFF),
];

/// A sweep of `count` points over the trained ranges, widened by a quarter on either side, preceded by all combinations of special
/// values and range ends. The points fill the space of all channels evenly (additive recurrence of Roberts 2018).
#[must_use]
pub fn sweep<const CELLS: usize>(model: &Model<CELLS>, count: usize) -> Vec<[f32; MAX_INPUTS]> {
    let mut points = Vec::new();
    let channels = model.inputs.len();
    for channel in 0..channels {
        let input = &model.inputs[channel];
        let ends = [
            input.low,
            input.high,
            input.low.next_down(),
            input.low.next_up(),
            input.high.next_down(),
            input.high.next_up(),
        ];
        for &value in SPECIAL_VALUES.iter().chain(&ends) {
            for &others in SPECIAL_VALUES.iter().chain(&[0.5, -0.25]) {
                let mut point = [others; MAX_INPUTS];
                point[channel] = value;
                points.push(point);
            }
        }
    }
    // The root of g^(d+1) = g + 1 spreads d dimensions.
    let ratio = (0..60).fold(2.0f64, |g, _| (1.0 + g).powf(1.0 / (channels as f64 + 1.0)));
    for index in 0..count {
        let mut point = [0.0f32; MAX_INPUTS];
        let mut step = 1.0;
        for (value, input) in point.iter_mut().zip(&model.inputs) {
            step /= ratio;
            let share = (0.5 + step * (index as f64 + 1.0)).fract() * 1.5 - 0.25;
            let (low, high) = (f64::from(input.low), f64::from(input.high));
            *value = (low + share * (high - low)) as f32;
        }
        points.push(point);
    }
    points
}

/// Compares a one-input model at all 2^32 `f32`, NaN included, in the order of their bit patterns. `progress` is told of every
/// finished chunk, from any thread.
#[must_use]
pub fn compare_exhaustively<const CELLS: usize>(model: &Model<CELLS>, progress: impl Fn(u64) + Sync) -> Comparison {
    let chunks: Vec<Comparison> = (0..(1u64 << 32) / CHUNK)
        .into_par_iter()
        .map(|chunk| {
            let outcome = compare_patterns(model, (chunk * CHUNK) as u32, CHUNK);
            progress(CHUNK);
            outcome
        })
        .collect();
    chunks.into_iter().fold(Comparison::NONE, Comparison::then)
}

/// Compares a one-input model at `count` consecutive bit patterns.
#[must_use]
pub fn compare_patterns<const CELLS: usize>(model: &Model<CELLS>, first: u32, count: u64) -> Comparison {
    let mut outcome = Comparison::NONE;
    for step in 0..count {
        let pattern = first.wrapping_add(step as u32);
        outcome = outcome.then(compare_one(model, &[f32::from_bits(pattern), 0.0, 0.0, 0.0]));
    }
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::formula::tests::stribeck_law;
    use crate::compile::formula::{Formula, Function, Operator};
    use crate::compile::integers::{Wanted, compile_integers};
    use crate::compile::networks::{Edge, Edges, Nodes, assemble, node_ranges};
    use crate::compile::program::compile_program;
    use crate::compile::tables::{compile_layout, compile_table, rows};
    use frikan_shared::image::{Image, decode, encode};
    use frikan_shared::model::{Input, Law, Provenance, RigidBody};
    use frikan_shared::pool::Pool;
    use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table, Uniform, UniformShape};
    use frikan_shared::units::{Quantity, Unit};

    type TestModel = Model<256>;

    fn model(law: Law, cells: &[Cell], quantities: &[Quantity]) -> TestModel {
        let inputs = quantities.iter().map(|quantity| Input {
            quantity: quantity.clone(),
            unit: Unit::RadianPerSecond,
            low: -2.0,
            high: 2.0,
        });
        let model = TestModel {
            inputs: inputs.collect(),
            output_unit: Unit::NewtonMetre,
            output_limit: if matches!(law, Law::Network(_)) { 1.0e6 } else { 60.0 },
            rigid_body: RigidBody::default(),
            law,
            effects: heapless::Vec::new(),
            cells: Pool::from_slice(cells).unwrap(),
        };
        // What is compared is what a drive decodes.
        let mut buffer = [0; 8192];
        let image = Image { provenance: Provenance::default(), model };
        decode(encode(&image, &mut buffer).unwrap()).unwrap().model
    }

    fn assert_identical(model: &TestModel) {
        let comparison = compare(model, &sweep(model, 1_000_000));
        assert!(comparison.identical(), "{comparison:?}");
        assert!(comparison.compared >= 1_000_000);
        if model.inputs.len() == 1 {
            for first in [0, 0x3C00_0000, 0x7F7F_0000, 0x8000_0000, 0xBE00_0000, 0xFF7F_0000] {
                assert!(compare_patterns(model, first, 0x2_0000).identical());
            }
        }
    }

    #[test]
    fn tables_agree_to_the_bit() {
        let odd = stribeck_law();
        let sided = stribeck_law().join(Operator::Add, Formula::Input(0).apply(Function::Cos));
        for curve in [&odd, &sided] {
            let compiled = compile_table(curve, -2.0, 2.0, 1.0e-3, 0).unwrap();
            assert_identical(&model(compiled.table.into(), &compiled.cells, &[Quantity::Velocity]));
        }
        let layout = Uniform::new(UniformShape { first_cell: 0, cells: 37, low: -1.7, high: 2.1 });
        let uniform = compile_layout(&odd, Table::Uniform(layout));
        assert_identical(&model(uniform.table.into(), &uniform.cells, &[Quantity::Velocity]));
    }

    #[test]
    fn integer_tables_agree_to_the_bit() {
        let law = stribeck_law();
        let held = |velocity: f64| law.evaluate(&[velocity.clamp(-2.0, 2.0)]);
        let bound = 5.0e-2;
        let wanted = Wanted { range: [-2.0, 2.0], velocity_count: None, torque_count: None, bound, cells: 128 };
        let compiled = compile_integers(&held, &wanted).unwrap();
        assert_identical(&model(Law::IntegerTable(compiled.table), &compiled.cells, &[Quantity::Velocity]));
    }

    #[test]
    fn expressions_agree_to_the_bit() {
        let law = stribeck_law();
        let program = compile_program(&law, 1).unwrap();
        assert_identical(&model(Law::Expression(program), &[], &[Quantity::Velocity]));
        let x = || Formula::Input(1);
        let every_function =
            [Function::Reciprocal, Function::Log, Function::Sin, Function::Cos, Function::Atan, Function::SquareRoot]
                .into_iter()
                .fold(law, |sum, function| sum.join(Operator::Add, x().apply(function)))
                .join(Operator::Add, x().join(Operator::Power, Formula::Input(0)))
                .join(Operator::Divide, Formula::Input(0).join(Operator::Subtract, x()));
        let program = compile_program(&every_function, 2).unwrap();
        assert_identical(&model(Law::Expression(program), &[], &[Quantity::Velocity, Quantity::Load]));
    }

    #[test]
    fn networks_agree_to_the_bit() {
        let geometric = Table::Geometric(Geometric::new(GeometricShape {
            first_cell: 0,
            offset_exponent: -3,
            octave_cells_log2: 1,
            symmetry: Symmetry::Sided,
            reach: 2.0,
            reach_negative: 2.0,
        }));
        let uniform = Table::Uniform(Uniform::new(UniformShape { first_cell: 0, cells: 8, low: -2.0, high: 2.0 }));
        let curve = |target: usize| stribeck_law().join(Operator::Divide, Formula::Constant(10.0 + target as f64));
        let nodes = |(additive, products)| Nodes { additive, products };
        for (inputs, shapes) in [(2, &[][..]), (2, &[(2, 1)]), (2, &[(3, 0), (1, 2)]), (2, &[(2, 2)]), (1, &[(5, 0)])] {
            let hidden: Vec<Nodes> = shapes.iter().copied().map(nodes).collect();
            let tables = &[geometric, uniform][..inputs];
            let mut domains = vec![[-2.0, 2.0]; inputs];
            let mut layers: Vec<Edges> = Vec::new();
            for index in 0..=hidden.len() {
                let into = hidden.get(index);
                let targets = into.map_or(1, |into| usize::from(into.additive + 2 * into.products));
                let over = |rows: Vec<(f64, f64)>| -> Vec<Edge> {
                    (0..targets).map(|target| Edge::new(Some(&curve(target)), &rows, 0.0)).collect()
                };
                let edges: Edges = if index == 0 {
                    tables.iter().map(|table| over(rows(*table).0)).collect()
                } else {
                    let end = |low: f64, high: f64, row: u32| low + (high - low) * f64::from(row) / 6.0;
                    let row = |low, high| move |row: u32| (end(low, high, row), end(low, high, row + 1));
                    domains.iter().map(|&[low, high]| over((0..6).map(row(low, high)).collect())).collect()
                };
                if let Some(into) = into {
                    domains = node_ranges(&edges, *into);
                }
                layers.push(edges);
            }
            let (network, cells) = assemble(tables, &layers, &hidden).unwrap();
            let quantities = &[Quantity::Velocity, Quantity::Load][..inputs];
            assert_identical(&model(Law::Network(network), &cells, quantities));
        }
    }
}
