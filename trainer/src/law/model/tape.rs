//! Several expressions evaluated together over whole columns, common parts once, with forward derivatives with respect
//! to the parameters. A few rows at a time go through all operations, so that nothing between input and output leaves the cache.

use super::expression::{Expr, Unary};

/// Rows that go through all operations together: registers of a law and of its derivatives then stay in the fastest caches.
const ROWS_AT_ONCE: usize = 128;

/// A value for each of the rows at hand.
type Register = [f64; ROWS_AT_ONCE];

/// Expressions compiled for column-wise evaluation.
#[derive(Clone, Debug)]
pub struct Tape {
    ops: Vec<Op>,
    reads: Vec<Reads>,
    outputs: Vec<usize>,
    /// Values that depend on rows and on no parameter, computed once; empty for the others. In the order of `ops`.
    given: Vec<Vec<f64>>,
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

/// What the value of an operation depends on.
#[derive(Clone, Copy, Debug)]
struct Reads {
    parameters: bool,
    rows: bool,
}

/// Values of the outputs over all samples, and where asked for their derivatives.
#[derive(Clone, Debug)]
pub struct Columns {
    /// `values[output][row]`.
    pub values: Vec<Vec<f64>>,
    /// `slopes[output][i]`, with respect to the `i`-th parameter that was asked for; `None` where the output does not depend on it.
    pub slopes: Vec<Vec<Option<Vec<f64>>>>,
}

impl Tape {
    /// Compiles `outputs` for `channels[i][row]`.
    ///
    /// # Panics
    /// When an input index is out of range or a channel has fewer than `rows` values.
    pub fn new(outputs: &[Expr], channels: &[&[f64]], rows: usize) -> Self {
        let mut tape = Self { ops: Vec::new(), reads: Vec::new(), outputs: Vec::new(), given: Vec::new(), rows };
        tape.outputs = outputs.iter().map(|e| tape.add(e)).collect();
        tape.given = vec![Vec::new(); tape.ops.len()];
        let mut registers = vec![[0.0; ROWS_AT_ONCE]; tape.ops.len()];
        for begin in (0..rows).step_by(ROWS_AT_ONCE) {
            let end = rows.min(begin + ROWS_AT_ONCE);
            for place in (0..tape.ops.len()).filter(|&place| !tape.reads[place].parameters) {
                match tape.ops[place] {
                    Op::Input(i) => registers[place][..end - begin].copy_from_slice(&channels[i][begin..end]),
                    _ => tape.value(place, &[], &mut registers),
                }
                if tape.reads[place].rows {
                    tape.given[place].extend_from_slice(&registers[place][..end - begin]);
                }
            }
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
        let reads = |of: fn(&Reads) -> bool| op.operands().any(|place| of(&self.reads[place]));
        self.reads.push(Reads {
            parameters: matches!(op, Op::Param(_)) || reads(|reads| reads.parameters),
            rows: matches!(op, Op::Input(_)) || reads(|reads| reads.rows),
        });
        self.ops.push(op);
        self.ops.len() - 1
    }

    /// Works out the register of an operation from those before it.
    fn value(&self, place: usize, params: &[f64], registers: &mut [Register]) {
        let (before, rest) = registers.split_at_mut(place);
        self.ops[place].value(before, params, &mut rest[0]);
    }

    /// Values of every output, with derivatives with respect to the parameters in `slopes`.
    ///
    /// # Panics
    /// When a parameter index is out of range.
    pub fn run(&self, params: &[f64], slopes: &[usize]) -> Columns {
        let count = slopes.len();
        let mut registers = vec![[0.0; ROWS_AT_ONCE]; self.ops.len()];
        // Of each operation one for each parameter, where it depends on that.
        let mut tangents = vec![[0.0; ROWS_AT_ONCE]; self.ops.len() * count];
        let depends = self.dependence(slopes);
        let column = || Vec::with_capacity(self.rows);
        let slopes_of = |&output: &usize| (0..count).map(|i| depends[output * count + i].then(column)).collect();
        let mut columns = Columns {
            values: self.outputs.iter().map(|_| column()).collect(),
            slopes: self.outputs.iter().map(slopes_of).collect(),
        };
        for begin in (0..self.rows).step_by(ROWS_AT_ONCE) {
            let rows = ROWS_AT_ONCE.min(self.rows - begin);
            for (place, reads) in self.reads.iter().enumerate() {
                if reads.rows && !reads.parameters {
                    registers[place][..rows].copy_from_slice(&self.given[place][begin..begin + rows]);
                    continue;
                }
                // Without rows the registers of the first hold for all.
                if reads.rows || begin == 0 {
                    self.value(place, params, &mut registers);
                    for i in (0..count).filter(|i| depends[place * count + i]) {
                        let (before, rest) = tangents.split_at_mut(place * count + i);
                        let of = |operand: usize| {
                            let at = operand * count + i;
                            depends[at].then(|| &before[at])
                        };
                        self.ops[place].tangent(&registers, &registers[place], of, &mut rest[0]);
                    }
                }
            }
            for (output, &place) in self.outputs.iter().enumerate() {
                columns.values[output].extend_from_slice(&registers[place][..rows]);
                for (i, slope) in columns.slopes[output].iter_mut().enumerate() {
                    if let Some(slope) = slope {
                        slope.extend_from_slice(&tangents[place * count + i][..rows]);
                    }
                }
            }
        }
        columns
    }

    /// Whether each operation depends on each of the parameters, operation after operation.
    fn dependence(&self, parameters: &[usize]) -> Vec<bool> {
        let count = parameters.len();
        let mut depends = vec![false; self.ops.len() * count];
        for (place, op) in self.ops.iter().enumerate() {
            for (i, parameter) in parameters.iter().enumerate() {
                depends[place * count + i] =
                    *op == Op::Param(*parameter) || op.operands().any(|operand| depends[operand * count + i]);
            }
        }
        depends
    }
}

/// Each element of a register from that of another.
fn map(x: &Register, out: &mut Register, f: impl Fn(f64) -> f64) {
    out.iter_mut().zip(x).for_each(|(out, x)| *out = f(*x));
}

/// Each element of a register from those of two others.
fn zip(a: &Register, b: &Register, out: &mut Register, f: impl Fn(f64, f64) -> f64) {
    for row in 0..ROWS_AT_ONCE {
        out[row] = f(a[row], b[row]);
    }
}

impl Op {
    /// Places of the operands.
    fn operands(&self) -> impl Iterator<Item = usize> + use<> {
        let (a, b) = match *self {
            Self::Const(_) | Self::Param(_) | Self::Input(_) => (None, None),
            Self::Unary(_, x) => (Some(x), None),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) | Self::Pow(a, b, _) => {
                (Some(a), Some(b))
            }
        };
        a.into_iter().chain(b)
    }

