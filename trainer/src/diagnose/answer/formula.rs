//! A formula for an unnamed structure, where a simple one says as much as the free function does.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::function_form::{FORMULA_FORMS, Form};
use crate::diagnose::hypotheses::label::{Label, ridge_of};
use crate::diagnose::hypotheses::unnamed::Generic;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::search::accepted::{Accepted, others};
use crate::figures::digits;
use crate::numerics::pattern_search::climb;
use crate::physics::Shape;
use rayon::prelude::*;

/// The equation of an unnamed structure beside the other effects, with its coefficients where a formula carries it: each
/// coefficient and each parameter of the shape is paid for (Schwarz 1978), and the formula has to be worth what the
/// structure is as it was accepted.
pub(crate) fn equation(
    workbench: &Workbench,
    accepted: &[Accepted],
    index: usize,
    rival: Generic,
    noise: &Noise,
) -> String {
    let unwritten = || format!("dF = {} c({})", rival.factor.text(), rival.channel.name());
    formula(workbench, accepted, index, rival, noise).unwrap_or_else(unwritten)
}

fn formula(
    workbench: &Workbench,
    accepted: &[Accepted],
    index: usize,
    rival: Generic,
    noise: &Noise,
) -> Option<String> {
    let state = &workbench.prepared.state;
    let range = rival.range(state)?;
    let bench = workbench.bench(workbench.base_with_tangents(others(accepted, index).map(Accepted::term)), noise);
    let alone = bench.alone()?;
    let rows = bench.rows();
    let weigh = |rival: Generic, shape: &[f64]| {
        let label = Label::Generic(rival);
        let columns = workbench.whitened(&workbench.filtered_columns(&label, shape), noise);
        let evidence = bench.weigh(&columns, &ridge_of(&label, shape), false)?;
        let shape_price = 0.5 * rival.form.movable(shape, range).len() as f64 * rows.ln();
        let gain = 0.5 * rows * (alone.residual / evidence.residual).ln() - evidence.complexity - shape_price;
        Some((gain, evidence.coefficients))
    };
    let (accepted_gain, _) = weigh(rival, &accepted[index].shape)?;
    let best_of = |form: Form| -> Option<(f64, Generic, Shape, Vec<f64>)> {
        let rival = Generic { form, ..rival };
        let gain = |shape: &[f64]| weigh(rival, shape).map(|(gain, _)| gain);
        let grid: Vec<(f64, Shape)> =
            rival.grid(state).into_par_iter().filter_map(|shape| gain(&shape).map(|gain| (gain, shape))).collect();
        let (_, start) = grid.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let shape = climb(&start, &form.movable(&start, range), gain);
        let (gain, coefficients) = weigh(rival, &shape)?;
        Some((gain, rival, shape, coefficients))
    };
    let best = FORMULA_FORMS.into_iter().filter_map(best_of).max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(gain, ..)| *gain >= accepted_gain).map(|(_, rival, shape, coefficients)| {
        let functions = rival.texts(&shape);
        let terms: Vec<String> = coefficients.iter().zip(&functions).map(|(c, text)| term(*c, text)).collect();
        format!("dF = {} ({})", rival.factor.text(), terms.join(" + ").replace("+ -", "- "))
    })
}

fn term(coefficient: f64, function: &str) -> String {
    if function.is_empty() { digits(coefficient) } else { format!("{} {function}", digits(coefficient)) }
}
