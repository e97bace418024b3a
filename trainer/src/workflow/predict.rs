//! A recording with a model's prediction beside it.

use frikan_shared::units::Unit;

use super::columns::with_columns;
use super::recordings::{Warning, motion};
use super::source::Source;
use crate::actuator::Kind;
use crate::error::{Error, Result};
use crate::fit::HostModel;
use crate::fit::predict::every_row;
use crate::joint::Joint;
use crate::recording::{Axis, Channel, Quantity, Recording};
use crate::samples::interpolate;
use crate::servo::{Load, as_given, known_torque};

/// A recording with what a model predicts of it.
#[derive(Clone, Debug)]
pub struct Predicted {
    /// The recording's columns, then `predicted_<quantity>_<unit>` and, where the actuator is recorded, `residual_<unit>`; of a joint that reports no
    /// torque before them `actuator_<quantity>_<unit>`, what its actuator made of the commands. As CSV.
    pub csv: Vec<u8>,
    /// What the checks of the recording noticed.
    pub warnings: Vec<Warning>,
}

/// Predicts a recording, row by row. Of a joint that reports no torque `[actuator]` has to give every constant: the torque is then what the actuator makes
/// of its commands, and the load of the gear, as `fit` scores such a law.
///
/// # Errors
/// `FRK-D...` when the recording cannot be used or lacks what the model reads, `FRK-D014` for a constant of the actuator that is open.
pub fn predict(model: &HostModel, recording: Source<'_>, joint: &Joint) -> Result<Predicted> {
    let recording = recording.read(joint)?;
    let (motion, warnings) = motion(recording.clone(), joint)?;
    let in_file = |error: Error| error.in_file(recording.file());
    let csv = if joint.actuator.kind == Kind::Torque {
        let predicted = total(model, &motion).map_err(in_file)?;
        table(&recording, model, &at_rows(&recording, &motion, predicted))?
    } else {
        let identified = as_given(&motion, joint)?;
        let known = known_torque(&motion, joint, &identified, 0.0, Load::OfActuator)?;
        let own = total(model, &known).map_err(in_file)?;
        let whole = known.values(Quantity::LoadTorque).unwrap_or_default().to_vec();
        let bare = known.actuator().map(|channel| channel.values.as_slice()).unwrap_or_default();
        // What the payload takes is no part of the model.
        let predicted = own.iter().zip(&whole).zip(bare).map(|((own, whole), bare)| own + whole - bare).collect();
        let [whole, predicted] = [whole, predicted].map(|values| at_rows(&recording, &motion, values));
        let residual = whole.iter().zip(&predicted).map(|(whole, predicted)| whole - predicted).collect();
        let (quantity, unit) = if recording.axis == Axis::Rotary { ("torque", "Nm") } else { ("force", "N") };
        let added = [
            (format!("actuator_{quantity}_{unit}"), whole),
            (format!("predicted_{quantity}_{unit}"), predicted),
            (format!("residual_{unit}"), residual),
        ];
        with_columns(&recording, &added)?
    };
    Ok(Predicted { csv, warnings })
}

/// The whole torque that the model explains, at every row of a recording that was checked.
fn total(model: &HostModel, motion: &Recording) -> Result<Vec<f64>> {
    Ok(crate::fit::predict::predict(model, &every_row(model, motion)?)?.total())
}

/// The prediction at every row of the file: rows that the checks left out, since they repeat or hold others, lie between those.
fn at_rows(recording: &Recording, motion: &Recording, predicted: Vec<f64>) -> Vec<f64> {
    match (recording.values(Quantity::Time), motion.values(Quantity::Time)) {
        (Some(all), Some(used)) if all.len() > used.len() => interpolate(used, &predicted, all),
        _ => predicted,
    }
}

/// Quantity, unit and way from SI of the predicted column.
fn target<'a>(recording: &'a Recording, model: &HostModel) -> (String, String, f64, Option<&'a Channel>) {
    if let Some(channel) = recording.separated_friction().or_else(|| recording.actuator()) {
        return (channel.name.clone(), channel.column_unit.clone(), channel.si_per_column_unit, Some(channel));
    }
    let (quantity, unit) = match model.output_unit {
        Unit::Newton => ("force", "N"),
        Unit::Ampere => ("current", "A"),
        _ => ("torque", "Nm"),
    };
    (quantity.to_owned(), unit.to_owned(), 1.0, None)
}

fn table(recording: &Recording, model: &HostModel, predicted: &[f64]) -> Result<Vec<u8>> {
    let (quantity, unit, si_per_unit, measured) = target(recording, model);
    let mut added = vec![(format!("predicted_{quantity}_{unit}"), predicted.iter().map(|x| x / si_per_unit).collect())];
    if let Some(channel) = measured {
        let residual = channel.values.iter().zip(predicted).map(|(measured, x)| (measured - x) / si_per_unit);
        added.push((format!("residual_{unit}"), residual.collect()));
    }
    with_columns(recording, &added)
}
