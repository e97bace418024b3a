//! An effect of which only a part shows is told by the effect of the catalogue that is this part.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::proof::discarded::{MINOR_SHARE, MINOR_TORQUE_SHARE, energy_left, torque_beside_rigid_body};
use crate::diagnose::proof::refit::Refit;
use crate::diagnose::search::accepted::Accepted;
use crate::numerics::least_squares::{dot, fit_residual};

/// Share of the energy of a column that may lie outside of a span, but for roundoff and filtering.
const PART_ENERGY_SHARE: f64 = 1e-6;

/// Tells effects by their parts where the further coefficients are as minor as an effect of their own would be: a spring whose force hardly
/// changes over the travel is an offset. Whether any was.
pub(crate) fn tell_by_a_part(workbench: &Workbench, accepted: &mut [Accepted], baseline: &Refit) -> bool {
    let small_energy = (MINOR_TORQUE_SHARE * torque_beside_rigid_body(workbench)).powi(2);
    let mut is_any_told = false;
    for index in 0..accepted.len() {
        let Some(all) = energy_left(workbench, accepted) else { continue };
        let most = small_energy.min(MINOR_SHARE * (baseline.noise.rms.powi(2) - all));
        let part = workbench.hypotheses.iter().find_map(|part| {
            let mut told = accepted.to_vec();
            told[index] = Accepted { label: Label::Named(part.id()), shape: Vec::new(), ..told[index].clone() };
            let is_told = is_part(workbench, &told[index], &accepted[index])
                && energy_left(workbench, &told).is_some_and(|left| left - all < most);
            is_told.then(|| told.swap_remove(index))
        });
        if let Some(part) = part {
            accepted[index] = part;
            is_any_told = true;
        }
    }
    is_any_told
}

/// Whether an effect without shape parameters is a named one with fewer coefficients.
fn is_part(workbench: &Workbench, part: &Accepted, whole: &Accepted) -> bool {
    let has_shape = workbench.hypothesis(part.effect()).is_none_or(|part| !part.shape_names(&[]).is_empty());
    if has_shape || part.label == whole.label || whole.label.channel().is_some() {
        return false;
    }
    let runs = workbench.prepared.open_runs();
    let [columns, span] = [part, whole].map(|effect| workbench.filtered_columns(&effect.label, &effect.shape));
    let is_within = |column: &Vec<f64>| {
        let left = fit_residual(&span, column, &runs).map_or(f64::INFINITY, |left| dot(&left, &left, &runs));
        left < PART_ENERGY_SHARE * dot(column, column, &runs)
    };
    (1..span.len()).contains(&columns.len()) && columns.iter().all(is_within)
}
