//! A law as text: for the terminal, for papers, and as source code that evaluates to it. Knows no data and no fit.

mod code;
mod latex;
mod number;
mod text;

pub use latex::latex;
pub use number::significant;

use crate::law::model::expression::Expr;

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

#[cfg(test)]
mod tests;
