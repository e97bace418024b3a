//! Which structures are laws that a person would write down.

use super::structure::{Modulation, Shape, Structure, Term};

/// Whether a structure is one that a person would write down: no two terms for the same thing.
pub fn admissible(structure: &Structure) -> bool {
    let count = |f: &dyn Fn(&Term) -> bool| structure.terms().iter().filter(|t| f(t)).count();
    let plain = |t: &Term| t.modulation == Modulation::Plain;
    let one_stribeck = count(&|t| plain(t) && t.shape.is_stribeck()) <= 1;
    let stribeck_shapes: Vec<Shape> = structure.terms().iter().map(|t| t.shape).filter(|s| s.is_stribeck()).collect();
    let one_shape = stribeck_shapes.windows(2).all(|w| w[0] == w[1]);
    let one_power = count(&|t| t.shape.is_power() || t.shape == Shape::Quadratic) <= 1;
    let decays = |shape| count(&|t| t.shape == shape && matches!(t.modulation, Modulation::Decay(_)));
    let plains = |shape| count(&|t| t.shape == shape && plain(t));
    // A decay already holds its value at the reference temperature.
    let one_decay = [Shape::Sign, Shape::Viscous].into_iter().all(|s| decays(s) == 0 || plains(s) == 0);
    // What declines from the static to the Coulomb level, and what differs between directions, needs a Coulomb level.
    let based =
        count(&|t| t.shape == Shape::Sign) > 0 || count(&|t| t.shape.is_stribeck() || t.shape == Shape::AbsSign) == 0;
    one_stribeck && one_shape && one_power && one_decay && based
}
