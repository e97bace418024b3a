//! Table and expression side by side: what each costs on a drive, which of them the budget allows, which goes into the image.

use frikan_shared::image::Image;
use frikan_shared::model::Law;

use super::choose::{Trial, decide};
use super::gather::Material;
use super::model::{HostModel, provenance, to_bytes};
use super::options::Budget;
use super::outcome::{Candidate, Representation};
use super::rigid;
use crate::compile::cost::instructions;
use crate::error::{Error, Result, codes};

/// Both forms, fitted to the open blocks; `None` where a form does not fit into an image.
pub(super) struct Rivals {
    pub(super) table: Option<Box<HostModel>>,
    pub(super) expression: Option<Box<HostModel>>,
}

/// Which form was chosen, and why.
pub(super) struct Verdict {
    pub(super) representation: Representation,
    pub(super) reason: String,
    pub(super) candidates: Vec<Candidate>,
}

impl Budget {
    /// Whether a model keeps within it.
    pub(super) fn allows(&self, model: &HostModel) -> bool {
        size(model).is_ok_and(|bytes| self.covers(bytes, instructions(model)))
    }

    fn covers(&self, bytes: usize, instructions: u32) -> bool {
        self.bytes.is_none_or(|most| bytes <= most) && self.instructions.is_none_or(|most| instructions <= most)
    }
}

/// Bytes of the image of a model, provenance not counted.
fn size(model: &HostModel) -> Result<usize> {
    Ok(to_bytes(&Image { provenance: provenance("", &[], 0), model: model.clone() })?.len())
}

impl Rivals {
    /// Compares the forms on the locked rows and takes the better one that is asked for, can be had and may be afforded.
    pub(super) fn judge(&self, material: &Material, asked: Option<Representation>, budget: &Budget) -> Result<Verdict> {
        let unit = rigid::printed(material.samples.actuator_unit);
        let trial = |model: &Option<Box<HostModel>>| model.as_ref().map(|m| Trial::of(m, material)).transpose();
        let (table, expression) = (trial(&self.table)?, trial(&self.expression)?);
        let mut candidates = Vec::new();
        let forms =
            [(Representation::Table, &self.table, &table), (Representation::Expression, &self.expression, &expression)];
        for (form, model, trial) in forms {
            let Some((model, trial)) = model.as_ref().zip(trial.as_ref()) else { continue };
            let bytes = size(model)?;
            candidates.push(Candidate {
                representation: form,
                description: describe(&model.law, model.cells.len()),
                held_out_rmse: trial.rmse(),
                bytes,
                instructions: instructions(model),
                within_budget: budget.covers(bytes, instructions(model)),
                chosen: false,
            });
        }
        if candidates.is_empty() {
            return Err(no_image());
        }
        if candidates.iter().all(|candidate| !candidate.within_budget) {
            return Err(beyond(&candidates));
        }
        let affordable = |form| candidates.iter().any(|c| c.representation == form && c.within_budget);
        let (representation, reason) = match (asked, &table, &expression) {
            (Some(asked), _, _) if affordable(asked) => (asked, format!("{} was asked for", named(asked))),
            (_, Some(table), Some(expression))
                if affordable(Representation::Table) && affordable(Representation::Expression) =>
            {
                decide(table, expression, material, unit)
            }
            _ => {
                let (only, other) = if affordable(Representation::Table) {
                    (Representation::Table, Representation::Expression)
                } else {
                    (Representation::Expression, Representation::Table)
                };
                let there = candidates.iter().any(|c| c.representation == other);
                let why = if there { "is beyond the budget" } else { "does not fit into an image" };
                (only, format!("{} {why}", named(other)))
            }
        };
        candidates.iter_mut().for_each(|candidate| candidate.chosen = candidate.representation == representation);
        let reason = format!("{reason}; {}", costs(&candidates));
        Ok(Verdict { representation, reason, candidates })
    }
}

fn named(form: Representation) -> &'static str {
    match form {
        Representation::Table => "the table",
        Representation::Expression => "the expression",
    }
}

/// What each form costs, in words.
fn costs(candidates: &[Candidate]) -> String {
    let cost = |c: &Candidate| {
        format!("{} takes {} instructions and {} bytes", named(c.representation), c.instructions, c.bytes)
    };
    candidates.iter().map(cost).collect::<Vec<_>>().join(", ")
}

fn beyond(candidates: &[Candidate]) -> Error {
    Error::new(&codes::USAGE, format!("no form of the law keeps within the budget: {}", costs(candidates)))
}

/// Neither form has room.
pub(super) fn no_image() -> Error {
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
