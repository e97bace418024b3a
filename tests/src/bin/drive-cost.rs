//! Measures what models and their peers cost on the emulated targets and writes `docs/drive-cost.md`.

use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::c::{EVERY_FEATURE, EXAMPLE_INPUTS, example, example_of_nothing};
use frikan_tests::cost::{count, count_integer, count_integer_steps, count_rows, count_steps, count_supervised};
use frikan_tests::models::{self, TestModel, stribeck_friction};
use frikan_tests::vectors::one_input;
use frikan_trainer::emulator::{Answer, Emulator, Firmware, Footprint, Mode, Request, footprint};
use frikan_trainer::error::Result;
use frikan_trainer::files::write_whole;

/// Where the table goes, from the root of the repository.
const PAGE: &str = "docs/drive-cost.md";

/// Velocity over which the peers are compared, rad/s: their tables end there.
const REACH: f32 = 2.0;

/// Features of the firmware, `watched` for those of a supervised drive.
const FEATURES: [&str; 9] = [
    "table",
    "table,slots",
    "table,watched",
    "table,slots,watched",
    "table,auth",
    "expression",
    "network",
    "effects",
    "expression,network,effects,watched,slots,auth",
];

/// The peers: what it is, and the binary of the firmware.
const PEERS: [(&str, &str); 6] = [
    ("C, newlib `expf`, `tanhf`, -O2", "peer-newlib-float"),
    ("C, newlib `exp`, `tanh` in double, -O2", "peer-newlib-double"),
    ("Rust, libm 0.2.16", "peer-libm"),
    ("Rust, micromath 2.1", "peer-micromath"),
    ("C, linear table of 256", "peer-linear-c"),
    ("Rust, linear table of 256", "peer-linear-rust"),
];

const HEAD: &str = "\
# What a model costs on the drive

Written by `cargo run --release -p frikan-tests --bin drive-cost`; nothing here is typed by hand.

A step is what a control loop calls: channels, law, effects with their memory, limits. It is counted over 4096 samples of the sequence by
which `trainer verify` proves a model: motions at every scale, reversals, dwells, missing samples, special values, resets, limits. A law
is the table, network or formula alone, over 4096 rows that hold every special value (zeros, subnormals, infinities, NaN), a sweep beyond
the trained range and random bit patterns.

Instructions are counted under QEMU: SysTick on Arm, `minstret` on RISC-V, calibrated by 1024 `nop`. A count runs from the first instruction
inside the call to its return, the loading of the sample and the storing of the answer included; the model is read from the decoded
image, not compiled in. Instructions are not cycles: a core that issues one at a time takes at least as many cycles, more for loads,
divisions and taken branches.

Flash is the code and constants of the smallest firmware that decodes an image and steps every kind of model, beyond one that does nothing
(and so the same in every row). RAM is the compensator with room for 128 cells, its last sample and answer. Stack is the depth that one step
and decoding reach.

Rows that name effects are the symmetric table with these effects; it then reads velocity, position, load and temperature, unless the row says
how many inputs.
";

fn main() -> Result<()> {
    let mut page = String::from(HEAD);
    let firmware = Firmware::find()?;
    for name in firmware.target_names()? {
        eprintln!("{name}");
        append_target(&mut page, &firmware, &name)?;
    }
    append_features(&mut page, &firmware)?;
    append_supervised(&mut page, &firmware)?;
    append_c_library(&mut page)?;
    append_peers(&mut page, &firmware)?;
    write_whole(Path::new(PAGE), page.as_bytes())?;
    print!("{page}");
    Ok(())
}

/// The section of one target.
fn append_target(page: &mut String, firmware: &Firmware, name: &str) -> Result<()> {
    let (steps, laws) = (Emulator::with_binary(firmware, name, "emulate-step")?, Emulator::new(name)?);
    let Footprint { flash_bytes, .. } = steps.footprint()?;
    append(page, format_args!("\n## {name}\n\nFlash {flash_bytes} B.\n\n"));
    append(
        page,
        format_args!(
            "| model | step, instructions | law, instructions | stack, step B | stack, decode B | RAM B | image B | decode, instructions |\n\
             |---|---|---|---|---|---|---|---|\n"
        ),
    );
    let kinds = models::every_kind().into_iter().map(|(kind, model)| (kind.to_owned(), model));
    for (kind, model) in kinds.chain(models::with_every_effect()) {
        let step = count_steps(&steps, &model)?;
        append_model(page, &kind, &model, (&range(&step), &range(&count(&laws, &model)?)), &step);
    }
    let integer = Emulator::with_binary(firmware, name, "emulate-integer")?;
    let (kind, model) = ("integer table, counts in and out, without limits", models::integer_table());
    let counted = count_integer(&integer, &model)?;
    append_model(page, kind, &model, ("-", &range(&counted)), &counted);
    append_integer_step(page, firmware, name)
}

