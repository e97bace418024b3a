//! The notations of programming languages. Numbers are written so that they read back to the same bits.

use super::text::Notation;
use crate::law::model::expression::Unary;

fn exact(x: f64) -> String {
    format!("{x:?}")
}

fn called(name: &str, operand: &str) -> String {
    format!("{name}({operand})")
}

pub(super) struct C;

impl Notation for C {
    fn number(&self, x: f64) -> String {
        exact(x)
    }

    fn call(&self, function: Unary, x: &str) -> String {
        match function {
            Unary::Neg => format!("-({x})"),
            Unary::Abs => called("fabs", x),
            Unary::Square => format!("(({x}) * ({x}))"),
            Unary::Exp => called("exp", x),
            Unary::Tanh => called("tanh", x),
            Unary::Sin => called("sin", x),
            Unary::Cos => called("cos", x),
            Unary::Atan => called("atan", x),
            Unary::Sqrt => format!("sqrt(fabs({x}))"),
            Unary::Log => format!("log(fabs({x}))"),
        }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("pow(fabs({base}), {exponent})")
    }

    fn times(&self) -> &'static str {
        " * "
    }
}

pub(super) struct Rust;

impl Notation for Rust {
    fn number(&self, x: f64) -> String {
        format!("{}_f64", exact(x))
    }

    fn call(&self, function: Unary, x: &str) -> String {
        match function {
            Unary::Neg => format!("-({x})"),
            Unary::Abs => format!("({x}).abs()"),
            Unary::Square => format!("({x}).powi(2)"),
            Unary::Exp => format!("({x}).exp()"),
            Unary::Tanh => format!("({x}).tanh()"),
            Unary::Sin => format!("({x}).sin()"),
            Unary::Cos => format!("({x}).cos()"),
            Unary::Atan => format!("({x}).atan()"),
            Unary::Sqrt => format!("({x}).abs().sqrt()"),
            Unary::Log => format!("({x}).abs().ln()"),
        }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("({base}).abs().powf({exponent})")
    }

    fn times(&self) -> &'static str {
        " * "
    }
}

pub(super) struct Python;

impl Notation for Python {
    fn number(&self, x: f64) -> String {
        exact(x)
    }

    fn call(&self, function: Unary, x: &str) -> String {
        match function {
            Unary::Neg => format!("-({x})"),
            Unary::Abs => called("np.abs", x),
            Unary::Square => called("np.square", x),
            Unary::Exp => called("np.exp", x),
            Unary::Tanh => called("np.tanh", x),
            Unary::Sin => called("np.sin", x),
            Unary::Cos => called("np.cos", x),
            Unary::Atan => called("np.arctan", x),
            Unary::Sqrt => format!("np.sqrt(np.abs({x}))"),
            Unary::Log => format!("np.log(np.abs({x}))"),
        }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("np.abs({base}) ** ({exponent})")
    }

    fn times(&self) -> &'static str {
        " * "
    }
}

pub(super) struct SymPy;

impl Notation for SymPy {
    fn number(&self, x: f64) -> String {
        exact(x)
    }

    fn call(&self, function: Unary, x: &str) -> String {
        match function {
            Unary::Neg => format!("-({x})"),
            Unary::Abs => called("Abs", x),
            Unary::Square => format!("({x})**2"),
            Unary::Exp => called("exp", x),
            Unary::Tanh => called("tanh", x),
            Unary::Sin => called("sin", x),
            Unary::Cos => called("cos", x),
            Unary::Atan => called("atan", x),
            Unary::Sqrt => format!("sqrt(Abs({x}))"),
            Unary::Log => format!("log(Abs({x}))"),
        }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("Abs({base})**({exponent})")
    }
}
