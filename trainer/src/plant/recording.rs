//! What a simulated drive hands over, and the truth behind it.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A simulated recording: columns as a drive would log them, and the truth that only a simulator knows.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedRecording {
    /// Columns in the order of the file, all of one length.
    pub columns: Vec<Column>,
    /// What nobody but the proof may look at.
    pub truth: Truth,
}

/// One column, named `<quantity>_<unit>`.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name as in the header of the CSV.
    pub name: &'static str,
    /// Values, one a sample.
    pub values: Vec<f64>,
}

/// The truth behind a recording, one value a sample; torques act over the sample that begins at the row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// Everything the nominal law leaves out, joint side, N m: recorded torque minus noise minus the nominal law.
    pub effect_torque: Vec<f64>,
    /// Noise in the torque column, N m.
    pub noise_torque: Vec<f64>,
    /// Root mean square of `noise_torque`, N m.
    pub noise_rms: f64,
    /// True motor-side position at the sample instant, rad.
    pub position: Vec<f64>,
    /// True velocity at the sample instant, rad/s.
    pub velocity: Vec<f64>,
    /// Mean true acceleration over the sample, rad/s2.
    pub acceleration: Vec<f64>,
    /// Name of every drawn parameter (`effect.parameter_unit`) and its value, before the amplitude multiplies.
    pub parameters: Vec<(String, f64)>,
}

impl SimulatedRecording {
    /// Values of a column, if it was recorded.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.name == name).map(|column| column.values.as_slice())
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Whether nothing was recorded.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One recording a trajectory, in order; the drawn parameters go with each.
    pub fn split(&self) -> Vec<Self> {
        let Some(labels) = self.column("trajectory") else { return vec![self.clone()] };
        let mut parts = Vec::new();
        let mut start = 0;
        for end in 1..=labels.len() {
            if end == labels.len() || labels[end] != labels[start] {
                parts.push(self.part(start..end));
                start = end;
            }
        }
        parts
    }

    fn part(&self, range: std::ops::Range<usize>) -> Self {
        let columns = self
            .columns
            .iter()
            .map(|column| Column { name: column.name, values: column.values[range.clone()].to_vec() })
            .collect();
        let truth = &self.truth;
        let cut = |values: &[f64]| values[range.clone()].to_vec();
        let mut truth = Truth {
            effect_torque: cut(&truth.effect_torque),
            noise_torque: cut(&truth.noise_torque),
            noise_rms: 0.0,
            position: cut(&truth.position),
            velocity: cut(&truth.velocity),
            acceleration: cut(&truth.acceleration),
            parameters: truth.parameters.clone(),
        };
        truth.noise_rms = root_mean_square(&truth.noise_torque);
        Self { columns, truth }
    }

    /// Writes the columns as CSV; numbers are the shortest that read back exactly.
    ///
    /// # Errors
    /// Whatever the writer reports.
    pub fn write_csv(&self, mut writer: impl Write) -> io::Result<()> {
        let names: Vec<&str> = self.columns.iter().map(|column| column.name).collect();
        writeln!(writer, "{}", names.join(","))?;
        for row in 0..self.len() {
            for (i, column) in self.columns.iter().enumerate() {
                let separator = if i == 0 { "" } else { "," };
                write!(writer, "{separator}{}", column.values[row])?;
            }
            writeln!(writer)?;
        }
        writer.flush()
    }

    /// Writes the CSV whole or not at all: into a new file beside it that is renamed at the end.
    ///
    /// # Errors
    /// What the file system reports; then nothing is left behind.
    pub fn save_csv(&self, path: &Path) -> io::Result<()> {
        let name = path.file_name().ok_or_else(|| io::Error::other("not a file name"))?;
        let mut temporary_name = std::ffi::OsString::from(".");
        temporary_name.push(name);
        temporary_name.push(format!(".{}.partial", std::process::id()));
        let temporary = path.with_file_name(temporary_name);
        let written = File::create(&temporary)
            .and_then(|file| {
                let mut writer = BufWriter::new(file);
                self.write_csv(&mut writer)?;
                writer.into_inner()?.sync_all()
            })
            .and_then(|()| std::fs::rename(&temporary, path));
        if written.is_err() {
            // Nothing more can be done about a file that cannot be removed either.
            let _ = std::fs::remove_file(&temporary);
        }
        written
    }
}

/// Root mean square; 0 for no values.
pub(crate) fn root_mean_square(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}