/// The integer compensator with its table in flash, and the smallest drive with it alone.
fn append_integer_step(page: &mut String, firmware: &Firmware, name: &str) -> Result<()> {
    let alone = firmware.with_features("integer");
    let emulator = Emulator::with_binary(&alone, name, "emulate-integer-step")?;
    let model = models::integer_table();
    let counted = count_integer_steps(&emulator, &model)?;
    append_model(page, "integer compensator, its table in flash", &model, (&range(&counted), "-"), &counted);
    let drive = footprint(&alone.build(emulator.target(), "drive-integer")?)?;
    let flash = drive.beyond(footprint(&alone.build(emulator.target(), "bare")?)?).flash_bytes;
    append(page, format_args!("\nFlash of the drive with the integer compensator alone {flash} B.\n"));
    Ok(())
}

fn append_model(page: &mut String, kind: &str, model: &TestModel, (step, law): (&str, &str), answer: &Answer) {
    append(
        page,
        format_args!(
            "| {kind} | {step} | {law} | {} | {} | {} | {} | {} |\n",
            answer.evaluate_stack_bytes,
            answer.decode_stack_bytes,
            answer.model_bytes,
            models::image(model).len(),
            answer.decode_instructions
        ),
    );
}

/// The smallest drive of some features on Cortex-M4F, a row each.
fn append_features(page: &mut String, firmware: &Firmware) -> Result<()> {
    append(
        page,
        format_args!(
            "\n## Features on cortex-m4f\n\n\
         The smallest drive with these features of `frikan-runtime` alone, beside a program that does nothing. Without one of `expression`,\n\
         `network` and `effects` a table is read where it lies in flash, else images are decoded to memory. Step, stack and RAM (the compensator, its\n\
         last sample and answer, 52 B) are those of the symmetric table without supervisor.\n\n\
         | features | flash B | RAM B | stack, start B | stack, step B | step, instructions | start, instructions |\n\
         |---|---|---|---|---|---|---|\n"
        ),
    );
    for features in FEATURES {
        eprintln!("{features}");
        let alone = firmware.with_features(features);
        let target = alone.target("cortex-m4f")?;
        let drive = footprint(&alone.build(&target, "drive")?)?;
        let flash = drive.beyond(footprint(&alone.build(&target, "bare")?)?).flash_bytes;
        let answer =
            count_steps(&Emulator::with_binary(&alone, "cortex-m4f", "emulate-step")?, &models::symmetric_table())?;
        let Answer { model_bytes, decode_stack_bytes, evaluate_stack_bytes, decode_instructions, .. } = answer;
        let step = range(&answer);
        let shown = features.replace("watched", "supervised").replace(',', ", ");
        append(
            page,
            format_args!(
                "| {shown} | {flash} | {model_bytes} | {decode_stack_bytes} | {evaluate_stack_bytes} | {step} | {decode_instructions} |\n"
            ),
        );
    }
    Ok(())
}

/// The supervised step on Cortex-M4F.
fn append_supervised(page: &mut String, firmware: &Firmware) -> Result<()> {
    append(
        page,
        format_args!(
            "\n## The supervised step on cortex-m4f\n\n\
         The symmetric table in flash under a supervisor, over 4096 samples of a sine behind its reference, with rests. RAM is compensator, supervisor, last\n\
         sample and answer.\n\n\
         | step | step, instructions | stack, step B | RAM B |\n|---|---|---|---|\n"
        ),
    );
    let emulator = Emulator::with_binary(&firmware.with_features("table,watched"), "cortex-m4f", "emulate-supervised")?;
    for (step, learns) in [("supervised", false), ("supervised, with `--adapt`", true)] {
        let answer = count_supervised(&emulator, &models::symmetric_table(), learns)?;
        let (range, stack, ram) = (range(&answer), answer.evaluate_stack_bytes, answer.model_bytes);
        append(page, format_args!("| {step} | {range} | {stack} | {ram} |\n"));
    }
    Ok(())
}

