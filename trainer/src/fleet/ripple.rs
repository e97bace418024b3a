//! The strongest wave over position that a model leaves in a recording.

/// Fewest periods over the travel: a wave of fewer is gravity, or friction that depends on the position.
const LEAST_PERIODS: f64 = 3.0;
/// Most periods over the travel.
const MOST_PERIODS: f64 = 60.0;
/// Step between two waves that are tried, periods over the travel: one between two steps keeps nine tenths of its amplitude.
const STEP_PERIODS: f64 = 0.5;

/// Most rows that are read; recordings with more are thinned evenly.
const MOST_ROWS: usize = 20_000;

/// Speed over the top speed above which a row counts as motion.
const MOVING_SHARE: f64 = 0.05;

/// Rows of a recording in which waves are looked for; all lists have one length.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// Position, rad or m.
    pub position: &'a [f64],
    /// Velocity, rad/s or m/s.
    pub velocity: &'a [f64],
    /// Recorded less predicted actuator.
    pub residual: &'a [f64],
}

/// A wave over position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Amplitude in the unit of the residual.
    pub amplitude: f64,
    /// Radians of its phase per unit of position: periods a turn on a rotary joint.
    pub order: f64,
}

/// The wave with the largest amplitude, of a torque or of a friction (which turns with the direction); `None` where the joint hardly
/// moves or the lists differ in length.
#[must_use]
pub fn ripple(rows: &Rows<'_>) -> Option<Ripple> {
    let top = crate::samples::top_speed(rows.velocity);
    if rows.position.len() != rows.residual.len() || rows.velocity.len() != rows.residual.len() || top <= 0.0 {
        return None;
    }
    let stride = rows.residual.len().div_ceil(MOST_ROWS).max(1);
    let moving = (0..rows.residual.len()).step_by(stride).filter(|&row| rows.velocity[row].abs() > MOVING_SHARE * top);
    let moving: Vec<usize> = moving.collect();
    let positions = || moving.iter().map(|&row| rows.position[row]);
    let (lowest, highest) = (positions().fold(f64::INFINITY, f64::min), positions().fold(f64::NEG_INFINITY, f64::max));
    let travel = highest - lowest;
    if moving.is_empty() || !(travel.is_finite() && travel > 0.0) {
        return None;
    }
    let per_period = std::f64::consts::TAU / travel;
    let steps = ((MOST_PERIODS - LEAST_PERIODS) / STEP_PERIODS) as usize;
    let orders = (0..=steps).map(|step| (LEAST_PERIODS + STEP_PERIODS * step as f64) * per_period);
    let waves = orders.map(|order| Ripple { amplitude: amplitude(rows, &moving, order), order });
    waves.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
}

/// Amplitude of a wave in the residual, as a torque or as a friction, whichever is larger.
fn amplitude(rows: &Rows<'_>, moving: &[usize], order: f64) -> f64 {
    let mut sums = [[0.0; 2]; 2];
    for &row in moving {
        let (sine, cosine) = (order * rows.position[row]).sin_cos();
        let residual = rows.residual[row];
        let turned = residual * rows.velocity[row].signum();
        sums[0][0] += residual * cosine;
        sums[0][1] += residual * sine;
        sums[1][0] += turned * cosine;
        sums[1][1] += turned * sine;
    }
    let largest = sums.map(|[cosine, sine]| cosine.hypot(sine)).into_iter().fold(0.0, f64::max);
    2.0 * largest / moving.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strongest_wave_is_found_with_its_amplitude_whether_torque_or_friction() {
        let phase = (0..30_000).map(|row| 0.01 * f64::from(row));
        let (position, velocity): (Vec<f64>, Vec<f64>) = phase.map(|phase| (2.0 * phase.sin(), phase.cos())).unzip();
        let noise = |row: usize| 0.02 * (row as f64 * 1.7).sin();
        for turns in [false, true] {
            let residual: Vec<f64> = (0..position.len())
                .map(|row| {
                    let sign = if turns { velocity[row].signum() } else { 1.0 };
                    0.3 * sign * (12.0 * position[row] + 0.4).cos() + noise(row)
                })
                .collect();
            let rows = Rows { position: &position, velocity: &velocity, residual: &residual };
            let found = ripple(&rows).unwrap();
            assert!((found.order - 12.0).abs() < 0.5 && (found.amplitude - 0.3).abs() < 0.05, "{found:?}");
        }
        assert_eq!(ripple(&Rows { position: &[1.0], velocity: &[0.0], residual: &[0.0] }), None);
    }
}
