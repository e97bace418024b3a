//! One cell: its cubic, and the certificate of its error.
//!
//! The cubic interpolates the function at four Chebyshev points stretched to the cell's ends, so that neighbours meet, and its
//! coefficients are rounded to `f32`. With `e = f - p` the error of the rounded cubic, the certificate cuts the cell into
//! parts of radius `r` about `m` and takes, in each, the smallest of the Taylor bounds
//!
//! ```text
//! |e| <= |e_0(m)| + |e_1(m)| r + ... + |e_{K-1}(m)| r^{K-1} + sup |e_K| r^K,   K = 0..=4,
//! ```
//!
//! where `e_k` are Taylor coefficients enclosed by interval arithmetic ([`super::series`]). It rests on that arithmetic, on nothing
//! sampled. What the drive adds by computing in `f32` is bounded beside it: the Horner scheme by the usual
//! running error analysis (Higham 2002, section 5.1), the rounding of the input by its effect on the cell's coordinate.

use super::formula::Curve;
use super::interval::Interval;
use super::series::{ORDERS, Series};

/// Parts into which a certificate cuts a cell.
const PARTS: usize = 32;

/// Unit roundoff of `f32`.
const F32_ROUNDOFF: f64 = 1.0 / 16_777_216.0;

/// A cubic in the local coordinate `x` in `[0, 1]`, lowest power first. Its coefficients are those that the drive has, so that a
/// certificate speaks of these and not of what they were rounded from.
pub type Cubic = [f64; 4];

/// The coefficients of the drive's coordinate `t = 1 + x`, rounded to `f32`.
///
/// What is too small to matter is zero, so that no coefficient is subnormal. The constant is chosen last, against the rounded others, so
/// that the near end keeps its value: exactly where that is 0.
#[must_use]
pub fn to_drive(cubic: Cubic) -> [f32; 4] {
    let [near, c1, c2, c3] = cubic;
    let round = |c: f64| if c.abs() < 1.0e-30 { 0.0 } else { c as f32 };
    let (d1, d2, d3) = (round(c1 - 2.0 * c2 + 3.0 * c3), round(c2 - 3.0 * c3), round(c3));
    let others = (d3 + d2) + d1;
    [round(near - f64::from(others)), d1, d2, d3]
}

/// The cubic in `x` of the drive's coefficients.
fn from_drive(cell: &[f32; 4]) -> Cubic {
    let [c0, c1, c2, c3] = cell.map(f64::from);
    [c0 + c1 + c2 + c3, c1 + 2.0 * c2 + 3.0 * c3, c2 + 3.0 * c3, c3]
}

/// The cubic, not yet rounded, through the function at the stretched Chebyshev points of `[low, high]`, where `high` may lie below `low`: the local
/// coordinate runs from `low` to `high`.
#[must_use]
pub fn fit_cell(curve: &dyn Curve, low: f64, high: f64) -> Cubic {
    let stretch = (std::f64::consts::PI / 8.0).cos();
    let inner = (3.0 * std::f64::consts::PI / 8.0).cos() / stretch;
    let nodes = [0.0, 0.5 - 0.5 * inner, 0.5 + 0.5 * inner, 1.0];
    let [y0, y1, y2, y3] = nodes.map(|x| curve.value(low + (high - low) * x));
    let [x0, x1, x2, x3] = nodes;
    // Newton's divided differences, then powers of x; x0 = 0.
    let d01 = (y1 - y0) / (x1 - x0);
    let d12 = (y2 - y1) / (x2 - x1);
    let d23 = (y3 - y2) / (x3 - x2);
    let d012 = (d12 - d01) / (x2 - x0);
    let d123 = (d23 - d12) / (x3 - x1);
    let d0123 = (d123 - d012) / (x3 - x0);
    let c3 = d0123;
    let c2 = d012 - d0123 * (x1 + x2);
    let c1 = d01 - d012 * x1 + d0123 * x1 * x2;
    [y0, c1, c2, c3]
}

