//! Elementary functions in `f32` that never branch on their argument: on a core with an FPU each takes the same number of
//! instructions for every input, and each gives a finite value for every bit pattern.
//!
//! The trainer's reference evaluator and the drive call these very functions, so that a law means the same bits on both
//! sides. Every product and every sum is rounded by itself, in the order written; nothing is contracted.
//!
//! | function | held to | largest error against `f64`, over every 397th `f32` of the range |
//! |---|---|---|
//! | [`exp`] | `-87 <= x <= 88.37` | 1.0e-7 relative |
//! | [`log`] | `2^-126 <= abs(x)` finite | 1.0e-7 of the larger of 1 and the result's magnitude |
//! | [`tanh`] | `abs(x) <= 7.9` | 4.6e-7 relative |
//! | [`sin`], [`cos`] | `abs(x) <= 32768` | 1.3e-7 absolute |
//! | [`atan`] | finite | 1.6e-7 relative |
//! | [`power`] | result in `exp`'s range | 1.0e-7 (1 + 2 abs(p ln x)) relative |
//! | [`square_root`] | `2^-126 <= abs(x)` finite | correctly rounded (libm) |
//!
//! Relative errors are of results above 1e-35 in magnitude.
//!
//! [`exp`] and [`tanh`], which friction laws are made of, and [`decay`] are inlined; the others are calls.
//!
//! NaN is taken as the upper end of the range. libm's `expf`, `tanhf`, `sinf` and their like branch on the argument (61 to 188
//! instructions for one friction law on a Cortex-M4F), and micromath errs by 0.24 % in `exp` and 6 % in `sqrt`: neither
//! is used here. libm's square root has a fixed course for the normal numbers that it is given here.

/// Adding this to an `f32` below `2^22` in magnitude rounds it to an integer, to even at ties, in the low mantissa bits.
const ROUND: f32 = 12_582_912.0;

/// Bits of 1.0.
const ONE_BITS: u32 = 0x3F80_0000;

/// `high` in place of NaN and of what lies above.
#[inline(always)]
fn at_most(x: f32, high: f32) -> f32 {
    if x < high { x } else { high }
}

/// `low` in place of what lies below.
#[inline(always)]
fn at_least(x: f32, low: f32) -> f32 {
    if x > low { x } else { low }
}

/// `exp(x)`, held at both ends: never zero, never infinite.
#[must_use]
#[inline]
pub fn exp(x: f32) -> f32 {
    exp_of_held(at_least(at_most(x, 88.37), -87.0))
}

/// `exp(-|x|)` of what decays, to the bit: above zero and at most 1.
#[must_use]
#[inline]
pub fn decay(x: f32) -> f32 {
    exp_of_held(at_least(-x.abs(), -87.0))
}

/// `exp(x)` from -87 to 88.37. Polynomial of Cephes `expf` (Moshier 1992).
#[inline(always)]
fn exp_of_held(x: f32) -> f32 {
    let rounded = x * core::f32::consts::LOG2_E + ROUND;
    let n = rounded - ROUND;
    // ln 2 in two parts; the products with the first are exact.
    let r = x - n * 0.693_359_4;
    let r = r - n * -2.121_944_4e-4;
    let p = 1.987_569_1e-4;
    let p = p * r + 1.398_2e-3;
    let p = p * r + 8.333_452e-3;
    let p = p * r + 4.166_579_6e-2;
    let p = p * r + 0.166_666_66;
    let p = p * r + 0.5;
    let p = p * (r * r) + r + 1.0;
    p * f32::from_bits((rounded.to_bits() << 23).wrapping_add(ONE_BITS))
}

