//! The notation of SymPy. Numbers are written so that they read back to the same bits.

use super::text::Notation;
use crate::law::model::expression::Unary;

fn called(name: &str, operand: &str) -> String {
    format!("{name}({operand})")
}

pub(super) struct SymPy;

impl Notation for SymPy {
    fn number(&self, x: f64) -> String {
        format!("{x:?}")
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
