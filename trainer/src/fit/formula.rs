//! A law in the terms of the compiler.

use crate::compile::formula::{Formula, Function, Operator};
use crate::law::expression::{Expr, Unary};

/// The formula of a bound expression (one without open parameters, which would read as NaN).
#[must_use]
pub fn formula_of(expression: &Expr) -> Formula {
    let join = |operator, left: &Expr, right: &Expr| formula_of(left).join(operator, formula_of(right));
    match expression {
        Expr::Const(value) => Formula::Constant(*value),
        Expr::Param(_) => Formula::Constant(f64::NAN),
        Expr::Input(index) => Formula::Input(*index),
        Expr::Add(left, right) => join(Operator::Add, left, right),
        Expr::Sub(left, right) => join(Operator::Subtract, left, right),
        Expr::Mul(left, right) => join(Operator::Multiply, left, right),
        Expr::Div(left, right) => join(Operator::Divide, left, right),
        Expr::Pow(base, exponent) => join(Operator::Power, base, exponent),
        Expr::Unary(unary, argument) => formula_of(argument).apply(function_of(*unary)),
    }
}

fn function_of(unary: Unary) -> Function {
    match unary {
        Unary::Neg => Function::Negate,
        Unary::Abs => Function::Absolute,
        Unary::Square => Function::Square,
        Unary::Exp => Function::Exp,
        Unary::Tanh => Function::Tanh,
        Unary::Sin => Function::Sin,
        Unary::Cos => Function::Cos,
        Unary::Atan => Function::Atan,
        Unary::Sqrt => Function::SquareRoot,
        Unary::Log => Function::Log,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expression_and_formula_have_one_value() {
        let v = || Expr::Input(0);
        let law = (Expr::Const(22.0) + Expr::Const(8.0) * (-(v().abs() / Expr::Const(0.1))).exp())
            * (Expr::Const(50.0) * v()).then(Unary::Tanh)
            + Expr::Const(0.3) * v().pow(Expr::Const(1.5)) * v().then(Unary::Atan);
        let formula = formula_of(&law);
        for v in [-0.9, -0.01, 0.0, 0.2] {
            assert!((formula.evaluate(&[v]) - law.value(&[v], &[])).abs() < 1e-12);
        }
    }
}
