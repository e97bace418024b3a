//! How friction turns over with the direction: as softly as a smoothed sign of some width, and some time before the velocity.
//!
//! Friction of a recording that turns over otherwise than the base's is no effect beside it: a contact is as soft as it is, and solvers of constraints
//! oppose the velocity that the joint is about to have ([`relaxation`](crate::diagnose::comparison::relaxation)).

use crate::diagnose::comparison::columns::{BaseKind, nuisances, raw_columns};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::comparison::relaxation::TRIED_S;
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{
    fit_residual, gram, least_squares, moments, orthonormal, project_out, rows_in, solve_symmetric,
};
use crate::numerics::pattern_search::{Movable, climb};

/// Widths of the smoothed sign that are tried, over what the recording resolves.
const WIDTH_RATIOS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

/// Log likelihood (nats) by which a width has to show: half of what a chi-squared variable of one degree exceeds once in twenty.
const SHOWN_NATS: f64 = 1.92;

/// The same for a lead, which solvers have and no contact has: odds of 150, very strong evidence by Kass and Raftery (1995).
const SHOWN_LEAD_NATS: f64 = 5.0;

/// Rows from which it is looked for. Chosen by judgement: fewer do not tell the noise from the friction.
const LEAST_ROWS: usize = 100;

/// How friction turns over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurnOver {
    /// Time by which it does before the velocity, s.
    pub lead_s: f64,
    /// Width of the smoothed sign.
    pub width: f64,
}

impl TurnOver {
    /// With which most is explained, from the least width on; `None` where nothing is.
    pub fn most_explained(least: f64, mut explained: impl FnMut(f64, f64) -> Option<f64>) -> Option<Self> {
        let leads = std::iter::once(0.0).chain(TRIED_S);
        let tried = leads.flat_map(|lead_s| WIDTH_RATIOS.map(|ratio| (lead_s, ratio * least)));
        let valued = tried.filter_map(|(lead_s, width)| Some((lead_s, width, explained(lead_s, width)?)));
        let (lead_s, width, _) = valued.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let free = [
            Movable { index: 0, step: (0.5 * lead_s).max(TRIED_S[0]), low: 0.0, high: TRIED_S[TRIED_S.len() - 1] },
            Movable { index: 1, step: 0.5, low: least.ln(), high: (WIDTH_RATIOS[3] * least).ln() },
        ];
        let found = climb(&[lead_s, width.ln()], &free, |at| explained(at[0], at[1].exp()));
        Some(Self { lead_s: found[0], width: found[1].exp() })
    }

    /// That of a recording beside its base, as far as it shows.
    fn of_recording(prepared: &Prepared, comparison: &Comparison, kind: BaseKind) -> Self {
        let (mut state, runs) = (prepared.state.clone(), prepared.open_runs());
        let least = state.sign_velocity;
        let sharp = Self { lead_s: 0.0, width: least };
        if rows_in(&runs) < LEAST_ROWS {
            return sharp;
        }
        let mut fixed = nuisances(prepared);
        fixed.push(prepared.filtered(&vec![1.0; state.len()]));
        if state.rotary {
            fixed.push(prepared.filtered(&state.map(|i| state.position[i].sin())));
            fixed.push(prepared.filtered(&state.map(|i| state.position[i].cos())));
        }
        let target = prepared.filtered(&prepared.friction_torque);
        // A torque that was recorded late or early, by a part of a sample, is shifted as a whole, the rigid body with it.
        let sharply = raw_columns(&state, comparison, kind);
        let filtered: Vec<Vec<f64>> = sharply.iter().map(|(_, column)| prepared.filtered(column)).collect();
        let beside: Vec<Vec<f64>> = filtered.into_iter().chain(fixed.iter().cloned()).collect();
        let Some(coefficients) = least_squares(&beside, &target, &runs) else { return sharp };
        let known = comparison.known().torque;
        let predicted = state.map(|i| {
            let fitted: f64 = sharply.iter().zip(&coefficients).map(|((_, column), c)| c * column[i]).sum();
            fitted + known.map_or(0.0, |known| known[i])
        });
        fixed.push(prepared.filtered(&state.rate_of(&predicted)));
        // Beside a free curve over speed, so that friction that bends is not taken for noise.
        let curve =
            raw_columns(&state, comparison, BaseKind::Spline).into_iter().map(|(_, column)| prepared.filtered(&column));
        let Some(left) = fit_residual(&fixed.iter().cloned().chain(curve).collect::<Vec<_>>(), &target, &runs) else {
            return sharp;
        };
        let noise = Noise::fit(&left, &runs, &noise_features(prepared));
        let white = |column: &Vec<f64>| noise.whitened(column, &runs);
        let basis = orthonormal(&fixed.iter().map(white).collect::<Vec<_>>(), &runs);
        let mut target = white(&target);
        project_out(&mut target, &basis, &runs);
        let mut explained = |lead_s: f64, width: f64| {
            state.sign_lead_s = lead_s;
            state.turn_over_within(width);
            let columns = raw_columns(&state, comparison, kind);
            let mut columns: Vec<Vec<f64>> =
                columns.iter().map(|(_, column)| white(&prepared.filtered(column))).collect();
            columns.iter_mut().for_each(|column| project_out(column, &basis, &runs));
            let asked = moments(&columns, &target, &runs);
            let solution = solve_symmetric(&gram(&columns, &runs), &asked)?;
            Some(0.5 * solution.dot(&asked)).filter(|value| value.is_finite())
        };
        let Some(mut found) = Self::most_explained(least, &mut explained) else { return sharp };
        let mut nats = |at: Self| explained(at.lead_s, at.width).unwrap_or(0.0);
        let in_step = Self { lead_s: 0.0, ..found };
        if nats(found) - nats(in_step) < SHOWN_LEAD_NATS {
            found = in_step;
        }
        let narrow = Self { width: least, ..found };
        if nats(found) - nats(narrow) < SHOWN_NATS { narrow } else { found }
    }
}

/// Friction of a recording that is compared with friction fitted to itself turns over as the recording shows.
pub(crate) fn fit_turn_over(prepared: &mut Prepared, comparison: &Comparison, kind: BaseKind) {
    if kind == BaseKind::Reference {
        return;
    }
    let TurnOver { lead_s, width } = TurnOver::of_recording(prepared, comparison, kind);
    prepared.state.sign_lead_s = lead_s;
    prepared.state.turn_over_within(width);
}
