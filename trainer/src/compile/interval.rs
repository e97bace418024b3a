//! Interval arithmetic in `f64`, rounded outwards: the ground on which certified errors stand.
//!
//! Sums, products and quotients are widened by one unit in the last place on either side. The library's elementary functions
//! are trusted to 4 units in the last place (measured errors of common libraries are below 1) and widened by as much.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// All reals between `low` and `high`; infinite where nothing is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Units in the last place to which elementary functions of the host are trusted.
const ELEMENTARY_ULPS: usize = 4;

impl Interval {
    /// Everything: the enclosure of what is not known or does not exist.
    pub const ENTIRE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// The interval `[low, high]`.
    #[must_use]
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// A single number.
    #[must_use]
    pub const fn point(value: f64) -> Self {
        Self { low: value, high: value }
    }

    /// Largest magnitude.
    #[must_use]
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// `high - low`.
    #[must_use]
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Whether `value` lies inside.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// The smallest interval around both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// The part that both share; the other's where they do not meet.
    #[must_use]
    pub fn meet(self, other: Self) -> Self {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        if low <= high { Self::new(low, high) } else { other }
    }

    /// Widened by `ulps` units in the last place; everything where an end is NaN.
    fn outwards(self, ulps: usize) -> Self {
        if self.low.is_nan() || self.high.is_nan() {
            return Self::ENTIRE;
        }
        (0..ulps).fold(self, |wide, _| Self::new(wide.low.next_down(), wide.high.next_up()))
    }

    /// The image under a function that rises throughout.
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(function(self.low), function(self.high)).outwards(ELEMENTARY_ULPS)
    }

    /// `exp`.
    #[must_use]
    pub fn exp(self) -> Self {
        let wide = self.rising(f64::exp);
        Self::new(wide.low.max(0.0), wide.high)
    }

    /// `ln`; everything where the interval reaches below or to zero.
    #[must_use]
    pub fn ln(self) -> Self {
        if self.low > 0.0 { self.rising(f64::ln) } else { Self::ENTIRE }
    }

    /// `tanh`.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.rising(f64::tanh).meet(Self::new(-1.0, 1.0))
    }

    /// `atan`.
    #[must_use]
    pub fn atan(self) -> Self {
        self.rising(f64::atan)
    }

    /// `sqrt`, negative parts left out.
    #[must_use]
    pub fn sqrt(self) -> Self {
        Self::new(self.low.max(0.0), self.high.max(0.0)).rising(f64::sqrt)
    }

    /// `sin`: the ends, and the extrema between them.
    #[must_use]
    pub fn sin(self) -> Self {
        if self.width() >= std::f64::consts::TAU || !self.width().is_finite() || self.magnitude() > 1.0e6 {
            return Self::new(-1.0, 1.0);
        }
        let mut image = Self::point(self.low.sin()).hull(Self::point(self.high.sin())).outwards(ELEMENTARY_ULPS);
        let first = (self.low / std::f64::consts::FRAC_PI_2).floor() as i64 - 1;
        let last = (self.high / std::f64::consts::FRAC_PI_2).ceil() as i64 + 1;
        for quarter in (first..=last).filter(|quarter| quarter.rem_euclid(2) == 1) {
            let extremum = quarter as f64 * std::f64::consts::FRAC_PI_2;
            // A hair too wide rather than too narrow.
            if extremum >= self.low - 1.0e-9 && extremum <= self.high + 1.0e-9 {
                image = image.hull(Self::point(if quarter.rem_euclid(4) == 1 { 1.0 } else { -1.0 }));
            }
        }
        image.meet(Self::new(-1.0, 1.0))
    }

    /// `cos`.
    #[must_use]
    pub fn cos(self) -> Self {
        (self + Self::point(std::f64::consts::FRAC_PI_2).outwards(1)).sin()
    }

    /// `|x|`.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            -self
        } else {
            Self::new(0.0, self.magnitude())
        }
    }

    /// `x^exponent` for `x >= 0`; everything for a negative exponent at zero.
    #[must_use]
    pub fn power(self, exponent: f64) -> Self {
        let base = Self::new(self.low.max(0.0), self.high.max(0.0));
        if exponent >= 0.0 {
            base.rising(|x| x.powf(exponent)).meet(Self::new(0.0, f64::INFINITY))
        } else if base.low > 0.0 {
            Self::new(base.high.powf(exponent), base.low.powf(exponent)).outwards(ELEMENTARY_ULPS)
        } else {
            Self::ENTIRE
        }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.low + other.low, self.high + other.high).outwards(1)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // Exactly zero annihilates everything, also what is not known to be finite.
        if self == Self::point(0.0) || other == Self::point(0.0) {
            return Self::point(0.0);
        }
        let products = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        if products.iter().any(|product| product.is_nan()) {
            return Self::ENTIRE;
        }
        let [first, ..] = products;
        products.into_iter().fold(Self::point(first), |hull, x| hull.hull(Self::point(x))).outwards(1)
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.contains(0.0) {
            return Self::ENTIRE;
        }
        self * Self::new(1.0 / other.high, 1.0 / other.low).outwards(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn images_contain_the_values(a in -20.0..20.0f64, width in 0.0..5.0f64, share in 0.0..=1.0f64, b in -3.0..3.0f64) {
            let interval = Interval::new(a, a + width);
            let x = (a + share * width).min(a + width);
            let other = Interval::new(b, b + 0.5);
            prop_assert!(interval.exp().contains(x.exp()));
            prop_assert!(interval.tanh().contains(x.tanh()));
            prop_assert!(interval.sin().contains(x.sin()));
            prop_assert!(interval.cos().contains(x.cos()));
            prop_assert!(interval.atan().contains(x.atan()));
            prop_assert!(interval.abs().contains(x.abs()));
            prop_assert!(interval.abs().sqrt().contains(x.abs().sqrt()));
            prop_assert!(interval.abs().power(1.3).contains(x.abs().powf(1.3)));
            prop_assert!(interval.ln().contains(x.abs().ln()) || interval.low <= 0.0);
            prop_assert!((interval * other).contains(x * b));
            prop_assert!((interval / other).contains(x / b));
            prop_assert!((interval - other).contains(x - b));
        }
    }
}
