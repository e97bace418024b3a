//! Structures to start a search from, read off the activations of a pruned network.

use super::library::MOST_TERMS;
use super::matching::{Function, Match, matches};
use crate::law::model::admissible::admissible;
use crate::law::model::data::ChannelRole;
use crate::law::model::structure::{Modulation, Nonlinear, Shape, SignForm, Structure, Term};

/// Activations whose best function leaves more unexplained than this propose nothing.
const RECOGNITION_THRESHOLD: f64 = 0.02;

/// A structure with some of its non-linear constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Which law.
    pub structure: Structure,
    /// Constants that are known; the others are looked for on their grids.
    pub constants: Vec<(Nonlinear, f64)>,
}

/// What one path of a network does to a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Activation {
    /// Index of the channel.
    pub channel: usize,
    /// What the channel means.
    pub role: ChannelRole,
    /// Points over the channel.
    pub points: Vec<[f64; 2]>,
}

/// A factor of a term, recognised.
#[derive(Clone, Debug)]
enum Factor {
    Velocity(Shape, SignForm),
    Other(Modulation),
}

/// Terms that an activation, or a product of two, suggests.
struct Suggestion {
    terms: Vec<Term>,
    sign: SignForm,
    constants: Vec<(Nonlinear, f64)>,
}

/// A sine comes with its cosine, which together have any phase.
fn with_quadrature(term: Term) -> Vec<Term> {
    match term.modulation {
        Modulation::Sine(channel) => vec![term, Term { modulation: Modulation::Cosine(channel), ..term }],
        _ => vec![term],
    }
}

/// Structures that the activations of a network suggest: `sums` act on the output by themselves, the pairs in `products` by
/// their product. Together, and each beside Coulomb and viscous friction.
#[must_use]
pub fn proposals(sums: &[Activation], products: &[[Activation; 2]]) -> Vec<Start> {
    let mut found: Vec<Suggestion> = Vec::new();
    for activation in sums {
        if let Some((factor, constants)) = recognised(activation) {
            let (term, sign) = match factor {
                Factor::Velocity(shape, sign) => (Term::plain(shape), sign),
                Factor::Other(modulation) => (Term { shape: Shape::Offset, modulation }, SignForm::Tanh),
            };
            found.push(Suggestion { terms: with_quadrature(term), sign, constants });
        }
    }
    for [left, right] in products {
        let (Some((left, mut constants)), Some((right, more))) = (recognised(left), recognised(right)) else {
            continue;
        };
        if let Some((term, sign)) = product(&left, &right) {
            constants.extend(more);
            found.push(Suggestion { terms: with_quadrature(term), sign, constants });
        }
    }
    let base = [Term::plain(Shape::Sign), Term::plain(Shape::Viscous)];
    let mut starts: Vec<Start> = found
        .iter()
        .map(|one| Start {
            structure: Structure::new(one.sign, base.into_iter().chain(one.terms.iter().copied())),
            constants: one.constants.clone(),
        })
        .collect();
    let mut together = Start { structure: Structure::new(SignForm::Tanh, base), constants: Vec::new() };
    for one in &found {
        let wider =
            one.terms.iter().fold(together.structure.clone(), |wider, term| wider.with(*term)).with_sign(one.sign);
        if wider.terms().len() <= MOST_TERMS && admissible(&wider) {
            together.structure = wider;
            together.constants.extend(&one.constants);
        }
    }
    starts.push(together);
    starts.retain(|start| admissible(&start.structure));
    for start in &mut starts {
        let needed = start.structure.nonlinear();
        start.constants.retain(|(constant, value)| needed.contains(constant) && value.is_finite());
    }
    starts.dedup();
    starts
}

fn recognised(activation: &Activation) -> Option<(Factor, Vec<(Nonlinear, f64)>)> {
    let best = matches(&activation.points).into_iter().next().filter(|m| m.unexplained < RECOGNITION_THRESHOLD)?;
    let channel = activation.channel;
    let slope = best.inner[0].abs();
    match activation.role {
        ChannelRole::Velocity => {
            let (shape, sign, constant) = of_velocity(&best)?;
            Some((Factor::Velocity(shape, sign), constant.into_iter().collect()))
        }
        ChannelRole::Position => (best.function == Function::Sine)
            .then(|| (Factor::Other(Modulation::Sine(channel)), vec![(Nonlinear::Order(channel), slope)])),
        ChannelRole::Temperature if best.function == Function::Exp => {
            Some((Factor::Other(Modulation::Decay(channel)), vec![(Nonlinear::Rate(channel), -best.inner[0])]))
        }
        ChannelRole::Temperature => Some((Factor::Other(Modulation::Difference(channel)), Vec::new())),
        ChannelRole::Load | ChannelRole::Other => {
            let modulation = match best.function {
                Function::Line => Modulation::Value(channel),
                _ => Modulation::Magnitude(channel),
            };
            Some((Factor::Other(modulation), Vec::new()))
        }
    }
}

