//! Infix notation with as few brackets as precedence allows; a notation says how leaves and functions are spelt.

use super::number::significant;
use crate::law::model::expression::{Expr, Unary};

/// How leaves and functions are spelt.
pub(super) trait Notation {
    /// A number.
    fn number(&self, x: f64) -> String;
    /// A function of one argument; `operand` is already bracketed as an argument would be read alone.
    fn call(&self, function: Unary, operand: &str) -> String;
    /// `|base|^exponent`, both standing alone.
    fn power(&self, base: &str, exponent: &str) -> String;
    /// Between factors.
    fn times(&self) -> &'static str {
        "*"
    }
    /// The minus sign.
    fn minus(&self) -> &'static str {
        "-"
    }
}

pub(super) struct Unicode;

impl Notation for Unicode {
    fn number(&self, x: f64) -> String {
        significant(x, 6)
    }

    fn call(&self, function: Unary, operand: &str) -> String {
        match function {
            Unary::Abs => format!("|{operand}|"),
            Unary::Square => format!("({operand})²"),
            Unary::Sqrt => format!("√|{operand}|"),
            Unary::Log => format!("ln|{operand}|"),
            Unary::Neg => format!("−({operand})"),
            Unary::Exp => format!("exp({operand})"),
            Unary::Tanh => format!("tanh({operand})"),
            Unary::Sin => format!("sin({operand})"),
            Unary::Cos => format!("cos({operand})"),
            Unary::Atan => format!("atan({operand})"),
        }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        let bracketed = if exponent.chars().all(|c| c.is_ascii_digit() || c == '.') {
            exponent.to_owned()
        } else {
            format!("({exponent})")
        };
        format!("|{base}|^{bracketed}")
    }

    fn times(&self) -> &'static str {
        "·"
    }

    fn minus(&self) -> &'static str {
        "−"
    }
}

/// How tightly an expression holds together: 1 sum, 2 product, 3 negation, 4 everything else.
fn strength(e: &Expr) -> u8 {
    match e {
        Expr::Add(..) | Expr::Sub(..) => 1,
        Expr::Mul(..) | Expr::Div(..) => 2,
        Expr::Unary(Unary::Neg, _) => 3,
        Expr::Const(c) if c.is_sign_negative() => 3,
        _ => 4,
    }
}

/// Writes `e`.
pub(super) fn infix(e: &Expr, inputs: &[&str], notation: &impl Notation) -> String {
    let at_least = |x: &Expr, needed: u8| {
        let text = infix(x, inputs, notation);
        if strength(x) < needed { format!("({text})") } else { text }
    };
    match e {
        Expr::Const(c) => notation.number(*c),
        Expr::Param(k) => format!("p{k}"),
        Expr::Input(i) => inputs[*i].into(),
        Expr::Add(a, b) => format!("{} + {}", at_least(a, 1), at_least(b, 2)),
        Expr::Sub(a, b) => format!("{} {} {}", at_least(a, 1), notation.minus(), at_least(b, 2)),
        Expr::Mul(a, b) => format!("{}{}{}", at_least(a, 2), notation.times(), at_least(b, 3)),
        Expr::Div(a, b) => format!("{}/{}", at_least(a, 2), at_least(b, 4)),
        Expr::Pow(a, b) => notation.power(&infix(a, inputs, notation), &infix(b, inputs, notation)),
        Expr::Unary(Unary::Neg, x) => format!("{}{}", notation.minus(), at_least(x, 2)),
        Expr::Unary(Unary::Square, x) if notation.times() == "·" && strength(x) == 4 => {
            format!("{}²", infix(x, inputs, notation))
        }
        Expr::Unary(f, x) => notation.call(*f, &infix(x, inputs, notation)),
    }
}
