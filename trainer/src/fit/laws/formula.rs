//! The formula: looked for on open blocks, then fitted to everything jointly with the rigid body; and a law in the terms of the
//! compiler.

use rayon::prelude::*;

use crate::compile::formula::{Formula, Function, Operator};
use crate::error::{Error, Result, codes};
use crate::fit::data::gather::Material;
use crate::fit::data::inputs::{ChosenInput, symbol};
use crate::fit::data::rigid;
use crate::fit::data::turns;
use crate::fit::outcome::{ClassicalLaw, FrontLaw, LawSummary};
use crate::law::{
    self, Channel, ChannelRole, Discovery, Expr, FormFit, Interval, KnownForm, Language, LawData, LawError, Nuisance,
    Remainder, SearchOptions, Start, Structure, Unary, discover, fit_form, refit_structure, remainder, render, settle,
};
use crate::parameter::Parameter;
use crate::samples;
use crate::samples::blocks::Split;

/// Most samples that constants are fitted to; more would change no digit that is printed.
const MOST_SAMPLES: usize = 12_000;

/// Most samples that the classical laws are fitted to.
const MOST_CLASSICAL_SAMPLES: usize = 4_000;

/// Difference of the criterion (Schwarz 1978) that counts as clear (Kass & Raftery 1995).
const BIC_DIFFERENCE_THRESHOLD: f64 = 6.0;

/// The formula with what led to it.
pub(in crate::fit) struct Found {
    pub(in crate::fit) discovery: Discovery,
    /// Fitted to the open blocks only; what candidates are compared by.
    pub(in crate::fit) open: FormFit,
    /// Its non-linear constants, where other rows start from.
    constants: Vec<f64>,
    /// The non-linear constants of the classical laws, likewise.
    classical: Vec<Option<Vec<f64>>>,
}

/// Rows as the law room takes them: averages over their states.
pub(in crate::fit) fn law_data(material: &Material, inputs: &[ChosenInput]) -> LawData {
    let axis = material.samples.axis;
    let actuator = material.samples.actuator_unit;
    let channel = |input: &ChosenInput| Channel {
        name: input.name.clone(),
        unit: input.unit.symbol().to_owned(),
        role: input.role,
        values: input.values.clone(),
    };
    let nuisance = material.columns.iter().map(|column| Nuisance {
        name: column.kind.name().to_owned(),
        unit: rigid::unit(column.kind, axis, actuator),
        values: material.pick(&column.values),
    });
    let artefacts = material.artefacts().into_iter();
    let artefacts = artefacts.map(|(name, unit, values)| Nuisance { name: name.to_owned(), unit, values });
    LawData {
        channels: inputs.iter().map(channel).collect(),
        target: material.pick(&material.target),
        target_unit: rigid::printed(actuator).to_owned(),
        // Those of the rigid body come first.
        nuisance: nuisance.chain(artefacts).collect(),
        states: material.states.as_ref().map(|states| law_states(states, inputs)),
        blocks: material.labels.clone(),
    }
}

/// The same rows with what the law at their own velocity has to explain, for what works point by point.
pub(in crate::fit) fn at_velocity(material: &Material, data: &LawData) -> LawData {
    LawData { target: material.target_at_velocity(), states: None, ..data.clone() }
}

/// The states of the rows with all channels: the velocity of each, and what else the law reads as its row has it, since a law is bent over
/// velocity.
fn law_states(states: &samples::states::States, inputs: &[ChosenInput]) -> law::States {
    let of_state = |input: &ChosenInput| match input.role {
        ChannelRole::Velocity => states.velocity.clone(),
        _ => states.nearest.iter().map(|&row| input.values[row]).collect(),
    };
    law::States { averages: states.averages.clone(), channels: inputs.iter().map(of_state).collect() }
}

