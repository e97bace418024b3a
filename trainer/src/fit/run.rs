//! One call from recordings to an outcome.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::image::Image;
use frikan_shared::model::{MAX_INPUTS, Provenance};

use super::choice::physical::Violation;
use super::choice::rivals::{Freedom, judge, no_image};
use super::choice::shipped::{Shipped, on_all_rows, shipped};
use super::choice::turn::{self, Turn};
use super::data::gather::{Material, gather};
use super::data::inputs::{ChosenInput, choose};
use super::data::rigid;
use super::gate::confounded::Identified;
use super::gate::{bends, fixed, withheld};
use super::integers::{self, of_velocity};
use super::law_error::{Residual, law_error};
use super::laws::builder::Builder;
use super::laws::formula::{self, at_velocity, classical, law_data, law_parameters};
use super::laws::learn::{TrainedNetwork, TrainingData};
use super::laws::next_width::{at_next_width, hold_both};
use super::laws::simple::Simple;
use super::model::{HostModel, from_bytes, provenance, to_bytes};
use super::options::{Options, Progress, ProgressCallback, Stage};
use super::outcome::{
    CLOUD_POINTS, CURVE_POINTS, Form, InputRange, Outcome, Representation, Score, Soundness, SplitScore,
    uncertain_share,
};
use super::preparation_error::allow_for;
use super::rigid_body_error::rigid_body_error;
use super::score::trace_delayed;
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::law::{FormFit, Law};
use crate::parameter::Parameter;
use crate::recording::Recording;
use crate::samples::{Request, told_of_clock};

/// Share of the inertia that noise may take untold.
const TOLD_ATTENUATION: f64 = 0.01;

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
    let options = &of_velocity(&of_form(options)?)?;
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

/// The options of a fit of a law of the literature, where one is asked for: it is a formula of the velocity.
///
/// # Errors
/// `FRK-U001` where other inputs or a table are asked for.
fn of_form(options: &Options) -> Result<Options> {
    let Some(form) = options.form else { return Ok(options.clone()) };
    let velocity = vec!["velocity".to_owned()];
    let refused = |what: &str| {
        Error::new(&codes::USAGE, format!("the form `{}` is a formula of the velocity: {what}", form.key()))
    };
    if options.representation == Some(Representation::Table) {
        return Err(refused("it cannot be a table as well"));
    }
    if options.inputs.as_ref().is_some_and(|inputs| *inputs != velocity) {
        return Err(refused("it reads no other input"));
    }
    Ok(Options { inputs: Some(velocity), ..options.clone() })
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
    let request = Request { rate_hz: options.rate_hz, ..Request::default() };
    let material = gather(recordings, joint, &request)?;
    let (inputs, relevance) = choose(&material, options.inputs.as_deref())?;
    let builder = Builder { material: &material, inputs: &inputs, joint, cells: options.budget.cells() };

    let training = TrainingData::new(&material, &inputs, options)?;
    let data = law_data(&material, &inputs);
    let points = at_velocity(&material, &data);
    let turns = material.turns.iter();
    let turns = turns.map(|split| Turn::take(&builder, &training, (&points, &data), split, options.form, progress));
    let turns = turns.collect::<Result<Vec<_>>>()?;
    let trials = turn::trials(&turns, &material.turns, &material)?;
    let first = turns.first().ok_or_else(no_image)?;
    tell(Stage::Comparing);
    let classical = classical(&material, &data, &first.found);

    tell(Stage::Compiling);
    let (found, of_the_sign) = first.found.on_all(&data)?;
    let correlation_length = found.uncertainty.correlation_length;
    let refitted = training.refit(&first.pruned.result)?;
    let learnt = training.learnt(&refitted);
    let verdict =
        judge(&material, &first.models, &trials, freedom(first, &learnt), options.representation, &options.budget)?;
    let Shipped { model, fit } = shipped(&builder, verdict.form, first, found, &learnt, &data, options)?;
    let violation = Violation::of(&model, &material);
    let rmse = on_all_rows(&model, &material).sqrt();
    let (model, integers) = integers::shipped(model, &joint.drive, options, rmse)?;

    let name = joint.name.clone().unwrap_or_default();
    let residual = Residual::of(&model, &material)?;
    let provenance = Provenance {
        law_error: law_error(&material, &residual),
        rigid_body_error: rigid_body_error(&material, &residual),
        ..provenance(&name, recordings, options.seed)
    };
    let image = to_bytes(&Image { provenance, model: *model })?;
    // What is scored is what a drive would decode.
    let model = from_bytes(&image)?.model;
    tell(Stage::Scoring);
    let score = |recording: &Recording| trace_delayed(&model, recording, material.torque_delay_s);
    let train = recordings.iter().map(score).collect::<Result<Vec<_>>>()?;
    let tests = tests.iter().map(score).collect::<Result<Vec<_>>>()?;

    let by_expression = verdict.form != Form::Network;
    let identified = Identified::by(&material);
    let band = training.band(&refitted, correlation_length, f64::from(model.rigid_body.offset))?;
    let mut parameters = parameters(&material, &fit, &learnt, by_expression, &identified);
    hold_both(
        &mut parameters,
        &at_next_width(recordings, joint, &request, (&material, &inputs), &fit).unwrap_or_default(),
    );
    let trial = trials[verdict.form.place()].as_ref();
    let mut sound = soundness(&material, &fit, &learnt, verdict.form, violation)
        .and(|| withheld(&material, &identified, trial, &parameters, uncertain_share(&band)));
    if let Some(bending) = (sound != Soundness::Sound).then(|| bends(&material, trial)).flatten() {
        (parameters, sound) = (bending.parameters, Soundness::NotIdentifiable(bending.sentence));
    }
    Ok(Outcome {
        joint: name,
        axis: material.samples.axis,
        unit: rigid::printed(material.samples.actuator_unit),
        seed: options.seed,
        filter: material.samples.filter.clone() + told_of_clock(recordings),
        inputs: input_ranges(&model, &inputs),
        relevance,
        network: training.summary(&first.fitted, &first.pruned, &refitted),
        law: formula::summary(&first.found, &fit, &inputs),
        classical,
        parameters,
        candidates: verdict.candidates,
        representation: if integers.is_some() { Representation::Table } else { verdict.form.representation() },
        held_out: material.repeats.is_none(),
        choice: verdict.reason,
        integers,
        remarks: remarks(&material, first, of_the_sign, verdict.form, recordings, &identified),
        sound,
        train_score: Score::over(&train),
        train_split: SplitScore::over(&train),
        train,
        tests,
        cloud: cloud(&material),
        law_curve: law_curve(&model, &inputs),
        band,
        image,
    })
}

