//! A law as text: for the terminal, for papers, and as source code that evaluates to it.

mod code;
mod latex;
mod text;

pub use latex::latex;

use super::expression::Expr;

/// What the text is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Language {
    /// Readable on a terminal, six significant digits.
    Unicode,
    /// Mathematics in LaTeX, six significant digits.
    Latex,
    /// A C function of doubles, `<math.h>` included.
    C,
    /// A Rust function of `f64`.
    Rust,
    /// A Python function over NumPy arrays.
    Python,
    /// A string for `sympy.sympify`.
    SymPy,
}

/// Renders a bound expression. `inputs[i]` names channel `i` (a symbol for the first two languages and SymPy, else an
/// identifier); code comes as a function `name` of all inputs in their order.
///
/// # Panics
/// When an input index is out of range.
pub fn render(expression: &Expr, language: Language, name: &str, inputs: &[&str]) -> String {
    match language {
        Language::Unicode => text::infix(expression, inputs, &text::Unicode),
        Language::Latex => latex(expression, inputs),
        Language::SymPy => text::infix(expression, inputs, &code::SymPy),
        Language::C => {
            let arguments: Vec<String> = inputs.iter().map(|i| format!("double {i}")).collect();
            let body = text::infix(expression, inputs, &code::C);
            format!("#include <math.h>\n\ndouble {name}({})\n{{\n    return {body};\n}}\n", arguments.join(", "))
        }
        Language::Rust => {
            let arguments: Vec<String> = inputs.iter().map(|i| format!("{i}: f64")).collect();
            let body = text::infix(expression, inputs, &code::Rust);
            format!("pub fn {name}({}) -> f64 {{\n    {body}\n}}\n", arguments.join(", "))
        }
        Language::Python => {
            let body = text::infix(expression, inputs, &code::Python);
            format!("import numpy as np\n\n\ndef {name}({}):\n    return {body}\n", inputs.join(", "))
        }
    }
}

/// A number with at most `digits` significant digits and no trailing zeros; powers of ten beyond 10⁶ and below 10⁻⁴.
pub fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return if x.is_nan() {
            "NaN".into()
        } else if x > 0.0 {
            "∞".into()
        } else {
            "-∞".into()
        };
    }
    let scientific = format!("{:.*e}", digits.saturating_sub(1), x);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |s: &str| -> String {
        if s.contains('.') { s.trim_end_matches('0').trim_end_matches('.').into() } else { s.into() }
    };
    if (-4..6).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        trimmed(&format!("{x:.decimals$}"))
    } else {
        format!("{}e{exponent}", trimmed(mantissa))
    }
}

#[cfg(test)]
mod tests;
