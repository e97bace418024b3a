//! What the choice of the filter does to constants: the law fitted once more behind the next wider filter. Noise of the states falls with the width and
//! what a filter does to friction grows with it, so that the two differ by about as much as either is wrong; an interval holds both.

use super::formula::{law_data, law_parameters, settled};
use crate::fit::data::gather::{Material, gather};
use crate::fit::data::inputs::{ChosenInput, choose};
use crate::fit::data::rigid;
use crate::fit::preparation_error::allow_for;
use crate::joint::Joint;
use crate::law::{FormFit, Interval};
use crate::parameter::Parameter;
use crate::recording::Recording;
use crate::samples::{Request, WIDTH_STEP};

/// The constants of a law that was fitted to `material`, fitted behind the next wider filter; `None` where nothing is filtered, the recordings are too
/// short for that filter, or the fit does not settle.
pub(in crate::fit) fn at_next_width(
    recordings: &[Recording],
    joint: &Joint,
    request: &Request,
    (material, inputs): (&Material, &[ChosenInput]),
    fit: &FormFit,
) -> Option<Vec<Parameter>> {
    let request = Request { sigma_s: Some(WIDTH_STEP * material.sigma_s?), ..*request };
    let wider = gather(recordings, joint, &request).ok()?;
    let names: Vec<String> = inputs.iter().map(|input| input.name.clone()).collect();
    let (inputs, _) = choose(&wider, Some(&names)).ok()?;
    let structure = &fit.law.structure;
    let count = structure.nonlinear().len();
    let constants: Vec<f64> = fit.law.parameters.iter().take(count).map(|constant| constant.value).collect();
    let (found, _) = settled((structure, &constants), &law_data(&wider, &inputs), Interval::Linearised).ok()?;
    if !found.converged {
        return None;
    }
    let mut parameters = law_parameters(&found.law.parameters);
    parameters.extend(rigid::parameters(&wider, &found.uncertainty.nuisance));
    allow_for(&mut parameters, &wider);
    Some(parameters)
}

/// Widens intervals to hold those of the same constants elsewhere; what has none there or here, or is fixed, stays.
pub(in crate::fit) fn hold_both(parameters: &mut [Parameter], elsewhere: &[Parameter]) {
    for parameter in parameters {
        let same = elsewhere.iter().find(|other| other.name == parameter.name);
        let is_bounded = |[low, high]: &[f64; 2]| low.is_finite() && high.is_finite() && low < high;
        if let Some(other) = same.filter(|other| is_bounded(&other.ci95) && is_bounded(&parameter.ci95)) {
            parameter.ci95 = [parameter.ci95[0].min(other.ci95[0]), parameter.ci95[1].max(other.ci95[1])];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_holds_what_both_widths_tell() {
        let named = |name: &str, ci95: [f64; 2]| Parameter {
            name: name.to_owned(),
            symbol: String::new(),
            value: 1.0,
            unit: String::new(),
            ci95,
        };
        let open = [0.5, f64::INFINITY];
        let mut parameters = [named("inertia", [0.9, 1.1]), named("limit", open), named("smoothing", [1.0, 1.0])];
        hold_both(
            &mut parameters,
            &[named("inertia", [1.0, 1.2]), named("limit", [0.1, 0.2]), named("smoothing", [0.5, 2.0])],
        );
        assert_eq!(parameters.map(|parameter| parameter.ci95), [[0.9, 1.2], open, [1.0, 1.0]]);
    }
}
