//! The expression tree of a law: what it is made of and what it is worth at one sample. Knows no data and no names.
//!
//! Elementary functions are those of the `libm` crate, so that a law has one value on every host.

/// A scalar expression of inputs (channels, by index) and constants.
///
/// A *template* also holds [`Expr::Param`]; [`Expr::bind`] replaces these by constants. The operators are exactly those
/// that the postfix program of the drive can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr {
    /// A number.
    Const(f64),
    /// A constant still to be fitted, by index into the parameter vector.
    Param(usize),
    /// A channel, by index.
    Input(usize),
    /// Sum.
    Add(Box<Expr>, Box<Expr>),
    /// Difference.
    Sub(Box<Expr>, Box<Expr>),
    /// Product.
    Mul(Box<Expr>, Box<Expr>),
    /// Quotient.
    Div(Box<Expr>, Box<Expr>),
    /// `|x|` to the power of a constant (`Const` or `Param`).
    Pow(Box<Expr>, Box<Expr>),
    /// A function of one argument.
    Unary(Unary, Box<Expr>),
}

/// Functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unary {
    /// `-x`
    Neg,
    /// `|x|`
    Abs,
    /// `x²`
    Square,
    /// `exp x`
    Exp,
    /// `tanh x`
    Tanh,
    /// `sin x`
    Sin,
    /// `cos x`
    Cos,
    /// `atan x`
    Atan,
    /// `sqrt |x|`
    Sqrt,
    /// `ln |x|`
    Log,
}

impl Unary {
    /// Value at `x`.
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Neg => -x,
            Self::Abs => x.abs(),
            Self::Square => x * x,
            Self::Exp => libm::exp(x),
            Self::Tanh => libm::tanh(x),
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Atan => libm::atan(x),
            Self::Sqrt => x.abs().sqrt(),
            Self::Log => libm::log(x.abs()),
        }
    }

    /// Derivative at `x`, where the value there is `y`. The derivative of `|x|` at 0 is taken as 0.
    pub fn slope(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Neg => -1.0,
            Self::Abs => sign(x),
            Self::Square => 2.0 * x,
            Self::Exp => y,
            Self::Tanh => 1.0 - y * y,
            Self::Sin => libm::cos(x),
            Self::Cos => -libm::sin(x),
            Self::Atan => 1.0 / (1.0 + x * x),
            Self::Sqrt => {
                if y > 0.0 {
                    0.5 * sign(x) / y
                } else {
                    0.0
                }
            }
            Self::Log => {
                if x == 0.0 {
                    0.0
                } else {
                    1.0 / x
                }
            }
        }
    }
}

/// -1, 0 or 1.
pub(in crate::law) fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// `|x|^p` as `exp(p ln |x|)`; zero for `x = 0` and positive `p`.
pub(in crate::law) fn power(x: f64, p: f64) -> f64 {
    libm::exp(p * libm::log(x.abs()))
}

impl From<f64> for Expr {
    fn from(value: f64) -> Self {
        Self::Const(value)
    }
}

impl std::ops::Add for Expr {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self::Add(Box::new(self), Box::new(rhs))
    }
}

impl std::ops::Sub for Expr {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self::Sub(Box::new(self), Box::new(rhs))
    }
}

impl std::ops::Mul for Expr {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        Self::Mul(Box::new(self), Box::new(rhs))
    }
}

impl std::ops::Div for Expr {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        Self::Div(Box::new(self), Box::new(rhs))
    }
}

impl std::ops::Neg for Expr {
    type Output = Self;
    fn neg(self) -> Self {
        self.then(Unary::Neg)
    }
}

impl Expr {
    /// The function applied to this expression.
    pub fn then(self, function: Unary) -> Self {
        Self::Unary(function, Box::new(self))
    }

    /// `|self|^exponent`.
    pub fn pow(self, exponent: Self) -> Self {
        Self::Pow(Box::new(self), Box::new(exponent))
    }

    /// `|self|`.
    pub fn abs(self) -> Self {
        self.then(Unary::Abs)
    }

    /// `exp(self)`.
    pub fn exp(self) -> Self {
        self.then(Unary::Exp)
    }

