//! How the friction of a simulation turns over with the direction.
//!
//! Solvers of constraints oppose the velocity that the joint is about to have, and no more than what stops it: MuJoCo's `frictionloss` is
//! `clamp(9 M b (v + a / b), -F, F)` with `b` of [`relaxation`](crate::diagnose::comparison::relaxation), so that both the time by which
//! it is ahead and the width of its turn depend on inertia and level. Smoothed signs of other simulators have a width and no lead.

use super::InverseLaw;
use crate::diagnose::comparison::relaxation::TRIED_S;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{gram, moments, orthonormal, project_out, solve_symmetric};
use crate::numerics::pattern_search::{Movable, climb};

/// Widths of the smoothed sign that are tried, over what the recording of the simulation resolves.
const WIDTH_RATIOS: [f64; 4] = [1.0, 3.0, 10.0, 30.0];

/// Time by which friction turns over before the velocity (s) and the width of its smoothed sign (rad/s): what leaves least of the
/// simulation beside the other columns of a law.
pub(super) fn turn_over(law: &InverseLaw, prepared: &Prepared) -> (f64, f64) {
    let (state, runs) = (&prepared.state, prepared.open_runs());
    let least = state.sign_velocity;
    let columns_at = |lead_s: f64, width: f64| {
        let law = InverseLaw { lead_s, sign_velocity: width, ..law.clone() };
        law.columns(state)
    };
    let odd = law.knots;
    let fixed = law.with_nuisances(prepared, &columns_at(0.0, least)[odd + 1..]);
    let basis = orthonormal(&fixed, &runs);
    let mut target = prepared.filtered(&prepared.torque);
    project_out(&mut target, &basis, &runs);
    let explained = |lead_s: f64, width: f64| {
        let mut columns = prepared.filtered_all(&columns_at(lead_s, width)[..odd]);
        columns.iter_mut().for_each(|column| project_out(column, &basis, &runs));
        let asked = moments(&columns, &target, &runs);
        solve_symmetric(&gram(&columns, &runs), &asked).map(|solution| solution.dot(&asked)).filter(|value| value.is_finite())
    };
    let leads = std::iter::once(0.0).chain(TRIED_S);
    let tried = leads.flat_map(|lead| WIDTH_RATIOS.map(|ratio| (lead, ratio * least)));
    let valued = tried.filter_map(|(lead, width)| explained(lead, width).map(|value| (lead, width, value)));
    let Some((lead, width, _)) = valued.max_by(|a, b| a.2.total_cmp(&b.2)) else { return (0.0, least) };
    let free = [
        Movable { index: 0, step: (0.5 * lead).max(TRIED_S[0]), low: 0.0, high: TRIED_S[TRIED_S.len() - 1] },
        Movable { index: 1, step: 0.5, low: least.ln(), high: (WIDTH_RATIOS[3] * least).ln() },
    ];
    let found = climb(&[lead, width.ln()], &free, |at| explained(at[0], at[1].exp()));
    (found[0], found[1].exp())
}
