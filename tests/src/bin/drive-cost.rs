//! Measures what models and their peers cost on the emulated targets and writes `docs/drive-cost.md`.

use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::cost::{count, count_integer, count_rows, count_steps};
use frikan_tests::models::{self, TestModel, stribeck_friction};
use frikan_tests::vectors::one_input;
use frikan_trainer::emulator::{Answer, Emulator, Firmware, Footprint, footprint};
use frikan_trainer::error::Result;
use frikan_trainer::files::write_whole;

/// Where the table goes, from the root of the repository.
const PAGE: &str = "docs/drive-cost.md";

/// Velocity over which the peers are compared, rad/s: their tables end there.
const REACH: f32 = 2.0;

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
