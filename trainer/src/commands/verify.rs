//! `trainer verify`: the runtime against the trainer's own evaluator, bit for bit, here or on an emulated target.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::Args;
use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::Quantity;
use serde_json::{Value, json};

use super::output::{Outputs, print};
use super::progress::Reporter;
use crate::compile::verify::{Comparison, Difference, compare, compare_exhaustively, sweep};
use crate::emulator::{Emulator, Mode, Request};
use crate::error::{Error, Result, codes};
use crate::fit::predict::every_row;
use crate::fit::{HostModel, model};
use crate::joint::Joint;
use crate::recording;

/// Points of the sweep besides the special values.
const SWEEP_POINTS: usize = 200_000;
/// Points whose instructions are counted on an emulated target.
const COUNTED_POINTS: usize = 2_000;

/// Prove that the drive's arithmetic gives the very bits that the trainer expects.
#[derive(Args, Clone, Debug)]
pub struct Verify {
    /// Image to verify
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Compare at all 2^32 single-precision numbers (models of one input, on the host)
    #[arg(long)]
    pub exhaustive: bool,
    /// Compare along a recording as well
    #[arg(long, value_name = "RECORDING")]
    pub recording: Option<PathBuf>,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Where to evaluate: host, or emulated: cortex-m0plus, cortex-m33, cortex-m4f, cortex-m7, riscv32imac, riscv32imc
    #[arg(long, default_value = "host")]
    pub target: String,
    /// Also write the result as JSON; `-` for standard output
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    pub json: Option<PathBuf>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// What a verification found beside the bits.
#[derive(Default)]
struct Cost {
    instructions: Option<(u32, u32)>,
    flash_bytes: u64,
    ram_bytes: u64,
    stack_bytes: u64,
}

/// Runs the command; the exit status is 0, or 1 where bits differ.
///
/// # Errors
/// `FRK-D020` for what is no image, `FRK-U001` for an exhaustive comparison of several inputs or on a target,
/// `FRK-U004` and `FRK-I004` to `FRK-I008` for targets that do not exist or cannot be emulated.
pub fn run(arguments: &Verify) -> Result<u8> {
    let (bytes, image) = model::load(&arguments.model)?;
    let model = &image.model;
    let on_host = arguments.target == "host";
    if arguments.exhaustive && !(on_host && model.inputs.len() == 1) {
        let message = "an exhaustive comparison needs a model of one input, on the host";
        return Err(Error::new(&codes::USAGE, message).with_value(format!("{} inputs", model.inputs.len())));
    }
    let mut points = sweep(model, SWEEP_POINTS);
    if let Some(path) = &arguments.recording {
        points.extend(along(arguments, path, model)?);
    }
    let reporter = Reporter::new(arguments.quiet);
    let (comparison, cost) = if on_host {
        let mut comparison = compare(model, &points);
        if arguments.exhaustive {
            comparison = exhaustive(model, &reporter);
        }
        let ram_bytes = size_of_val(model) + size_of_val(&model.cells[..]) - size_of_val(&model.cells);
        (comparison, Cost { flash_bytes: bytes.len() as u64, ram_bytes: ram_bytes as u64, ..Cost::default() })
    } else {
        reporter.say("building the firmware and running it");
        emulated(arguments, &bytes, model, &points)?
    };
    drop(reporter);
    let identical = comparison.identical();
    let text = summary(arguments, &comparison, &cost);
    match &arguments.json {
        Some(path) => {
            let mut outputs = Outputs::default();
            outputs.add(path, format!("{}\n", as_json(arguments, &comparison, &cost)));
            outputs.refuse_overwriting(&[arguments.model.as_path()])?;
            outputs.write()?;
            if path.as_os_str() != "-" {
                print(&text)?;
            }
        }
        None => print(&text)?,
    }
    Ok(u8::from(!identical))
}

/// Inputs of the model along a recording.
fn along(arguments: &Verify, path: &std::path::Path, model: &HostModel) -> Result<Vec<[f32; MAX_INPUTS]>> {
    let joint = arguments.joint.as_deref().map(Joint::load).transpose()?.unwrap_or_default();
    let recording = recording::load(path, &joint)?;
    let samples = every_row(model, &recording).map_err(|error| error.in_file(recording.file()))?;
    let mut points = vec![[0.0; MAX_INPUTS]; samples.len()];
    for (slot, input) in model.inputs.iter().enumerate() {
        let name = match &input.quantity {
            Quantity::Load if samples.input("load").is_none() => "rigid_body_torque",
            quantity => quantity.name(),
        };
        for (point, value) in points.iter_mut().zip(samples.require_input(name)?) {
            point[slot] = *value as f32;
        }
    }
    Ok(points)
}

fn exhaustive(model: &HostModel, reporter: &Reporter) -> Comparison {
    let done = AtomicU64::new(0);
    let total = 1u64 << 32;
    compare_exhaustively(model, |chunk| {
        let compared = done.fetch_add(chunk, Ordering::Relaxed) + chunk;
        reporter.say(&format!("{compared} of {total} inputs compared"));
    })
}

/// Evaluates on the emulated target and compares with the runtime on this host.
fn emulated(
    arguments: &Verify,
    image: &[u8],
    model: &HostModel,
    points: &[[f32; MAX_INPUTS]],
) -> Result<(Comparison, Cost)> {
    let emulator = Emulator::new(&arguments.target)?;
    let inputs = model.inputs.len();
    let run = |points: &[[f32; MAX_INPUTS]], mode| {
        let values: Vec<f32> = points.iter().flat_map(|point| point[..inputs].iter().copied()).collect();
        emulator.run(&Request { image, values: &values, inputs, mode, floating_point_control: 0 })
    };
    let answer = run(points, Mode::Evaluate)?;
    let mut comparison = Comparison { compared: 0, equal: 0, first_difference: None };
    for (point, output) in points.iter().zip(&answer.outputs) {
        let expected = evaluate(model, point);
        let equal = expected.to_bits() == output.to_bits();
        comparison = comparison.then(Comparison {
            compared: 1,
            equal: u64::from(equal),
            first_difference: (!equal).then_some(Difference { inputs: *point, runtime: *output, reference: expected }),
        });
    }
    let stride = points.len().div_ceil(COUNTED_POINTS).max(1);
    let some: Vec<[f32; MAX_INPUTS]> = points.iter().step_by(stride).copied().collect();
    let counted = run(&some, Mode::Count)?;
    let footprint = emulator.footprint()?;
    let cost = Cost {
        instructions: counted.instruction_range(),
        flash_bytes: footprint.flash_bytes + image.len() as u64,
        ram_bytes: footprint.ram_bytes,
        stack_bytes: u64::from(counted.evaluate_stack_bytes),
    };
    Ok((comparison, cost))
}

fn summary(arguments: &Verify, comparison: &Comparison, cost: &Cost) -> String {
    let mut text = format!("{} of {} equal on {}\n", comparison.equal, comparison.compared, arguments.target);
    if let Some(difference) = &comparison.first_difference {
        text += &format!(
            "first difference at {:?}: {:?} ({:08x}) where {:?} ({:08x}) is expected\n",
            difference.inputs,
            difference.runtime,
            difference.runtime.to_bits(),
            difference.reference,
            difference.reference.to_bits()
        );
    }
    if let Some((least, most)) = cost.instructions {
        text += &format!("{least} to {most} instructions an evaluation, {} bytes of stack\n", cost.stack_bytes);
    }
    text + &format!("{} bytes of flash, {} bytes of RAM\n", cost.flash_bytes, cost.ram_bytes)
}

fn as_json(arguments: &Verify, comparison: &Comparison, cost: &Cost) -> Value {
    let difference = comparison.first_difference.as_ref().map(|difference| {
        json!({
            "inputs_bits": difference.inputs.map(f32::to_bits),
            "computed_bits": difference.runtime.to_bits(),
            "expected_bits": difference.reference.to_bits(),
        })
    });
    json!({
        "schema": "frikan.verify/1",
        "target": arguments.target,
        "compared": comparison.compared,
        "equal": comparison.equal,
        "first_difference": difference,
        "instructions": cost.instructions.map(|(min, max)| json!({"min": min, "max": max})),
        "flash_bytes": cost.flash_bytes,
        "ram_bytes": cost.ram_bytes,
        "stack_bytes": cost.stack_bytes,
    })
}
