//! Which terms the data allow and which change of a structure is one move of the search.

use crate::law::fitting::problem::{Fit, Problem};
use crate::law::model::admissible::admissible;
use crate::law::model::data::{ChannelRole, LawData};
use crate::law::model::structure::{Modulation, Nonlinear, Shape, SignForm, Structure, Term};

/// Most terms of a law.
pub const MOST_TERMS: usize = 6;

/// A change of a fitted structure: terms taken out, terms put in, the sign form afterwards.
#[derive(Clone, Debug)]
pub struct Move {
    /// Taken out.
    pub removed: Vec<Term>,
    /// Put in.
    pub added: Vec<Term>,
    /// Smoothing afterwards.
    pub sign: SignForm,
}

/// The terms that the channels of the data allow. A ripple comes as sine and cosine together.
pub fn terms(data: &LawData, problem: &Problem<'_>) -> Vec<Vec<Term>> {
    let plain = [
        Shape::Sign,
        Shape::StribeckExponential,
        Shape::StribeckGaussian,
        Shape::SignPower,
        Shape::Viscous,
        Shape::Quadratic,
        Shape::OddPower,
        Shape::OddRoot,
        Shape::AbsSign,
        Shape::AbsViscous,
        Shape::Offset,
    ];
    let mut all: Vec<Vec<Term>> = plain.iter().map(|s| vec![Term::plain(*s)]).collect();
    for (i, channel) in data.channels.iter().enumerate().filter(|(i, _)| problem.extents().varies(*i)) {
        let mut one = |shape, modulation| all.push(vec![Term { shape, modulation }]);
        match channel.role {
            ChannelRole::Velocity => {}
            ChannelRole::Load | ChannelRole::Other => {
                one(Shape::Sign, Modulation::Magnitude(i));
                one(Shape::StribeckExponential, Modulation::Magnitude(i));
                one(Shape::Viscous, Modulation::Magnitude(i));
                one(Shape::Sign, Modulation::Value(i));
                one(Shape::Offset, Modulation::Value(i));
            }
            ChannelRole::Temperature => {
                one(Shape::Viscous, Modulation::Decay(i));
                one(Shape::Viscous, Modulation::Difference(i));
                one(Shape::Sign, Modulation::Decay(i));
                one(Shape::Sign, Modulation::Difference(i));
            }
            ChannelRole::Position => {
                for shape in [Shape::Offset, Shape::Sign] {
                    let both = [Modulation::Sine(i), Modulation::Cosine(i)];
                    all.push(both.map(|modulation| Term { shape, modulation }).to_vec());
                }
            }
        }
    }
    all
}

/// All moves from a structure.
pub fn moves(structure: &Structure, library: &[Vec<Term>]) -> Vec<Move> {
    let sign = structure.sign();
    let mut all = Vec::new();
    for added in library {
        let new: Vec<Term> = added.iter().copied().filter(|t| !structure.has(*t)).collect();
        if !new.is_empty() {
            all.push(Move { removed: Vec::new(), added: new, sign });
        }
    }
    for &removed in structure.terms() {
        all.push(Move { removed: vec![removed], added: Vec::new(), sign });
        let kin =
            library.iter().filter(|a| a.iter().all(|t| !structure.has(*t)) && a.iter().any(|t| related(removed, *t)));
        all.extend(kin.map(|added| Move { removed: vec![removed], added: added.clone(), sign }));
        if removed.shape.is_stribeck() && removed.modulation == Modulation::Plain {
            let general = Term::plain(Shape::StribeckPower);
            if !structure.has(general) {
                all.push(Move { removed: vec![removed], added: vec![general], sign });
            }
        }
    }
    if structure.nonlinear().contains(&Nonlinear::Smoothing) {
        let forms = [SignForm::Tanh, SignForm::Arctan, SignForm::Algebraic, SignForm::Parabolic, SignForm::Cubic];
        all.extend(forms.into_iter().filter(|f| *f != sign).map(|f| Move {
            removed: Vec::new(),
            added: Vec::new(),
            sign: f,
        }));
    }
    all.retain(|m| {
        let after = m.apply(structure);
        after.terms().len() <= MOST_TERMS && admissible(&after)
    });
    all
}

/// Whether one term is an alternative for another: the same shape with another factor, or shapes that look alike.
fn related(a: Term, b: Term) -> bool {
    let family = |s: Shape| match s {
        Shape::StribeckExponential | Shape::StribeckGaussian | Shape::StribeckPower | Shape::Breakaway => 0,
        Shape::SignPower | Shape::OddPower | Shape::OddRoot | Shape::Quadratic | Shape::Viscous => 1,
        Shape::AbsSign | Shape::AbsViscous | Shape::Offset => 2,
        Shape::Sign => 3,
    };
    let ripple = |t: Term| matches!(t.modulation, Modulation::Sine(_) | Modulation::Cosine(_));
    (a.modulation == b.modulation && family(a.shape) == family(b.shape))
        || (a.shape == b.shape && a.modulation != b.modulation && !ripple(b))
}

impl Move {
    /// The structure after the move.
    pub fn apply(&self, structure: &Structure) -> Structure {
        let kept = structure.terms().iter().copied().filter(|t| !self.removed.contains(t));
        Structure::new(self.sign, kept.chain(self.added.iter().copied()))
    }

    /// Constants to start from: those of the fit. Another smoothing of the sign looks for its width afresh.
    pub fn carry_over(&self, fit: &Fit) -> Vec<(Nonlinear, f64)> {
        let kept = |n: &Nonlinear| *n != Nonlinear::Smoothing || fit.structure.sign() == self.sign;
        fit.nonlinear().into_iter().filter(|(n, _)| kept(n)).collect()
    }
}
