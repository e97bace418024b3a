//! How friction turns over with the direction: as softly as a smoothed sign of some width, and some time before the velocity.
//!
//! Friction of a recording that turns over otherwise than the base's is no effect beside it: a contact is as soft as it is, and solvers of constraints
//! oppose the velocity that the joint is about to have ([`lead`](crate::samples::lead)).

use crate::diagnose::comparison::columns::{BaseKind, differentiation_bias, raw_columns, sharpness};
use crate::diagnose::comparison::reference::{Comparison, Reference};
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{
    explained_energy, explained_up_to, fit_residual, least_squares, orthonormal, project_out, rows_in,
};
use crate::numerics::pattern_search::{Movable, climb};
use crate::physics::JointState;
use crate::physics::presliding::{breakaway_distances, bristle};
use crate::samples::SLIDING_SPEED_SHARE;
use crate::samples::lead::{SHOWN_NATS as SHOWN_LEAD_NATS, TRIED_S};

/// Widths of the smoothed sign that are tried, over what the recording resolves; each is four times the one before.
const WIDTH_RATIOS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

/// Upper ends of width and lead over the largest that are tried: the same as half a step between two widths.
const END_RATIO: f64 = 2.0;

/// Log likelihood (nats) by which a width has to show: half of what a chi-squared variable of one degree exceeds once in twenty.
const SHOWN_NATS: f64 = 1.92;

/// The same for two degrees: a share of the friction with a width of its own, or width and lead together.
pub(crate) const SHOWN_BOTH_NATS: f64 = 3.0;

/// Least rows of motion from which a law of friction is learned.
pub(crate) const LEAST_ROWS: usize = 100;

/// How friction turns over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurnOver {
    /// Time by which it does before the velocity, s.
    pub lead_s: f64,
    /// Width of the smoothed sign.
    pub width: f64,
}

impl TurnOver {
    /// With which most is explained, from the least width on and with a lead if there may be one; `None` where nothing is, or where more is
    /// explained up to the end of what turns over, at `widest` or before.
    pub fn most_explained(
        least: f64,
        widest: f64,
        may_lead: bool,
        explained: impl Fn(Self) -> Option<f64>,
    ) -> Option<Self> {
        let leads = std::iter::once(0.0).chain(TRIED_S.into_iter().filter(|_| may_lead));
        let widths = WIDTH_RATIOS.map(|ratio| ratio * least).into_iter().filter(|width| *width < widest);
        let tried = leads.flat_map(|lead_s| widths.clone().map(move |width| Self { lead_s, width }));
        let valued = tried.filter_map(|at| Some((at, explained(at)?)));
        let (nearest, _) = valued.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let longest_s = END_RATIO * TRIED_S[TRIED_S.len() - 1];
        let widest = widest.min(END_RATIO * WIDTH_RATIOS[WIDTH_RATIOS.len() - 1] * least);
        let step_s = (0.5 * nearest.lead_s).max(TRIED_S[0]);
        let width = Movable { index: 1, step: 0.5, low: least.ln(), high: widest.ln() };
        let lead = Movable { index: 0, step: step_s, low: 0.0, high: longest_s };
        let free = if may_lead { vec![lead, width] } else { vec![width] };
        let of = |at: &[f64]| Self { lead_s: at[0], width: at[1].exp() };
        let found = of(&climb(&[nearest.lead_s, nearest.width.ln()], &free, |at| explained(of(at))));
        (found.lead_s < longest_s && found.width.ln() < widest.ln()).then_some(found)
    }

    /// Lets the friction of states turn over so.
    pub fn turn(self, state: &mut JointState) {
        state.turn_over_at(self.lead_s, self.width);
    }

    /// That of a recording, as far as it shows. Beside friction that is fitted to it this is sharp where nothing shows; beside a model that was
    /// fitted elsewhere, whose friction turns over as its data told, and beside a simulation it is `None`.
    pub fn of_recording(prepared: &Prepared, comparison: &Comparison, kind: BaseKind) -> Option<Self> {
        let is_fitted = kind != BaseKind::Reference;
        let sharp = Self { lead_s: 0.0, width: prepared.sharp_sign_velocity };
        let unshown = is_fitted.then_some(sharp);
        if !is_fitted && !comparison.is_with_fitted_model() || rows_in(&prepared.open_runs()) < LEAST_ROWS {
            return unshown;
        }
        let Some(evidence) = Evidence::new(prepared, comparison, kind) else { return unshown };
        if is_fitted { Some(evidence.shown(sharp)) } else { evidence.shown_beside_law(sharp) }
    }
}

