//! The one way in which a law is written: constants folded, signs carried by the operators, operands in a fixed order.

use std::cmp::Ordering;

use super::expression::{Expr, Unary};

/// The canonical form: of equal value (up to rounding of folded constants), and the same for laws that differ only in the
/// order of operands, in double negation or in where a sign or a constant factor stands inside a product.
pub fn canonical(e: &Expr) -> Expr {
    match e {
        Expr::Const(_) | Expr::Param(_) | Expr::Input(_) => e.clone(),
        Expr::Unary(Unary::Neg, _) | Expr::Mul(..) | Expr::Div(..) => Product::of(e).build(),
        Expr::Add(..) | Expr::Sub(..) => sum(e),
        Expr::Pow(a, b) => fold(Expr::Pow(Box::new(without_sign(canonical(a))), Box::new(canonical(b)))),
        Expr::Unary(f, x) => function(*f, canonical(x)),
    }
}

fn function(f: Unary, x: Expr) -> Expr {
    let even = matches!(f, Unary::Abs | Unary::Square | Unary::Cos | Unary::Sqrt | Unary::Log);
    let odd = matches!(f, Unary::Tanh | Unary::Sin | Unary::Atan);
    if even {
        return fold(without_sign(x).then(f));
    }
    match (odd, negated(&x)) {
        (true, Some(positive)) => -fold(positive.then(f)),
        _ => fold(x.then(f)),
    }
}

fn without_sign(x: Expr) -> Expr {
    negated(&x).unwrap_or(x)
}

/// The expression with the opposite sign where it visibly carries a minus.
fn negated(x: &Expr) -> Option<Expr> {
    match x {
        Expr::Const(c) if c.is_sign_negative() => Some(Expr::Const(-c)),
        Expr::Unary(Unary::Neg, inner) => Some((**inner).clone()),
        Expr::Mul(a, b) => match &**a {
            Expr::Const(c) if c.is_sign_negative() => Some(Expr::Const(-c) * (**b).clone()),
            _ => None,
        },
        _ => None,
    }
}

/// Evaluates an operator all of whose operands are numbers.
fn fold(e: Expr) -> Expr {
    let numbers = e.children().all(|c| matches!(c, Expr::Const(_)));
    if numbers && e.children().next().is_some() { Expr::Const(e.value(&[], &[])) } else { e }
}

/// A product as constant, factors and divisors.
struct Product {
    constant: f64,
    factors: Vec<Expr>,
    divisors: Vec<Expr>,
}

impl Product {
    fn of(e: &Expr) -> Self {
        let mut product = Self { constant: 1.0, factors: Vec::new(), divisors: Vec::new() };
        product.take(e, false);
        product.factors.sort_by(order);
        product.divisors.sort_by(order);
        product
    }

    fn take(&mut self, e: &Expr, below: bool) {
        match e {
            Expr::Unary(Unary::Neg, x) => {
                self.constant = -self.constant;
                self.take(x, below);
            }
            Expr::Mul(a, b) => {
                self.take(a, below);
                self.take(b, below);
            }
            Expr::Div(a, b) => {
                self.take(a, below);
                self.take(b, !below);
            }
            Expr::Const(c) if !below => self.constant *= c,
            Expr::Param(_) | Expr::Input(_) | Expr::Const(_) => self.put(e.clone(), below),
            _ => match canonical(e) {
                // A sign or number that came to the front joins this product.
                reduced @ (Expr::Unary(Unary::Neg, _) | Expr::Mul(..) | Expr::Const(_)) if reduced != *e => {
                    self.take(&reduced, below);
                }
                reduced => self.put(reduced, below),
            },
        }
    }

    fn put(&mut self, e: Expr, below: bool) {
        if below { self.divisors.push(e) } else { self.factors.push(e) }
    }

