//! What holds for every bit pattern of an input: its cell lies in the table, and runtime and reference agree. With
//! `FRIKAN_EXHAUSTIVE=1` all 2^32 patterns are looked at, which takes minutes; else an even part of them.

use frikan_runtime::evaluate::evaluate;
use frikan_runtime::in_place::TableInPlace;
use frikan_runtime::integer_table::evaluate_integer;
use frikan_runtime::shared::model::Law;
use frikan_runtime::shared::table::{Geometric, GeometricShape, Symmetry, Table, Uniform, UniformShape};
use frikan_runtime::table::place;
use frikan_tests::exhaustive;
use frikan_tests::models::{self, TestModel};
use frikan_trainer::compile::reference::{evaluate_one, integer_value};
use frikan_trainer::compile::verify::{compare, sweep};
use rayon::prelude::*;

/// Patterns that are passed over otherwise; prime, so that every exponent and a spread of mantissas occur.
const STRIDE: usize = 4099;

/// The first pattern for which `holds` does not, of all or of an even part.
fn first_exception(holds: impl Fn(u32) -> bool + Sync) -> Option<u32> {
    let stride = if exhaustive() { 1 } else { STRIDE };
    let exception = |high: u32| {
        let first = high << 16;
        let offset = (stride - first as usize % stride) % stride;
        (offset..1 << 16).step_by(stride).map(|low| first | low as u32).find(|&bits| !holds(bits))
    };
    (0..1u32 << 16).into_par_iter().filter_map(exception).find_first(|_| true)
}

/// Finding a cell never leaves the table, and the coordinate never leaves `[1, 2)`: no index is checked in an evaluation.
#[test]
fn every_input_has_its_cell() {
    let geometric = |symmetry, octave_cells_log2, offset_exponent, reach| {
        Table::Geometric(Geometric::new(GeometricShape {
            first_cell: 3,
            offset_exponent,
            octave_cells_log2,
            symmetry,
            reach,
            reach_negative: 0.7 * reach,
        }))
    };
    let uniform = |cells, low, high| Table::Uniform(Uniform::new(UniformShape { first_cell: 5, cells, low, high }));
    let tables = [
        geometric(Symmetry::Odd, 2, -6, 2.0),
        geometric(Symmetry::Sided, 0, -14, 1.0e9),
        geometric(Symmetry::Sided, 5, 3, 0.3),
        geometric(Symmetry::Even, 1, -60, 1.0e-9),
        uniform(1, -2.0, 2.0),
        uniform(37, -1.7, 2.1),
        uniform(1024, -1.0e9, 1.0e9),
        uniform(64, 0.999_999, 1.0),
    ];
    for table in tables {
        let cells = table.first_cell()..table.first_cell() + table.cells();
        let exception = first_exception(|bits| {
            let place = place(&table, f32::from_bits(bits));
            cells.contains(&place.row) && (1.0..2.0).contains(&place.t)
        });
        assert_eq!(exception, None, "{table:?}");
    }
}

fn agrees(name: &str, model: &TestModel) {
    let exception = first_exception(|bits| {
        let point = [f32::from_bits(bits), 0.0, 0.0, 0.0];
        evaluate(model, &point).to_bits() == evaluate_one(model, &point).to_bits()
    });
    assert_eq!(exception, None, "{name}");
}

fn one_input_models_agree(is_asked: impl Fn(&Law) -> bool) {
    let asked = |model: &TestModel| model.inputs.len() == 1 && is_asked(&model.law);
    for (name, model) in models::every_law().into_iter().filter(|(_, model)| asked(model)) {
        agrees(name, &model);
    }
}

/// The table of an image that is read where it lies gives what the decoded one gives.
#[test]
fn tables_in_place_agree_at_every_input() {
    for (name, model) in [("symmetric", models::symmetric_table()), ("sided", models::sided_table())] {
        let image = models::image(&model);
        let table = TableInPlace::new(&image).unwrap();
        let exception = first_exception(|bits| {
            let velocity = f32::from_bits(bits);
            let expected = evaluate_one(&model, &[velocity, 0.0, 0.0, 0.0]);
            velocity.is_nan() || table.value(velocity).to_bits() == expected.to_bits()
        });
        assert_eq!(exception, None, "{name}");
    }
}

#[test]
fn tables_agree_at_every_input() {
    one_input_models_agree(|law| matches!(law, Law::Geometric(_) | Law::Uniform(_) | Law::IntegerTable(_)));
}

#[test]
fn the_stribeck_expression_agrees_at_every_input() {
    agrees("Stribeck expression", &models::stribeck_expression());
}

#[test]
fn an_expression_of_every_operation_agrees_at_every_input() {
    agrees("every operation", &models::every_operation());
}

#[test]
fn networks_agree_at_every_input() {
    one_input_models_agree(|law| matches!(law, Law::Network(_)));
}

#[test]
fn the_integer_table_agrees_at_every_count() {
    let model = models::integer_table();
    let Law::IntegerTable(table) = &model.law else { unreachable!() };
    let shape = table.shape();
    let exception = first_exception(|bits| {
        let count = bits as i32;
        evaluate_integer(table, &model.cells, count) == integer_value(&shape, &model.cells, count)
    });
    assert_eq!(exception, None);
}

/// Two and three inputs on a set that fills their space, special values among them.
#[test]
fn models_of_several_inputs_agree_on_a_million_rows() {
    for (name, model) in models::every_kind() {
        if model.inputs.len() > 1 {
            let comparison = compare(&model, &sweep(&model, 1_000_000));
            assert!(comparison.identical() && comparison.compared >= 1_000_000, "{name}: {comparison:?}");
        }
    }
}