/// `ln |x|`; `ln 2^-126` for zero and subnormal numbers. Polynomial of FreeBSD `e_logf.c` (Sun 1993).
#[must_use]
#[inline(never)]
pub fn log(x: f32) -> f32 {
    let x = at_least(at_most(x.abs(), f32::MAX), f32::MIN_POSITIVE);
    // x = 2^k m with m in [sqrt(1/2), sqrt(2)), whose lower end has the bits 0x3f3504f3.
    let shifted = x.to_bits().wrapping_add(ONE_BITS - 0x3F35_04F3);
    let k = ((shifted >> 23) as i32 - 127) as f32;
    let f = f32::from_bits((shifted & 0x007F_FFFF) + 0x3F35_04F3) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (0.400_009_72 + w * 0.242_790_79);
    let odd = z * (0.666_666_6 + w * 0.284_987_87);
    let half_square = 0.5 * f * f;
    s * (half_square + (odd + even)) + k * 9.058_001e-6 - half_square + f + k * 0.693_138_1
}

/// `tanh(x)`, odd, exactly 0 at 0, at most 1 in magnitude. Rational approximation of Eigen's `ptanh` (degree 13 over 6).
#[must_use]
#[inline]
pub fn tanh(x: f32) -> f32 {
    let x = at_least(at_most(x, TANH_END), -TANH_END);
    let z = x * x;
    let p = -2.760_768_5e-16;
    let p = p * z + 2.000_188e-13;
    let p = p * z + -8.604_672e-11;
    let p = p * z + 5.122_297e-8;
    let p = p * z + 1.485_722_4e-5;
    let p = p * z + 6.372_619e-4;
    let p = p * z + 4.893_524_6e-3;
    let q = 1.198_258_4e-6;
    let q = q * z + 1.185_347_1e-4;
    let q = q * z + 2.268_434_6e-3;
    let q = q * z + 4.893_525e-3;
    (x * p) / q
}

/// Where `tanh` is 1 to within an `f32`'s rounding.
const TANH_END: f32 = 7.905_311;

/// Largest magnitude that the circular functions reduce; beyond it they hold.
const CIRCLE_END: f32 = 32768.0;

/// `sin(r)` for `|r| <= pi / 2 + 0.001`.
#[inline(always)]
fn sin_half_turn(r: f32) -> f32 {
    let z = r * r;
    let p = -2.408_036_8e-8;
    let p = p * z + 2.753_647_5e-6;
    let p = p * z + -1.984_108_7e-4;
    let p = p * z + 8.333_333e-3;
    let p = p * z + -0.166_666_67;
    p * z * r + r
}

/// `x - turns * pi` in three parts of pi; the products with the first two are exact.
#[inline(always)]
fn less_half_turns(x: f32, turns: f32) -> f32 {
    let r = x - turns * 3.140_625;
    let r = r - turns * 9.670_257_6e-4;
    r - turns * 6.278_329_5e-7
}

/// `sin(x)`, odd, exactly 0 at 0.
#[must_use]
#[inline(never)]
pub fn sin(x: f32) -> f32 {
    let x = at_least(at_most(x, CIRCLE_END), -CIRCLE_END);
    let rounded = x * core::f32::consts::FRAC_1_PI + ROUND;
    let r = less_half_turns(x, rounded - ROUND);
    // An odd number of half turns changes the sign.
    f32::from_bits(sin_half_turn(r).to_bits() ^ (rounded.to_bits() << 31))
}

/// `cos(x)`, even.
#[must_use]
#[inline(never)]
pub fn cos(x: f32) -> f32 {
    let x = at_most(x.abs(), CIRCLE_END);
    let rounded = x * core::f32::consts::FRAC_1_PI - 0.5 + ROUND;
    let r = less_half_turns(x, rounded - ROUND + 0.5);
    // cos((n + 1/2) pi + r) = -(-1)^n sin(r)
    f32::from_bits(sin_half_turn(r).to_bits() ^ (!rounded.to_bits() << 31))
}