    fn build(self) -> Expr {
        if self.constant == 0.0 {
            return Expr::Const(0.0);
        }
        let negative = self.constant < 0.0;
        let magnitude = self.constant.abs();
        let mut factors = self.factors;
        let mut all: Vec<Expr> = Vec::new();
        // Equal neighbours become a square.
        factors.reverse();
        while let Some(f) = factors.pop() {
            if factors.last() == Some(&f) {
                factors.pop();
                all.push(f.then(Unary::Square));
            } else {
                all.push(f);
            }
        }
        let product = all.into_iter().reduce(|a, b| a * b);
        let numerator = match product {
            Some(p) if magnitude == 1.0 => p,
            Some(p) => Expr::Const(magnitude) * p,
            None => Expr::Const(magnitude),
        };
        let quotient = match self.divisors.into_iter().reduce(|a, b| a * b) {
            Some(d) => numerator / d,
            None => numerator,
        };
        match (negative, quotient) {
            (false, e) => e,
            (true, Expr::Const(c)) => Expr::Const(-c),
            (true, e) => -e,
        }
    }
}

fn sum(e: &Expr) -> Expr {
    let mut terms = Vec::new();
    let mut constant = 0.0;
    collect(e, false, &mut terms, &mut constant);
    terms.sort_by(|a, b| order(&a.1, &b.1));
    // A sum starts with a positive term where it has one.
    if let Some(first) = terms.iter().position(|(negative, _)| !negative)
        && constant <= 0.0
    {
        let term = terms.remove(first);
        terms.insert(0, term);
    }
    let mut total = (constant > 0.0).then_some(Expr::Const(constant));
    for (negative, term) in terms {
        total = Some(match (total, negative) {
            (Some(t), false) => t + term,
            (Some(t), true) => t - term,
            (None, false) => term,
            (None, true) => -term,
        });
    }
    match total {
        Some(t) if constant < 0.0 => t - Expr::Const(-constant),
        Some(t) => t,
        None => Expr::Const(constant),
    }
}

fn collect(e: &Expr, negative: bool, terms: &mut Vec<(bool, Expr)>, constant: &mut f64) {
    match e {
        Expr::Add(a, b) => {
            collect(a, negative, terms, constant);
            collect(b, negative, terms, constant);
        }
        Expr::Sub(a, b) => {
            collect(a, negative, terms, constant);
            collect(b, !negative, terms, constant);
        }
        Expr::Const(c) => *constant += if negative { -c } else { *c },
        _ => match canonical(e) {
            Expr::Unary(Unary::Neg, x) => terms.push((!negative, *x)),
            reduced @ (Expr::Add(..) | Expr::Sub(..)) if reduced != *e => collect(&reduced, negative, terms, constant),
            Expr::Const(c) => *constant += if negative { -c } else { c },
            reduced => terms.push((negative, reduced)),
        },
    }
}

/// A total order of expressions that puts products of sums (the bracket of the smoothed sign) first, then longer terms
/// before shorter ones.
fn order(a: &Expr, b: &Expr) -> Ordering {
    let key = |e: &Expr| (std::cmp::Reverse(e.node_count()), shape(e).to_string(), format!("{e:?}"));
    key(a).cmp(&key(b))
}

/// The expression without its numbers, so that the order does not hang on them.
fn shape(e: &Expr) -> String {
    format!("{:?}", e.map_leaves(&|leaf| if matches!(leaf, Expr::Const(_)) { Expr::Const(0.0) } else { leaf.clone() }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v() -> Expr {
        Expr::Input(0)
    }

    #[test]
    fn equal_laws_become_equal() {
        let c = |x: f64| Expr::Const(x);
        let decline = || (-(v().abs() / c(0.1))).exp();
        let one = (c(22.0) + c(8.0) * decline()) * (c(50.0) * v()).then(Unary::Tanh) + c(0.5) * v();
        let other = v() * c(0.5) + (v() * c(50.0)).then(Unary::Tanh) * (decline() * c(8.0) + c(22.0));
        let signs = c(0.5) * v() - (c(-50.0) * v()).then(Unary::Tanh) * (c(22.0) - decline() * c(-8.0));
        assert_eq!(canonical(&one), canonical(&other));
        assert_eq!(canonical(&one), canonical(&signs));
        assert_eq!(canonical(&one).node_count(), 19);
    }

    #[test]
    fn negative_coefficients_become_differences_and_squares_are_seen() {
        let e = Expr::Const(2.0) * v() + Expr::Const(-3.0) * (v() * v());
        let form = canonical(&e);
        assert_eq!(form.node_count(), 8);
        assert!((form.value(&[0.7], &[]) - e.value(&[0.7], &[])).abs() < 1e-15);
        assert_eq!(canonical(&form), form);
    }
}
