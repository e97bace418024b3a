//! What a search works with, and what it may still find.

use crate::diagnose::evidence::measurement_noise::MeasurementNoise;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::thresholds::Settings;
use crate::physics::Hypothesis;

/// The search over one prepared recording.
pub struct Search<'a> {
    pub(crate) workbench: &'a Workbench<'a>,
    /// What more of the encoder's grain and of the torque's noise would change.
    pub(crate) measurement_noise: Option<&'a MeasurementNoise>,
    pub(crate) settings: Settings,
    /// What was found before and other rows did not bear out.
    pub(crate) refused: Vec<Label>,
}

impl Search<'_> {
    /// Whether a label may be found in the next round: once, except for effects that repeat with other shapes, and not what was refused.
    pub(crate) fn may_be_found(&self, label: &Label, accepted: &[Accepted]) -> bool {
        let repeats = match label {
            Label::Named(effect) => self.workbench.hypothesis(*effect).is_some_and(Hypothesis::repeats),
            Label::Generic(_) => false,
        };
        !self.refused.contains(label) && (repeats || accepted.iter().all(|found| found.label != *label))
    }
}
