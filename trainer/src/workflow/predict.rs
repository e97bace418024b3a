//! A recording with a model's prediction beside it.

use frikan_shared::units::Unit;

use super::columns::with_columns;
use super::recordings::{Source, Warning, motion};
use crate::error::Result;
use crate::fit::HostModel;
use crate::fit::predict::every_row;
use crate::joint::Joint;
use crate::recording::{Channel, Quantity, Recording};
use crate::samples::interpolate;

/// A recording with what a model predicts of it.
#[derive(Clone, Debug)]
pub struct Predicted {
    /// The recording's columns, then `predicted_<quantity>_<unit>` and, where the actuator is recorded, `residual_<unit>`; as CSV.
    pub csv: Vec<u8>,
    /// What the checks of the recording noticed.
    pub warnings: Vec<Warning>,
}

/// Predicts a recording, row by row.
///
/// # Errors
/// `FRK-D...` when the recording cannot be used or lacks what the model reads.
pub fn predict(model: &HostModel, recording: Source<'_>, joint: &Joint) -> Result<Predicted> {
    let recording = recording.read(joint)?;
    let (motion, warnings) = motion(recording.clone(), joint)?;
    let samples = every_row(model, &motion).map_err(|error| error.in_file(recording.file()))?;
    let prediction = crate::fit::predict::predict(model, &samples).map_err(|error| error.in_file(recording.file()))?;
    let predicted = at_rows(&recording, &motion, prediction.total());
    Ok(Predicted { csv: table(&recording, model, &predicted)?, warnings })
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
