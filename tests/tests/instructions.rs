//! Instructions of an evaluation on the emulated targets: the same for every input where there is a floating-point unit,
//! and within the budget.

use frikan_runtime::shared::expression::{Operation, Program};
use frikan_runtime::shared::model::Law;
use frikan_tests::cost::{Documented, count, count_integer, count_steps};
use frikan_tests::models;
use frikan_trainer::compile::cost::{float_step, float_term, instructions};
use frikan_trainer::emulator::{Emulator, Firmware};

/// Every law, constant; those named in `budgets` within their budget.
fn every_law_is_constant_on(target: &str, budgets: &[(&str, u32)]) {
    let emulator = Emulator::new(target).unwrap();
    let range = |model| count(&emulator, &model).unwrap().instruction_range().unwrap();
    let counted: Vec<_> = models::every_law().into_iter().map(|(name, model)| (name, range(model))).collect();
    for (name, (fewest, most)) in &counted {
        assert_eq!(fewest, most, "{name} on {target} is not constant: {counted:?}");
    }
    for (name, budget) in budgets {
        let (_, (_, most)) = counted.iter().find(|(counted, _)| counted == name).unwrap();
        assert!(most <= budget, "{name} on {target} takes {most} instructions, {budget} at most: {counted:?}");
    }
}

fn integer_table_is_constant_on(target: &str, budget: u32) {
    let emulator = Emulator::with_binary(&Firmware::find().unwrap(), target, "emulate-integer").unwrap();
    let answer = count_integer(&emulator, &models::integer_table()).unwrap();
    let (fewest, most) = answer.instruction_range().unwrap();
    assert_eq!(fewest, most, "the integer table on {target} is not constant");
    assert!(most <= budget, "the integer table on {target} takes {most} instructions, {budget} at most");
}

#[test]
fn every_law_is_constant_on_cortex_m4f() {
    let budgets =
        [("symmetric table", 45), ("sided table", 45), ("network [1,5,1]", 160), ("Stribeck expression", 250)];
    every_law_is_constant_on("cortex-m4f", &budgets);
}

#[test]
fn every_law_is_constant_on_cortex_m7() {
    every_law_is_constant_on("cortex-m7", &[]);
}

#[test]
fn every_law_is_constant_on_cortex_m33() {
    every_law_is_constant_on("cortex-m33", &[]);
}

/// Every step, constant whatever the sample, missing and special ones included; the commonest within their budget.
fn every_step_is_constant_on(target: &str, budgets: &[(&str, u32)]) {
    let emulator = Emulator::with_binary(&Firmware::find().unwrap(), target, "emulate-step").unwrap();
    let laws = models::every_law().into_iter().map(|(name, model)| (name.to_owned(), model));
    let all = laws.chain(models::with_every_effect());
    let counted: Vec<(String, (u32, u32))> =
        all.map(|(name, model)| (name, count_steps(&emulator, &model).unwrap().instruction_range().unwrap())).collect();
    for (name, (fewest, most)) in &counted {
        assert_eq!(fewest, most, "a step of {name} on {target} is not constant");
        // The page has no row for what no drive has.
        if !["every operation", "integer table"].contains(&name.as_str()) {
            Documented::of(target, name).holds("step, instructions", (*most).into());
        }
    }
    for (name, budget) in budgets {
        let (_, (_, most)) = counted.iter().find(|(counted, _)| counted == name).unwrap();
        assert!(most <= budget, "a step of {name} on {target} takes {most} instructions, {budget} at most");
    }
}

#[test]
fn every_step_is_constant_on_cortex_m4f() {
    let budgets = [
        ("symmetric table", 120),
        ("sided table", 120),
        ("table of 1 inputs with one element", 250),
        ("table of 2 inputs with one element", 270),
    ];
    every_step_is_constant_on("cortex-m4f", &budgets);
}

#[test]
fn every_step_is_constant_on_cortex_m7() {
    every_step_is_constant_on("cortex-m7", &[]);
}

#[test]
fn every_step_is_constant_on_cortex_m33() {
    every_step_is_constant_on("cortex-m33", &[]);
}

