//! How the friction of a simulation turns over with the direction.
//!
//! Solvers of constraints oppose the velocity that the joint is about to have, and no more than what stops it: MuJoCo's `frictionloss` is
//! `clamp(9 M b (v + a / b), -F, F)` with `b` of [`relaxation`](super::relaxation), so that both the time by which
//! it is ahead and the width of its turn depend on inertia and level. Smoothed signs of other simulators have a width and no lead.

use super::InverseLaw;
use crate::diagnose::comparison::turn_over::{SHOWN_BOTH_NATS, TurnOver};
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{dot, explained_energy, fit_residual, orthonormal, project_out};

/// Least lead that is told from the sampling's own delay, samples: half a sample is the difference between the begin of a step and its mean.
const LEAST_LEAD: f64 = 0.5;

/// How the friction of a simulation turns over: what leaves least of it beside the other columns of a law; sharply where that does not show, as
/// in a simulation that has no friction.
pub(super) fn turn_over(law: &InverseLaw, prepared: &Prepared) -> TurnOver {
    let (state, runs) = (&prepared.state, prepared.open_runs());
    let least = state.sign_velocity;
    let columns_at =
        |lead_s: f64, width: f64| InverseLaw { lead_s, sign_velocity: width, ..law.clone() }.columns(state);
    // The hats over speed turn over; what follows but for the friction that differs between the directions does not.
    let fixed = law.with_nuisances(prepared, &columns_at(0.0, least)[law.knots + 1..]);
    let basis = orthonormal(&fixed, &runs);
    let torque = prepared.filtered(&prepared.torque);
    let mut target = torque.clone();
    project_out(&mut target, &basis, &runs);
    let friction_at = |at: TurnOver| prepared.filtered_all(&columns_at(at.lead_s, at.width)[..law.knots]);
    let explained = |at: TurnOver| {
        let mut columns = friction_at(at);
        columns.iter_mut().for_each(|column| project_out(column, &basis, &runs));
        explained_energy(&columns, &target, &runs)
    };
    let sharp = TurnOver { lead_s: 0.0, width: least };
    let Some(found) = TurnOver::most_explained(least, f64::INFINITY, true, explained) else { return sharp };
    let law_at = |at: TurnOver| [&friction_at(at)[..], &fixed].concat();
    let nats = gained_nats([&law_at(sharp), &law_at(found)], &torque, prepared);
    if nats.is_none_or(|nats| nats < SHOWN_BOTH_NATS) {
        return sharp;
    }
    let is_resolved = found.lead_s > LEAST_LEAD * state.period;
    TurnOver { lead_s: if is_resolved { found.lead_s } else { 0.0 }, ..found }
}

/// Log likelihood (nats) of a torque by `after` over that by `before`, columns each, with the noise that `after` leaves; `None` where either is
/// singular.
fn gained_nats([before, after]: [&[Vec<f64>]; 2], torque: &[f64], prepared: &Prepared) -> Option<f64> {
    let runs = prepared.open_runs();
    let noise = Noise::fit(&fit_residual(after, torque, &runs)?, &runs, &noise_features(prepared));
    let energy = |columns: &[Vec<f64>]| {
        let columns: Vec<Vec<f64>> = columns.iter().map(|column| noise.whitened(column, &runs)).collect();
        let left = fit_residual(&columns, &noise.whitened(torque, &runs), &runs)?;
        Some(dot(&left, &left, &runs))
    };
    Some(0.5 * (energy(before)? - energy(after)?))
}
