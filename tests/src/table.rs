//! Tables that the command line writes.

use std::path::Path;

/// Columns of a table by their names, row by row.
///
/// # Panics
/// Where there is no such table or column, or a field is no number.
#[must_use]
pub fn columns<const N: usize>(path: &Path, names: [&str; N]) -> Vec<[f64; N]> {
    let mut table = csv::Reader::from_path(path).expect("a table");
    let header = table.headers().expect("a header").clone();
    let places = names.map(|name| header.iter().position(|column| column == name).expect("a column"));
    let row = |record: Result<csv::StringRecord, csv::Error>| {
        let record = record.expect("a whole row");
        places.map(|place| record[place].parse().expect("a number"))
    };
    table.records().map(row).collect()
}
