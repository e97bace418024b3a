//! An activation of a network matched against a library of functions: `c f(a x + b) + d`, the simplest that fits.

use crate::law::fitting::projection::dot;

/// What an activation can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Function {
    /// `x`
    Line,
    /// `|x|`
    Absolute,
    /// `x²`
    Square,
    /// `x |x|`
    SignedSquare,
    /// `tanh x`
    Tanh,
    /// `atan x`
    Atan,
    /// `exp x`
    Exp,
    /// `exp(-|x|)`
    Laplace,
    /// `exp(-x²)`
    Gauss,
    /// `sin x`
    Sine,
}

/// A function that follows an activation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// Which.
    pub function: Function,
    /// `[a, b]` of `c f(a x + b) + d`.
    pub inner: [f64; 2],
    /// `[c, d]`.
    pub outer: [f64; 2],
    /// Share of the activation's variance that it leaves unexplained.
    pub unexplained: f64,
}

/// Natural logarithm of the unexplained variance that one unit of complexity has to save.
const COMPLEXITY_PENALTY: f64 = 0.5;
/// Unexplained share that counts as none: splines follow their law no closer.
const UNEXPLAINED_FLOOR: f64 = 1e-5;
/// Inner slopes that are tried first, for an argument scaled to `[-1, 1]`: this many, up to the steepest.
const SLOPE_COUNT: usize = 14;
const LOWEST_SLOPE: f64 = 0.3;
const HIGHEST_SLOPE: f64 = 80.0;
/// Shifts of the argument that are tried first.
const SHIFTS: [f64; 9] = [0.0, -0.25, 0.25, -0.5, 0.5, -0.75, 0.75, -1.0, 1.0];
/// Rounds of the pattern search that refines slope and shift (Hooke & Jeeves 1961).
const REFINEMENT_ROUNDS: usize = 40;

impl Function {
    const ALL: [Self; 10] = [
        Self::Line,
        Self::Absolute,
        Self::Square,
        Self::SignedSquare,
        Self::Tanh,
        Self::Atan,
        Self::Exp,
        Self::Laplace,
        Self::Gauss,
        Self::Sine,
    ];

    /// Value at `x`.
    #[must_use]
    pub fn value(self, x: f64) -> f64 {
        match self {
            Self::Line => x,
            Self::Absolute => x.abs(),
            Self::Square => x * x,
            Self::SignedSquare => x * x.abs(),
            Self::Tanh => libm::tanh(x),
            Self::Atan => libm::atan(x),
            Self::Exp => libm::exp(x),
            Self::Laplace => libm::exp(-x.abs()),
            Self::Gauss => libm::exp(-x * x),
            Self::Sine => libm::sin(x),
        }
    }

    /// What it costs, in the units of the paper's library.
    #[must_use]
    pub fn complexity(self) -> f64 {
        match self {
            Self::Line => 1.0,
            Self::Square | Self::Exp | Self::Sine => 2.0,
            Self::Absolute | Self::SignedSquare | Self::Tanh | Self::Gauss | Self::Laplace => 3.0,
            Self::Atan => 4.0,
        }
    }

    /// As a label prints it, of `x`.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Line => "x",
            Self::Absolute => "|x|",
            Self::Square => "x²",
            Self::SignedSquare => "x|x|",
            Self::Tanh => "tanh x",
            Self::Atan => "atan x",
            Self::Exp => "exp x",
            Self::Laplace => "exp(−|x|)",
            Self::Gauss => "exp(−x²)",
            Self::Sine => "sin x",
        }
    }

    /// Whether stretching the argument is more than stretching the value, and whether shifting it is more than adding to it.
    fn shapes(self) -> (bool, bool) {
        match self {
            Self::Line => (false, false),
            Self::Absolute | Self::Square | Self::SignedSquare => (false, true),
            Self::Exp => (true, false),
            Self::Tanh | Self::Atan | Self::Laplace | Self::Gauss | Self::Sine => (true, true),
        }
    }
}

impl Match {
    /// Value at `x`.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        self.outer[0] * self.function.value(self.inner[0] * x + self.inner[1]) + self.outer[1]
    }

    fn score(&self) -> f64 {
        libm::log(self.unexplained + UNEXPLAINED_FLOOR) + COMPLEXITY_PENALTY * self.function.complexity()
    }
}

