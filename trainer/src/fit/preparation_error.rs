//! What errors of the preparation do to constants that are linear in the torque: noise of the acceleration takes a share of the inertia, for which
//! gravity and friction make up; and a delay of the torque that the samples do not show passes for viscous friction.

use super::data::gather::{MOST_ATTENUATION, Material, RigidColumn};
use super::data::rigid::{attenuation, names};
use crate::numerics::regression::Columns;
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;

/// Widens the intervals of constants by what both errors may have moved them; that of the inertia allows for its own share already.
pub(super) fn allow_for(parameters: &mut [Parameter], material: &Material) {
    let named = |column: &RigidColumn| (names(column.kind, material.samples.axis).0, material.pick(&column.values));
    let (inertia, others): (Vec<_>, Vec<_>) = material.columns.iter().partition(|column| column.kind.is_inertia());
    let velocity = material.pick(material.samples.velocity.as_deref().unwrap_or_default());
    let sign = velocity.iter().map(|v| v.signum()).collect();
    let friction = [("coulomb_torque", sign), ("viscous_coefficient", velocity)];
    let (constants, columns): (Vec<&str>, Vec<Vec<f64>>) = others.into_iter().map(named).chain(friction).unzip();
    let beside = Columns::of(&columns);

    if let Some((name, acceleration)) = inertia.first().map(|column| named(column)) {
        let share = attenuation(material).min(MOST_ATTENUATION);
        let found = parameters.iter().find(|parameter| parameter.name == name).map_or(0.0, |inertia| inertia.value);
        let missing = found * share / (1.0 - share);
        for (constant, held) in constants.iter().zip(beside.coefficients(&acceleration)) {
            let moved = -held * missing;
            change(parameters, constant, |[low, high]| [low + moved.min(0.0), high + moved.max(0.0)]);
        }
    }
    if let Some(rate) = material.rate_of_rigid_body().filter(|_| material.unknown_delay_s > 0.0) {
        for (constant, of_rate) in constants.iter().zip(beside.coefficients(&rate)) {
            let error = NORMAL_95 * of_rate * material.unknown_delay_s;
            change(parameters, constant, |[low, high]| {
                let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).hypot(error));
                [middle - half, middle + half]
            });
        }
    }
}

/// Changes the interval of the parameter of a name where it has one.
fn change(parameters: &mut [Parameter], name: &str, by: impl Fn([f64; 2]) -> [f64; 2]) {
    let of_name = parameters.iter_mut().filter(|parameter| parameter.name == name);
    for parameter in of_name.filter(|parameter| parameter.ci95.iter().all(|bound| bound.is_finite())) {
        parameter.ci95 = by(parameter.ci95);
    }
}