/// `atan(x)`, odd, exactly 0 at 0.
#[must_use]
#[inline(never)]
pub fn atan(x: f32) -> f32 {
    // Before the sign is taken: that of a NaN differs between processors.
    let x = at_most(x, f32::MAX);
    let magnitude = x.abs();
    let beyond = magnitude > 1.0;
    let z = if beyond { 1.0 } else { magnitude } / if beyond { magnitude } else { 1.0 };
    let s = z * z;
    let p = -2.508_607_5e-3;
    let p = p * s + 1.399_660_7e-2;
    let p = p * s + -3.667_048_4e-2;
    let p = p * s + 6.318_236e-2;
    let p = p * s + -8.689_052e-2;
    let p = p * s + 0.110_420_376;
    let p = p * s + -0.142_796_16;
    let p = p * s + 0.199_997_9;
    let p = p * s + -0.333_333_3;
    let near = p * s * z + z;
    let angle = if beyond { core::f32::consts::FRAC_PI_2 - near } else { near };
    f32::from_bits(angle.to_bits() | (x.to_bits() & 0x8000_0000))
}

/// `|x|^p` as `exp(p ln |x|)`; 0 at `x = 0` for every `p` above 0.
#[must_use]
#[inline(never)]
pub fn power(x: f32, p: f32) -> f32 {
    let result = exp(p * log(x));
    if (x == 0.0) & (p > 0.0) { 0.0 } else { result }
}

/// `sqrt |x|`; subnormal numbers count as zero.
#[must_use]
#[inline(never)]
pub fn square_root(x: f32) -> f32 {
    let magnitude = at_most(x.abs(), f32::MAX);
    let root = libm::sqrtf(at_least(magnitude, f32::MIN_POSITIVE));
    if magnitude < f32::MIN_POSITIVE { 0.0 } else { root }
}

/// `-1`, `0` or `1` with the sign of `x`; `0` for NaN.
#[must_use]
#[inline]
pub fn sign(x: f32) -> f32 {
    let positive = if x > 0.0 { 1.0 } else { 0.0 };
    if x < 0.0 { -1.0 } else { positive }
}