    fn value(&self, of: &[Register], params: &[f64], out: &mut Register) {
        match *self {
            Self::Const(c) => out.fill(c),
            Self::Param(k) => out.fill(params[k]),
            Self::Input(_) => unreachable!("inputs are given"),
            Self::Add(a, b) => zip(&of[a], &of[b], out, |a, b| a + b),
            Self::Sub(a, b) => zip(&of[a], &of[b], out, |a, b| a - b),
            Self::Mul(a, b) => zip(&of[a], &of[b], out, |a, b| a * b),
            Self::Div(a, b) => zip(&of[a], &of[b], out, |a, b| a / b),
            // Minus infinity stands for the logarithm of zero.
            Self::Pow(_, b, log) => zip(&of[log], &of[b], out, |log, power| libm::exp(power * log)),
            // A loop for each, which knows its function.
            Self::Unary(f, x) => match f {
                Unary::Neg => map(&of[x], out, |x| Unary::Neg.apply(x)),
                Unary::Abs => map(&of[x], out, |x| Unary::Abs.apply(x)),
                Unary::Square => map(&of[x], out, |x| Unary::Square.apply(x)),
                Unary::Exp => map(&of[x], out, |x| Unary::Exp.apply(x)),
                Unary::Tanh => map(&of[x], out, |x| Unary::Tanh.apply(x)),
                other => map(&of[x], out, |x| other.apply(x)),
            },
        }
    }