/// What each form is free to choose, in the order of [`Form::ALL`].
fn freedom(turn: &Turn, learnt: &TrainedNetwork) -> [Freedom; 4] {
    let of = |law: &Law| {
        let linear = law.parameters.iter().skip(law.structure.nonlinear().len());
        let mut stribeck = law.structure.terms().iter().zip(linear).filter(|(term, _)| term.shape.is_stribeck());
        Freedom {
            constants: law.parameters.len(),
            stribeck_is_negative: stribeck.any(|(_, parameter)| parameter.value < 0.0),
        }
    };
    let simple = |simple: &Option<Simple>| simple.as_ref().map_or_else(Freedom::default, |simple| of(&simple.fit.law));
    let network = Freedom { constants: learnt.network.coefficient_count(), stribeck_is_negative: false };
    [simple(&turn.simple[0]), simple(&turn.simple[1]), of(&turn.found.open.law), network]
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
fn parameters(
    material: &Material,
    fit: &FormFit,
    learnt: &TrainedNetwork,
    by_expression: bool,
    identified: &Identified,
) -> Vec<Parameter> {
    let nuisance = &fit.uncertainty.nuisance;
    // The network identifies the same coefficients; its own standard errors are not worked out, those beside the
    // formula stand for them.
    let in_image = |(index, &(value, error)): (usize, &(f64, f64))| {
        (if by_expression { value } else { learnt.coefficients.get(index).copied().unwrap_or(value) }, error)
    };
    let coefficients: Vec<(f64, f64)> = nuisance.iter().enumerate().map(in_image).collect();
    let mut parameters = law_parameters(&fit.law.parameters);
    parameters.extend(rigid::parameters(material, &coefficients));
    allow_for(&mut parameters, material);
    // Of what the motion does not tell apart there is no interval.
    let unknown = identified.unknown();
    for parameter in parameters.iter_mut().filter(|p| unknown.iter().any(|constant| constant.is_named(&p.name))) {
        parameter.ci95 = [f64::NEG_INFINITY, f64::INFINITY];
    }
    parameters
}

fn remarks(
    material: &Material,
    turn: &Turn,
    of_the_sign: Vec<String>,
    form: Form,
    recordings: &[Recording],
    identified: &Identified,
) -> Vec<String> {
    let mut remarks = fixed(material, identified);
    if matches!(form, Form::Found | Form::Network) {
        remarks.extend(turn.found.discovery.remarks.iter().cloned().chain(of_the_sign));
    }
    if let Some(repeats) = &material.repeats {
        remarks.push(format!("{}: the law was chosen by what its constants cost.", repeats.sentence));
    }
    let attenuation = rigid::attenuation(material);
    if attenuation > TOLD_ATTENUATION {
        remarks.push(format!(
            "Noise of the acceleration may have taken up to {:.0} % of the inertia; the intervals of all constants allow for that.",
            100.0 * attenuation
        ));
    }
    if material.stride > 1 {
        let (stride, learnt) = (material.stride, material.rows.len());
        remarks.push(format!(
            "Learnt from one in {stride} of the samples in motion, {learnt} in all; scored on every row."
        ));
    }
    for recording in recordings {
        let notes = recording.health.notes.iter();
        remarks.extend(notes.map(|note| format!("{}: {note}", recording.label)));
    }
    remarks
}

fn soundness(
    material: &Material,
    fit: &FormFit,
    learnt: &TrainedNetwork,
    form: Form,
    violation: Violation,
) -> Soundness {
    if let Some(what) = violation.sentence() {
        return Soundness::NotPhysical(what);
    }
    if let Some(name) = rigid::collinear(material) {
        return Soundness::NotIdentifiable(format!(
            "{name} cannot be separated from the other terms on this motion; drive several speeds and accelerations"
        ));
    }
    let by_expression = form != Form::Network;
    let settled = if by_expression { fit.converged } else { learnt.settled };
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
