//! One call from recordings to an outcome.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::image::Image;
use frikan_shared::model::{Law, MAX_INPUTS};

use super::activations;
use super::formula::{self, Found, classical, formula_of, law_data, law_parameters, search};
use super::gather::{Material, gather};
use super::inputs::{ChosenInput, choose, output_unit};
use super::learn::{TrainedNetwork, TrainingData};
use super::model::{HostModel, Parts, assemble, from_bytes, provenance, to_bytes};
use super::options::{Options, Progress, ProgressCallback, Stage};
use super::outcome::{CURVE_POINTS, InputRange, Outcome, Representation, Score, Soundness};
use super::predict::trace;
use super::rivals::{Rivals, no_image};
use super::{rigid, tables};
use crate::compile::program::compile_program;
use crate::error::Result;
use crate::joint::Joint;
use crate::law::{Expr, FormFit};
use crate::parameter::Parameter;
use crate::recording::Recording;

/// Tables follow the network to within this share of the residual, and of the range of friction where there is none.
const TABLE_SHARE_OF_RESIDUAL: f64 = 0.03;
const TABLE_SHARE_OF_RANGE: f64 = 1e-5;
/// On the samples a coarser table may be off by this share of the residual, in the root mean square, to save cells.
const COARSER_SHARE_OF_RESIDUAL: f64 = 0.15;
/// Where no table comes that close, one that is off by this share still serves.
const COARSEST_SHARE_OF_RESIDUAL: f64 = 0.5;
/// How often the bound of a table is doubled at most, so that its cells fit into the smallest drive.
const DOUBLINGS: i32 = 12;
/// Most samples on which a table is compared with its network.
const COMPARED_SAMPLES: usize = 2000;
/// The drive never puts out more than this multiple of the largest friction that was seen.
const LIMIT_OVER_LARGEST: f64 = 1.5;
/// Most points of a picture.
const CLOUD_POINTS: usize = 4000;

/// Fits recordings of one joint; `tests` are only scored.
///
/// # Errors
/// `FRK-D...` when a recording cannot be used, `FRK-U...` for inputs that do not exist, `FRK-N...` when nothing can be
/// identified at all. A fit that came about but may not be relied upon is no error, see [`Outcome::sound`].
pub fn fit(
    recordings: &[Recording],
    tests: &[Recording],
    joint: &Joint,
    options: &Options,
    progress: ProgressCallback<'_>,
) -> Result<Outcome> {
    let first = fit_once(recordings, tests, joint, options, progress);
    let too_large = first.as_ref().is_err_and(|error| *error == no_image());
    if !too_large || options.inputs.is_some() {
        return first;
    }
    // Inputs that relevance picked may ask for more than a drive has room for; velocity alone never does.
    let velocity = Options { inputs: Some(vec!["velocity".to_owned()]), ..options.clone() };
    let mut outcome = fit_once(recordings, tests, joint, &velocity, progress)?;
    outcome
        .remarks
        .push("A law of all relevant inputs does not fit into an image; this one reads velocity alone.".into());
    Ok(outcome)
}

fn fit_once(
    recordings: &[Recording],
    tests: &[Recording],
    joint: &Joint,
    options: &Options,
    progress: ProgressCallback<'_>,
) -> Result<Outcome> {
    let tell = |stage| progress(&Progress { stage, steps: 0, rmse: None });
    tell(Stage::Separating);
    let material = gather(recordings, joint, options)?;
    let (inputs, relevance) = choose(&material, options.inputs.as_deref())?;
    let builder = Builder { material: &material, inputs: &inputs, joint, cells: options.budget.cells() };

    tell(Stage::Training);
    let training = TrainingData::new(&material, &inputs, options)?;
    let (fitted, pruned) = training.train(&material, progress)?;
    tell(Stage::Searching);
    let data = law_data(&material, &inputs);
    let open = training.learnt(&pruned.result);
    let found = search(&material, &data, activations::starts(&open.network, &open.graph, &inputs))?;
    tell(Stage::Comparing);
    let classical = classical(&material, &data);

    tell(Stage::Compiling);
    let refitted = training.refit(&pruned.result)?;
    let learnt = training.learnt(&refitted);
    let rivals =
        Rivals { table: builder.table(&open, pruned.result.train_rmse), expression: builder.expression(&found.open) };
    let verdict = rivals.judge(&material, options.representation, &options.budget)?;
    let (last, compared) = match verdict.representation {
        Representation::Table => (builder.table(&learnt, refitted.train_rmse), rivals.table),
        Representation::Expression => (builder.expression(&found.last), rivals.expression),
    };
    let model = last.filter(|model| options.budget.allows(model)).or(compared).ok_or_else(no_image)?;

    let name = joint.name.clone().unwrap_or_default();
    let image = to_bytes(&Image { provenance: provenance(&name, recordings, options.seed), model: *model })?;
    // What is scored is what a drive would decode.
    let model = from_bytes(&image)?.model;
    tell(Stage::Scoring);
    let score = |recording: &Recording| trace(&model, recording, joint);
    let train = recordings.iter().map(score).collect::<Result<Vec<_>>>()?;
    let tests = tests.iter().map(score).collect::<Result<Vec<_>>>()?;

    let by_expression = verdict.representation == Representation::Expression;
    Ok(Outcome {
        joint: name,
        axis: material.samples.axis,
        unit: rigid::printed(material.samples.actuator_unit),
        seed: options.seed,
        filter: material.samples.filter.clone(),
        inputs: input_ranges(&model, &inputs),
        relevance,
        network: training.summary(&fitted, &pruned, &refitted),
        law: formula::summary(&found, &inputs),
        classical,
        parameters: parameters(&material, &found, &learnt, by_expression),
        candidates: verdict.candidates,
        representation: verdict.representation,
        choice: verdict.reason,
        remarks: remarks(&material, &found, recordings),
        sound: soundness(&material, &found, &learnt, by_expression),
        train_score: Score::over(&train),
        train,
        tests,
        cloud: cloud(&material),
        law_curve: law_curve(&model, &inputs),
        band: training.band(&refitted, found.last.uncertainty.correlation_length)?,
        image,
    })
}

