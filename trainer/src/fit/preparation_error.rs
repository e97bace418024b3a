//! What errors of the preparation do to constants that are linear in the torque: noise of the acceleration takes a share of the inertia, for which
//! gravity and friction make up; and a delay of the torque that the samples do not show passes for viscous friction.

use super::data::gather::{MOST_ATTENUATION, Material};
use super::data::rigid::{attenuation, names};
use crate::numerics::regression::Columns;
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;

/// Widens the intervals of constants by what both errors may have moved them; that of the inertia allows for its own share already.
pub(super) fn allow_for(parameters: &mut [Parameter], material: &Material) {
    let inertia = material.columns.iter().position(|column| column.kind.is_inertia());
    let mut columns: Vec<(&str, Vec<f64>)> = Vec::new();
    for (place, column) in material.columns.iter().enumerate().filter(|(place, _)| Some(*place) != inertia) {
        columns.push((names(column.kind, material.samples.axis).0, material.pick(&material.columns[place].values)));
    }
    let velocity = material.pick(material.samples.velocity.as_deref().unwrap_or_default());
    columns.push(("coulomb_torque", velocity.iter().map(|v| v.signum()).collect()));
    columns.push(("viscous_coefficient", velocity));
    let (names, columns): (Vec<&str>, Vec<Vec<f64>>) = columns.into_iter().unzip();
    let beside = Columns::of(&columns);
    if let Some(place) = inertia {
        let share = attenuation(material).min(MOST_ATTENUATION);
        let value = parameters
            .iter()
            .find(|parameter| parameter.name == self::names(material.columns[place].kind, material.samples.axis).0);
        let missing = value.map_or(0.0, |inertia| inertia.value * share / (1.0 - share));
        let held = beside.coefficients(&material.pick(&material.columns[place].values));
        for (name, held) in names.iter().zip(held) {
            moved(parameters, name, |[low, high]| {
                [low + (-held * missing).min(0.0), high + (-held * missing).max(0.0)]
            });
        }
    }
    if let Some(rate) = material.rate_of_rigid_body().filter(|_| material.unknown_delay_s > 0.0) {
        for (name, of_rate) in names.iter().zip(beside.coefficients(&rate)) {
            let error = NORMAL_95 * of_rate * material.unknown_delay_s;
            moved(parameters, name, |[low, high]| {
                let middle = 0.5 * (low + high);
                let half = (0.5 * (high - low)).hypot(error);
                [middle - half, middle + half]
            });
        }
    }
}

/// Changes the interval of the parameter of a name where it has one.
fn moved(parameters: &mut [Parameter], name: &str, change: impl Fn([f64; 2]) -> [f64; 2]) {
    for parameter in parameters.iter_mut().filter(|parameter| parameter.name == name) {
        if parameter.ci95.iter().all(|bound| bound.is_finite()) {
            parameter.ci95 = change(parameter.ci95);
        }
    }
}