/// The cubic in `f64`.
fn value_at(cubic: &Cubic, x: f64) -> f64 {
    let [c0, c1, c2, c3] = *cubic;
    ((c3 * x + c2) * x + c1) * x + c0
}

/// The largest sampled error of a cubic; a quick look before a certificate is worked out.
#[must_use]
pub fn sampled_error(curve: &dyn Curve, low: f64, high: f64, cubic: &Cubic) -> f64 {
    (0..=10)
        .map(|i| f64::from(i) / 10.0)
        .map(|x| (curve.value(low + (high - low) * x) - value_at(cubic, x)).abs())
        .fold(0.0, |worst, error| if error > worst || error.is_nan() { error } else { worst })
}

/// Series of the cubic over an interval of the local coordinate.
fn cubic_series(cubic: &Cubic, x: Interval) -> Series {
    let [c0, c1, c2, c3] = cubic.map(Series::constant);
    let x = Series::variable(x);
    ((c3 * x + c2) * x + c1) * x + c0
}

/// Series of the function as one of the local coordinate.
fn local_series(curve: &dyn Curve, low: f64, high: f64, x: Interval) -> Series {
    let width = Interval::point(high) - Interval::point(low);
    let over = Interval::point(low) + width * x;
    let mut series = curve.series(over);
    let mut factor = Interval::point(1.0);
    for coefficient in &mut series.0 {
        *coefficient = *coefficient * factor;
        factor = factor * width;
    }
    series
}

/// What the certificate of a cell states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Largest error of the cubic in exact arithmetic.
    pub approximation: f64,
    /// Largest error that `f32` arithmetic adds, input included.
    pub rounding: f64,
}

impl Certificate {
    /// The largest error altogether.
    #[must_use]
    pub fn total(self) -> f64 {
        self.approximation + self.rounding
    }
}

/// Largest error of the cubic of `[low, high]` in exact arithmetic, and the largest change of the function's value when the
/// local coordinate is off by `coordinate_error`.
#[must_use]
pub fn bound_cell(curve: &dyn Curve, low: f64, high: f64, cubic: &Cubic, coordinate_error: f64) -> (f64, f64) {
    let mut approximation = 0.0f64;
    let mut moved = 0.0f64;
    for part in 0..PARTS {
        let x = Interval::new(part as f64 / PARTS as f64, (part + 1) as f64 / PARTS as f64);
        let middle = 0.5 * (x.low + x.high);
        let radius = 0.5 * x.width();
        let function = local_series(curve, low, high, x);
        let over = function - cubic_series(cubic, x);
        let centre = Interval::point(middle);
        let at = local_series(curve, low, high, centre) - cubic_series(cubic, centre);
        let mut best = f64::INFINITY;
        let mut lower_orders = 0.0;
        let mut power = 1.0;
        for k in 0..ORDERS {
            best = best.min(lower_orders + over.0[k].magnitude() * power);
            lower_orders += at.0[k].magnitude() * power;
            power *= radius;
        }
        approximation = approximation.max(best);
        // A coordinate a little off moves the function's value by its slope, or at most across the part.
        let [value, slope, ..] = function.0;
        moved = moved.max((slope.magnitude() * coordinate_error).min(value.width()));
    }
    (approximation * (1.0 + 1.0e-9), moved)
}

/// Certifies a cell of `f32` coefficients, whose local coordinate the drive computes to within `coordinate_error`.
#[must_use]
pub fn certify(curve: &dyn Curve, low: f64, high: f64, cell: &[f32; 4], coordinate_error: f64) -> Certificate {
    let (approximation, moved) = bound_cell(curve, low, high, &from_drive(cell), coordinate_error);
    // Horner at t <= 2: every product and every sum adds a roundoff of its own magnitude, and the products double what was there.
    let [a0, a1, a2, a3] = cell.map(|c| f64::from(c.abs()));
    let (mut sum, mut error) = (a3, 0.0);
    for coefficient in [a2, a1, a0] {
        sum *= 2.0;
        error = 2.0 * error + sum;
        sum += coefficient;
        error += sum;
    }
    Certificate { approximation, rounding: 1.001 * F32_ROUNDOFF * error + moved }
}