#[test]
fn the_integer_table_is_constant_on_cortex_m0plus() {
    integer_table_is_constant_on("cortex-m0plus", 50);
}

#[test]
fn the_integer_table_is_constant_on_riscv32imac() {
    integer_table_is_constant_on("riscv32imac", 45);
}

#[test]
fn the_integer_table_is_constant_on_riscv32imc() {
    integer_table_is_constant_on("riscv32imc", 45);
}

/// What `fit` says of the float path of a drive without floating-point unit is what the page has.
#[test]
fn the_documented_float_steps_are_those_of_the_page() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/drive-cost.md")).unwrap();
    for target in ["cortex-m0plus", "riscv32imac", "riscv32imc"] {
        let section = page.split("\n## ").find(|section| section.starts_with(&format!("{target}\n"))).unwrap();
        for (_, model) in models::every_kind() {
            let step = float_step(target, &model.law).unwrap();
            let row = section.lines().find_map(|line| line.strip_prefix(&format!("| {} | ", step.row))).unwrap();
            let [least, most] = step.instructions;
            assert!(row.starts_with(&format!("{least}-{most} |")), "{target}, {}: {row}", step.row);
        }
        let range = |name: &str| -> [u32; 2] {
            let row = section.lines().find_map(|line| line.strip_prefix(&format!("| {name} | "))).unwrap();
            let (least, most) = row.split(' ').next().unwrap().split_once('-').unwrap();
            [least, most].map(|number| number.parse().unwrap())
        };
        let table = range("symmetric table");
        let beyond = models::every_effect().into_iter().map(|(name, _)| {
            let with = range(name);
            [0, 1].map(|end| with[end] - table[end])
        });
        let ends = beyond.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        assert_eq!(float_term(target), ends, "{target}");
    }
}

/// Without a floating-point unit the float table does take its time by the input: the count sees the difference.
#[test]
fn the_count_sees_a_time_that_varies() {
    let emulator = Emulator::new("cortex-m0plus").unwrap();
    let (fewest, most) = count(&emulator, &models::symmetric_table()).unwrap().instruction_range().unwrap();
    assert!(fewest < most && fewest > 50, "{fewest} to {most}");
}

/// The cost by which a fit chooses the form of a law is the cost on the target.
#[test]
fn the_cost_worked_out_beforehand_is_the_count_on_cortex_m4f() {
    let emulator = Emulator::new("cortex-m4f").unwrap();
    // Networks whose layers, nodes and edges differ in number one at a time.
    let shapes: [(usize, &[(u8, u8)]); 6] = [
        (1, &[(3, 0)]),
        (2, &[(5, 0)]),
        (2, &[(2, 0)]),
        (3, &[(2, 0)]),
        (2, &[(3, 0), (3, 0)]),
        (2, &[(1, 1), (2, 0)]),
    ];
    let networks = shapes.map(|(inputs, layers)| ("network", models::network(inputs, layers)));
    let counted: Vec<(&str, u32, u32)> = models::every_law()
        .into_iter()
        .chain(networks)
        .map(|(name, model)| {
            let (_, most) = count(&emulator, &model).unwrap().instruction_range().unwrap();
            (name, instructions(&model), most)
        })
        .collect();
    for (name, expected, most) in &counted {
        assert!(most.abs_diff(*expected) * 50 <= *most, "{name}, expected and counted: {counted:?}");
    }
    let mut model = models::stribeck_expression();
    use Operation::{
        Atan, Constant, Cos, Input, Log, Maximum, Minimum, Power, PowerOf, Reciprocal, Sign, Sin, SquareRoot, Subtract,
    };
    let two = |operation| vec![Input(0), Constant(2.0), operation];
    let programs = [Atan, Cos, Log, PowerOf(1.5), Reciprocal, Sign, Sin, SquareRoot].map(|o| vec![Input(0), o]);
    for operations in programs.into_iter().chain([Maximum, Minimum, Power, Subtract].map(two)) {
        model.law = Law::Expression(Program { operations: operations.iter().copied().collect() });
        let (_, most) = count(&emulator, &model).unwrap().instruction_range().unwrap();
        assert_eq!(instructions(&model), most, "{operations:?}");
    }
}
