//! Taylor coefficients up to the fourth, enclosed over an interval: what bounds a function between sample points.
//!
//! The series of a function over an interval holds, for `k = 0..=4`, an enclosure of `f^(k)(x) / k!` for all `x` in it
//! (Moore 1966; recurrences as in Griewank & Walther 2008, chapter 13). A derivative that does not exist, at a kink or a
//! knot, is enclosed by everything.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::interval::Interval;

/// Orders that a series holds.
pub const ORDERS: usize = 5;

/// Enclosures of the Taylor coefficients, constant first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series(pub [Interval; ORDERS]);

const ZERO: Interval = Interval::point(0.0);

fn scale(factor: f64) -> Interval {
    Interval::point(factor)
}

impl Series {
    /// The identity over `x`.
    #[must_use]
    pub const fn variable(x: Interval) -> Self {
        Self([x, Interval::point(1.0), ZERO, ZERO, ZERO])
    }

    /// A constant.
    #[must_use]
    pub const fn constant(value: f64) -> Self {
        Self([Interval::point(value), ZERO, ZERO, ZERO, ZERO])
    }

    /// Solves `f' = derivative(f) u'` order by order: `k f_k = sum_{j=1..=k} j u_j g_{k-j}` with `g` the derivative's series.
    fn solve(self, value: Interval, derivative: impl Fn(&Self) -> Self) -> Self {
        let mut f = Self([value, ZERO, ZERO, ZERO, ZERO]);
        for k in 1..ORDERS {
            let g = derivative(&f);
            let mut sum = ZERO;
            for j in 1..=k {
                sum = sum + scale(j as f64) * self.0[j] * g.0[k - j];
            }
            f.0[k] = sum / scale(k as f64);
        }
        f
    }

    /// `exp u`.
    #[must_use]
    pub fn exp(self) -> Self {
        self.solve(self.0[0].exp(), |f| *f)
    }

    /// `ln |u|`.
    #[must_use]
    pub fn ln_abs(self) -> Self {
        let inverse = Self::constant(1.0) / self;
        self.solve(self.0[0].abs().ln(), |_| inverse)
    }

    /// `tanh u`.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.solve(self.0[0].tanh(), |f| Self::constant(1.0) - *f * *f)
    }

    /// `atan u`.
    #[must_use]
    pub fn atan(self) -> Self {
        let derivative = Self::constant(1.0) / (Self::constant(1.0) + self.square());
        self.solve(self.0[0].atan(), |_| derivative)
    }

    /// `sin u` and `cos u`.
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = (Self::constant(0.0), Self::constant(0.0));
        (sin.0[0], cos.0[0]) = (self.0[0].sin(), self.0[0].cos());
        for k in 1..ORDERS {
            let (mut s, mut c) = (ZERO, ZERO);
            for j in 1..=k {
                let weight = scale(j as f64) * self.0[j];
                s = s + weight * cos.0[k - j];
                c = c - weight * sin.0[k - j];
            }
            (sin.0[k], cos.0[k]) = (s / scale(k as f64), c / scale(k as f64));
        }
        (sin, cos)
    }

    /// `u^2`, never negative.
    #[must_use]
    pub fn square(self) -> Self {
        let mut square = self * self;
        square.0[0] = square.0[0].meet(Interval::new(0.0, f64::INFINITY));
        square
    }

    /// `|u|`; derivatives beyond the first do not exist across zero.
    #[must_use]
    pub fn abs(self) -> Self {
        let [u, first, ..] = self.0;
        if u.low >= 0.0 {
            self
        } else if u.high <= 0.0 {
            -self
        } else {
            Self([u.abs(), first.hull(-first), Interval::ENTIRE, Interval::ENTIRE, Interval::ENTIRE])
        }
    }

    /// `|u|^p`, by `k u f_k`-recurrences away from zero; across zero only the value is known, and the derivative for `p >= 1`.
    #[must_use]
    pub fn power(self, p: f64) -> Self {
        let base = self.abs();
        let [u, first, ..] = base.0;
        let value = u.power(p);
        if u.low <= 0.0 {
            let derivative = if p >= 1.0 { scale(p) * u.power(p - 1.0) * first } else { Interval::ENTIRE };
            return Self([value, derivative, Interval::ENTIRE, Interval::ENTIRE, Interval::ENTIRE]);
        }
        // f' u = p f u'
        let mut f = Self([value, ZERO, ZERO, ZERO, ZERO]);
        for k in 1..ORDERS {
            let mut sum = ZERO;
            for j in 1..=k {
                sum = sum + scale(p * j as f64 - (k - j) as f64) * base.0[j] * f.0[k - j];
            }
            f.0[k] = sum / (scale(k as f64) * u);
        }
        f
    }
}

impl Add for Series {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Series {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl Neg for Series {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|coefficient| -coefficient))
    }
}

impl Mul for Series {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| (0..=k).fold(ZERO, |sum, j| sum + self.0[j] * other.0[k - j])))
    }
}

impl Div for Series {
    type Output = Self;
    // Long division of power series multiplies and subtracts.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, other: Self) -> Self {
        let mut quotient = Self([ZERO; ORDERS]);
        for k in 0..ORDERS {
            let known = (0..k).fold(self.0[k], |rest, j| rest - quotient.0[j] * other.0[k - j]);
            quotient.0[k] = known / other.0[0];
        }
        quotient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients at a point against central differences of the function.
    fn check(f: impl Fn(f64) -> f64, series: impl Fn(Series) -> Series, x: f64) {
        let at = series(Series::variable(Interval::point(x)));
        let h = 1.0e-2;
        let (m2, m1, c, p1, p2) = (f(x - 2.0 * h), f(x - h), f(x), f(x + h), f(x + 2.0 * h));
        let derivatives = [
            c,
            (m2 - 8.0 * m1 + 8.0 * p1 - p2) / (12.0 * h),
            (-m2 + 16.0 * m1 - 30.0 * c + 16.0 * p1 - p2) / (24.0 * h * h),
            (p2 - 2.0 * p1 + 2.0 * m1 - m2) / (12.0 * h * h * h),
            (m2 - 4.0 * m1 + 6.0 * c - 4.0 * p1 + p2) / (24.0 * h.powi(4)),
        ];
        for (k, want) in derivatives.into_iter().enumerate() {
            let got = at.0[k];
            assert!(got.width() < 1.0e-9, "order {k}: {got:?}");
            assert!(
                (got.low - want).abs() < 5.0e-3 * (1.0 + want.abs()),
                "order {k} at {x}: {got:?}, differences give {want}"
            );
        }
    }

    #[test]
    fn coefficients_agree_with_differences() {
        for x in [-1.3, -0.4, 0.3, 0.9] {
            check(f64::exp, Series::exp, x);
            check(|x| x.abs().ln(), Series::ln_abs, x);
            check(f64::tanh, Series::tanh, x);
            check(f64::atan, Series::atan, x);
            check(f64::sin, |u| u.sin_cos().0, x);
            check(f64::cos, |u| u.sin_cos().1, x);
            check(|x| x.abs().powf(1.7), |u| u.power(1.7), x);
            check(f64::abs, Series::abs, x);
            check(|x| x.sin() / (2.0 + x * x), |u| u.sin_cos().0 / (Series::constant(2.0) + u.square()), x);
        }
    }
}
