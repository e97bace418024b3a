//! Why a model is refused, and the ranges that all numbers of a model keep to.

/// Why a model is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InvalidModel {
    /// The model has no input.
    NoInput,
    /// A standard quantity occurs twice among the inputs.
    DuplicateInput,
    /// The trained range of an input is empty, inverted, not finite, or beyond 1e9.
    InputRange,
    /// The output limit is not a positive finite number, or the tables of the law exceed it.
    OutputLimit,
    /// A rigid-body parameter is not finite.
    RigidBody,
    /// The law needs another number of inputs.
    LawInputs,
    /// The layout of a table is out of its documented range.
    TableShape,
    /// A table reaches beyond the pool of coefficients.
    CellOutOfPool,
    /// A coefficient of a cell is infinite, NaN, subnormal, or too large.
    Coefficient,
    /// Layers and sources of a network do not fit each other.
    NetworkShape,
    /// The program of an expression cannot be evaluated.
    Program(ProgramFault),
    /// A coefficient of an effect is not finite, or a scale of it is not above zero.
    EffectCoefficient,
    /// An effect needs an input that the model does not have.
    EffectInput,
    /// A frictional lag that is not the first effect: the law sees the velocity that it gives.
    LagNotFirst,
}

/// What is wrong with a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ProgramFault {
    /// The program has no operation.
    Empty,
    /// An operation lacks an operand.
    MissingOperand,
    /// The stack grows beyond `MAX_DEPTH` of the expressions.
    TooDeep,
    /// More than one value is left at the end.
    ValuesLeft,
    /// An operation reads an input that the model does not have.
    NoSuchInput,
    /// A constant is not finite.
    NonFiniteConstant,
}

/// Largest magnitude of a trained range and of a coefficient: keeps every sum of a table and of a state finite.
pub(crate) const LARGEST: f32 = 1.0e9;

pub(crate) fn ensure(holds: bool, otherwise: InvalidModel) -> Result<(), InvalidModel> {
    if holds { Ok(()) } else { Err(otherwise) }
}

/// A coefficient or the end of a range.
#[cfg(feature = "models")]
pub(crate) fn bounded(x: f32) -> bool {
    // Patterns order magnitudes, without the flags of a comparison of floats.
    x.abs().to_bits() <= LARGEST.to_bits()
}

/// A scale by which something is divided.
pub(crate) fn scale(x: f32) -> bool {
    ((1.0 / LARGEST).to_bits()..=LARGEST.to_bits()).contains(&x.to_bits())
}
