//! An integer table in the counts of a drive: the integer compensator against its reference.

use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, Units};
use serde_json::{Value, json};

use super::told::{Cost, line};
use crate::commands::measurement::table_in_counts;
use crate::compile::integers::steps::{
    INTEGER_CALL_WORDS, IntegerDifference, compare_integer_answers, integer_calls, integer_step,
};
use crate::compile::verify::Comparison;
use crate::emulator::{Emulator, Firmware, Mode, Request, footprint};
use crate::error::Result;
use crate::fit::HostModel;
use crate::joint::Drive;

/// Counts that are compared at most, evenly spread where there are more: here, all that there can be, and on a target.
const COUNTS: usize = 1 << 20;
const ALL_COUNTS: usize = 1 << 24;
const COUNTS_ON_TARGET: usize = 1 << 17;

/// Where the step runs.
#[derive(Clone, Copy)]
pub(super) enum Place<'a> {
    /// Here; at every count that there is.
    Host {
        /// Every count, whatever time it takes.
        exhaustively: bool,
    },
    /// On an emulated target.
    Target(&'a str),
}

/// What a comparison of the integer compensator found.
pub(super) struct InIntegers {
    units: Units,
    pub(super) steps: Comparison<IntegerDifference>,
    cost: Cost,
}

/// Compares the integer compensator with its reference; none where the law is no integer table.
///
/// # Errors
/// `FRK-U001` where the image is for other counts than those of the joint file; those of the emulator.
pub(super) fn compare(place: Place<'_>, image: &[u8], model: &HostModel, drive: &Drive) -> Result<Option<InIntegers>> {
    let Some((units, table)) = table_in_counts(image, model, drive)? else { return Ok(None) };
    let counts = match place {
        Place::Host { exhaustively: true } => ALL_COUNTS,
        Place::Host { exhaustively: false } => COUNTS,
        Place::Target(_) => COUNTS_ON_TARGET,
    };
    let Some(calls) = integer_calls(model, units, counts) else { return Ok(None) };
    let (answers, cost) = match place {
        Place::Host { .. } => {
            let mut compensator = IntegerCompensator::new(Ok(table), IntegerLimits::OFF);
            let answers: Vec<i32> = calls.iter().map(|call| integer_step(&mut compensator, call)).collect();
            let (flash_bytes, ram_bytes) = (image.len() as u64, size_of_val(&compensator) as u64);
            (answers, Cost { flash_bytes, ram_bytes, ..Cost::default() })
        }
        Place::Target(target) => {
            let firmware = Firmware::find()?.with_features("integer");
            let emulator = Emulator::with_binary(&firmware, target, "emulate-integer-step")?;
            let values: Vec<f32> = calls.iter().flat_map(|call| call.words(units)).collect();
            let (inputs, outputs, mode) = (INTEGER_CALL_WORDS, 1, Mode::Count);
            let request = Request { image, values: &values, inputs, outputs, mode, floating_point_control: 0 };
            let answer = emulator.run(&request)?;
            let drive = footprint(&firmware.build(emulator.target(), "drive-integer")?)?;
            let drive = drive.beyond(footprint(&firmware.build(emulator.target(), "bare")?)?);
            let cost = Cost::on_target(&answer, drive, image);
            (answer.outputs.iter().map(|output| output.to_bits().cast_signed()).collect(), cost)
        }
    };
    let steps = compare_integer_answers(model, units, &calls, answers);
    Ok(steps.map(|steps| InIntegers { units, steps, cost }))
}

impl InIntegers {
    /// For a reader.
    pub(super) fn text(&self) -> String {
        let Self { units: Units { velocity, torque }, steps, cost } = self;
        let what = format!("steps in counts of {velocity:?} and {torque:?}");
        let mut text = format!("{}\n", line(steps, &what));
        if let Some(IntegerDifference { step, call, computed, expected }) = &steps.first_difference {
            text += &format!("first difference at step {step}: {computed} where {expected} is expected\n{call:?}\n");
        }
        text + &cost.text("in integers ")
    }

    /// For `--json`.
    pub(super) fn to_json(&self) -> Value {
        let Self { units, steps, cost } = self;
        let difference = steps.first_difference.as_ref().map(|difference| {
            let IntegerDifference { step, call, computed, expected } = difference;
            json!({"step": step, "velocity": call.velocity, "limits": call.limits, "computed": computed, "expected": expected})
        });
        json!({
            "velocity_count": f64::from(units.velocity),
            "torque_count": f64::from(units.torque),
            "steps": steps.compared,
            "steps_equal": steps.equal,
            "first_difference": difference,
            "instructions": cost.instructions_json(),
            "flash_bytes": cost.flash_bytes,
            "ram_bytes": cost.ram_bytes,
            "stack_bytes": cost.stack_bytes,
        })
    }
}