/// What a recording says of how its friction turns over, beside all that is no friction of the velocity.
struct Evidence<'a> {
    prepared: &'a Prepared,
    comparison: &'a Comparison,
    kind: BaseKind,
    noise: Noise,
    /// Orthonormal basis of what is fitted beside friction, whitened.
    beside: Vec<Vec<f64>>,
    /// Whitened torque less what that explains.
    target: Vec<f64>,
    /// The law, where one is compared with.
    law: Option<&'a Reference>,
}

impl<'a> Evidence<'a> {
    fn new(prepared: &'a Prepared, comparison: &'a Comparison, kind: BaseKind) -> Option<Self> {
        let (state, runs) = (&prepared.state, prepared.open_runs());
        let mut beside = differentiation_bias(prepared);
        beside.push(prepared.filtered(&vec![1.0; state.len()]));
        if state.rotary {
            beside.push(prepared.filtered(&state.map(|i| state.position[i].sin())));
            beside.push(prepared.filtered(&state.map(|i| state.position[i].cos())));
        }
        // Friction that builds up over a distance turns over late, not softly (Al-Bender, Lampaert and Swevers 2005).
        let builds_up = |distance| {
            let deflection = bristle(state, distance);
            prepared.filtered(&state.map(|i| deflection[i] - state.sign[i]))
        };
        beside.extend(breakaway_distances(state).into_iter().map(builds_up));
        let target = prepared.filtered(&prepared.friction_torque);
        // A torque that was recorded late or early, by a part of a sample, is shifted as a whole, the rigid body with it.
        let sharply = raw_columns(state, comparison, kind);
        let filtered: Vec<Vec<f64>> = sharply.iter().map(|(_, column)| prepared.filtered(column)).collect();
        let coefficients = least_squares(&[&filtered[..], &beside].concat(), &target, &runs)?;
        if kind == BaseKind::Reference {
            beside.extend(filtered);
            beside.push(sharpness(prepared));
        }
        let known = comparison.known().torque;
        let predicted = state.map(|i| {
            let fitted: f64 = sharply.iter().zip(&coefficients).map(|((_, column), c)| c * column[i]).sum();
            fitted + known.map_or(0.0, |known| known[i])
        });
        beside.push(prepared.filtered(&state.rate_of(&predicted)));
        // Beside a free curve over speed, so that friction that bends is not taken for noise.
        let curve = raw_columns(state, comparison, BaseKind::Spline);
        let curve: Vec<Vec<f64>> = curve.iter().map(|(_, column)| prepared.filtered(column)).collect();
        let left = fit_residual(&[&beside[..], &curve].concat(), &target, &runs)?;
        let noise = Noise::fit(&left, &runs, &noise_features(prepared));
        let white = |column: &Vec<f64>| noise.whitened(column, &runs);
        let beside = orthonormal(&beside.iter().map(white).collect::<Vec<_>>(), &runs);
        let mut target = white(&target);
        project_out(&mut target, &beside, &runs);
        let law = comparison.reference.as_ref().filter(|_| kind == BaseKind::Reference);
        Some(Self { prepared, comparison, kind, noise, beside, target, law })
    }

    /// Log likelihood (nats) that friction explains if it turns over so; beside a law, if a share of the law's does.
    fn nats(&self, at: TurnOver) -> Option<f64> {
        let runs = self.prepared.open_runs();
        let mut state = self.prepared.state.clone();
        at.turn(&mut state);
        let whitened = |column: &Vec<f64>| {
            let mut column = self.noise.whitened(&self.prepared.filtered(column), &runs);
            project_out(&mut column, &self.beside, &runs);
            column
        };
        if let Some(law) = self.law {
            // No more than all of the law's friction turns over otherwise.
            let otherwise = whitened(&law.turned_otherwise(&state)?);
            return explained_up_to(1.0, &otherwise, &self.target, &runs).map(|energy| 0.5 * energy);
        }
        let columns = raw_columns(&state, self.comparison, self.kind);
        let columns: Vec<Vec<f64>> = columns.iter().map(|(_, column)| whitened(column)).collect();
        explained_energy(&columns, &self.target, &runs).map(|energy| 0.5 * energy)
    }

    /// With which most is explained from `least` on.
    fn most(&self, least: f64, may_lead: bool) -> Option<TurnOver> {
        // Beside a law a part of the friction turns over otherwise, and where the joint slides there is none of that.
        let widest = self.law.map_or(f64::INFINITY, |_| SLIDING_SPEED_SHARE * self.prepared.state.top_speed());
        TurnOver::most_explained(least, widest, may_lead, |at| self.nats(at))
    }

