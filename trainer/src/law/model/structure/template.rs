//! A structure as an expression: its terms as columns, and the whole law with the smoothed sign factored out.

use std::f64::consts::FRAC_2_PI;

use super::{Layout, Modulation, Nonlinear, Shape, SignForm, Structure, Term};
use crate::law::model::expression::{Expr, Unary};

/// Keeps a power of the speed with a negative exponent finite at rest, velocity unit.
const SPEED_FLOOR: f64 = 1e-9;

impl Structure {
    /// The terms as expressions of the non-linear parameters, without their coefficients.
    pub fn columns(&self, layout: &Layout) -> Vec<Expr> {
        let build = Builder { structure: self, layout, nonlinear: self.nonlinear() };
        self.terms.iter().map(|t| build.column(*t)).collect()
    }

    /// The whole law, the smoothed sign factored out of the terms that hold it.
    pub fn template(&self, layout: &Layout) -> Expr {
        let build = Builder { structure: self, layout, nonlinear: self.nonlinear() };
        let first = build.nonlinear.len();
        let mut bracket: Option<Expr> = None;
        let mut rest: Option<Expr> = None;
        for (i, term) in self.terms.iter().enumerate() {
            let coefficient = Expr::Param(first + i);
            let sum = if term.shape.has_sign() { &mut bracket } else { &mut rest };
            let part = build.factor(*term).map_or(coefficient.clone(), |f| coefficient * f);
            *sum = Some(sum.take().map_or(part.clone(), |s| s + part));
        }
        match (bracket.map(|b| b * build.sign()), rest) {
            (Some(b), Some(r)) => b + r,
            (Some(e), None) | (None, Some(e)) => e,
            (None, None) => Expr::Const(0.0),
        }
    }
}

struct Builder<'a> {
    structure: &'a Structure,
    layout: &'a Layout,
    nonlinear: Vec<Nonlinear>,
}

impl Builder<'_> {
    fn v(&self) -> Expr {
        Expr::Input(self.layout.velocity)
    }

    fn param(&self, which: Nonlinear) -> Expr {
        Expr::Param(self.nonlinear.iter().position(|n| *n == which).expect("a term lists the constants it uses"))
    }

    /// `v` clipped to ±`w`: `(|v + w| - |v - w|)/2`.
    fn clipped(&self, width: Nonlinear) -> Expr {
        let w = || self.param(width);
        Expr::Const(0.5) * ((self.v() + w()).abs() - (self.v() - w()).abs())
    }

    fn sign(&self) -> Expr {
        let k = || self.param(Nonlinear::Smoothing);
        let c = || self.clipped(Nonlinear::Smoothing) / k();
        match self.structure.sign {
            SignForm::Tanh => (k() * self.v()).then(Unary::Tanh),
            SignForm::Arctan => Expr::Const(FRAC_2_PI) * (k() * self.v()).then(Unary::Atan),
            SignForm::Algebraic => {
                self.v() / (self.v().then(Unary::Square) + k().then(Unary::Square)).then(Unary::Sqrt)
            }
            SignForm::Parabolic => c() * (Expr::Const(2.0) - c().abs()),
            SignForm::Cubic => c() * (Expr::Const(1.5) - Expr::Const(0.5) * c().then(Unary::Square)),
        }
    }

    /// `|v|`, or for the clipped signs the speed above their width, where their Stribeck decline begins.
    fn declining_speed(&self) -> Expr {
        match self.structure.sign {
            SignForm::Parabolic | SignForm::Cubic => self.v().abs() - self.clipped(Nonlinear::Smoothing).abs(),
            SignForm::Tanh | SignForm::Arctan | SignForm::Algebraic => self.v().abs(),
        }
    }

    /// The shape without the smoothed sign; `None` is 1.
    fn shape(&self, shape: Shape) -> Option<Expr> {
        let vs = || self.param(Nonlinear::StribeckVelocity);
        match shape {
            Shape::Sign | Shape::Offset => None,
            Shape::StribeckExponential => Some((-(self.declining_speed() / vs())).exp()),
            Shape::StribeckGaussian => {
                let speed = match self.structure.sign {
                    SignForm::Parabolic | SignForm::Cubic => self.declining_speed(),
                    SignForm::Tanh | SignForm::Arctan | SignForm::Algebraic => self.v(),
                };
                Some((-(speed / vs()).then(Unary::Square)).exp())
            }
            Shape::StribeckPower => {
                Some((-(self.declining_speed() / vs()).pow(self.param(Nonlinear::StribeckExponent))).exp())
            }
            Shape::Breakaway => {
                let c = self.clipped(Nonlinear::BreakawayVelocity) / self.param(Nonlinear::BreakawayVelocity);
                Some(Expr::Const(1.0) - c.then(Unary::Square))
            }
            Shape::SignPower => Some(self.v().pow(self.param(Nonlinear::Exponent))),
            Shape::Viscous => Some(self.v()),
            Shape::Quadratic => Some(self.v() * self.v().abs()),
            Shape::OddPower => Some(self.v() * self.v().pow(self.param(Nonlinear::Exponent))),
            Shape::OddRoot => {
                let speed = self.v().abs() + Expr::Const(SPEED_FLOOR);
                Some(self.v() / speed.pow(self.param(Nonlinear::RootExponent)))
            }
            Shape::AbsSign => Some(self.sign().abs()),
            Shape::AbsViscous => Some(self.v().abs()),
        }
    }

    fn modulation(&self, modulation: Modulation) -> Option<Expr> {
        let difference = |i: usize| Expr::Input(i) - Expr::Const(self.layout.references[i]);
        match modulation {
            Modulation::Plain => None,
            Modulation::Magnitude(i) => Some(Expr::Input(i).abs()),
            Modulation::Value(i) => Some(Expr::Input(i)),
            Modulation::Difference(i) => Some(difference(i)),
            Modulation::Decay(i) => Some((-(self.param(Nonlinear::Rate(i)) * difference(i))).exp()),
            Modulation::Sine(i) => Some((self.param(Nonlinear::Order(i)) * Expr::Input(i)).then(Unary::Sin)),
            Modulation::Cosine(i) => Some((self.param(Nonlinear::Order(i)) * Expr::Input(i)).then(Unary::Cos)),
        }
    }

    /// The term without its coefficient and without the smoothed sign; `None` is 1.
    fn factor(&self, term: Term) -> Option<Expr> {
        product(self.modulation(term.modulation), self.shape(term.shape))
    }

    fn column(&self, term: Term) -> Expr {
        let factor = self.factor(term);
        let sign = term.shape.has_sign().then(|| self.sign());
        product(factor, sign).unwrap_or(Expr::Const(1.0))
    }
}