/// Looks for the formula in `points`, beginning also at `starts`, and fits it to `data`, the averages of the same rows. Another law of the search's
/// front or a classical one that describes those better, its constants paid for, takes its place; a `form` that is asked for in any case.
pub(in crate::fit) fn search(
    split: &Split,
    (points, data): (&LawData, &LawData),
    starts: Vec<Start>,
    form: Option<KnownForm>,
) -> Result<Found> {
    let open = turns::open(split);
    let options = SearchOptions { starts, intervals: Interval::Linearised, ..SearchOptions::default() };
    let discovery = discover(&points.select(&open), &options).map_err(|error| refused(&error))?;
    let open_data = data.select(&open);
    let few = thinned(&open_data, MOST_CLASSICAL_SAMPLES);
    let law = &discovery.law;
    let constants: Vec<f64> = law.parameters.iter().take(law.structure.nonlinear().len()).map(|p| p.value).collect();
    let own = remainder(&law.structure, &few, Some(&constants)).map_err(|error| refused(&error))?;
    // One effective number of samples for all, or their criteria would not compare.
    let effective = few.rows() as f64 / own.correlation_length;
    let criterion = |left: &Remainder, structure: &Structure| {
        let misfit = effective * left.mean_square.max(f64::MIN_POSITIVE).ln();
        misfit + effective.ln() * structure.constants() as f64
    };
    let limit = criterion(&own, &law.structure) - BIC_DIFFERENCE_THRESHOLD;
    let front = discovery.front.iter().filter(|entry| entry.nodes <= options.max_nodes);
    let classical = KnownForm::ALL.map(KnownForm::structure);
    let front = front.map(|entry| (&entry.structure, Some(&entry.constants)));
    // What the search has fitted already is not looked for again.
    let rivals = classical.iter().map(|structure| (structure, discovery.explored.get(structure))).chain(front);
    let judged = |(structure, constants): &(&Structure, Option<&Vec<f64>>)| {
        let left = remainder(structure, &few, constants.map(Vec::as_slice)).ok().filter(|left| left.converged)?;
        Some((criterion(&left, structure), (*structure).clone(), left.constants))
    };
    let judged: Vec<_> = rivals.collect::<Vec<_>>().par_iter().map(judged).collect();
    let constants_of = |judged: &Option<(f64, Structure, Vec<f64>)>| judged.as_ref().map(|(.., c)| c.clone());
    let of_classical = judged.iter().take(classical.len()).map(constants_of).collect();
    let (structure, constants) = match form {
        Some(form) => {
            let structure = form.structure();
            let left = remainder(&structure, &few, discovery.explored.get(&structure).map(Vec::as_slice));
            let constants = left.map_err(|error| refused(&error))?.constants;
            (structure, constants)
        }
        None => {
            let better = judged.into_iter().flatten().filter(|(value, ..)| *value < limit);
            let best = better.min_by(|a, b| a.0.total_cmp(&b.0));
            best.map_or((law.structure.clone(), own.constants), |(_, structure, constants)| (structure, constants))
        }
    };
    let (open, _) = settled((&structure, &constants), &open_data, Interval::Linearised)?;
    Ok(Found { open, constants, classical: of_classical, discovery })
}

/// A law fitted from constants that some of the rows gave it, and what is to be said of its sign.
pub(in crate::fit) fn settled(
    (structure, constants): (&Structure, &[f64]),
    data: &LawData,
    intervals: Interval,
) -> Result<(FormFit, Vec<String>)> {
    settle(structure, constants, &thinned(data, MOST_SAMPLES), intervals).map_err(|error| refused(&error))
}

impl Found {
    /// The formula fitted to all rows, and what is to be said of its sign.
    pub(in crate::fit) fn on_all(&self, data: &LawData) -> Result<(FormFit, Vec<String>)> {
        settled((&self.open.law.structure, &self.constants), data, Interval::Profile)
    }
}

/// Every `k`-th sample, so that at most `most` are left.
pub(in crate::fit) fn thinned(data: &LawData, most: usize) -> LawData {
    let stride = data.rows().div_ceil(most).max(1);
    data.select(&(0..data.rows()).step_by(stride).collect::<Vec<_>>())
}

/// The laws of the literature on the same samples, those that can be fitted, each from where the search left it.
pub(in crate::fit) fn classical(material: &Material, data: &LawData, found: &Found) -> Vec<ClassicalLaw> {
    let mut over_velocity = thinned(data, MOST_CLASSICAL_SAMPLES);
    over_velocity.channels.truncate(1);
    let fit = |(form, constants): (&KnownForm, &Option<Vec<f64>>)| {
        let structure = form.structure();
        let fit = match constants {
            Some(constants) => refit_structure(&structure, constants, &over_velocity, Interval::Linearised),
            None => fit_form(*form, &over_velocity, None),
        };
        let fit = fit.ok()?;
        let mut parameters = law_parameters(&fit.law.parameters);
        parameters.extend(rigid::parameters(material, &fit.uncertainty.nuisance));
        Some(ClassicalLaw { name: form.name(), rmse: fit.rmse, bic: fit.bic, parameters })
    };
    KnownForm::ALL.par_iter().zip(&found.classical).map(fit).collect::<Vec<_>>().into_iter().flatten().collect()
}

