//! A law in symbols, as the compiler needs it: evaluated in `f64`, enclosed over intervals, and told odd from even.

use super::interval::Interval;
use super::series::{ORDERS, Series};

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// `-x`.
    Negate,
    /// `|x|`.
    Absolute,
    /// `x^2`.
    Square,
    /// `1 / x`.
    Reciprocal,
    /// `exp x`.
    Exp,
    /// `ln |x|`.
    Log,
    /// `tanh x`.
    Tanh,
    /// `sin x`.
    Sin,
    /// `cos x`.
    Cos,
    /// `atan x`.
    Atan,
    /// `sqrt |x|`.
    SquareRoot,
}

/// An operation on two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `x + y`.
    Add,
    /// `x - y`.
    Subtract,
    /// `x y`.
    Multiply,
    /// `x / y`.
    Divide,
    /// `|x|^y`.
    Power,
}

/// An expression tree.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// Input channel by its number.
    Input(usize),
    /// A constant.
    Constant(f64),
    /// A function of a subtree.
    Apply(Function, Box<Formula>),
    /// Two subtrees joined.
    Join(Operator, Box<Formula>, Box<Formula>),
}

/// How a function of one variable behaves under a change of sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// `f(-x) = -f(x)`.
    Odd,
    /// `f(-x) = f(x)`.
    Even,
    /// Neither can be shown.
    Neither,
}

/// A function of one variable that can bound itself.
pub trait Curve: Sync {
    /// The value at `x`.
    fn value(&self, x: f64) -> f64;
    /// Enclosures of the Taylor coefficients over an interval.
    fn series(&self, over: Interval) -> Series;
    /// Its symmetry, where it can be shown.
    fn parity(&self) -> Parity {
        Parity::Neither
    }
}

/// A curve of which only values are known, and perhaps their symmetry; no enclosure is claimed.
pub struct Sampled<'a> {
    /// The value at a point.
    pub value: &'a (dyn Fn(f64) -> f64 + Sync),
    /// The symmetry of the values.
    pub parity: Parity,
}

impl Curve for Sampled<'_> {
    fn value(&self, x: f64) -> f64 {
        (self.value)(x)
    }

    fn series(&self, _over: Interval) -> Series {
        Series([Interval::ENTIRE; ORDERS])
    }

    fn parity(&self) -> Parity {
        self.parity
    }
}

impl Formula {
    /// `function(self)`.
    #[must_use]
    pub fn apply(self, function: Function) -> Self {
        Self::Apply(function, Box::new(self))
    }

    /// `operator(self, other)`.
    #[must_use]
    pub fn join(self, operator: Operator, other: Self) -> Self {
        Self::Join(operator, Box::new(self), Box::new(other))
    }

    /// The value in `f64` for `inputs`; NaN where a channel is missing.
    #[must_use]
    pub fn evaluate(&self, inputs: &[f64]) -> f64 {
        match self {
            Self::Input(index) => inputs.get(*index).copied().unwrap_or(f64::NAN),
            Self::Constant(value) => *value,
            Self::Apply(function, argument) => {
                let x = argument.evaluate(inputs);
                match function {
                    Function::Negate => -x,
                    Function::Absolute => x.abs(),
                    Function::Square => x * x,
                    Function::Reciprocal => 1.0 / x,
                    Function::Exp => x.exp(),
                    Function::Log => x.abs().ln(),
                    Function::Tanh => x.tanh(),
                    Function::Sin => x.sin(),
                    Function::Cos => x.cos(),
                    Function::Atan => x.atan(),
                    Function::SquareRoot => x.abs().sqrt(),
                }
            }
            Self::Join(operator, left, right) => {
                let (x, y) = (left.evaluate(inputs), right.evaluate(inputs));
                match operator {
                    Operator::Add => x + y,
                    Operator::Subtract => x - y,
                    Operator::Multiply => x * y,
                    Operator::Divide => x / y,
                    Operator::Power => x.abs().powf(y),
                }
            }
        }
    }