/// Turns laws into models of one joint.
struct Builder<'a> {
    material: &'a Material,
    inputs: &'a [ChosenInput],
    joint: &'a Joint,
    /// Cells that a table may have.
    cells: usize,
}

impl Builder<'_> {
    fn expression(&self, fit: &FormFit) -> Option<Box<HostModel>> {
        let expression = &fit.law.expression;
        let used: Vec<usize> = (0..self.inputs.len()).filter(|&index| reads(expression, index)).collect();
        // A law that reads nothing still needs a channel to be a model.
        let used = if used.is_empty() { vec![0] } else { used };
        let renumbered = expression.map_leaves(&|leaf| match leaf {
            Expr::Input(index) => Expr::Input(used.iter().position(|u| u == index).unwrap_or(0)),
            other => other.clone(),
        });
        let program = compile_program(&formula_of(&renumbered), used.len()).ok()?;
        let coefficients: Vec<f64> = fit.uncertainty.nuisance.iter().map(|(value, _)| *value).collect();
        self.model(Law::Expression(program), &[], &used, &coefficients)
    }

    /// The tightest table that fits into the budget and the smallest drive, else the tightest of all.
    fn table(&self, learnt: &TrainedNetwork, rmse: f64) -> Option<Box<HostModel>> {
        let bound = (TABLE_SHARE_OF_RESIDUAL * rmse).max(TABLE_SHARE_OF_RANGE * self.largest());
        let ranges: Vec<[f64; 2]> = self.inputs.iter().map(|input| [input.low, input.high]).collect();
        let mut tightest = None;
        for doubling in 0..=DOUBLINGS {
            let slack = 2f64.powi(doubling);
            let Some(tables) = tables::compile(&learnt.network, &learnt.graph, &ranges, bound * slack) else {
                continue;
            };
            let fits = tables.cells.len() <= self.cells;
            let model = self.model(tables.law, &tables.cells, &tables.inputs, &learnt.coefficients);
            let Some(model) = model else { continue };
            let deviation = self.deviation(&model, learnt);
            if deviation > (COARSER_SHARE_OF_RESIDUAL * rmse).max(bound) {
                return tightest.or((deviation <= COARSEST_SHARE_OF_RESIDUAL * rmse).then_some(model));
            }
            if fits {
                return Some(model);
            }
            tightest.get_or_insert(model);
        }
        tightest
    }

    /// Root mean square of what a model's law differs from its network by, on some of the samples.
    fn deviation(&self, model: &HostModel, learnt: &TrainedNetwork) -> f64 {
        let rows = self.material.rows.len();
        let stride = rows.div_ceil(COMPARED_SAMPLES).max(1);
        let (mut sum, mut count) = (0.0, 0.0);
        for row in (0..rows).step_by(stride) {
            let point: Vec<f64> = self.inputs.iter().map(|input| input.values[row]).collect();
            let mut channels = [0.0f32; MAX_INPUTS];
            for (slot, read) in channels.iter_mut().zip(&model.inputs) {
                let index = self.inputs.iter().position(|input| input.quantity == read.quantity);
                *slot = index.map_or(0.0, |index| point[index] as f32);
            }
            sum += (f64::from(evaluate(model, &channels)) - learnt.network.evaluate(&point)).powi(2);
            count += 1.0;
        }
        (sum / f64::max(count, 1.0)).sqrt()
    }

    fn model(
        &self,
        law: Law,
        cells: &[frikan_shared::table::Cell],
        used: &[usize],
        coefficients: &[f64],
    ) -> Option<Box<HostModel>> {
        // A table is refused where a cell could exceed the limit, so the limit covers what the cells can put out.
        let reach = cells.iter().map(|cell| f64::from(cell.bound())).fold(0.0, f64::max);
        let limit = match law {
            Law::Geometric(_) | Law::Uniform(_) => reach * (1.0 + 1e-6),
            Law::Network(ref network) => tables::output_bound(network),
            _ => 0.0,
        };
        assemble(&Parts {
            law,
            cells,
            inputs: used.iter().map(|&index| &self.inputs[index]).collect(),
            unit: output_unit(self.material.samples.actuator_unit),
            limit: limit.max(LIMIT_OVER_LARGEST * self.largest()),
            rigid_body: rigid::in_force(self.material, self.joint, coefficients),
        })
    }

    /// Largest magnitude of friction in the rows that are learnt from.
    fn largest(&self) -> f64 {
        let friction = self.material.pick(&self.material.friction);
        friction.iter().fold(0.0_f64, |peak, f| peak.max(f.abs())).max(1e-6)
    }
}

