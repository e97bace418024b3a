//! What errors of the preparation do to constants that are linear in the torque: noise of the acceleration takes a share of the inertia, for which
//! gravity and friction make up; and a delay of the torque that the samples do not show passes for viscous friction.

use super::data::gather::{MOST_ATTENUATION, Material};
use super::data::rigid::{attenuation, beside, name};
use crate::numerics::regression::Columns;
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;

/// Widens the intervals of constants by what both errors may have moved them; that of the inertia allows for its own share already.
pub(super) fn allow_for(parameters: &mut [Parameter], material: &Material) {
    let inertia = material.columns.iter().position(|column| column.kind.is_inertia());
    let (constants, columns) = beside(material, inertia);
    let beside = Columns::of(&columns);
    if let Some(index) = inertia {
        let share = attenuation(material).min(MOST_ATTENUATION);
        let column = &material.columns[index];
        let found = parameters.iter().find(|parameter| parameter.name == name(material, column));
        let missing = found.map_or(0.0, |inertia| inertia.value) * share / (1.0 - share);
        let acceleration = material.pick(&column.values);
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

/// Changes the interval of the parameter of a name or symbol where it has one.
fn change(parameters: &mut [Parameter], called: &str, by: impl Fn([f64; 2]) -> [f64; 2]) {
    let is_called = |parameter: &&mut Parameter| parameter.name == called || parameter.symbol == called;
    let has_interval = |parameter: &&mut Parameter| parameter.ci95.iter().all(|bound| bound.is_finite());
    for parameter in parameters.iter_mut().filter(is_called).filter(has_interval) {
        parameter.ci95 = by(parameter.ci95);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_is_found_whatever_the_actuator_is_measured_in() {
        let named = |name: &str, ci95: [f64; 2]| Parameter {
            name: name.to_owned(),
            symbol: "F_c".to_owned(),
            value: 1.0,
            unit: "N".to_owned(),
            ci95,
        };
        let open = [f64::NEG_INFINITY, f64::INFINITY];
        let mut parameters =
            [named("coulomb_force", [0.9, 1.1]), named("coulomb_torque", [0.9, 1.1]), named("coulomb_current", open)];
        change(&mut parameters, "F_c", |[low, high]| [low - 1.0, high + 1.0]);
        assert!(parameters[..2].iter().all(|parameter| (parameter.ci95[0] + 0.1).abs() < 1e-12));
        assert_eq!(parameters[2].ci95, open);
    }
}
