//! One turn: everything that is learnt without the locked blocks of one split.

use super::choose::Trial;
use crate::error::Result;
use crate::fit::data::gather::Material;
use crate::fit::data::turns;
use crate::fit::laws::activations;
use crate::fit::laws::builder::Builder;
use crate::fit::laws::formula::{Found, search};
use crate::fit::laws::learn::TrainingData;
use crate::fit::laws::simple::{Simple, simple};
use crate::fit::model::HostModel;
use crate::fit::options::{Progress, ProgressCallback, Stage};
use crate::fit::outcome::Form;
use crate::kan::{FitResult, Pruned};
use crate::law::{KnownForm, LawData};
use crate::samples::blocks::Split;

/// What one turn brings.
pub(in crate::fit) struct Turn {
    pub(in crate::fit) fitted: FitResult,
    pub(in crate::fit) pruned: Pruned,
    pub(in crate::fit) found: Found,
    /// The simple model of right signs, and the one of wrong signs where that is the better.
    pub(in crate::fit) simple: [Option<Simple>; 2],
    /// A model of each form, in the order of [`Form::ALL`]; `None` where it does not fit into an image.
    pub(in crate::fit) models: [Option<Box<HostModel>>; 4],
}

impl Turn {
    /// Trains, searches and builds without the locked blocks; a law of the form `asked` alone, where one is asked for.
    ///
    /// # Errors
    /// `FRK-N...` and `FRK-D...` when nothing can be learnt at all.
    pub(in crate::fit) fn take(
        builder: &Builder<'_>,
        training: &TrainingData,
        (points, data): (&LawData, &LawData),
        split: &Split,
        asked: Option<KnownForm>,
        progress: ProgressCallback<'_>,
    ) -> Result<Self> {
        let tell = |stage| progress(&Progress { stage, steps: 0, rmse: None });
        tell(Stage::Training);
        let (fitted, pruned) = training.train(split, progress)?;
        tell(Stage::Searching);
        let learnt = training.learnt(&pruned.result);
        let starts = activations::starts(&learnt.network, &learnt.graph, builder.inputs);
        let found = search(split, (points, data), starts, asked)?;
        let (sound, free) = simple(&data.select(&turns::open(split)));
        let of = |simple: &Option<Simple>| simple.as_ref().and_then(|simple| builder.expression(&simple.fit));
        let models = Form::ALL.map(|form| match form {
            Form::Found => builder.expression(&found.open),
            _ if asked.is_some() => None,
            Form::Simple => of(&sound),
            // Where no sign is wrong in this turn it is the same.
            Form::SimpleAsFitted => of(&free).or_else(|| of(&sound)),
            Form::Network => builder.table(&learnt),
        });
        Ok(Self { fitted, pruned, found, simple: [sound, free], models })
    }
}

/// Errors of each form over all turns; `None` where one of the turns has no model of it.
pub(in crate::fit) fn trials(turns: &[Turn], splits: &[Split], material: &Material) -> Result<[Option<Trial>; 4]> {
    let mut trials: [Option<Trial>; 4] = std::array::from_fn(|_| Some(Trial::default()));
    for (turn, split) in turns.iter().zip(splits) {
        for (trial, model) in trials.iter_mut().zip(&turn.models) {
            match (trial.as_mut(), model) {
                (Some(trial), Some(model)) => trial.add(model, material, split)?,
                _ => *trial = None,
            }
        }
    }
    if turns.iter().all(|turn| turn.simple[1].is_none()) {
        // No sign is wrong in any turn.
        trials[1] = None;
    }
    Ok(trials)
}
