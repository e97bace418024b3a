//! Several expressions evaluated together over whole columns, common parts once, with forward derivatives with respect
//! to the parameters.

use std::borrow::Cow;

use super::expression::{Expr, Unary};

/// Expressions compiled for column-wise evaluation.
#[derive(Clone, Debug)]
pub struct Tape {
    ops: Vec<Op>,
    outputs: Vec<usize>,
    params: usize,
    /// Values that depend on no parameter, computed once; in the order of `ops`.
    given: Vec<Option<Column>>,
    rows: usize,
}

#[derive(Clone, Debug, PartialEq)]
enum Op {
    Const(f64),
    Param(usize),
    Input(usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Div(usize, usize),
    /// Base, exponent, logarithm of the base.
    Pow(usize, usize, usize),
    Unary(Unary, usize),
}

/// A value per sample, or one for all of them.
#[derive(Clone, Debug)]
enum Column {
    Same(f64),
    Each(Vec<f64>),
}

impl Column {
    fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Same(c) => Self::Same(f(*c)),
            Self::Each(values) => Self::Each(values.iter().map(|&x| f(x)).collect()),
        }
    }

    fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        match (self, other) {
            (Self::Same(a), Self::Same(b)) => Self::Same(f(*a, *b)),
            (Self::Same(a), Self::Each(b)) => Self::Each(b.iter().map(|&b| f(*a, b)).collect()),
            (Self::Each(a), Self::Same(b)) => Self::Each(a.iter().map(|&a| f(a, *b)).collect()),
            (Self::Each(a), Self::Each(b)) => Self::Each(a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect()),
        }
    }

    fn into_rows(self, rows: usize) -> Vec<f64> {
        match self {
            Self::Same(c) => vec![c; rows],
            Self::Each(values) => values,
        }
    }
}

/// Values of the outputs over all samples, and where asked for their derivatives.
#[derive(Clone, Debug)]
pub struct Columns {
    /// `values[output][row]`.
    pub values: Vec<Vec<f64>>,
    /// `slopes[output][parameter]`, `None` where the output does not depend on the parameter; empty when not asked for.
    pub slopes: Vec<Vec<Option<Vec<f64>>>>,
}

impl Tape {
    /// Compiles `outputs`, which may use parameters `0..params`, for `channels[i][row]`.
    ///
    /// # Panics
    /// When an input index is out of range or a channel has fewer than `rows` values.
    pub fn new(outputs: &[Expr], params: usize, channels: &[&[f64]], rows: usize) -> Self {
        let mut tape = Self { ops: Vec::new(), outputs: Vec::new(), params, given: Vec::new(), rows };
        tape.outputs = outputs.iter().map(|e| tape.add(e)).collect();
        for op in &tape.ops {
            let column = match op {
                Op::Input(i) => Some(Column::Each(channels[*i][..rows].to_vec())),
                _ => op.value(&tape.given, &[]),
            };
            tape.given.push(column);
        }
        tape
    }

    fn add(&mut self, e: &Expr) -> usize {
        let op = match e {
            Expr::Const(c) => Op::Const(*c),
            Expr::Param(k) => Op::Param(*k),
            Expr::Input(i) => Op::Input(*i),
            Expr::Add(a, b) => Op::Add(self.add(a), self.add(b)),
            Expr::Sub(a, b) => Op::Sub(self.add(a), self.add(b)),
            Expr::Mul(a, b) => Op::Mul(self.add(a), self.add(b)),
            Expr::Div(a, b) => Op::Div(self.add(a), self.add(b)),
            Expr::Pow(a, b) => {
                let base = self.add(a);
                let log = self.push(Op::Unary(Unary::Log, base));
                Op::Pow(base, self.add(b), log)
            }
            Expr::Unary(f, x) => Op::Unary(*f, self.add(x)),
        };
        self.push(op)
    }

    fn push(&mut self, op: Op) -> usize {
        if let Some(found) = self.ops.iter().position(|known| *known == op) {
            return found;
        }
        self.ops.push(op);
        self.ops.len() - 1
    }

    /// Values of every output, with derivatives with respect to all parameters when `slopes`.
    ///
    /// # Panics
    /// When a parameter index is out of range.
    pub fn run(&self, params: &[f64], slopes: bool) -> Columns {
        let mut values: Vec<Cow<'_, Column>> = Vec::with_capacity(self.ops.len());
        let mut tangents: Vec<Vec<Option<Column>>> = Vec::with_capacity(self.ops.len());
        for (op, given) in self.ops.iter().zip(&self.given) {
            let value = match given {
                Some(column) => Cow::Borrowed(column),
                None => Cow::Owned(op.value_with(&values, params)),
            };
            if slopes {
                let all = 0..self.params;
                tangents.push(match given {
                    Some(_) => vec![None; self.params],
                    None => all.map(|k| tangent(op, k, &values, &value, &tangents)).collect(),
                });
            }
            values.push(value);
        }
        let slopes = if slopes {
            self.outputs
                .iter()
                .map(|&o| tangents[o].iter().map(|t| t.clone().map(|t| t.into_rows(self.rows))).collect())
                .collect()
        } else {
            Vec::new()
        };
        Columns {
            values: self.outputs.iter().map(|&o| values[o].clone().into_owned().into_rows(self.rows)).collect(),
            slopes,
        }
    }
}

