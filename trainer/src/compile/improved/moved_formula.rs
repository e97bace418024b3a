//! A formula whose constants a refit has moved. The refit is linear in the constants, the formula is not: where they move far, the formula
//! with moved constants is another law than the one that was refitted.

use crate::compile::host_model::HostModel;
use crate::diagnose::comparison::from_model::{DIFFERENCE_STEP_SHARE, constant_at, law_at, mean_measurement, moved};
use crate::physics::JointState;
use frikan_runtime::friction::Measurement;
use frikan_shared::units::Quantity;

/// Largest deviation of the moved formula from the refitted law, as a share of that law's root mean square over velocity. Chosen by
/// judgement: a twentieth of the friction is what a refit of Coulomb and viscous friction tells apart.
const DEVIATION_SHARE: f64 = 0.05;
/// Velocities at which both are compared.
const COMPARED_VELOCITIES: usize = 65;

/// The law after a refit.
pub(super) enum MovedFormula {
    /// The formula with its constants moved.
    Formula(Box<HostModel>),
    /// The refitted law over velocity: the formula and its slopes by each constant times what the constant moves.
    Curve(Tangent),
}

/// A formula of velocity with its slopes by its constants.
pub(super) struct Tangent {
    model: Box<HostModel>,
    /// Channels besides the velocity.
    mean: Measurement,
    /// The formula with one constant a step higher and a step lower, and how many such differences the constant moves.
    slopes: Vec<([Box<HostModel>; 2], f64)>,
}

impl Tangent {
    fn of(model: &HostModel, places: &[usize], by: &[f64], state: &JointState) -> Option<Self> {
        let slopes = places.iter().zip(by).map(|(place, by)| {
            let step = DIFFERENCE_STEP_SHARE * constant_at(model, *place)?.abs().max(1e-3);
            let shifted = |step| moved(model.clone(), *place, step).map(Box::new);
            Some(([shifted(step)?, shifted(-step)?], by / (2.0 * step)))
        });
        let mean = mean_measurement(state);
        Some(Self { model: Box::new(model.clone()), mean, slopes: slopes.collect::<Option<_>>()? })
    }

    /// The refitted law at a velocity, other channels at their mean.
    pub(super) fn at(&self, velocity: f64) -> f64 {
        let mean = &self.mean;
        let slope = |([up, down], factor): &([Box<HostModel>; 2], f64)| {
            factor * (law_at(up, mean, velocity) - law_at(down, mean, velocity))
        };
        law_at(&self.model, mean, velocity) + self.slopes.iter().map(slope).sum::<f64>()
    }
}

/// The formula of `model` with the constants at `places` moved `by` so much where that is the refitted law to a twentieth, else that law
/// over velocity; `None` where neither is a model: a formula of several channels is no curve over velocity.
pub(super) fn moved_formula(
    model: &HostModel,
    places: &[usize],
    by: &[f64],
    state: &JointState,
) -> Option<MovedFormula> {
    let tangent = Tangent::of(model, places, by, state)?;
    let formula = places
        .iter()
        .zip(by)
        .try_fold(Box::new(model.clone()), |law, (place, by)| moved(*law, *place, *by).map(Box::new));
    if let Some(formula) = formula.filter(|formula| is_near(formula, &tangent, state.top_speed())) {
        return Some(MovedFormula::Formula(formula));
    }
    let is_by_velocity_alone = model.inputs.iter().all(|input| input.quantity == Quantity::Velocity);
    is_by_velocity_alone.then_some(MovedFormula::Curve(tangent))
}

fn is_near(formula: &HostModel, tangent: &Tangent, top: f64) -> bool {
    let middle = (COMPARED_VELOCITIES / 2) as f64;
    let (deviation, size) = (0..COMPARED_VELOCITIES)
        .map(|index| top * (index as f64 - middle) / middle)
        .map(|velocity| (law_at(formula, &tangent.mean, velocity), tangent.at(velocity)))
        .fold((0.0, 0.0), |(deviation, size), (law, refitted)| {
            (deviation + (law - refitted) * (law - refitted), size + refitted * refitted)
        });
    deviation <= DEVIATION_SHARE * DEVIATION_SHARE * size
}