    /// The operands, left to right.
    pub fn children(&self) -> impl Iterator<Item = &Self> {
        let (a, b) = match self {
            Self::Const(_) | Self::Param(_) | Self::Input(_) => (None, None),
            Self::Unary(_, x) => (Some(x), None),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) | Self::Pow(a, b) => {
                (Some(a), Some(b))
            }
        };
        a.into_iter().chain(b).map(AsRef::as_ref)
    }

    /// Number of nodes: every operator, input and constant counts one. This is the complexity that is reported.
    pub fn node_count(&self) -> usize {
        1 + self.children().map(Self::node_count).sum::<usize>()
    }

    /// Value at one sample: `inputs[i]` is channel `i`, `params[k]` the constant `Param(k)`.
    ///
    /// # Panics
    /// When an input or parameter index is out of range.
    pub fn value(&self, inputs: &[f64], params: &[f64]) -> f64 {
        let at = |e: &Self| e.value(inputs, params);
        match self {
            Self::Const(c) => *c,
            Self::Param(k) => params[*k],
            Self::Input(i) => inputs[*i],
            Self::Add(a, b) => at(a) + at(b),
            Self::Sub(a, b) => at(a) - at(b),
            Self::Mul(a, b) => at(a) * at(b),
            Self::Div(a, b) => at(a) / at(b),
            Self::Pow(a, b) => power(at(a), at(b)),
            Self::Unary(f, x) => f.apply(at(x)),
        }
    }

    /// The same expression with every `Param(k)` replaced by `Const(params[k])`.
    ///
    /// # Panics
    /// When a parameter index is out of range.
    pub fn bind(&self, params: &[f64]) -> Self {
        self.map_leaves(&|leaf| match leaf {
            Self::Param(k) => Self::Const(params[*k]),
            other => other.clone(),
        })
    }

    /// The same expression with every leaf passed through `change`.
    pub fn map_leaves(&self, change: &impl Fn(&Self) -> Self) -> Self {
        let go = |e: &Self| Box::new(e.map_leaves(change));
        match self {
            Self::Const(_) | Self::Param(_) | Self::Input(_) => change(self),
            Self::Add(a, b) => Self::Add(go(a), go(b)),
            Self::Sub(a, b) => Self::Sub(go(a), go(b)),
            Self::Mul(a, b) => Self::Mul(go(a), go(b)),
            Self::Div(a, b) => Self::Div(go(a), go(b)),
            Self::Pow(a, b) => Self::Pow(go(a), go(b)),
            Self::Unary(f, x) => Self::Unary(*f, go(x)),
        }
    }

    /// The operators in postfix order, as a stack machine runs them.
    pub fn postfix(&self) -> Vec<Step> {
        let mut steps = Vec::with_capacity(self.node_count());
        self.push_postfix(&mut steps);
        steps
    }

    fn push_postfix(&self, steps: &mut Vec<Step>) {
        self.children().for_each(|child| child.push_postfix(steps));
        steps.push(match self {
            Self::Const(c) => Step::Const(*c),
            Self::Param(k) => Step::Param(*k),
            Self::Input(i) => Step::Input(*i),
            Self::Add(..) => Step::Add,
            Self::Sub(..) => Step::Sub,
            Self::Mul(..) => Step::Mul,
            Self::Div(..) => Step::Div,
            Self::Pow(..) => Step::Pow,
            Self::Unary(f, _) => Step::Unary(*f),
        });
    }
}

/// One step of the postfix form. A binary step takes the right operand from the top of the stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Push a number.
    Const(f64),
    /// Push a constant that is still to be fitted (never in a bound law).
    Param(usize),
    /// Push a channel.
    Input(usize),
    /// Pop two, push the sum.
    Add,
    /// Pop two, push the difference.
    Sub,
    /// Pop two, push the product.
    Mul,
    /// Pop two, push the quotient.
    Div,
    /// Pop exponent and base, push `|base|^exponent`.
    Pow,
    /// Replace the top.
    Unary(Unary),
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(p0 + p1 exp(-|v|/p2)) tanh(p3 v) + p4 v`
    fn stribeck() -> Expr {
        let v = || Expr::Input(0);
        (Expr::Param(0) + Expr::Param(1) * (-(v().abs() / Expr::Param(2))).exp())
            * (Expr::Param(3) * v()).then(Unary::Tanh)
            + Expr::Param(4) * v()
    }

    #[test]
    fn the_reference_law_has_nineteen_nodes_and_the_value_of_the_equation() {
        let params = [22.0, 8.0, 0.1, 50.0, 0.03];
        assert_eq!(stribeck().node_count(), 19);
        let v: f64 = -0.07;
        let expected = (22.0 + 8.0 * (-0.7f64).exp()) * (50.0 * v).tanh() + 0.03 * v;
        assert!((stribeck().value(&[v], &params) - expected).abs() < 1e-12);
        assert_eq!(stribeck().bind(&params).value(&[v], &[]), stribeck().value(&[v], &params));
    }

    #[test]
    fn postfix_runs_on_a_stack_to_the_same_bits() {
        let law = stribeck().bind(&[22.0, 8.0, 0.1, 50.0, 0.03]);
        let mut stack = Vec::new();
        for step in law.postfix() {
            let two = |f: fn(f64, f64) -> f64, s: &mut Vec<f64>| {
                let b = s.pop().unwrap();
                let a = s.pop().unwrap();
                s.push(f(a, b));
            };
            match step {
                Step::Const(c) => stack.push(c),
                Step::Input(_) => stack.push(0.33),
                Step::Param(_) => unreachable!("bound"),
                Step::Add => two(|a, b| a + b, &mut stack),
                Step::Sub => two(|a, b| a - b, &mut stack),
                Step::Mul => two(|a, b| a * b, &mut stack),
                Step::Div => two(|a, b| a / b, &mut stack),
                Step::Pow => two(power, &mut stack),
                Step::Unary(f) => {
                    let x = stack.pop().unwrap();
                    stack.push(f.apply(x));
                }
            }
        }
        assert_eq!(stack, [law.value(&[0.33], &[])]);
    }
}
