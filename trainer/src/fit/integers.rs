//! The law that was chosen as a table of integers, for a drive without floating-point unit.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::{Law, MAX_INPUTS};
use frikan_shared::pool::Pool;
use frikan_shared::units::Quantity;

use super::integer_summary::IntegerSummary;
use super::model::HostModel;
use super::options::Options;
use crate::compile::cost::{float_step, integer_step};
use crate::compile::integers::{IntegerError, Wanted, compile_integers};
use crate::error::{Error, Result, codes};
use crate::joint::Drive;

/// By this share of what the law leaves of the recordings the table may differ from it, as the tables of networks may.
const SHARE_OF_RESIDUAL: f64 = 0.03;
/// The same of the largest friction, where the law leaves nothing.
const SHARE_OF_RANGE: f64 = 1.0e-5;

/// The options of a fit whose law becomes a table of integers where that is asked for: it reads the velocity alone.
///
/// # Errors
/// `FRK-U001` where other inputs are asked for.
pub(super) fn of_velocity(options: &Options) -> Result<Options> {
    let velocity = vec![Quantity::Velocity.name().to_owned()];
    match &options.inputs {
        Some(inputs) if options.integers && *inputs != velocity => {
            let message = format!(
                "{} has no floating-point unit: its table of integers reads the velocity alone",
                options.budget.target.name
            );
            Err(Error::new(&codes::USAGE, message).with_value(inputs.join(",")))
        }
        None if options.integers => Ok(Options { inputs: Some(velocity), ..options.clone() }),
        _ => Ok(options.clone()),
    }
}

/// The model that goes into the image: in integers where that is asked for, within the budget, with what is to be told of them. `rmse` is what the law leaves of the
/// recordings.
///
/// # Errors
/// `FRK-U001` where the counts of the drive do not fit the law, or its cells do not suffice.
pub(super) fn shipped(
    model: Box<HostModel>,
    drive: &Drive,
    options: &Options,
    rmse: f64,
) -> Result<(Box<HostModel>, Option<IntegerSummary>)> {
    let (true, [velocity]) = (options.integers, &model.inputs[..]) else { return Ok((model, None)) };
    let target = options.budget.target.name;
    let range = [velocity.low, velocity.high].map(f64::from);
    let law = |velocity: f64| {
        let mut inputs = [0.0; MAX_INPUTS];
        inputs[0] = velocity as f32;
        f64::from(evaluate(&model, &inputs))
    };
    let largest = range.map(|end| law(end).abs()).into_iter().fold(0.0, f64::max);
    let wanted = Wanted {
        range,
        velocity_count: drive.velocity_count_rad_s,
        torque_count: drive.torque_count_nm,
        bound: (SHARE_OF_RESIDUAL * rmse).max(SHARE_OF_RANGE * largest).max(f64::MIN_POSITIVE),
        cells: options.budget.cells(),
    };
    let made = compile_integers(&law, &wanted).map_err(|error| refused(&error, target))?;
    let summary = IntegerSummary {
        target,
        cells: made.cells.len(),
        counts: made.units,
        error: made.error,
        instructions: integer_step(target),
        in_floats: float_step(target, &model.law),
    };
    let cells =
        Pool::from_slice(&made.cells).map_err(|_| refused(&IntegerError::Cells { cells: wanted.cells }, target))?;
    Ok((Box::new(HostModel { law: Law::IntegerTable(made.table), cells, ..*model }), Some(summary)))
}

fn refused(error: &IntegerError, target: &str) -> Error {
    let key = match error {
        IntegerError::VelocityCount { .. } => ": `[drive] velocity_count_rad_s` of the joint file",
        IntegerError::TorqueCount { .. } => ": `[drive] torque_count_Nm` of the joint file",
        IntegerError::Cells { .. } | IntegerError::Range { .. } => "",
    };
    Error::new(&codes::USAGE, format!("the law does not become a table of integers for {target}: {error}{key}"))
}
