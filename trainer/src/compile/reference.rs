//! The trainer's own evaluator of a decoded model, over whole batches, in `f32`.
//!
//! It is written apart from the runtime: it finds cells by counting exponents and mantissas instead of masking patterns, runs
//! programs on a growing stack, and walks networks edge by edge. It shares with the runtime only what *defines* a model: the order
//! of every rounding, and the elementary functions of [`frikan_shared::elementary`].

use frikan_shared::elementary;
use frikan_shared::expression::{Operation, Program};
use frikan_shared::integer_table::{IntegerShape, REACH_BITS, SEGMENT_BITS, SEGMENTS, WAY_BITS};
use frikan_shared::model::{Law, MAX_INPUTS, Model};
use frikan_shared::network::Network;
use frikan_shared::table::{Cell, Geometric, Symmetry, Table, Uniform};

/// The static law of `model` at each of `inputs`, as the drive must compute it to the bit.
#[must_use]
pub fn evaluate_batch<const CELLS: usize>(model: &Model<CELLS>, inputs: &[[f32; MAX_INPUTS]]) -> Vec<f32> {
    inputs.iter().map(|inputs| evaluate_one(model, inputs)).collect()
}

/// The static law of `model` at one point.
#[must_use]
pub fn evaluate_one<const CELLS: usize>(model: &Model<CELLS>, inputs: &[f32; MAX_INPUTS]) -> f32 {
    let count = match &model.law {
        // A table reads the first channel.
        Law::Geometric(_) | Law::Uniform(_) | Law::IntegerTable(_) => 1,
        Law::Network(_) | Law::Expression(_) => model.inputs.len(),
    };
    if inputs[..count].iter().any(|input| input.is_nan()) {
        return 0.0;
    }
    let value = match &model.law {
        Law::Geometric(layout) => single_table(&Table::Geometric(*layout), &model.cells, inputs[0]),
        Law::Uniform(layout) => single_table(&Table::Uniform(*layout), &model.cells, inputs[0]),
        Law::Network(network) => network_value(network, &model.cells, &inputs[..count]),
        Law::Expression(program) => {
            let held: Vec<f32> =
                inputs.iter().zip(&model.inputs).map(|(x, channel)| x.clamp(channel.low, channel.high)).collect();
            program_value(program, &held)
        }
        Law::IntegerTable(table) => {
            let shape = table.shape();
            let half = if inputs[0].is_sign_negative() { -0.5 } else { 0.5 };
            let steps = (inputs[0] / shape.input_step + half) as i32;
            integer_value(&shape, &model.cells, steps) as f32 * shape.output_step
        }
    };
    if value.is_nan() { 0.0 } else { value.clamp(-model.output_limit, model.output_limit) }
}

/// Row, local coordinate and sign of the output.
type Found = (usize, f32, bool);

fn find(table: &Table, input: f32) -> Found {
    match table {
        Table::Geometric(layout) => find_geometric(layout, input),
        Table::Uniform(layout) => find_uniform(layout, input),
    }
}

fn find_geometric(layout: &Geometric, input: f32) -> Found {
    let shape = layout.shape();
    let negative = input.is_sign_negative();
    let per_octave = 2u64.pow(u32::from(shape.octave_cells_log2));
    let steps_per_cell = 2u64.pow(23) / per_octave;
    let c = 2.0f64.powi(i32::from(shape.offset_exponent)) as f32;
    // Steps of equal ratio from c to |v| + c: 2^23 for each octave, linear within it.
    let steps = |magnitude: f32| -> u64 {
        let w = magnitude + c;
        if w.is_infinite() {
            return u64::MAX;
        }
        let exponent = f64::from(w).log2().floor() as i32;
        let exponent = if f64::from(w) < 2.0f64.powi(exponent) { exponent - 1 } else { exponent };
        let octaves = (exponent - i32::from(shape.offset_exponent)) as u64;
        let within = (f64::from(w) / 2.0f64.powi(exponent) - 1.0) * 2.0f64.powi(23);
        octaves * 2u64.pow(23) + within as u64
    };
    let reach = if negative && shape.symmetry == Symmetry::Sided { shape.reach_negative } else { shape.reach };
    let last = steps(reach).max(1) - 1;
    let position = steps(input.abs()).min(last);
    let mut row = u64::from(shape.first_cell) + position / steps_per_cell;
    if negative && shape.symmetry == Symmetry::Sided {
        row += (steps(shape.reach).max(1) - 1) / steps_per_cell + 1;
    }
    let t = (1.0 + (position % steps_per_cell) as f64 / steps_per_cell as f64) as f32;
    (row as usize, t, negative && shape.symmetry == Symmetry::Odd)
}

