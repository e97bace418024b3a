//! `trainer verify`: the step that a control loop calls against the trainer's own evaluator, bit for bit, here or on an emulated target.

mod integers;
mod told;

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::Args;
use frikan_runtime::friction::Measurement;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::Quantity;
use integers::{InIntegers, Place};
use serde_json::{Value, json};
use told::{Cost, line};

use super::measurement::{self, motion};
use super::output::{Outputs, print, refuse_unwritable};
use super::progress::Reporter;
use crate::compile::cost;
use crate::compile::profile::Profile;
use crate::compile::steps::sequence::sequence;
use crate::compile::steps::{
    ANSWER_WORDS, Answer, CALL_WORDS, Call, LEAST_STEPS, StepDifference, compare as compare_steps, compare_answers,
};
use crate::compile::verify::{Comparison, compare, compare_exhaustively, sweep};
use crate::emulator::{Emulator, Firmware, Mode, Request};
use crate::error::{Error, Result, codes};
use crate::fit::predict::every_row;
use crate::fit::{HostModel, model};
use crate::recording;

/// Points at which the static law is compared besides the special values.
const SWEEP_POINTS: usize = 200_000;

/// Prove that the drive's arithmetic gives the very bits that the trainer expects.
#[derive(Args, Clone, Debug)]
pub struct Verify {
    /// Image to verify
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Compare the static law at all 2^32 single-precision numbers as well (models of one input, on the host)
    #[arg(long)]
    pub exhaustive: bool,
    /// Steps to compare, at least 100000: motions at every scale, reversals, dwells, missing samples, special values, resets, limits
    #[arg(long, value_name = "N", default_value_t = LEAST_STEPS as u64, value_parser = clap::value_parser!(u64).range(LEAST_STEPS as u64..=10_000_000))]
    pub steps: u64,
    /// Compare along a recording as well
    #[arg(long, value_name = "RECORDING")]
    pub recording: Option<PathBuf>,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Where to step: host, or emulated: cortex-m0plus, cortex-m33, cortex-m4f, cortex-m7, riscv32imac, riscv32imc
    #[arg(long, default_value = "host")]
    pub target: String,
    /// Also write the result as JSON; `-` for standard output
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    pub json: Option<PathBuf>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// What a verification found.
struct Found {
    steps: Comparison<StepDifference>,
    /// Of the static law apart; on the host alone, for on a target the steps go through it.
    law: Option<Comparison>,
    cost: Cost,
    /// Of an integer table, here or where there is no floating-point unit.
    in_integers: Option<InIntegers>,
}

/// Runs the command; the exit status is 0, or 1 where bits differ.
///
/// # Errors
/// `FRK-D020` for what is no image, `FRK-U001` for an exhaustive comparison of several inputs or on a target,
/// `FRK-U004` and `FRK-I004` to `FRK-I008` for targets that do not exist or cannot be emulated.
pub fn run(arguments: &Verify) -> Result<u8> {
    let read = [Some(&arguments.model), arguments.recording.as_ref(), arguments.joint.as_ref()];
    refuse_unwritable(&arguments.json, &read.into_iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let (bytes, image) = model::load(&arguments.model)?;
    let model = &image.model;
    let on_host = arguments.target == "host";
    if arguments.exhaustive && !(on_host && model.inputs.len() == 1) {
        let message = "an exhaustive comparison needs a model of one input, on the host";
        return Err(Error::new(&codes::USAGE, message).with_value(format!("{} inputs", model.inputs.len())));
    }
    let mut calls = match &arguments.recording {
        Some(path) => along(arguments, path, model)?,
        None => Vec::new(),
    };
    calls.extend(sequence(model, arguments.steps as usize));
    let reporter = Reporter::new(arguments.quiet);
    let found = if on_host {
        let law = if arguments.exhaustive {
            exhaustive(model, &reporter)
        } else {
            compare(model, &sweep(model, SWEEP_POINTS))
        };
        let ram_bytes = size_of_val(model) + size_of_val(&model.cells[..]) - size_of_val(&model.cells);
        let cost = Cost { flash_bytes: bytes.len() as u64, ram_bytes: ram_bytes as u64, ..Cost::default() };
        Found { steps: compare_steps(model, &calls), law: Some(law), cost, in_integers: None }
    } else {
        reporter.say("building the firmware and running it");
        emulated(arguments, &bytes, model, &calls)?
    };
    let place =
        if on_host { Place::Host { exhaustively: arguments.exhaustive } } else { Place::Target(&arguments.target) };
    let in_integers = if on_host || !has_floats(&arguments.target) {
        let drive = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?.drive;
        integers::compare(place, &bytes, model, &drive)?
    } else {
        None
    };
    let found = Found { in_integers, ..found };
    drop(reporter);
    let text = summary(arguments, &found);
    match &arguments.json {
        Some(path) => {
            let mut outputs = Outputs::default();
            outputs.add_json(path, as_json(arguments, &found));
            outputs.write()?;
            if path.as_os_str() != "-" {
                print(&text)?;
            }
        }
        None => print(&text)?,
    }
    Ok(u8::from(!found.identical()))
}

impl Found {
    fn identical(&self) -> bool {
        self.steps.identical()
            && self.law.is_none_or(|law| law.identical())
            && self.in_integers.as_ref().is_none_or(|found| found.steps.identical())
    }
}

/// Whether a target calculates with floats by itself.
fn has_floats(target: &str) -> bool {
    Profile::named(target).is_none_or(|profile| profile.has_floats)
}

/// A call for each sample of a recording, without limits.
fn along(arguments: &Verify, path: &std::path::Path, model: &HostModel) -> Result<Vec<Call>> {
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let recording = motion(recording::load(path, &joint)?, &joint)?.0;
    let samples = every_row(model, &recording).map_err(|error| error.in_file(recording.file()))?;
    let limits = [1.0, 2.0 * model.output_limit, f32::MAX];
    let mut calls = vec![Call { limits, ..Call::default() }; samples.len()];
    for (call, two) in calls.iter_mut().skip(1).zip(samples.time.windows(2)) {
        call.dt = (two[1] - two[0]) as f32;
    }
    let mut others = 0..MAX_INPUTS;
    for input in &model.inputs {
        let name = match &input.quantity {
            Quantity::Load if samples.input("load").is_none() => "rigid_body_torque",
            quantity => quantity.name(),
        };
        let other = if matches!(input.quantity, Quantity::Other(_)) { others.next() } else { None };
        for (call, value) in calls.iter_mut().zip(samples.require_input(name)?) {
            *channel(&mut call.measurement, &input.quantity, other.unwrap_or(0)) = *value as f32;
        }
    }
    Ok(calls)
}

/// The place of a quantity in a measurement; `other` is its number where it is no standard quantity.
fn channel<'a>(measurement: &'a mut Measurement, quantity: &Quantity, other: usize) -> &'a mut f32 {
    match quantity {
        Quantity::Velocity => &mut measurement.velocity,
        Quantity::Position => &mut measurement.position,
        Quantity::Acceleration => &mut measurement.acceleration,
        Quantity::Load => &mut measurement.load,
        Quantity::Temperature => &mut measurement.temperature,
        Quantity::Other(_) => &mut measurement.other[other],
    }
}

