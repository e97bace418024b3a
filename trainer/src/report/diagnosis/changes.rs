//! What each parameter is in the model compared with, and what it has to become.

use frikan_shared::model::RigidBody;

use crate::diagnose::answer::outcome::{Diagnosis, Estimate, Finding};
use crate::figures::{estimate, interval, quantity};
use crate::parameter::Parameter;
use crate::physics::units::Units;
use crate::report::tell::evidence::parameter;

/// A parameter of the model before and after.
struct Change {
    /// As it is afterwards, with its interval.
    after: Parameter,
    /// As it is in the model compared with; `None` where that has no such parameter.
    before: Option<f64>,
}

/// Header of the rows below.
pub(super) const HEADER: [&str; 3] = ["parameter", "model \u{2192} joint", "95 % interval"];

/// Rows of a table: the parameters of a finding; `body` is the rigid body of the model compared with.
pub(super) fn of_finding(
    diagnosis: &Diagnosis,
    found: &Finding,
    body: Option<&RigidBody>,
    units: Units,
) -> Vec<Vec<String>> {
    let change = |estimate: &Estimate| {
        let after = parameter(estimate, units);
        if let Some(held) = body.and_then(|body| held(body, estimate.name)) {
            return corrected(after, f64::from(held));
        }
        // Of a level the finding has what is right, and the base what it changed by.
        let by = diagnosis.base_parameters.iter().find(|base| base.name.strip_suffix("_change") == Some(estimate.name));
        Change { before: by.map(|by| after.value - by.value), after }
    };
    // A change is told by what it changes.
    let told = found.parameters.iter().filter(|estimate| !estimate.name.ends_with("_change"));
    told.map(change).map(|change| row(change).to_vec()).collect()
}

/// The constant of a rigid body that a correction of that name is added to.
fn held(body: &RigidBody, correction: &str) -> Option<f32> {
    match correction {
        "inertia_correction" => Some(body.inertia),
        "gravity_sine_torque" => Some(body.gravity_sin),
        "gravity_cosine_torque" => Some(body.gravity_cos),
        "torque_offset" => Some(body.offset),
        _ => None,
    }
}

/// What was estimated as a correction, as the corrected value.
fn corrected(by: Parameter, before: f64) -> Change {
    let name = by.name.strip_suffix("_correction").unwrap_or(&by.name).to_string();
    let symbol = by.symbol.strip_prefix('d').unwrap_or(&by.symbol).to_string();
    let [value, low, high] = [by.value, by.ci95[0], by.ci95[1]].map(|value| before + value);
    Change { before: Some(before), after: Parameter { name, symbol, value, ci95: [low, high], ..by } }
}

fn row(Change { after, before }: Change) -> [String; 3] {
    // Lines break between figures, not between a figure and its unit.
    let whole = |figure: &str| figure.replace(' ', "\u{a0}");
    let bounds = if after.ci95[1] > after.ci95[0] { interval(after.ci95, &after.unit) } else { String::new() };
    let before = before.map_or_else(|| "none".to_string(), |before| quantity(before, &after.unit));
    let now = estimate(after.value, after.ci95, &after.unit);
    let values = format!("{}\u{a0}\u{2192} {}", whole(&before), whole(&now));
    [after.name.replace('_', " "), values, whole(&bounds).replace("to\u{a0}", "to ")]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_interval_keeps_its_digits_and_its_value() {
        let after = Parameter {
            name: "coulomb_torque".to_owned(),
            symbol: "F_c".to_owned(),
            value: 1.5,
            unit: "N m".to_owned(),
            ci95: [1.4965, 1.5035],
        };
        let cells = row(Change { after, before: Some(1.0) }).map(|cell| cell.replace('\u{a0}', " "));
        assert_eq!(cells, ["coulomb torque", "1 N m \u{2192} 1.5000 N m", "1.4965 to 1.5035 N m"]);
    }
}