    /// Derivative with respect to a parameter that the operation depends on, from the registers, its own `value`, and the derivatives of
    /// the operands, of which `None` is zero.
    fn tangent<'a>(
        &self,
        of: &[Register],
        value: &Register,
        slope: impl Fn(usize) -> Option<&'a Register>,
        out: &mut Register,
    ) {
        out.fill(0.0);
        let mut chain = |operand: usize, factor: &dyn Fn(&mut Register)| {
            let Some(slope) = slope(operand) else { return };
            let mut by = [0.0; ROWS_AT_ONCE];
            factor(&mut by);
            for row in 0..ROWS_AT_ONCE {
                out[row] += slope[row] * by[row];
            }
        };
        match *self {
            Self::Const(_) | Self::Input(_) => {}
            Self::Param(_) => out.fill(1.0),
            Self::Add(a, b) => {
                chain(a, &|by| by.fill(1.0));
                chain(b, &|by| by.fill(1.0));
            }
            Self::Sub(a, b) => {
                chain(a, &|by| by.fill(1.0));
                chain(b, &|by| by.fill(-1.0));
            }
            Self::Mul(a, b) => {
                chain(a, &|by| *by = of[b]);
                chain(b, &|by| *by = of[a]);
            }
            Self::Div(a, b) => {
                chain(a, &|by| map(&of[b], by, |b| 1.0 / b));
                chain(b, &|by| zip(value, &of[b], by, |y, b| -y / b));
            }
            Self::Pow(a, b, log) => {
                chain(a, &|by| {
                    let mut ratio = [0.0; ROWS_AT_ONCE];
                    zip(value, &of[a], &mut ratio, |y, x| if x == 0.0 { 0.0 } else { y / x });
                    zip(&ratio, &of[b], by, |ratio, power| ratio * power);
                });
                chain(b, &|by| zip(value, &of[log], by, |y, log| if y == 0.0 { 0.0 } else { y * log }));
            }
            Self::Unary(f, x) => match f {
                Unary::Neg => chain(x, &|by| by.fill(-1.0)),
                Unary::Abs => chain(x, &|by| zip(&of[x], value, by, |x, y| Unary::Abs.slope(x, y))),
                Unary::Square => chain(x, &|by| zip(&of[x], value, by, |x, y| Unary::Square.slope(x, y))),
                Unary::Exp => chain(x, &|by| zip(&of[x], value, by, |x, y| Unary::Exp.slope(x, y))),
                Unary::Tanh => chain(x, &|by| zip(&of[x], value, by, |x, y| Unary::Tanh.slope(x, y))),
                other => chain(x, &|by| zip(&of[x], value, by, |x, y| other.slope(x, y))),
            },
        }
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
            let columns = Tape::new(std::slice::from_ref(&e), &[&vs, &qs], 1).run(&p, &[0, 1, 2, 3]);
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

    /// A column is worked out a few rows at a time: none is left out, and constants hold for all of them.
    #[test]
    fn rows_do_not_know_which_others_there_are() {
        let p = [0.7, 1.3, 2.1, 0.4];
        let expressions = [everything(), Expr::Const(2.0) * Expr::Param(1), Expr::Const(3.0), Expr::Input(1).abs()];
        let of = |rows: usize| -> [Vec<f64>; 2] {
            [0.013, -0.37].map(|step| (0..rows).map(|row| (step * (row as f64 + 0.5)).sin()).collect())
        };
        let all = of(2 * ROWS_AT_ONCE + 5);
        let together = Tape::new(&expressions, &[&all[0], &all[1]], all[0].len()).run(&p, &[1, 3]);
        assert!(together.slopes[1][1].is_none() && together.slopes[2][0].is_none());
        for row in [0, ROWS_AT_ONCE - 1, ROWS_AT_ONCE, 2 * ROWS_AT_ONCE + 4] {
            let one = Tape::new(&expressions, &[&all[0][row..=row], &all[1][row..=row]], 1).run(&p, &[1, 3]);
            for (output, values) in together.values.iter().enumerate() {
                assert_eq!(values.len(), all[0].len());
                assert_eq!(values[row].to_bits(), one.values[output][0].to_bits(), "{output} {row}");
                for (slope, alone) in together.slopes[output].iter().zip(&one.slopes[output]) {
                    assert_eq!(slope.as_ref().map(|s| s[row].to_bits()), alone.as_ref().map(|s| s[0].to_bits()));
                }
            }
        }
    }
}
