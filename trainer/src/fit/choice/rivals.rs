//! The laws side by side: what each costs on a drive, which of them the budget allows, which goes into the image.

use frikan_shared::image::Image;
use frikan_shared::model::Law;

use super::choose::{Entry, Judge, Trial, effective_rows};
use super::physical::Violation;
use crate::compile::cost::instructions;
use crate::compile::profile::Profile;
use crate::error::{Error, Result, codes};
use crate::fit::data::gather::Material;
use crate::fit::data::rigid;
use crate::fit::data::turns::Repetition;
use crate::fit::model::{HostModel, provenance, to_bytes};
use crate::fit::options::Budget;
use crate::fit::outcome::{Candidate, Form, Representation};

/// Which law was chosen, and why.
pub(in crate::fit) struct Verdict {
    pub(in crate::fit) form: Form,
    pub(in crate::fit) reason: String,
    pub(in crate::fit) candidates: Vec<Candidate>,
}

/// What a law was free to choose, and how it used that.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::fit) struct Freedom {
    /// Constants beside the rigid body.
    pub(in crate::fit) constants: usize,
    /// Whether friction is less at rest than in motion, which has to be wanted clearly.
    pub(in crate::fit) stribeck_is_negative: bool,
}

impl Budget {
    /// Whether a model keeps within it.
    pub(in crate::fit) fn allows(&self, model: &HostModel) -> bool {
        size(model).is_ok_and(|bytes| self.covers(model, bytes))
    }

    fn covers(&self, model: &HostModel, bytes: usize) -> bool {
        self.bytes.is_none_or(|most| bytes <= most)
            && self.instructions.is_none_or(|most| instructions(model) <= most)
            && model.cells.len() <= self.target.cells
    }
}

/// Bytes of the image of a model, provenance not counted.
fn size(model: &HostModel) -> Result<usize> {
    Ok(to_bytes(&Image { provenance: provenance("", &[], 0), model: model.clone() })?.len())
}

/// Compares the laws on rows that they have not seen, or by what their constants cost where there are none, and takes the simplest
/// that none of those asked for and within the budget beats. `models` are those of the first turn, `freedom` what each was free to choose, both in the order of [`Form::ALL`].
pub(in crate::fit) fn judge(
    material: &Material,
    models: &[Option<Box<HostModel>>; 4],
    trials: &[Option<Trial>; 4],
    freedom: [Freedom; 4],
    asked: Option<Representation>,
    budget: &Budget,
) -> Result<Verdict> {
    let unit = rigid::printed(material.samples.actuator_unit);
    let mut candidates = Vec::new();
    let mut entries: [Option<Entry<'_>>; 4] = std::array::from_fn(|_| None);
    for (index, form) in Form::ALL.into_iter().enumerate() {
        let Some((model, trial)) = models[index].as_ref().zip(trials[index].as_ref()) else { continue };
        let bytes = size(model)?;
        let violation = Violation::of(model, material);
        let candidate = Candidate {
            form,
            representation: form.representation(),
            description: describe(&model.law, model.cells.len()),
            held_out_rmse: trial.rmse(),
            violation: violation.sentence(),
            bytes,
            instructions: instructions(model),
            within_budget: budget.covers(model, bytes),
            chosen: false,
        };
        if candidate.within_budget && asked.is_none_or(|asked| asked == candidate.representation) {
            let Freedom { constants, stribeck_is_negative } = freedom[index];
            let breaks_physics = violation.is_any() || stribeck_is_negative;
            entries[index] = Some(Entry { trial, constants, breaks_physics });
        }
        candidates.push(candidate);
    }
    if candidates.is_empty() {
        return Err(no_image());
    }
    let judge = match &material.repeats {
        Some(repetition) => Judge::Penalty { effective: effective_rows(material, repetition.new_share) },
        None => Judge::Locked,
    };
    let Some(chosen) = judge.choose(&entries) else { return Err(beyond(&candidates, asked, budget.target)) };
    let form = Form::ALL[chosen];
    candidates.iter_mut().for_each(|candidate| candidate.chosen = candidate.form == form);
    let reason = reason(form, &candidates, material.repeats.as_ref(), unit);
    Ok(Verdict { form, reason: format!("{reason}; {}", costs(&candidates)), candidates })
}

/// Why this one, with the figures of the others.
fn reason(form: Form, candidates: &[Candidate], repeats: Option<&Repetition>, unit: &str) -> String {
    let figure = |candidate: &Candidate| format!("{:.4} {unit} of {}", candidate.held_out_rmse, candidate.form.name());
    let own = candidates.iter().find(|candidate| candidate.form == form).map(figure).unwrap_or_default();
    let others: Vec<String> = candidates.iter().filter(|candidate| candidate.form != form).map(figure).collect();
    let rows = match repeats {
        Some(repeats) => format!("on the rows that were fitted, constants being paid for ({})", repeats.sentence),
        None => "on held-out blocks".to_owned(),
    };
    if others.is_empty() { format!("{own} {rows}") } else { format!("{own} against {} {rows}", others.join(", ")) }
}

/// What each costs, in words.
fn costs(candidates: &[Candidate]) -> String {
    let cost = |c: &Candidate| format!("{} takes {} instructions and {} bytes", c.form.name(), c.instructions, c.bytes);
    candidates.iter().map(cost).collect::<Vec<_>>().join(", ")
}

fn beyond(candidates: &[Candidate], asked: Option<Representation>, target: Profile) -> Error {
    if candidates.iter().all(|candidate| asked.is_some_and(|asked| candidate.representation != asked)) {
        return no_image();
    }
    let room = format!("{}, which has room for {} cells", target.name, target.cells);
    Error::new(&codes::USAGE, format!("no form of the law keeps within the budget and {room}: {}", costs(candidates)))
}

/// Neither form has room.
pub(in crate::fit) fn no_image() -> Error {
    Error::new(&codes::NOT_IDENTIFIABLE, "neither the network nor the expression fits into an image")
}

fn describe(law: &Law, cells: usize) -> String {
    match law {
        Law::Expression(program) => format!("program of {} operations", program.operations.len()),
        Law::Network(network) => {
            let nodes: usize = network.layers().iter().map(|layer| layer.nodes()).sum();
            format!("network of {nodes} hidden nodes, {cells} cells")
        }
        _ => format!("table of {cells} cells"),
    }
}