/// Constants of a law as results carry them.
pub(in crate::fit) fn law_parameters(parameters: &[law::Parameter]) -> Vec<Parameter> {
    let carried = parameters.iter().map(|p| Parameter {
        name: p.name.clone(),
        symbol: p.symbol.clone(),
        value: p.value,
        unit: p.unit.clone(),
        ci95: p.ci95,
    });
    carried.collect()
}

/// What a report shows of the search, with the formula that is told at last.
pub(in crate::fit) fn summary(found: &Found, fit: &FormFit, inputs: &[ChosenInput]) -> LawSummary {
    let front = found.discovery.front.iter().map(|entry| FrontLaw {
        expression: text(&entry.expression, inputs),
        nodes: entry.nodes,
        rmse: entry.rmse,
        held_out_rmse: entry.held_out_rmse,
    });
    let expression = &fit.law.expression;
    let symbols: Vec<&str> = inputs.iter().map(|input| symbol(&input.name)).collect();
    LawSummary {
        expression: text(expression, inputs),
        latex: render(expression, Language::Latex, &symbols),
        nodes: expression.node_count(),
        rmse: fit.rmse,
        front: front.collect(),
        explored: found.discovery.explored.len(),
    }
}

fn text(expression: &Expr, inputs: &[ChosenInput]) -> String {
    let symbols: Vec<&str> = inputs.iter().map(|input| symbol(&input.name)).collect();
    render(expression, Language::Unicode, &symbols)
}

fn refused(error: &LawError) -> Error {
    let code = match error {
        LawError::TooFewSamples { .. } => &codes::TOO_FEW_ROWS,
        LawError::NotFinite { .. } => &codes::NOT_FINITE,
        LawError::ConstantVelocity => &codes::NO_MOTION,
        _ => &codes::NOT_IDENTIFIABLE,
    };
    Error::new(code, error.to_string())
}

/// The formula of a bound expression (one without open parameters, which would read as NaN).
#[must_use]
pub fn formula_of(expression: &Expr) -> Formula {
    let join = |operator, left: &Expr, right: &Expr| formula_of(left).join(operator, formula_of(right));
    match expression {
        Expr::Const(value) => Formula::Constant(*value),
        Expr::Param(_) => Formula::Constant(f64::NAN),
        Expr::Input(index) => Formula::Input(*index),
        Expr::Add(left, right) => join(Operator::Add, left, right),
        Expr::Sub(left, right) => join(Operator::Subtract, left, right),
        Expr::Mul(left, right) => join(Operator::Multiply, left, right),
        Expr::Div(left, right) => join(Operator::Divide, left, right),
        Expr::Pow(base, exponent) => join(Operator::Power, base, exponent),
        Expr::Unary(unary, argument) => formula_of(argument).apply(function_of(*unary)),
    }
}

fn function_of(unary: Unary) -> Function {
    match unary {
        Unary::Neg => Function::Negate,
        Unary::Abs => Function::Absolute,
        Unary::Square => Function::Square,
        Unary::Exp => Function::Exp,
        Unary::Tanh => Function::Tanh,
        Unary::Sin => Function::Sin,
        Unary::Cos => Function::Cos,
        Unary::Atan => Function::Atan,
        Unary::Sqrt => Function::SquareRoot,
        Unary::Log => Function::Log,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expression_and_formula_have_one_value() {
        let v = || Expr::Input(0);
        let law = (Expr::Const(22.0) + Expr::Const(8.0) * (-(v().abs() / Expr::Const(0.1))).exp())
            * (Expr::Const(50.0) * v()).then(Unary::Tanh)
            + Expr::Const(0.3) * v().pow(Expr::Const(1.5)) * v().then(Unary::Atan);
        let formula = formula_of(&law);
        for v in [-0.9, -0.01, 0.0, 0.2] {
            assert!((formula.evaluate(&[v]) - law.value(&[v], &[])).abs() < 1e-12);
        }
    }
}
