//! LaTeX: fractions, functions upright.

use super::number::significant;
use crate::law::model::expression::{Expr, Unary};

/// The law as LaTeX mathematics (without delimiters), six significant digits; `inputs` are symbols.
///
/// # Panics
/// When an input index is out of range.
pub fn latex(e: &Expr, inputs: &[&str]) -> String {
    let plain = |x: &Expr| latex(x, inputs);
    let bracketed = |x: &Expr| match x {
        Expr::Add(..) | Expr::Sub(..) | Expr::Unary(Unary::Neg, _) => format!("\\left({}\\right)", plain(x)),
        Expr::Const(c) if c.is_sign_negative() => format!("\\left({}\\right)", plain(x)),
        _ => plain(x),
    };
    let function = |name: &str, x: &Expr| format!("{name}\\left({}\\right)", plain(x));
    match e {
        Expr::Const(c) => number(*c),
        Expr::Param(k) => format!("p_{{{k}}}"),
        Expr::Input(i) => symbol(inputs[*i]),
        Expr::Add(a, b) => format!("{} + {}", plain(a), plain(b)),
        Expr::Sub(a, b) => {
            let right = if matches!(**b, Expr::Add(..) | Expr::Sub(..)) { bracketed(b) } else { plain(b) };
            format!("{} - {right}", plain(a))
        }
        Expr::Mul(a, b) => format!("{} \\, {}", bracketed(a), bracketed(b)),
        Expr::Div(a, b) => format!("\\frac{{{}}}{{{}}}", plain(a), plain(b)),
        Expr::Pow(a, b) => format!("\\left|{}\\right|^{{{}}}", plain(a), plain(b)),
        Expr::Unary(f, x) => match f {
            Unary::Neg => format!("-{}", bracketed(x)),
            Unary::Abs => format!("\\left|{}\\right|", plain(x)),
            Unary::Square => match **x {
                Expr::Input(_) | Expr::Param(_) => format!("{{{}}}^{{2}}", plain(x)),
                _ => format!("\\left({}\\right)^{{2}}", plain(x)),
            },
            Unary::Exp => function("\\exp", x),
            Unary::Tanh => function("\\tanh", x),
            Unary::Sin => function("\\sin", x),
            Unary::Cos => function("\\cos", x),
            Unary::Atan => function("\\arctan", x),
            Unary::Sqrt => format!("\\sqrt{{\\left|{}\\right|}}", plain(x)),
            Unary::Log => format!("\\ln\\left|{}\\right|", plain(x)),
        },
    }
}

fn number(x: f64) -> String {
    let text = significant(x, 6);
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{mantissa} \\cdot 10^{{{exponent}}}"),
        None => text.replace('∞', "\\infty"),
    }
}

fn symbol(name: &str) -> String {
    match name.split_once('_') {
        _ if name.chars().count() == 1 => name.into(),
        Some((base, index)) if base.chars().count() == 1 => {
            format!("{base}_{{\\mathrm{{{}}}}}", index.replace('_', "\\_"))
        }
        _ => format!("\\mathrm{{{}}}", name.replace('_', "\\_")),
    }
}