fn exhaustive(model: &HostModel, reporter: &Reporter) -> Comparison {
    let done = AtomicU64::new(0);
    let total = 1u64 << 32;
    compare_exhaustively(model, |chunk| {
        let compared = done.fetch_add(chunk, Ordering::Relaxed) + chunk;
        reporter.say(&format!("{compared} of {total} inputs compared"));
    })
}

/// Steps the compensator on the emulated target, counting, and compares its answers with the reference.
fn emulated(arguments: &Verify, image: &[u8], model: &HostModel, calls: &[Call]) -> Result<Found> {
    let emulator = Emulator::with_binary(&Firmware::find()?, &arguments.target, "emulate-step")?;
    let values: Vec<f32> = calls.iter().flat_map(Call::words).collect();
    let (inputs, outputs, mode) = (CALL_WORDS, ANSWER_WORDS, Mode::Count);
    let answer = emulator.run(&Request { image, values: &values, inputs, outputs, mode, floating_point_control: 0 })?;
    let (answers, _) = answer.outputs.as_chunks::<ANSWER_WORDS>();
    let steps = compare_answers(model, calls, answers.iter().copied().map(Answer::from_words));
    let cost = Cost::on_target(&answer, emulator.footprint()?, image);
    Ok(Found { steps, law: None, cost, in_integers: None })
}

