//! Laws become models of one joint: formula or tables, rigid body and limit.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::{Law, MAX_INPUTS};

use super::formula::formula_of;
use super::learn::TrainedNetwork;
use super::tables;
use crate::compile::program::compile_program;
use crate::fit::data::gather::Material;
use crate::fit::data::inputs::{ChosenInput, output_unit};
use crate::fit::data::rigid;
use crate::fit::model::{HostModel, Parts, assemble};
use crate::joint::Joint;
use crate::law::{Expr, FormFit};

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
/// Turns laws into models of one joint.
pub(in crate::fit) struct Builder<'a> {
    pub(in crate::fit) material: &'a Material,
    pub(in crate::fit) inputs: &'a [ChosenInput],
    pub(in crate::fit) joint: &'a Joint,
    /// Cells that a table may have.
    pub(in crate::fit) cells: usize,
}

impl Builder<'_> {
    pub(in crate::fit) fn expression(&self, fit: &FormFit) -> Option<Box<HostModel>> {
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
    pub(in crate::fit) fn table(&self, learnt: &TrainedNetwork) -> Option<Box<HostModel>> {
        let rmse = learnt.rmse;
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
