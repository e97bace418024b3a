//! What a simulated drive hands over, and the truth behind it.

use crate::csv_text::csv_text;

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

impl Truth {
    /// Root mean square of `effect_torque`, N m.
    pub fn effect_rms(&self) -> f64 {
        root_mean_square(&self.effect_torque)
    }

    /// Root mean square of the moving average of `effect_torque` over `samples` (>= 1), N m: the part a filter of that
    /// length leaves. A compliant gear rings after every reversal far above the band in which it can be recognised.
    pub fn effect_rms_over(&self, samples: usize) -> f64 {
        let averages: Vec<f64> =
            self.effect_torque.windows(samples.max(1)).map(|w| w.iter().sum::<f64>() / w.len() as f64).collect();
        root_mean_square(&averages)
    }
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

    /// The samples of a range (within the recording) as a recording of their own; the drawn parameters go with it.
    pub fn part(&self, range: std::ops::Range<usize>) -> Self {
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

    /// The columns as CSV text; numbers are the shortest that read back exactly.
    pub fn to_csv(&self) -> String {
        csv(&self.columns)
    }

    /// The truth as CSV text, row by row beside [`to_csv`](Self::to_csv).
    pub fn truth_to_csv(&self) -> String {
        let truth = &self.truth;
        let column = |name, values: &[f64]| Column { name, values: values.to_vec() };
        csv(&[
            column("time_s", self.column("time_s").unwrap_or_default()),
            column("true_position_rad", &truth.position),
            column("true_velocity_rad_s", &truth.velocity),
            column("true_acceleration_rad_s2", &truth.acceleration),
            column("effect_torque_Nm", &truth.effect_torque),
            column("noise_torque_Nm", &truth.noise_torque),
        ])
    }
}

fn csv(columns: &[Column]) -> String {
    let named: Vec<_> = columns.iter().map(|column| (column.name.to_owned(), &column.values[..])).collect();
    csv_text(&named)
}

/// Root mean square; 0 for no values.
pub(crate) fn root_mean_square(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}