/// `1 - exp(-ratio)`, the share of the way that a first-order lag goes in a step of `ratio` time constants, as the
/// rational `n / (1 + n)` with `n` the series of `exp(ratio) - 1` to the fourth power: exact to `f32` up to `ratio = 0.05`, 0.4 %
/// low at 1, always in `[0, 1]`. Negative ratios and NaN count as 0 and as the end of the range.
#[must_use]
#[inline]
pub fn lag_share(ratio: f32) -> f32 {
    let x = at_least(at_most(ratio, 1.0e6), 0.0);
    let n = x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0))));
    n / (1.0 + n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::println;

    /// Every 397th bit pattern, so that all exponents and a spread of mantissas occur.
    fn patterns() -> impl Iterator<Item = f32> {
        /// An interpreter sees a part of them.
        const EVERY: usize = if cfg!(miri) { 3_970_007 } else { 397 };
        (0..=u32::MAX).step_by(EVERY).map(f32::from_bits)
    }

    /// Largest of `error(x)` over the patterns in `[low, high]`.
    fn worst(name: &str, low: f32, high: f32, error: impl Fn(f32) -> f64) -> f64 {
        let mut worst = (0.0, 0.0);
        for x in patterns().filter(|x| (low..=high).contains(x)) {
            let error = error(x);
            if error > worst.0 {
                worst = (error, x);
            }
        }
        println!("{name}: {:e} at {:e}", worst.0, worst.1);
        worst.0
    }

    fn relative(got: f32, want: f64) -> f64 {
        (f64::from(got) - want).abs() / want.abs().max(1.0e-35)
    }

    #[test]
    fn documented_errors_hold() {
        let f = |x: f32| f64::from(x);
        assert!(worst("exp", -87.0, 88.37, |x| relative(exp(x), f(x).exp())) < 1.0e-7);
        assert!(
            worst("log", f32::MIN_POSITIVE, f32::MAX, |x| {
                let want = f(x).ln();
                (f(log(x)) - want).abs() / want.abs().max(1.0)
            }) < 1.0e-7
        );
        assert!(worst("tanh", -TANH_END, TANH_END, |x| relative(tanh(x), f(x).tanh())) < 4.6e-7);
        assert!(worst("sin", -CIRCLE_END, CIRCLE_END, |x| (f(sin(x)) - f(x).sin()).abs()) < 1.3e-7);
        assert!(worst("cos", -CIRCLE_END, CIRCLE_END, |x| (f(cos(x)) - f(x).cos()).abs()) < 1.3e-7);
        assert!(worst("atan", -f32::MAX, f32::MAX, |x| relative(atan(x), f(x).atan())) < 1.6e-7);
        assert!(worst("square_root", f32::MIN_POSITIVE, f32::MAX, |x| relative(square_root(x), f(x).sqrt())) < 6.0e-8);
        for p in [-2.0f32, -0.5, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0] {
            let error = worst("power", 1.0e-4, 1.0e4, |x| {
                relative(power(x, p), f(x).powf(f(p))) / (1.0 + 2.0 * (f(p) * f(x).ln()).abs())
            });
            assert!(error < 1.0e-7);
        }
        assert!(worst("lag_share", 1.0e-7, 0.05, |x| relative(lag_share(x), -(-f(x)).exp_m1())) < 3.0e-7);
        assert!(worst("lag_share", 1.0e-7, 1.0, |x| relative(lag_share(x), -(-f(x)).exp_m1())) < 5.0e-3);
    }

    #[test]
    fn every_bit_pattern_gives_a_finite_value() {
        for x in patterns().chain([f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0]) {
            for (name, y) in [
                ("exp", exp(x)),
                ("decay", decay(x)),
                ("log", log(x)),
                ("tanh", tanh(x)),
                ("sin", sin(x)),
                ("cos", cos(x)),
                ("atan", atan(x)),
                ("power", power(x, 1.7)),
                ("square_root", square_root(x)),
                ("sign", sign(x)),
                ("lag_share", lag_share(x)),
            ] {
                assert!(y.is_finite(), "{name}({x:e}) = {y}");
            }
            assert!(tanh(x).abs() <= 1.0 && sin(x).abs() <= 1.0 && cos(x).abs() <= 1.0, "{x:e}");
        }
    }

    /// The sign and the payload of a NaN differ between processors: no function may let them through.
    #[test]
    fn every_nan_gives_the_same_bits() {
        let functions =
            [exp, decay, log, tanh, sin, cos, atan, square_root, sign, lag_share, |x| power(x, 1.7), |x| power(2.0, x)];
        for (index, function) in functions.into_iter().enumerate() {
            let bits = function(f32::NAN).to_bits();
            for nan in [0x7F80_0001, 0x7FFF_FFFF, 0xFF80_0001, 0xFFC0_0000, 0xFFFF_FFFF] {
                assert_eq!(function(f32::from_bits(nan)).to_bits(), bits, "function {index}, NaN {nan:x}");
            }
        }
    }

    #[test]
    fn what_decays_is_the_exponential_to_the_bit() {
        for x in patterns().filter(|x| *x >= 0.0) {
            assert_eq!(decay(x).to_bits(), exp(-x).to_bits(), "{x:e}");
        }
    }

    #[test]
    fn exact_values() {
        assert_eq!(exp(0.0).to_bits(), 1.0f32.to_bits());
        assert_eq!(tanh(0.0).to_bits(), 0.0f32.to_bits());
        assert_eq!(sin(0.0), 0.0);
        assert!(cos(0.0) >= 1.0 - f32::EPSILON);
        assert_eq!(atan(-0.0).to_bits(), (-0.0f32).to_bits());
        assert_eq!(atan(f32::NEG_INFINITY), -core::f32::consts::FRAC_PI_2);
        assert_eq!(power(0.0, 0.1), 0.0);
        assert_eq!(square_root(0.0), 0.0);
        assert_eq!(square_root(-9.0), 3.0);
        assert_eq!(sign(-0.0), 0.0);
        assert_eq!(sign(f32::NAN), 0.0);
    }
}
