//! Noise of a position from which the torque of a joint follows.

use crate::diagnose::measurement::signals::Signals;
use crate::samples::white_position_noise;

/// Noise of the position of a joint whose torque follows from it, beside the encoder's steps, as white noise, in its unit: none of a joint that records
/// its torque, whose noise does not go with that of the position.
pub(crate) fn commanded_noise(signals: &Signals) -> f64 {
    /// As many tell it to within a hundredth.
    const ROWS_OF_NOISE: usize = 16_384;
    let longest = signals.segments.iter().max_by_key(|segment| segment.len());
    let longest = longest.filter(|_| signals.commanded.is_some());
    longest.map_or(0.0, |rows| {
        let rows = rows.start..rows.end.min(rows.start + ROWS_OF_NOISE);
        white_position_noise(&signals.position[rows], signals.position_resolution)
    })
}
