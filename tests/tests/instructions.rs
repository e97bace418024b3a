//! Instructions of an evaluation on the emulated targets: the same for every input, and within the budget.

use frikan_tests::models::{self, TestModel};
use frikan_tests::vectors::{one_input, space_filling};
use frikan_trainer::emulator::{Emulator, Mode, Request};

/// Rows that are counted; the special values are among them.
const ROWS: usize = 4096;

/// Fewest and most instructions of one evaluation over [`ROWS`] rows.
fn instruction_range(emulator: &Emulator, model: &TestModel) -> (u32, u32) {
    let inputs = model.inputs.len();
    let values = if inputs == 1 {
        one_input(ROWS, model.inputs[0].high, 2)
    } else {
        space_filling(ROWS, &model.inputs.iter().map(|input| input.high).collect::<Vec<_>>())
    };
    let image = models::image(model);
    let request = Request { image: &image, values: &values, inputs, mode: Mode::Count, floating_point_control: 0 };
    emulator.run(&request).unwrap().instruction_range().unwrap()
}

/// Every kind of model, constant; those named in `budgets` within their budget.
fn every_kind_is_constant_on(target: &str, budgets: &[(&str, u32)]) {
    let emulator = Emulator::new(target).unwrap();
    let counted: Vec<_> =
        models::every_kind().into_iter().map(|(name, model)| (name, instruction_range(&emulator, &model))).collect();
    for (name, (fewest, most)) in &counted {
        assert_eq!(fewest, most, "{name} on {target} is not constant: {counted:?}");
    }
    for (name, budget) in budgets {
        let (_, (_, most)) = counted.iter().find(|(counted, _)| counted == name).unwrap();
        assert!(most <= budget, "{name} on {target} takes {most} instructions, {budget} at most: {counted:?}");
    }
}

#[test]
fn every_kind_is_constant_on_cortex_m4f() {
    let budgets =
        [("symmetric table", 45), ("sided table", 45), ("network [1,5,1]", 160), ("Stribeck expression", 250)];
    every_kind_is_constant_on("cortex-m4f", &budgets);
}

#[test]
fn every_kind_is_constant_on_cortex_m7() {
    every_kind_is_constant_on("cortex-m7", &[]);
}

#[test]
fn every_kind_is_constant_on_cortex_m33() {
    every_kind_is_constant_on("cortex-m33", &[]);
}

/// The count itself, against code whose instructions are known: a model that is a constant program of one more operation
/// cannot be cheaper, and counting twice gives the same.
#[test]
fn counting_repeats() {
    let emulator = Emulator::new("cortex-m4f").unwrap();
    let first = instruction_range(&emulator, &models::stribeck_expression());
    let second = instruction_range(&emulator, &models::stribeck_expression());
    assert_eq!(first, second);
}