    fn value(&self, at: TurnOver) -> f64 {
        self.nats(at).unwrap_or(f64::NEG_INFINITY)
    }

    /// How friction turns over as far as it shows: first without a lead, then with one.
    fn shown(&self, sharp: TurnOver) -> TurnOver {
        let better = |found: Option<TurnOver>, than: TurnOver, least: f64| {
            found.filter(|found| self.value(*found) - self.value(than) > least).unwrap_or(than)
        };
        let in_step = better(self.most(sharp.width, false), sharp, SHOWN_NATS);
        let leading = better(self.most(sharp.width, true), in_step, SHOWN_LEAD_NATS);
        better(Some(leading), TurnOver { width: sharp.width, ..leading }, SHOWN_NATS)
    }

    /// How a part of the friction turns over that the law does not have so, as far as there is one.
    fn shown_beside_law(&self, sharp: TurnOver) -> Option<TurnOver> {
        let in_step = self.most(sharp.width, false).filter(|found| self.value(*found) > SHOWN_BOTH_NATS);
        let gained = in_step.map_or(0.0, |found| self.value(found));
        self.most(sharp.width, true).filter(|found| self.value(*found) - gained > SHOWN_LEAD_NATS).or(in_step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;
    use crate::diagnose::preparation::rows::Lock;
    use std::f64::consts::TAU;

    /// A body of 0.5 kg m2 with friction by velocity, acceleration, and position since the last reversal.
    fn moving(friction: impl Fn(f64, f64, f64) -> f64) -> Signals {
        let time: Vec<f64> = (0..20_000).map(|i| 1e-3 * f64::from(i)).collect();
        let position: Vec<f64> = time.iter().map(|t| (TAU * 0.7 * t).sin() + 0.4 * (TAU * 0.31 * t).sin()).collect();
        let (fast, slow) = (TAU * 0.7, TAU * 0.31);
        let velocity: Vec<f64> = time.iter().map(|t| fast * (fast * t).cos() + 0.4 * slow * (slow * t).cos()).collect();
        let mut since = 0.0;
        let torque = |i: usize| {
            since = if i > 0 && velocity[i] * velocity[i - 1] < 0.0 { position[i] } else { since };
            let t = time[i];
            let acceleration = -fast * fast * (fast * t).sin() - 0.4 * slow * slow * (slow * t).sin();
            0.5 * acceleration
                + friction(velocity[i], acceleration, position[i] - since)
                + 1e-4 * (7919.0 * t * t).sin()
        };
        let torque = (0..time.len()).map(torque).collect();
        Signals::without_gap(1e-3, time, position, torque)
    }

    /// The least width, and how it turns over.
    fn widened(signals: Signals) -> (f64, TurnOver) {
        let comparison = Comparison::from(signals);
        let prepared = comparison.prepare(Lock::Nothing);
        let found = TurnOver::of_recording(&prepared, &comparison, BaseKind::CoulombViscous);
        (prepared.state.sign_velocity, found.expect("a width"))
    }

    #[test]
    fn the_width_of_a_soft_sign_is_found() {
        let (_, found) = widened(moving(|velocity, _, _| 2.0 * (velocity / 0.04).tanh() + 0.3 * velocity));
        assert!((found.width / 0.04 - 1.0).abs() < 0.1 && found.lead_s == 0.0, "{found:?}");
    }

    #[test]
    fn the_lead_of_a_constraint_is_found() {
        let leading = |velocity: f64, acceleration: f64, _| {
            2.0 * ((velocity + 0.008 * acceleration) / 0.02).tanh() + 0.3 * velocity
        };
        let (_, found) = widened(moving(leading));
        assert!((found.lead_s / 0.008 - 1.0).abs() < 0.1 && (found.width / 0.02 - 1.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn presliding_and_the_stribeck_effect_are_no_soft_sign() {
        let presliding = moving(|velocity, _, travelled| 2.0 * (travelled / 0.02).clamp(-1.0, 1.0) + 0.3 * velocity);
        let stribeck = moving(|velocity, _, _| (2.0 + (-(velocity / 0.2).powi(2)).exp()) * (velocity / 1e-3).tanh());
        for signals in [presliding, stribeck] {
            let (least, found) = widened(signals);
            assert_eq!(found.width, least);
        }
    }
}
