//! A recording with columns beside its own.

use crate::error::{Error, Result, codes};
use crate::recording::Recording;

/// The recording as CSV with `added` columns of as many values as it has rows; own columns of the same names make room.
///
/// # Errors
/// `FRK-I001` where a row cannot be written.
pub(crate) fn with_columns(recording: &Recording, added: &[(String, Vec<f64>)]) -> Result<Vec<u8>> {
    let own = recording.table.header();
    let kept: Vec<usize> = (0..own.len()).filter(|&i| added.iter().all(|(name, _)| *name != own[i])).collect();
    let names = kept.iter().map(|&i| &own[i]).chain(added.iter().map(|(name, _)| name));
    let failed = |error: csv::Error| Error::new(&codes::INPUT_OUTPUT, error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(names).map_err(failed)?;
    for row in 0..recording.len() {
        let fields: Vec<&str> = recording.table.row(row).collect();
        let own = kept.iter().map(|&i| fields[i].to_owned());
        // Nine significant digits, as a recording's own numbers.
        let new = added.iter().map(|(_, values)| crate::law::significant(values[row], 9));
        writer.write_record(own.chain(new)).map_err(failed)?;
    }
    writer.into_inner().map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))
}