impl Op {
    /// Operands.
    fn needs(&self) -> impl Iterator<Item = usize> {
        let (a, b) = match *self {
            Self::Const(_) | Self::Param(_) | Self::Input(_) => (None, None),
            Self::Unary(_, x) => (Some(x), None),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) | Self::Pow(a, b, _) => {
                (Some(a), Some(b))
            }
        };
        a.into_iter().chain(b)
    }

    /// The value where no parameter is needed.
    fn value(&self, given: &[Option<Column>], params: &[f64]) -> Option<Column> {
        let known = !matches!(self, Self::Param(_)) && self.needs().all(|i| given[i].is_some());
        known.then(|| {
            let empty = Column::Same(0.0);
            let all: Vec<Cow<'_, Column>> = given.iter().map(|c| Cow::Borrowed(c.as_ref().unwrap_or(&empty))).collect();
            self.value_with(&all, params)
        })
    }

    fn value_with(&self, values: &[Cow<'_, Column>], params: &[f64]) -> Column {
        match self {
            Self::Const(c) => Column::Same(*c),
            Self::Param(k) => Column::Same(params[*k]),
            Self::Input(_) => unreachable!("inputs are given"),
            Self::Add(a, b) => values[*a].zip(&values[*b], |a, b| a + b),
            Self::Sub(a, b) => values[*a].zip(&values[*b], |a, b| a - b),
            Self::Mul(a, b) => values[*a].zip(&values[*b], |a, b| a * b),
            Self::Div(a, b) => values[*a].zip(&values[*b], |a, b| a / b),
            Self::Pow(_, b, log) => values[*log].zip(&values[*b], power_of_log),
            Self::Unary(f, x) => values[*x].map(|x| f.apply(x)),
        }
    }
}

/// `exp(p l)`, where `l = -∞` stands for the logarithm of zero.
fn power_of_log(l: f64, p: f64) -> f64 {
    libm::exp(p * l)
}

/// Derivative of one operation with respect to parameter `k`; `None` is zero.
fn tangent(
    op: &Op,
    k: usize,
    values: &[Cow<'_, Column>],
    value: &Column,
    tangents: &[Vec<Option<Column>>],
) -> Option<Column> {
    let of = |i: usize| tangents[i][k].as_ref();
    let scaled = |t: &Column, by: &Column| t.zip(by, |t, c| t * c);
    match op {
        Op::Const(_) | Op::Input(_) => None,
        Op::Param(p) => (*p == k).then_some(Column::Same(1.0)),
        Op::Add(a, b) => sum(of(*a).cloned(), of(*b).cloned()),
        Op::Sub(a, b) => sum(of(*a).cloned(), of(*b).map(|t| t.map(|t| -t))),
        Op::Mul(a, b) => sum(of(*a).map(|t| scaled(t, &values[*b])), of(*b).map(|t| scaled(t, &values[*a]))),
        Op::Div(a, b) => sum(
            of(*a).map(|t| t.zip(&values[*b], |t, b| t / b)),
            of(*b).map(|t| t.zip(value, |t, y| -t * y).zip(&values[*b], |n, b| n / b)),
        ),
        Op::Pow(a, b, log) => sum(
            of(*a).map(|t| {
                let ratio = value.zip(&values[*a], |y, x| if x == 0.0 { 0.0 } else { y / x });
                scaled(t, &ratio.zip(&values[*b], |r, p| r * p))
            }),
            of(*b).map(|t| scaled(t, &value.zip(&values[*log], |y, l| if y == 0.0 { 0.0 } else { y * l }))),
        ),
        Op::Unary(f, x) => of(*x).map(|t| scaled(t, &values[*x].zip(value, |x, y| f.slope(x, y)))),
    }
}

fn sum(a: Option<Column>, b: Option<Column>) -> Option<Column> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.zip(&b, |a, b| a + b)),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn everything() -> Expr {
        let (v, q) = (|| Expr::Input(0), || Expr::Input(1));
        let stribeck = (-(v().abs() / Expr::Param(0)).pow(Expr::Param(1))).exp();
        let ripple = (Expr::Param(2) * q()).then(Unary::Sin) - (Expr::Param(2) * q()).then(Unary::Cos);
        let saturations = (Expr::Param(3) * v()).then(Unary::Tanh) + (Expr::Param(3) * v()).then(Unary::Atan)
            - v() / (v().then(Unary::Square) + Expr::Param(0).then(Unary::Square)).then(Unary::Sqrt);
        stribeck * saturations + ripple * (Expr::Const(2.0) + q()).then(Unary::Log)
    }

    proptest! {
        #[test]
        fn derivatives_agree_with_finite_differences(
            v in prop_oneof![-2.0..-0.02, 0.02..2.0], q in -1.5..1.5f64,
            p in prop::array::uniform4(0.3..2.5f64),
        ) {
            let e = everything();
            let (vs, qs) = ([v], [q]);
            let columns = Tape::new(std::slice::from_ref(&e), 4, &[&vs, &qs], 1).run(&p, true);
            prop_assert!((columns.values[0][0] - e.value(&[v, q], &p)).abs() < 1e-12);
            for k in 0..4 {
                let step = 1e-6;
                let (mut up, mut down) = (p, p);
                up[k] += step;
                down[k] -= step;
                let expected = (e.value(&[v, q], &up) - e.value(&[v, q], &down)) / (2.0 * step);
                let got = columns.slopes[0][k].as_ref().map_or(0.0, |s| s[0]);
                prop_assert!((got - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{k}: {got} {expected}");
            }
        }
    }
}