/// A non-linear constant with its value.
type Known = (Nonlinear, f64);

/// Shape over velocity, smoothing of the sign, and the constant that the match fixes.
fn of_velocity(found: &Match) -> Option<(Shape, SignForm, Option<Known>)> {
    let slope = found.inner[0].abs();
    let stribeck = Some((Nonlinear::StribeckVelocity, 1.0 / slope));
    match found.function {
        Function::Line => Some((Shape::Viscous, SignForm::Tanh, None)),
        Function::Absolute => Some((Shape::AbsViscous, SignForm::Tanh, None)),
        Function::SignedSquare => Some((Shape::Quadratic, SignForm::Tanh, None)),
        Function::Tanh => Some((Shape::Sign, SignForm::Tanh, Some((Nonlinear::Smoothing, slope)))),
        Function::Atan => Some((Shape::Sign, SignForm::Arctan, Some((Nonlinear::Smoothing, slope)))),
        Function::Laplace => Some((Shape::StribeckExponential, SignForm::Tanh, stribeck)),
        Function::Gauss => Some((Shape::StribeckGaussian, SignForm::Tanh, stribeck)),
        Function::Square | Function::Exp | Function::Sine => None,
    }
}

/// The term that two factors make: a sign times a decline is Stribeck friction, a shape of velocity times another channel is
/// that shape, modulated.
fn product(left: &Factor, right: &Factor) -> Option<(Term, SignForm)> {
    match (left, right) {
        (Factor::Velocity(shape, sign), Factor::Other(modulation))
        | (Factor::Other(modulation), Factor::Velocity(shape, sign)) => {
            Some((Term { shape: *shape, modulation: *modulation }, *sign))
        }
        (Factor::Velocity(Shape::Sign, sign), Factor::Velocity(decline, _))
        | (Factor::Velocity(decline, _), Factor::Velocity(Shape::Sign, sign))
            if decline.is_stribeck() =>
        {
            Some((Term::plain(*decline), *sign))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(channel: usize, role: ChannelRole, f: impl Fn(f64) -> f64) -> Activation {
        let points = (0..=240).map(|i| -1.0 + f64::from(i) / 120.0).map(|x| [x, f(x)]).collect();
        Activation { channel, role, points }
    }

    #[test]
    fn a_product_of_a_step_and_a_decline_proposes_stribeck_friction_with_its_constants() {
        let pair = [
            over(0, ChannelRole::Velocity, |v| (30.0 * v).tanh()),
            over(0, ChannelRole::Velocity, |v| 1.0 - (-(v / 0.2).abs()).exp()),
        ];
        let starts = proposals(&[over(0, ChannelRole::Velocity, |v| 2.0 * v)], &[pair]);
        let stribeck =
            Structure::new(SignForm::Tanh, [Shape::Sign, Shape::StribeckExponential, Shape::Viscous].map(Term::plain));
        let start = starts.iter().find(|s| s.structure == stribeck).unwrap();
        let constant = |which| start.constants.iter().find(|(n, _)| *n == which).unwrap().1;
        assert!((constant(Nonlinear::Smoothing) - 30.0).abs() < 0.3);
        assert!((constant(Nonlinear::StribeckVelocity) - 0.2).abs() < 2e-3);
    }

    #[test]
    fn other_channels_propose_their_own_terms() {
        let ripple = over(1, ChannelRole::Position, |q| (9.0 * q + 0.3).sin());
        let pair = [over(0, ChannelRole::Velocity, |v| (30.0 * v).tanh()), over(2, ChannelRole::Load, f64::abs)];
        let terms: Vec<Term> =
            proposals(&[ripple], &[pair]).into_iter().flat_map(|s| s.structure.terms().to_vec()).collect();
        assert!(terms.contains(&Term { shape: Shape::Offset, modulation: Modulation::Sine(1) }));
        assert!(terms.contains(&Term { shape: Shape::Sign, modulation: Modulation::Magnitude(2) }));
    }
}
