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
const WIDTH_RATIOS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

/// Least lead that is told from the sampling's own delay, samples: half a sample is the difference between the begin of a step and its mean.
const LEAST_LEAD: f64 = 0.5;

/// How friction turns over.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnOver {
    /// Time by which it does before the velocity, s.
    pub lead_s: f64,
    /// Width of the smoothed sign.
    pub width: f64,
}

impl TurnOver {
    /// What leaves least of a simulation beside the other columns of a law.
    pub fn of(law: &InverseLaw, prepared: &Prepared) -> Self {
        let (state, runs) = (&prepared.state, prepared.open_runs());
        let least = state.sign_velocity;
        let columns_at =
            |lead_s: f64, width: f64| InverseLaw { lead_s, sign_velocity: width, ..law.clone() }.columns(state);
        // The hats over speed turn over; what follows but for the friction that differs between the directions does not.
        let fixed = law.with_nuisances(prepared, &columns_at(0.0, least)[law.knots + 1..]);
        let basis = orthonormal(&fixed, &runs);
        let mut target = prepared.filtered(&prepared.torque);
        project_out(&mut target, &basis, &runs);
        let explained = |lead_s: f64, width: f64| {
            let mut columns = prepared.filtered_all(&columns_at(lead_s, width)[..law.knots]);
            columns.iter_mut().for_each(|column| project_out(column, &basis, &runs));
            let asked = moments(&columns, &target, &runs);
            let solution = solve_symmetric(&gram(&columns, &runs), &asked)?;
            Some(solution.dot(&asked)).filter(|value| value.is_finite())
        };
        let leads = std::iter::once(0.0).chain(TRIED_S);
        let tried = leads.flat_map(|lead_s| WIDTH_RATIOS.map(|ratio| (lead_s, ratio * least)));
        let valued = tried.filter_map(|(lead_s, width)| Some((lead_s, width, explained(lead_s, width)?)));
        let Some((lead_s, width, _)) = valued.max_by(|a, b| a.2.total_cmp(&b.2)) else {
            return Self { lead_s: 0.0, width: least };
        };
        let free = [
            Movable { index: 0, step: (0.5 * lead_s).max(TRIED_S[0]), low: 0.0, high: TRIED_S[TRIED_S.len() - 1] },
            Movable { index: 1, step: 0.5, low: least.ln(), high: (WIDTH_RATIOS[3] * least).ln() },
        ];
        let found = climb(&[lead_s, width.ln()], &free, |at| explained(at[0], at[1].exp()));
        let is_resolved = found[0] > LEAST_LEAD * state.period;
        Self { lead_s: if is_resolved { found[0] } else { 0.0 }, width: found[1].exp() }
    }
}
