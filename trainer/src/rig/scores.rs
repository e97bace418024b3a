//! What a run is worth.

use frikan_runtime::supervised::adaptation::Correction;

use super::drive::Answer;
use crate::numerics::statistics::root_mean_square;

/// One sample of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Start of the sample, s.
    pub time: f64,
    /// Position, rad, and velocity, rad/s, of the joint.
    pub position: f64,
    /// See `position`.
    pub velocity: f64,
    /// Position, rad, and velocity, rad/s, of the reference; NaN without a position loop.
    pub reference: [f32; 2],
    /// Temperature of the housing, degC.
    pub temperature: f64,
    /// What the drive answered.
    pub answer: Answer,
    /// What became of it in an actuator that reports no torque; none of a drive that puts out the torque itself.
    pub fed: Option<Fed>,
}

/// A sample of an actuator that reports no torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fed {
    /// Torque over the sample, N m.
    pub torque: f64,
    /// What it is told at the start of the sample: torque to add, N m, current, A, duty, voltage, V, or position reference, rad.
    pub told: f64,
    /// What of that compensates friction, in the same unit.
    pub feed_forward: f64,
}

impl Row {
    /// Torque of the motor, N m: that of the drive's answer, or of the actuator over the sample.
    #[must_use]
    pub fn torque(&self) -> f64 {
        self.fed.map_or(f64::from(self.answer.torque), |fed| fed.torque)
    }
}

/// All numbers of a run as bytes, for its checksum.
#[must_use]
pub fn trace_bytes(rows: &[Row]) -> Vec<u8> {
    let bytes = |row: &Row| {
        let joint = [row.position, row.velocity].map(f64::to_le_bytes).concat();
        let Answer { torque, velocity, compensation, gain_share, correction, status } = row.answer;
        let Correction { level, viscous, offset } = correction;
        let numbers = [torque, velocity, compensation, gain_share, level, viscous, offset];
        let drive = numbers.map(f32::to_le_bytes).concat();
        let fed = row
            .fed
            .map_or_else(Vec::new, |fed| [fed.torque, fed.told, fed.feed_forward].map(f64::to_le_bytes).concat());
        [joint, drive, status.to_le_bytes().to_vec(), fed].concat()
    };
    rows.iter().flat_map(bytes).collect()
}

/// Scores of a run, over all of it but the first second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scores {
    /// Root mean square of reference less position, rad.
    pub rms_error: f64,
    /// Largest magnitude of it, rad.
    pub peak_error: f64,
    /// Largest range of the position in a stretch where the reference has stood still for half a second, rad.
    pub hold_peak_to_peak: f64,
    /// Root mean square of the torque, N m.
    pub torque_rms: f64,
    /// Speed at the end, rad/s.
    pub final_speed: f64,
    /// Growth of the speed after the nudge: the largest speed less that at its end, rad/s; 0 where there is no nudge.
    pub speed_gain_after_nudge: f64,
    /// Largest speed after the end of the nudge, rad/s.
    pub max_speed_after_nudge: f64,
}

/// What the loop is given to settle, s.
const SETTLING_S: f64 = 1.0;
/// How long a reference has to have stood still, s.
const STILL_S: f64 = 0.5;

impl Scores {
    /// Scores of `rows`; the joint was let go at `nudge_end`, s.
    #[must_use]
    pub fn of(rows: &[Row], nudge_end: Option<f64>) -> Self {
        let settled = rows.iter().filter(|row| row.time >= SETTLING_S);
        let errors = settled.map(|row| f64::from(row.reference[0]) - row.position);
        let errors: Vec<f64> = errors.filter(|error| error.is_finite()).collect();
        let torques: Vec<f64> = rows.iter().map(Row::torque).collect();
        let let_go: Vec<f64> = nudge_end
            .map(|end| rows.iter().filter(|row| row.time >= end).map(|row| row.velocity.abs()).collect())
            .unwrap_or_default();
        let largest = let_go.iter().copied().fold(0.0, f64::max);
        Self {
            rms_error: root_mean_square(&errors),
            peak_error: errors.iter().map(|error| error.abs()).fold(0.0, f64::max),
            hold_peak_to_peak: hold_peak_to_peak(rows),
            torque_rms: root_mean_square(&torques),
            final_speed: rows.last().map_or(0.0, |row| row.velocity.abs()),
            speed_gain_after_nudge: largest - let_go.first().copied().unwrap_or(0.0),
            max_speed_after_nudge: largest,
        }
    }
}

fn hold_peak_to_peak(rows: &[Row]) -> f64 {
    let mut still_since: Option<f64> = None;
    let (mut low, mut high, mut largest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    for row in rows {
        if row.reference[1] != 0.0 {
            still_since = None;
            (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            continue;
        }
        if row.time - *still_since.get_or_insert(row.time) >= STILL_S {
            (low, high) = (low.min(row.position), high.max(row.position));
            largest = largest.max(high - low);
        }
    }
    largest
}
