//! The effect with a name that comes nearest to a structure without one.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::design::{Group, Variant};
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::search::accepted::{Accepted, others};
use crate::numerics::least_squares::{dot, least_squares, orthonormal, project_out, residual};
use crate::physics::EffectId;
use rayon::prelude::*;

/// Share (0..1) of the energy of an unnamed structure's torque that a named effect has to explain to be mentioned: more
/// than it leaves.
const LEAST_EXPLAINED_SHARE: f64 = 0.5;

/// The effect that explains most of the torque of a structure without a name, with the share of its energy on the open rows beside
/// the base and the other findings. `None` below a half, and of an effect with a name.
pub(crate) fn nearest(
    workbench: &Workbench,
    fitted: &Fitted,
    accepted: &[Accepted],
    index: usize,
) -> Option<(EffectId, f64)> {
    fitted.label.channel()?;
    let runs = workbench.prepared.open_runs();
    let beside = orthonormal(&workbench.base_with_tangents(others(accepted, index).map(Accepted::term)), &runs);
    let left_beside = |column: &Vec<f64>| {
        let mut left = column.clone();
        project_out(&mut left, &beside, &runs);
        left
    };
    let torque = left_beside(&workbench.torque_of(fitted));
    let energy = dot(&torque, &torque, &runs);
    let share = |group: &Group, variant: &Variant| {
        let columns: Vec<Vec<f64>> =
            workbench.design.columns[variant.columns.clone()].iter().map(left_beside).collect();
        let coefficients = least_squares(&columns, &torque, &runs)?;
        let rest = residual(&columns, &torque, &coefficients);
        workbench
            .is_possible(&group.label, &variant.shape, &coefficients)
            .then(|| 1.0 - dot(&rest, &rest, &runs) / energy)
    };
    let largest_share = |group: &Group| {
        let Label::Named(effect) = group.label else { return None };
        let shares = group.variants.iter().filter_map(|variant| share(group, variant));
        Some((effect, shares.fold(0.0, f64::max)))
    };
    let shares: Vec<(EffectId, f64)> = workbench.design.groups.par_iter().filter_map(largest_share).collect();
    shares.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, share)| *share >= LEAST_EXPLAINED_SHARE)
}