fn find_uniform(layout: &Uniform, input: f32) -> Found {
    let shape = layout.shape();
    let scale = 2.0f32.powi(32) / (shape.high - shape.low);
    let scaled = (input - shape.low) * scale;
    let fraction = f64::from(scaled).clamp(0.0, f64::from(u32::MAX)).floor() as u128;
    let product = fraction * u128::from(shape.cells);
    let cell = product / 2u128.pow(32);
    let t = 1.0 + ((product % 2u128.pow(32)) / 512) as f32 / 2.0f32.powi(23);
    (usize::from(shape.first_cell) + cell as usize, t, false)
}

fn cubic(cell: Cell, (_, t, turned): Found) -> f32 {
    let [c0, c1, c2, c3] = cell.floats();
    let mut value = c3;
    for coefficient in [c2, c1, c0] {
        value = value * t + coefficient;
    }
    if turned { -value } else { value }
}

/// The value of a single table at `input`.
pub(super) fn single_table(table: &Table, cells: &[Cell], input: f32) -> f32 {
    let found = find(table, input);
    cubic(cells[found.0], found)
}

/// The value of an integer table at `steps`, both in steps, worked out in 128 bits and by division instead of shifts.
#[must_use]
pub fn integer_value(shape: &IntegerShape, cells: &[Cell], steps: i32) -> i32 {
    let segment_steps = 1i128 << SEGMENT_BITS;
    let position = i128::from(steps).abs().min((1 << REACH_BITS) - 1);
    let segment = (position / segment_steps) as usize;
    let count = i128::from(shape.cells[segment]);
    let before = |end: usize| shape.cells[..end].iter().copied().map(i128::from).sum::<i128>();
    // The way through the segment, in its cells.
    let way = (position % segment_steps) * count;
    let mut cell = i128::from(shape.first_cell) + before(segment) + way / segment_steps;
    if steps < 0 && shape.symmetry == Symmetry::Sided {
        cell += before(SEGMENTS);
    }
    let [c0, c1, c2, c3] = cells[cell as usize].integers().map(i128::from);
    let unit = 1i128 << WAY_BITS;
    let x = (way % segment_steps) * unit / segment_steps;
    let mut value = c3;
    for coefficient in [c2, c1, c0] {
        value = coefficient + (value * x).div_euclid(unit);
    }
    let value = if steps < 0 && shape.symmetry == Symmetry::Odd { -value } else { value };
    value as i32
}

/// Row and coordinate in `2^31` of an input among a network's rows.
fn find_exactly(table: &Table, input: f32) -> (usize, i128) {
    // The drive's coordinate keeps 31 bits of the way through the cell; a table's keeps 23 of them.
    let (position, rows, first) = match table {
        Table::Geometric(layout) => {
            let (row, t, _) = find_geometric(layout, input);
            return (row, ((f64::from(t) - 1.0) * 2.0f64.powi(31)) as i128);
        }
        Table::Uniform(layout) => {
            let shape = layout.shape();
            let scaled = (input - shape.low) * (2.0f32.powi(32) / (shape.high - shape.low));
            (
                f64::from(scaled).clamp(0.0, f64::from(u32::MAX)).floor() as i128,
                i128::from(shape.cells),
                shape.first_cell,
            )
        }
    };
    let way = position * rows;
    (usize::from(first) + (way >> 32) as usize, (way % (1 << 32)) / 2)
}

/// The value of an edge at a coordinate in `2^31`.
fn edge_value(cell: Cell, x: i128) -> i128 {
    let [a0, a1, a2, a3] = cell.integers().map(i128::from);
    [a2, a1, a0].into_iter().fold(a3, |value, coefficient| coefficient + (value * x).div_euclid(1 << 32))
}