fn product(a: Option<Expr>, b: Option<Expr>) -> Option<Expr> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a * b),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout() -> Layout {
        Layout { velocity: 0, references: vec![0.0, 20.0] }
    }

    fn reference() -> Structure {
        Structure::new(SignForm::Tanh, [Shape::Viscous, Shape::Sign, Shape::StribeckExponential].map(Term::plain))
    }

    #[test]
    fn order_of_terms_does_not_matter_and_the_reference_law_has_nineteen_nodes() {
        let other = Structure::new(SignForm::Tanh, [Term::plain(Shape::StribeckExponential), Term::plain(Shape::Sign)])
            .with(Term::plain(Shape::Viscous));
        assert_eq!(reference(), other);
        assert_eq!(reference().template(&layout()).node_count(), 19);
    }

    #[test]
    fn template_equals_the_sum_of_its_columns() {
        let all = [
            Shape::Sign,
            Shape::StribeckExponential,
            Shape::Breakaway,
            Shape::SignPower,
            Shape::Viscous,
            Shape::AbsSign,
            Shape::Offset,
        ];
        for sign in [SignForm::Tanh, SignForm::Arctan, SignForm::Algebraic, SignForm::Parabolic, SignForm::Cubic] {
            let structure = Structure::new(sign, all.map(Term::plain))
                .with(Term { shape: Shape::Viscous, modulation: Modulation::Decay(1) })
                .with(Term { shape: Shape::Sign, modulation: Modulation::Magnitude(1) });
            let q = structure.nonlinear().len();
            let params: Vec<f64> = (0..q + structure.terms().len()).map(|i| 0.3 + 0.1 * i as f64).collect();
            for v in [-1.3, -0.02, 0.0, 0.4] {
                let inputs = [v, 23.0];
                let sum: f64 = structure
                    .columns(&layout())
                    .iter()
                    .enumerate()
                    .map(|(i, c)| params[q + i] * c.value(&inputs, &params))
                    .sum();
                assert!((structure.template(&layout()).value(&inputs, &params) - sum).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_parabolic_sign_is_that_of_bengisu_and_akay() {
        let structure = Structure::new(SignForm::Parabolic, [Shape::Sign, Shape::StribeckExponential].map(Term::plain));
        let (v0, vs, fc, fs) = (0.05, 0.2, 10.0, 14.0);
        let law = structure.template(&layout());
        for v in [-0.8f64, -0.03, 0.01, 0.05, 0.3] {
            let m = v.abs();
            let expected = v.signum()
                * if m < v0 { fs - fs / (v0 * v0) * (m - v0).powi(2) } else { fc + (fs - fc) * (-(m - v0) / vs).exp() };
            assert!((law.value(&[v, 0.0], &[v0, vs, fc, fs - fc]) - expected).abs() < 1e-12);
        }
    }
}
