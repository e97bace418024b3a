//! `trainer predict`: a recording with the model's prediction beside it.

use std::path::PathBuf;

use clap::Args;

use super::measurement::{self, motion};
use super::output::Outputs;
use crate::error::{Error, Result, codes};
use crate::fit::predict::{every_row, predict};
use crate::fit::{HostModel, model};
use crate::recording::{self, Channel, Quantity, Recording};
use crate::samples::interpolate;
use frikan_shared::units::Unit;

/// Copy a recording and add what the model predicts, `predicted_<quantity>_<unit>` and `residual_<unit>`.
#[derive(Args, Clone, Debug)]
pub struct Predict {
    /// Image that predicts
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Recording to predict
    #[arg(value_name = "RECORDING")]
    pub recording: PathBuf,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Recording to write
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: PathBuf,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// `FRK-D...` when image or recording cannot be used or lack what the model reads; nothing is written then.
pub fn run(arguments: &Predict) -> Result<()> {
    let (_, image) = model::load(&arguments.model)?;
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let recording = recording::load(&arguments.recording, &joint)?;
    let (motion, warnings) = motion(recording.clone(), &joint)?;
    let samples = every_row(&image.model, &motion).map_err(|error| error.in_file(recording.file()))?;
    let prediction = predict(&image.model, &samples).map_err(|error| error.in_file(recording.file()))?;
    let predicted = at_rows(&recording, &motion, prediction.total());
    let mut outputs = Outputs::default();
    outputs.add(&arguments.output, table(&recording, &image.model, &predicted)?);
    outputs.refuse_overwriting(&[arguments.model.as_path(), arguments.recording.as_path()])?;
    outputs.write()?;
    if !arguments.quiet {
        warnings.iter().for_each(|warning| eprintln!("{warning}"));
    }
    Ok(())
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
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = recording.table.header().to_vec();
    let (predicted_name, residual_name) = (format!("predicted_{quantity}_{unit}"), format!("residual_{unit}"));
    // A recording that was predicted before gets fresh columns in place of the old ones.
    let kept: Vec<usize> =
        (0..header.len()).filter(|&i| header[i] != predicted_name && header[i] != residual_name).collect();
    header = kept.iter().map(|&i| header[i].clone()).collect();
    header.push(predicted_name);
    header.extend(measured.map(|_| residual_name));
    let failed = |error: csv::Error| Error::new(&codes::INPUT_OUTPUT, error.to_string());
    writer.write_record(&header).map_err(failed)?;
    for (row, value) in predicted.iter().enumerate() {
        let fields: Vec<&str> = recording.table.row(row).collect();
        let mut record: Vec<String> = kept.iter().map(|&i| fields[i].to_owned()).collect();
        record.push(number(value / si_per_unit));
        record.extend(measured.map(|channel| number((channel.values[row] - value) / si_per_unit)));
        writer.write_record(&record).map_err(failed)?;
    }
    writer.into_inner().map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))
}

/// Nine significant digits, as a recording's own numbers.
fn number(value: f64) -> String {
    crate::law::significant(value, 9)
}
