//! Of each effect that was not found, the torque at which it would have been.

use crate::diagnose::answer::outcome::DetectionLimit;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::proof::discarded::negligible_torque;
use crate::diagnose::proof::refit::Refit;
use crate::diagnose::search::scored::Scored;
use crate::diagnose::search::thresholds::OTHER_ROWS_ERROR_RATIO;

/// Non-centrality (squared signal-to-noise ratio, dimensionless) that is found with a probability of 90 %: in
/// `docs/detection-curve.md` 73 of 79 effects between 30 and 50 are. Larger states a larger limit.
const NONCENTRALITY_AT_90_PERCENT_POWER: f64 = 40.0;

/// Torque of each effect in the last table of scores at which it would have been found nine times in ten.
pub(crate) fn detection_limits(workbench: &Workbench, table: &[Scored], refit: &Refit) -> Vec<DetectionLimit> {
    let bench = workbench.bench(workbench.base.columns.clone(), &refit.noise);
    let least = negligible_torque(workbench).max(OTHER_ROWS_ERROR_RATIO * workbench.base.formula_error);
    table
        .iter()
        .filter_map(|scored| {
            let Label::Named(effect) = scored.label else { return None };
            let columns = workbench.filtered_columns(&scored.label, &scored.shape);
            let first = columns.first()?;
            // The statistic of the column itself as target: its non-centrality per squared amplitude.
            let white = workbench.whitened(&columns[..1], &refit.noise);
            let visible = bench.visible_energy(&white[0])?;
            let amplitude = (NONCENTRALITY_AT_90_PERCENT_POWER / visible).sqrt();
            let rms = (first.iter().map(|v| v * v).sum::<f64>() / first.len() as f64).sqrt();
            Some(DetectionLimit { effect, torque_rms: (amplitude * rms).max(least) })
        })
        .filter(|limit| limit.torque_rms.is_finite())
        .collect()
}