fn network_value(network: &Network, cells: &[Cell], inputs: &[f32]) -> f32 {
    let edges = |first: usize, row: usize, x: i128, count: usize| -> Vec<i128> {
        (0..count).map(|target| edge_value(cells[first + row * count + target], x)).collect()
    };
    let total = |mut sums: Vec<i128>, more: Vec<i128>| {
        sums.iter_mut().zip(more).for_each(|(sum, value)| *sum += value);
        sums
    };
    let no_sums = |layer: usize| vec![0; network.targets(layer)];
    let mut sums = network.sources().iter().zip(inputs).fold(no_sums(0), |sums, (source, input)| {
        let (row, x) = find_exactly(&source.table, *input);
        total(sums, edges(usize::from(source.first_cell), row, x, network.targets(0)))
    });
    for (index, layer) in network.layers().iter().enumerate() {
        let end = i128::from(layer.first_row) + i128::from(layer.rows) * layer.nodes() as i128;
        // The largest power of two of which the positions before the end of the last row are fewer than 2^32.
        let width = (0..32).map(|bits| 1i128 << bits).take_while(|width| end * width < 1 << 32).last().unwrap_or(1);
        let (additive, factors) = sums.split_at(usize::from(layer.additive));
        let products = factors.chunks(2).zip(i128::from(layer.additive)..).map(|(pair, node)| {
            let rows = i128::from(layer.rows);
            let twice_the_middle = (2 * i128::from(layer.first_row) + (2 * node + 1) * rows) * width;
            twice_the_middle / 2 + (pair[0] * pair[1]).div_euclid(1 << 32)
        });
        let positions = additive.iter().map(|sum| sum.rem_euclid(1 << 32)).chain(products);
        sums = positions.fold(no_sums(index + 1), |sums, position| {
            let x = (position % width) * (1 << 31) / width;
            total(sums, edges(0, (position / width) as usize, x, network.targets(index + 1)))
        });
    }
    // The sum of the output is in range; its edges need not be.
    sums[0] as f32 * network.output_step
}

fn program_value(program: &Program, inputs: &[f32]) -> f32 {
    let mut stack: Vec<f32> = Vec::with_capacity(program.operations.len());
    for operation in &program.operations {
        let mut pop = || stack.pop().expect("a validated program has its operands");
        let value = match *operation {
            Operation::Input(index) => inputs[usize::from(index)],
            Operation::ScaledInput(index, factor) => inputs[usize::from(index)] * factor,
            Operation::ScaledMagnitude(index, factor) => inputs[usize::from(index)].abs() * factor,
            Operation::AddScaledInput(index, factor) => pop() + inputs[usize::from(index)] * factor,
            Operation::Constant(constant) => constant,
            Operation::Scale(factor) => pop() * factor,
            Operation::Offset(summand) => pop() + summand,
            Operation::Add => {
                let a = pop();
                pop() + a
            }
            Operation::Subtract => {
                let a = pop();
                pop() - a
            }
            Operation::Multiply => {
                let a = pop();
                pop() * a
            }
            Operation::Divide => {
                let a = pop();
                pop() / a
            }
            Operation::Minimum => {
                let (a, b) = (pop(), pop());
                if b < a { b } else { a }
            }
            Operation::Maximum => {
                let (a, b) = (pop(), pop());
                if b > a { b } else { a }
            }
            Operation::Power => {
                let a = pop();
                elementary::power(pop(), a)
            }
            Operation::PowerOf(exponent) => elementary::power(pop(), exponent),
            Operation::Negate => -pop(),
            Operation::Absolute => pop().abs(),
            Operation::Square => {
                let a = pop();
                a * a
            }
            Operation::Reciprocal => 1.0 / pop(),
            Operation::Exp => elementary::exp(pop()),
            Operation::Log => elementary::log(pop()),
            Operation::Tanh => elementary::tanh(pop()),
            Operation::Sin => elementary::sin(pop()),
            Operation::Cos => elementary::cos(pop()),
            Operation::Atan => elementary::atan(pop()),
            Operation::SquareRoot => elementary::square_root(pop()),
            Operation::Sign => elementary::sign(pop()),
        };
        stack.push(value);
    }
    stack.pop().expect("a validated program leaves a value")
}