    /// Largest input number plus one.
    #[must_use]
    pub fn inputs(&self) -> usize {
        match self {
            Self::Input(index) => index + 1,
            Self::Constant(_) => 0,
            Self::Apply(_, argument) => argument.inputs(),
            Self::Join(_, left, right) => left.inputs().max(right.inputs()),
        }
    }
}

impl Curve for Formula {
    fn value(&self, x: f64) -> f64 {
        self.evaluate(&[x])
    }

    fn series(&self, over: Interval) -> Series {
        match self {
            Self::Input(_) => Series::variable(over),
            Self::Constant(value) => Series::constant(*value),
            Self::Apply(function, argument) => {
                let u = argument.series(over);
                match function {
                    Function::Negate => -u,
                    Function::Absolute => u.abs(),
                    Function::Square => u.square(),
                    Function::Reciprocal => Series::constant(1.0) / u,
                    Function::Exp => u.exp(),
                    Function::Log => u.ln_abs(),
                    Function::Tanh => u.tanh(),
                    Function::Sin => u.sin_cos().0,
                    Function::Cos => u.sin_cos().1,
                    Function::Atan => u.atan(),
                    Function::SquareRoot => u.power(0.5),
                }
            }
            Self::Join(operator, left, right) => {
                let u = left.series(over);
                match (operator, right.as_ref()) {
                    (Operator::Power, Self::Constant(exponent)) => return u.power(*exponent),
                    (Operator::Multiply, other) if other == left.as_ref() => return u.square(),
                    _ => {}
                }
                let w = right.series(over);
                match operator {
                    Operator::Add => u + w,
                    Operator::Subtract => u - w,
                    Operator::Multiply => u * w,
                    Operator::Divide => u / w,
                    Operator::Power => (u.ln_abs() * w).exp(),
                }
            }
        }
    }

    fn parity(&self) -> Parity {
        use Parity::{Even, Neither, Odd};
        match self {
            Self::Input(_) => Odd,
            Self::Constant(_) => Even,
            Self::Apply(function, argument) => match (function, argument.parity()) {
                (_, Even) => Even,
                (_, Neither) => Neither,
                (Function::Absolute | Function::Square | Function::Cos | Function::Log | Function::SquareRoot, Odd) => {
                    Even
                }
                (Function::Exp, Odd) => Neither,
                (Function::Negate | Function::Reciprocal | Function::Tanh | Function::Sin | Function::Atan, Odd) => Odd,
            },
            Self::Join(operator, left, right) => match (operator, left.parity(), right.parity()) {
                (_, Neither, _) | (_, _, Neither) => Neither,
                (Operator::Power, _, Even) => Even,
                (Operator::Power, _, Odd) => Neither,
                (Operator::Add | Operator::Subtract, left, right) => {
                    if left == right {
                        left
                    } else {
                        Neither
                    }
                }
                (Operator::Multiply | Operator::Divide, left, right) => {
                    if left == right {
                        Even
                    } else {
                        Odd
                    }
                }
            },
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// `(22 + 8 exp(-|v / 0.1|)) tanh(50 v) + 0.03 v`: the first joint of the paper, in N m and rad/s.
    pub(crate) fn stribeck_law() -> Formula {
        let v = || Formula::Input(0);
        let constant = Formula::Constant;
        let rise = v()
            .join(Operator::Divide, constant(0.1))
            .apply(Function::Absolute)
            .apply(Function::Negate)
            .apply(Function::Exp);
        let coulomb = constant(22.0).join(Operator::Add, constant(8.0).join(Operator::Multiply, rise));
        let sign = constant(50.0).join(Operator::Multiply, v()).apply(Function::Tanh);
        coulomb.join(Operator::Multiply, sign).join(Operator::Add, constant(0.03).join(Operator::Multiply, v()))
    }

    #[test]
    fn the_law_of_the_paper_is_odd() {
        let law = stribeck_law();
        assert_eq!(law.parity(), Parity::Odd);
        assert_eq!(law.clone().join(Operator::Add, Formula::Constant(1.0)).parity(), Parity::Neither);
        assert!((law.value(1.0) - (22.03 + 8.0 * (-10.0f64).exp())).abs() < 1.0e-12);
    }
}
