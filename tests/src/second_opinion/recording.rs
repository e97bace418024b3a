//! Recordings as files, and what a case hands to the diagnosis.

use std::fmt::Write;

/// Columns of one length with their names.
#[derive(Clone, Debug, Default)]
pub struct Recording(Vec<(String, Vec<f64>)>);

impl Recording {
    /// Adds a column, or replaces the one of that name.
    pub fn put(&mut self, name: impl Into<String>, values: Vec<f64>) {
        let name = name.into();
        match self.0.iter_mut().find(|(existing, _)| *existing == name) {
            Some((_, existing)) => *existing = values,
            None => self.0.push((name, values)),
        }
    }

    /// Multiplies the column of that name.
    pub fn scale(&mut self, name: &str, factor: f64) {
        let column = self.0.iter_mut().filter(|(existing, _)| existing == name);
        column.for_each(|(_, values)| values.iter_mut().for_each(|value| *value *= factor));
    }

    /// Names of the columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }

    /// Comma-separated values of nine digits with a header.
    #[must_use]
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.names().collect();
        let mut text = names.join(",");
        text.push('\n');
        let rows = self.0.first().map_or(0, |(_, values)| values.len());
        for row in 0..rows {
            for (index, (_, values)) in self.0.iter().enumerate() {
                let comma = if index > 0 { "," } else { "" };
                // Writing to a string cannot fail.
                let _ = write!(text, "{comma}{:.8e}", values[row]);
            }
            text.push('\n');
        }
        text
    }
}

/// What the recording is compared with.
#[derive(Clone, Debug)]
pub enum Compared {
    /// The best static law of itself.
    Itself,
    /// A simulation of the joint.
    Simulation(Recording),
    /// A model fitted to another recording of the joint.
    Model(Recording),
}

/// Everything that the diagnosis of a case is given, and what the page says of it.
#[derive(Clone, Debug)]
pub struct Material {
    /// The recording to diagnose.
    pub real: Recording,
    /// `joint.toml`, where the case has one.
    pub joint: Option<String>,
    /// What it is compared with.
    pub compared: Compared,
    /// What is hidden and how it was recorded.
    pub description: String,
}