fn reads(expression: &Expr, input: usize) -> bool {
    *expression == Expr::Input(input) || expression.children().any(|child| reads(child, input))
}

fn input_ranges(model: &HostModel, inputs: &[ChosenInput]) -> Vec<InputRange> {
    let range = |input: &frikan_shared::model::Input| {
        let chosen = inputs.iter().find(|chosen| chosen.quantity == input.quantity);
        InputRange {
            name: chosen.map_or_else(|| input.quantity.name().to_owned(), |chosen| chosen.name.clone()),
            unit: input.unit.symbol(),
            low: f64::from(input.low),
            high: f64::from(input.high),
        }
    };
    model.inputs.iter().map(range).collect()
}

/// Constants of the formula, then the rigid body as it is in the image.
fn parameters(material: &Material, found: &Found, learnt: &TrainedNetwork, by_expression: bool) -> Vec<Parameter> {
    let nuisance = &found.last.uncertainty.nuisance;
    // The network identifies the same coefficients; its own standard errors are not worked out, those beside the
    // formula stand for them.
    let in_image = |(index, &(value, error)): (usize, &(f64, f64))| {
        (if by_expression { value } else { learnt.coefficients.get(index).copied().unwrap_or(value) }, error)
    };
    let coefficients: Vec<(f64, f64)> = nuisance.iter().enumerate().map(in_image).collect();
    let mut parameters = law_parameters(&found.last.law.parameters);
    parameters.extend(rigid::parameters(material, &coefficients));
    parameters
}

fn remarks(material: &Material, found: &Found, recordings: &[Recording]) -> Vec<String> {
    let mut remarks = found.discovery.remarks.clone();
    if material.stride > 1 {
        let (stride, learnt) = (material.stride, material.rows.len());
        remarks.push(format!(
            "TrainedNetwork from one in {stride} of the samples in motion, {learnt} in all; scored on every row."
        ));
    }
    for recording in recordings {
        let notes = recording.health.notes.iter();
        remarks.extend(notes.map(|note| format!("{}: {note}", recording.label)));
    }
    remarks
}

fn soundness(material: &Material, found: &Found, learnt: &TrainedNetwork, by_expression: bool) -> Soundness {
    if let Some(name) = rigid::collinear(material) {
        return Soundness::NotIdentifiable(format!(
            "{name} cannot be told from the other terms on this motion; drive several speeds and accelerations"
        ));
    }
    let settled = if by_expression { found.last.converged } else { learnt.settled };
    if settled {
        return Soundness::Sound;
    }
    let which = if by_expression { "the fit of the expression" } else { "the training of the network" };
    Soundness::NotConverged(format!("{which} was still improving when its steps were used up"))
}

fn cloud(material: &Material) -> Vec<[f64; 2]> {
    let velocity = material.samples.velocity.as_deref().unwrap_or_default();
    let stride = material.rows.len().div_ceil(CLOUD_POINTS).max(1);
    material.rows.iter().step_by(stride).map(|&row| [velocity[row], material.friction[row]]).collect()
}

/// The exported law over the trained velocities, every other input at its mean.
fn law_curve(model: &HostModel, inputs: &[ChosenInput]) -> Vec<[f64; 2]> {
    let mean = |input: &ChosenInput| input.values.iter().sum::<f64>() / input.values.len().max(1) as f64;
    let mut point = [0.0f32; MAX_INPUTS];
    for (slot, input) in point.iter_mut().zip(&model.inputs) {
        *slot = inputs.iter().find(|chosen| chosen.quantity == input.quantity).map_or(0.0, |c| mean(c) as f32);
    }
    let Some(velocity) = inputs.first() else { return Vec::new() };
    let slot = model.inputs.iter().position(|input| input.quantity == velocity.quantity);
    (0..CURVE_POINTS)
        .map(|i| {
            let v = velocity.low + (velocity.high - velocity.low) * i as f64 / (CURVE_POINTS - 1) as f64;
            if let Some(slot) = slot {
                point[slot] = v as f32;
            }
            [v, f64::from(evaluate(model, &point))]
        })
        .collect()
}
