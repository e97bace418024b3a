//! The network: trained, pruned, refitted on everything, and as the report shows it.

use super::activations::label_activations;
use crate::error::{Error, Result, codes};
use crate::fit::data::gather::Material;
use crate::fit::data::inputs::ChosenInput;
use crate::fit::options::{Options, Progress, ProgressCallback, Stage};
use crate::fit::outcome::{CURVE_POINTS, NetworkSummary};
use crate::kan::{self, Blocks, Dataset, FitOptions, FitResult, GraphSummary, Network, PruneOptions, Pruned, prune};
use crate::numerics::statistics::NORMAL_95;
use crate::samples::blocks::Split;
use crate::samples::rigid_body::TermKind;

/// The columns that a network learns from, at the rows of the material.
pub(in crate::fit) struct TrainingData {
    inputs: Vec<Vec<f64>>,
    target: Vec<f64>,
    linear: Vec<Vec<f64>>,
    /// Offset taken off the target, where one was identified.
    offset: Option<f64>,
    options: FitOptions,
}

/// A network with the rigid body that was identified along with it.
pub(in crate::fit) struct TrainedNetwork {
    pub(in crate::fit) network: Network,
    pub(in crate::fit) graph: GraphSummary,
    /// One coefficient for each column of the material.
    pub(in crate::fit) coefficients: Vec<f64>,
    pub(in crate::fit) settled: bool,
    /// Root mean square of what it leaves of the samples that it was trained on, unit of the target.
    pub(in crate::fit) rmse: f64,
}

impl TrainingData {
    /// # Errors
    /// `FRK-U001` where the network that is asked for has another number of inputs.
    pub(in crate::fit) fn new(material: &Material, inputs: &[ChosenInput], options: &Options) -> Result<Self> {
        let is_offset = |kind: TermKind| kind == TermKind::TorqueOffset;
        let parameters = material.separation.iter().flat_map(|separation| &separation.parameters);
        // A network has a constant of its own, so the offset cannot be identified beside it.
        let offset = parameters.clone().find(|p| is_offset(p.kind)).map(|p| p.value);
        let own = material.columns.iter().filter(|column| !is_offset(column.kind));
        let training = options.training.options(inputs.len(), options.seed);
        let wanted = training.architecture.inputs;
        if wanted != inputs.len() {
            let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
            let message = format!("the network has {wanted} inputs, the law reads {}", inputs.len());
            return Err(Error::new(&codes::USAGE, message).with_value(names.join(",")));
        }
        Ok(Self {
            inputs: inputs.iter().map(|input| input.values.clone()).collect(),
            target: material.target_at_velocity().iter().map(|total| total - offset.unwrap_or(0.0)).collect(),
            linear: own.map(|column| material.pick(&column.values)).collect(),
            offset,
            options: training,
        })
    }

    fn dataset<'a>(&'a self, blocks: &'a Blocks) -> Dataset<'a> {
        Dataset { inputs: &self.inputs, target: &self.target, linear: &self.linear, blocks }
    }

    /// Trains on the training blocks and prunes as the validation blocks allow.
    pub(in crate::fit) fn train(&self, split: &Split, progress: ProgressCallback<'_>) -> Result<(FitResult, Pruned)> {
        let blocks = Blocks { train: split.train.clone(), validation: split.validation.clone() };
        let dataset = self.dataset(&blocks);
        let told = |stage| {
            move |step: &kan::Progress| {
                progress(&Progress { stage, steps: step.step.step, rmse: Some(step.step.loss.sqrt()) });
            }
        };
        let fitted = kan::fit(&dataset, &self.options, &told(Stage::Training)).map_err(|error| refused(&error))?;
        let pruned = prune(&fitted, &dataset, &self.options, &PruneOptions::default(), &told(Stage::Pruning))
            .map_err(|error| refused(&error))?;
        Ok((fitted, pruned))
    }

    /// Goes on training a pruned network, on all rows.
    pub(in crate::fit) fn refit(&self, result: &FitResult) -> Result<FitResult> {
        let blocks = Blocks::default();
        let dataset = self.dataset(&blocks);
        kan::refit(&result.network, &result.linear_coefficients, &dataset, &self.options, &|_| ())
            .map_err(|error| refused(&error))
    }