fn summary(arguments: &Verify, Found { steps, law, cost, in_integers }: &Found) -> String {
    let mut text = format!("{} on {}: law, effects, memory and limits\n", line(steps, "steps"), arguments.target);
    if let Some(StepDifference { step, call, computed, expected }) = &steps.first_difference {
        let number = |bits| format!("{:?} ({bits:08x})", f32::from_bits(bits));
        text += &format!(
            "first difference at step {step}: torque {}, position {}, status {} where {}, {}, {} is expected\n{call:?}\n",
            number(computed.torque),
            number(computed.position),
            computed.status,
            number(expected.torque),
            number(expected.position),
            expected.status
        );
    }
    if let Some(law) = law {
        text += &format!("{}\n", line(law, "values of the static law"));
        if let Some(difference) = &law.first_difference {
            text += &format!(
                "first difference at {:?}: {:?} ({:08x}) where {:?} ({:08x}) is expected\n",
                difference.inputs,
                difference.runtime,
                difference.runtime.to_bits(),
                difference.reference,
                difference.reference.to_bits()
            );
        }
    }
    text += &cost.text("");
    match (in_integers, cost::integer_step(&arguments.target)) {
        (Some(found), _) => text + &found.text(),
        (None, Some(instructions)) => {
            let target = &arguments.target;
            text + &format!(
                "{target} has no floating-point unit: as a table of integers (`fit --target {target}`) {instructions} instructions a step\n"
            )
        }
        (None, None) => text,
    }
}

fn as_json(arguments: &Verify, Found { steps, law, cost, in_integers }: &Found) -> Value {
    let of_step = steps.first_difference.as_ref().map(|difference| {
        let answer =
            |Answer { torque, position, status }| json!({"torque": torque, "position": position, "status": status});
        json!({
            "step": difference.step,
            "call_bits": difference.call.words().map(f32::to_bits),
            "computed_bits": answer(difference.computed),
            "expected_bits": answer(difference.expected),
        })
    });
    let of_law = law.and_then(|law| law.first_difference).map(|difference| {
        json!({
            "inputs_bits": difference.inputs.map(f32::to_bits),
            "computed_bits": difference.runtime.to_bits(),
            "expected_bits": difference.reference.to_bits(),
        })
    });
    // What was asked for: the steps, or every value of the law.
    let (compared, equal) = match law {
        Some(law) if arguments.exhaustive => (law.compared, law.equal),
        _ => (steps.compared, steps.equal),
    };
    json!({
        "schema": "frikan.verify/1",
        "target": arguments.target,
        "compared": compared,
        "equal": equal,
        "first_difference": of_step.clone().or(of_law.clone()),
        "steps": steps.compared,
        "steps_equal": steps.equal,
        "law": law.map(|law| json!({"compared": law.compared, "equal": law.equal, "first_difference": of_law})),
        "instructions": cost.instructions_json(),
        "flash_bytes": cost.flash_bytes,
        "ram_bytes": cost.ram_bytes,
        "stack_bytes": cost.stack_bytes,
        "floating_point_unit": has_floats(&arguments.target),
        "integers": in_integers.as_ref().map(InIntegers::to_json),
    })
}