/// The library for C in its example, supervised, on Cortex-M4F.
fn append_c_library(page: &mut String) -> Result<()> {
    append(
        page,
        format_args!(
            "\n## The C library on cortex-m4f\n\n\
         `runtime/c/example`, a supervised drive of one joint compiled with `-O2`, beside the same example without the library. RAM is compensator and\n\
         supervisor; stack that of a symmetric table.\n\n\
         | features | flash B | RAM B | stack, start B | stack, step B |\n|---|---|---|---|---|\n"
        ),
    );
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let nothing = footprint(&example_of_nothing(folder.path()))?;
    let target = Firmware::find()?.target("cortex-m4f")?;
    for (shown, features) in [("by default", None), ("every feature", Some(EVERY_FEATURE))] {
        let elf = example(folder.path(), features, &[]);
        let Footprint { flash_bytes, ram_bytes } = footprint(&elf)?.beyond(nothing);
        let image = models::image(&models::symmetric_table());
        let (mode, values) = (Mode::Evaluate, [0.0; EXAMPLE_INPUTS]);
        let request = Request {
            image: &image,
            values: &values,
            inputs: EXAMPLE_INPUTS,
            outputs: 1,
            mode,
            floating_point_control: 0,
        };
        let answer = Emulator::with_elf(target.clone(), elf)?.run(&request)?;
        let (start, step) = (answer.decode_stack_bytes, answer.evaluate_stack_bytes);
        append(page, format_args!("| {shown} | {flash_bytes} | {ram_bytes} | {start} | {step} |\n"));
    }
    Ok(())
}

/// The peers on Cortex-M4F, beside the two ways in which Frikan carries the same law.
fn append_peers(page: &mut String, firmware: &Firmware) -> Result<()> {
    append(
        page,
        format_args!(
            "\n## Peers on cortex-m4f\n\n\
         The law `(22 + 8 exp(-|v / 0.1|)) tanh(50 v) + 0.03 v` over `[-2, 2]` rad/s, in the same harness. Flash is what the\n\
         peer adds to the harness; Frikan's rows, the law alone without limits, add the code for every kind of model and the image. The error is the\n\
         largest distance from the law in double precision.\n\n\
         | what | instructions | flash B | largest error, N m |\n|---|---|---|---|\n"
        ),
    );
    let values: Vec<f32> = one_input(4096, REACH, 2);
    let nothing = footprint(&firmware.build(&firmware.target("cortex-m4f")?, "peer-nothing")?)?;
    for (what, binary) in PEERS {
        eprintln!("{binary}");
        let emulator = Emulator::with_binary(firmware, "cortex-m4f", binary)?;
        let answer = count_rows(&emulator, &[], &values, 1)?;
        let flash = footprint(&firmware.build(emulator.target(), binary)?)?.beyond(nothing).flash_bytes;
        append(
            page,
            format_args!("| {what} | {} | {flash} | {:.2e} |\n", range(&answer), largest_error(&values, &answer)),
        );
    }
    let emulator = Emulator::new("cortex-m4f")?;
    let code = emulator.footprint()?.flash_bytes;
    let same_law =
        [("Frikan, geometric table", models::symmetric_table()), ("Frikan, expression", models::stribeck_expression())];
    for (what, model) in same_law {
        let answer = count_rows(&emulator, &models::image(&model), &values, 1)?;
        let flash = code + models::image(&model).len() as u64;
        append(
            page,
            format_args!("| {what} | {} | {flash} | {:.2e} |\n", range(&answer), largest_error(&values, &answer)),
        );
    }
    Ok(())
}

/// Largest distance of the outputs from the law, over the inputs within [`REACH`].
fn largest_error(values: &[f32], answer: &Answer) -> f64 {
    let within = values.iter().zip(&answer.outputs).filter(|(velocity, _)| velocity.abs() <= REACH);
    within
        .map(|(velocity, output)| (f64::from(*output) - stribeck_friction(f64::from(*velocity))).abs())
        .fold(0.0, f64::max)
}

/// `34` where constant, `53-206` where not.
fn range(answer: &Answer) -> String {
    match answer.instruction_range() {
        Some((fewest, most)) if fewest == most => fewest.to_string(),
        Some((fewest, most)) => format!("{fewest}-{most}"),
        None => String::from("-"),
    }
}

fn append(page: &mut String, text: std::fmt::Arguments<'_>) {
    page.write_fmt(text).expect("a string takes everything");
}