    /// A network with its scores and its rigid body.
    pub(in crate::fit) fn learnt(&self, result: &FitResult) -> TrainedNetwork {
        let blocks = Blocks::default();
        let mut coefficients = result.linear_coefficients.clone();
        coefficients.extend(self.offset);
        TrainedNetwork {
            graph: GraphSummary::of(&result.network, &self.dataset(&blocks)),
            network: result.network.clone(),
            coefficients,
            settled: result.convergence.status.is_settled(),
            rmse: result.train_rmse,
        }
    }

    /// What a report shows of the training.
    pub(in crate::fit) fn summary(&self, fitted: &FitResult, pruned: &Pruned, last: &FitResult) -> NetworkSummary {
        let blocks = Blocks::default();
        let dataset = self.dataset(&blocks);
        let mut after = GraphSummary::of(&last.network, &dataset);
        label_activations(&mut after, &last.network);
        let curve = |index: usize, active: bool| {
            if active { after.curve(&last.network, index, CURVE_POINTS) } else { Vec::new() }
        };
        let activations = after.edges.iter().enumerate().map(|(index, edge)| curve(index, edge.active)).collect();
        let stages = [1.0 / 3.0, 2.0 / 3.0, 1.0].map(|share| (share, self.over_velocity(fitted.network_at(share))));
        NetworkSummary {
            architecture: self.options.architecture.to_string(),
            before: GraphSummary::of(&fitted.network, &dataset),
            activations,
            removed: pruned.removed.clone(),
            history: fitted.history.clone(),
            stages: stages.into(),
            rmse: last.train_rmse,
            after,
        }
    }

    /// Points of a network over its first input, the others at their mean.
    fn over_velocity(&self, network: &Network) -> Vec<[f64; 2]> {
        let points = self.along_velocity();
        points[0].iter().copied().zip(network.evaluate_columns(&points)).map(|(v, f)| [v, f]).collect()
    }

    /// Columns of points along the first input, the others at their mean.
    fn along_velocity(&self) -> Vec<Vec<f64>> {
        let low = self.inputs[0].iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.inputs[0].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let at = |i: usize| low + (high - low) * i as f64 / (CURVE_POINTS - 1) as f64;
        let mean = |column: &Vec<f64>| column.iter().sum::<f64>() / column.len().max(1) as f64;
        let others = self.inputs[1..].iter().map(|column| vec![mean(column); CURVE_POINTS]);
        std::iter::once((0..CURVE_POINTS).map(at).collect()).chain(others).collect()
    }

    /// The 95 % band of a trained network along the velocity, `[velocity, low, high]`, residuals being correlated over
    /// `correlation_length` samples, of the friction beside a constant torque `offset`.
    pub(in crate::fit) fn band(
        &self,
        result: &FitResult,
        correlation_length: f64,
        offset: f64,
    ) -> Result<Vec<[f64; 3]>> {
        // A network has a constant of its own beside the offset that was taken off its samples.
        let apart = self.offset.unwrap_or(0.0) - offset;
        let blocks = Blocks::default();
        let points = self.along_velocity();
        let errors =
            kan::standard_errors(&result.network, &result.linear_coefficients, &self.dataset(&blocks), &points)
                .map_err(|error| refused(&error))?;
        let half = |error: f64| NORMAL_95 * error * correlation_length.sqrt();
        let curve = self.over_velocity(&result.network).into_iter().zip(errors);
        Ok(curve.map(|([v, f], error)| [v, f + apart - half(error), f + apart + half(error)]).collect())
    }
}

fn refused(error: &kan::KanError) -> Error {
    let code = match error {
        kan::KanError::TooFewRows { .. } => &codes::TOO_FEW_ROWS,
        kan::KanError::NotFinite { .. } => &codes::NOT_FINITE,
        _ => &codes::NOT_IDENTIFIABLE,
    };
    Error::new(code, error.to_string())
}
