//! Slow sines from far below the presliding distance to far above.

use std::f64::consts::TAU;

/// Sizes in units of the presliding distance.
const SIZES: [f64; 8] = [2.0, 5.0, 15.0, 60.0, 8.0, 30.0, 1.0, 20.0];
/// Whole sines at each size.
const CYCLES: [f64; 8] = [3.0, 4.0, 3.0, 2.0, 5.0, 2.0, 6.0, 3.0];

/// Sines of one size after the other, each faded in and out.
#[derive(Clone, Debug)]
pub struct SlowSines {
    /// Unit of the sizes, rad or m.
    pub unit: f64,
    /// Duration of the recording, s.
    pub duration_s: f64,
}

impl SlowSines {
    pub(super) fn state(&self, t: f64) -> [f64; 3] {
        let part_s = self.duration_s / SIZES.len() as f64;
        let part = ((t / part_s) as usize).min(SIZES.len() - 1);
        let u = t - part as f64 * part_s;
        let fade_s = 0.5 * part_s / CYCLES[part];
        let (rise, fall) = (quintic(u / fade_s), quintic((part_s - u) / fade_s));
        // Of the envelope: value, first and second derivative.
        let e = rise[0] * fall[0];
        let e1 = (rise[1] * fall[0] - rise[0] * fall[1]) / fade_s;
        let e2 = (rise[2] * fall[0] - 2.0 * rise[1] * fall[1] + rise[0] * fall[2]) / (fade_s * fade_s);
        let w = TAU * CYCLES[part] / part_s;
        let (sine, cosine) = (w * u).sin_cos();
        let size = SIZES[part] * self.unit;
        [
            size * e * sine,
            size * (e1 * sine + e * w * cosine),
            size * (e2 * sine + 2.0 * e1 * w * cosine - e * w * w * sine),
        ]
    }
}

/// The step of fifth order and its two derivatives.
fn quintic(x: f64) -> [f64; 3] {
    if x <= 0.0 {
        return [0.0; 3];
    }
    if x >= 1.0 {
        return [1.0, 0.0, 0.0];
    }
    [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * (x * (1.0 - x)).powi(2),
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    ]
}
