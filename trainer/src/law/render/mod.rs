//! A law as text: for the terminal, for papers, and for SymPy. Knows no data and no fit.

mod latex;
mod number;
mod sympy;
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
    /// A string for `sympy.sympify`.
    SymPy,
}

/// Renders a bound expression; `inputs[i]` is the symbol of channel `i`.
///
/// # Panics
/// When an input index is out of range.
pub fn render(expression: &Expr, language: Language, inputs: &[&str]) -> String {
    match language {
        Language::Unicode => text::infix(expression, inputs, &text::Unicode),
        Language::Latex => latex(expression, inputs),
        Language::SymPy => text::infix(expression, inputs, &sympy::SymPy),
    }
}

#[cfg(test)]
mod tests;