/// All functions fitted to the points of a curve, best first; none for a curve that does not vary.
#[must_use]
pub fn matches(points: &[[f64; 2]]) -> Vec<Match> {
    let bounds = |axis: usize| {
        let values = points.iter().map(|p| p[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((left, right), (low, high)) = (bounds(0), bounds(1));
    let varies = right - left > 0.0 && high - low > 1e-9 * (high.abs() + low.abs()) && (high - low).is_finite();
    if !varies {
        return Vec::new();
    }
    let (centre, half) = (0.5 * (left + right), 0.5 * (right - left));
    let x: Vec<f64> = points.iter().map(|p| (p[0] - centre) / half).collect();
    let y: Vec<f64> = points.iter().map(|p| p[1]).collect();
    let curve = Curve::new(x, &y);
    let mut found: Vec<Match> = Function::ALL
        .into_iter()
        .map(|function| {
            let fit = curve.best(function);
            // Back from the scaled argument to the real one.
            let slope = fit.inner[0] / half;
            Match { inner: [slope, fit.inner[1] - slope * centre], ..fit }
        })
        .collect();
    found.sort_by(|a, b| a.score().total_cmp(&b.score()).then(a.function.cmp(&b.function)));
    found
}

/// A curve with its mean taken off, over an argument in `[-1, 1]`.
struct Curve {
    x: Vec<f64>,
    mean: f64,
    centred: Vec<f64>,
    power: f64,
}

impl Curve {
    fn new(x: Vec<f64>, y: &[f64]) -> Self {
        let mean = y.iter().sum::<f64>() / y.len() as f64;
        let centred: Vec<f64> = y.iter().map(|y| y - mean).collect();
        let power = dot(&centred, &centred);
        Self { x, mean, centred, power }
    }

    /// The outer constants for given inner ones.
    fn at(&self, function: Function, [slope, shift]: [f64; 2]) -> Match {
        let mut f: Vec<f64> = self.x.iter().map(|x| function.value(slope * x + shift)).collect();
        let mean = f.iter().sum::<f64>() / f.len() as f64;
        f.iter_mut().for_each(|f| *f -= mean);
        let size = dot(&f, &f);
        let product = dot(&f, &self.centred);
        let usable = size.is_finite() && size > 1e-12;
        let factor = if usable { product / size } else { 0.0 };
        Match {
            function,
            inner: [slope, shift],
            outer: [factor, self.mean - factor * if usable { mean } else { 0.0 }],
            unexplained: (1.0 - factor * product / self.power).max(0.0),
        }
    }

    fn best(&self, function: Function) -> Match {
        let (stretches, shifts) = function.shapes();
        let ratio = libm::log(HIGHEST_SLOPE / LOWEST_SLOPE) / (SLOPE_COUNT - 1) as f64;
        let slopes: Vec<f64> = match stretches {
            true => (0..SLOPE_COUNT).map(|i| LOWEST_SLOPE * libm::exp(ratio * i as f64)).collect(),
            false => vec![1.0],
        };
        // An exponential falls as well as it rises; all others are odd or even.
        let signs: &[f64] = if function == Function::Exp { &[1.0, -1.0] } else { &[1.0] };
        let centres: &[f64] = if shifts { &SHIFTS } else { &[0.0] };
        let mut best = self.at(function, [signs[0] * slopes[0], 0.0]);
        for slope in slopes.iter().flat_map(|s| signs.iter().map(move |sign| sign * s)) {
            for centre in centres {
                let trial = self.at(function, [slope, -slope * centre]);
                if trial.unexplained < best.unexplained {
                    best = trial;
                }
            }
        }
        let (mut stretch, mut move_by) = (if stretches { 0.5 * ratio } else { 0.0 }, if shifts { 0.1 } else { 0.0 });
        for _ in 0..REFINEMENT_ROUNDS {
            let before = best.unexplained;
            let steps = [[stretch, 0.0], [-stretch, 0.0], [0.0, move_by], [0.0, -move_by]];
            for [by, shift] in steps {
                let [slope, offset] = best.inner;
                let scaled = slope * libm::exp(by);
                let centre = -offset / slope + shift;
                let trial = self.at(function, [scaled, -scaled * centre]);
                if trial.unexplained < best.unexplained {
                    best = trial;
                }
            }
            if best.unexplained >= before {
                (stretch, move_by) = (0.5 * stretch, 0.5 * move_by);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(f: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        (0..=240).map(|i| -2.0 + i as f64 / 60.0).map(|x| [x, f(x)]).collect()
    }

    #[test]
    fn each_function_is_recognised_behind_an_affine_map() {
        for function in Function::ALL {
            let (a, b) = if function.shapes().0 { (1.7, 0.4) } else { (1.0, 0.4) };
            let found = matches(&curve(|x| 3.0 - 2.0 * function.value(a * x + b)));
            assert_eq!(found[0].function, function, "{:?}", found[0]);
            assert!(found[0].unexplained < 1e-8);
            assert!((found[0].value(0.3) - (3.0 - 2.0 * function.value(a * 0.3 + b))).abs() < 1e-3);
        }
    }

    #[test]
    fn a_nearly_straight_curve_is_a_line_and_a_constant_one_is_nothing() {
        assert_eq!(matches(&curve(|x| 0.5 * x + 1e-4 * x * x))[0].function, Function::Line);
        assert!(matches(&curve(|_| 4.0)).is_empty());
    }
}
