//! What a simulator computes: its inverse law, learned from its recording as a function of the state, so that neither clock
//! nor sampling nor length of the two recordings have to agree (Atkeson, An and Hollerbach 1986 for the linear form).

mod curvature_prior;
mod relaxation;
#[cfg(test)]
mod relaxation_tests;
mod replay;
mod residual_noise;
mod simulated_effects;
#[cfg(test)]
mod tests;
mod turn_over;

use crate::diagnose::comparison::columns::nuisances;
use crate::diagnose::comparison::reference::{
    Outside, Reference, coulomb_and_viscous, sliding_friction, tabulated_velocities,
};
use crate::diagnose::comparison::turn_over::{LEAST_ROWS, TurnOver};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::preparation::states::{Known, Prepared};
use crate::numerics::covariance::of_whitened;
use crate::numerics::hat_functions::speed_hats;
use crate::numerics::least_squares::{least_squares, residual, weighted};
use crate::numerics::statistics::root_mean_square;
use crate::physics::{EffectId, JointState};
use curvature_prior::CurvaturePrior;
use relaxation::relaxation_time;
use replay::ReplayedResidual;
use residual_noise::{ResidualNoise, residual_noise};
pub use simulated_effects::FindEffects;
pub(crate) use simulated_effects::SimulatedEffect;
use simulated_effects::{SimulatedEffects, simulated_effects};
use turn_over::turn_over;

/// Least travel in rad over which gravity can be told from an offset.
const GRAVITY_TRAVEL_RAD: f64 = 0.2;
/// Knots over speed that are tried: a simulation without noise bears many, a short or noisy one few.
const KNOTS: [usize; 4] = [5, 9, 17, 33];

/// Noise of a simulation over that of the recording below which what a law leaves of it is the error of the law's formulas.
const QUIET_NOISE_RATIO: f64 = 0.5;

/// Why no law can be learned from a simulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unlearnable {
    /// The simulated joint rests, or nearly always does.
    #[error("the simulation holds only {rows} rows of motion behind the filter; its law cannot be learned from rest")]
    Rest {
        /// Rows of motion.
        rows: usize,
    },
    /// The simulated motion does not determine the law.
    #[error("the simulated motion does not determine a law: one velocity, or no change of direction")]
    Undetermined,
}

/// The learned law: rigid body, friction over velocity and what of the catalogue the simulator holds, linear in its coefficients.
#[derive(Clone, Debug)]
pub struct InverseLaw {
    sign_velocity: f64,
    top_speed: f64,
    /// Speed that the joint passes within a sample where it turns round, or within which the sign of friction does: no row tells friction
    /// below it from the sign.
    resolved_speed: f64,
    /// Time by which friction turns over before the velocity, s; `None` where it does not.
    relaxation_s: Option<f64>,
    /// The same where the friction of the law itself turns over so; zero where that is left out.
    lead_s: f64,
    gravity: bool,
    given: bool,
    /// Hats over speed.
    knots: usize,
    simulated: Option<SimulatedEffects>,
    /// Weights of the friction columns, then of the rigid body's, then of the effects'.
    coefficients: Vec<f64>,
    /// Weights of each direction in which the law is not sure of itself, at one standard deviation.
    uncertainty: Vec<Vec<f64>>,
    /// What the law leaves of the simulation.
    replay: Option<ReplayedResidual>,
    /// Root mean square of that beside the simulation's noise; zero of a simulation whose noise is nearly that of the recording.
    formula_error: f64,
    /// Root mean square of what the law leaves of the simulation, in the unit of the actuator.
    pub rmse: f64,
}

/// Learns the law of a simulation: what the real recording could show of it.
///
/// # Errors
/// [`Unlearnable`] for a simulation of rest or of one velocity.
pub fn learn(simulation: &Signals, real: &Signals, find_effects: FindEffects) -> Result<InverseLaw, Unlearnable> {
    let given = real.rigid_body.is_some() && simulation.rigid_body.is_some();
    let prepared = Prepared::new(simulation, Known::of(simulation), Lock::Nothing);
    let unfitted = InverseLaw::unfitted(&prepared, given)?;
    let law = unfitted.clone().relaxed(&prepared).learned(&prepared)?;
    let Some(ResidualNoise { noise, .. }) = residual_noise(real, &law) else { return Ok(law) };
    let simulated = simulated_effects(simulation, &law, noise, find_effects);
    let holds_effects = simulated.is_some();
    let with_effects = || InverseLaw { simulated, ..unfitted }.relaxed(&prepared).learned(&prepared);
    let mut law = if holds_effects { with_effects().unwrap_or(law) } else { law };
    let rest = residual_noise(simulation, &law).filter(|rest| rest.noise < QUIET_NOISE_RATIO * noise);
    law.formula_error = rest.map_or(0.0, |rest| rest.formula_error);
    law.replay = Some(ReplayedResidual::of(law.left_of(simulation, &prepared.state), &prepared.state));
    Ok(law)
}

/// Learns the static law of a simulation alone: rigid body and friction over velocity.
///
/// # Errors
/// [`Unlearnable`] for a simulation of rest or of one velocity.
pub fn learn_static(simulation: &Signals, real: &Signals) -> Result<InverseLaw, Unlearnable> {
    let given = real.rigid_body.is_some() && simulation.rigid_body.is_some();
    let prepared = Prepared::new(simulation, Known::of(simulation), Lock::Nothing);
    let unfitted = InverseLaw::unfitted(&prepared, given)?;
    let TurnOver { lead_s, width } = turn_over(&InverseLaw { knots: KNOTS[0], ..unfitted.clone() }, &prepared);
    let resolved_speed = unfitted.resolved_speed.max(width);
    InverseLaw { lead_s, sign_velocity: width, resolved_speed, ..unfitted }.learned(&prepared)
}

impl InverseLaw {
    /// A static law without coefficients, whose friction turns over with the velocity and as sharply as the simulation resolves.
    fn unfitted(prepared: &Prepared, given: bool) -> Result<Self, Unlearnable> {
        let rows = prepared.rows.len();
        if rows < LEAST_ROWS {
            return Err(Unlearnable::Rest { rows });
        }
        let state = &prepared.state;
        Ok(Self {
            sign_velocity: state.sign_velocity,
            top_speed: state.top_speed(),
            resolved_speed: state.resolved_speed(),
            relaxation_s: None,
            lead_s: 0.0,
            knots: KNOTS[KNOTS.len() - 1],
            gravity: state.rotary && state.span() > GRAVITY_TRAVEL_RAD,
            given,
            simulated: None,
            coefficients: Vec::new(),
            uncertainty: Vec::new(),
            replay: None,
            formula_error: 0.0,
            rmse: 0.0,
        })
    }

    /// The same with the relaxation of the simulator's constraints beside it.
    fn relaxed(self, prepared: &Prepared) -> Self {
        let columns = self.with_nuisances(prepared, &self.columns(&prepared.state));
        let torque = prepared.filtered(&prepared.torque);
        Self { relaxation_s: relaxation_time(prepared, &columns, &torque), ..self }
    }

    /// The law with its coefficients, at as many knots as the simulation bears.
    fn learned(&self, prepared: &Prepared) -> Result<Self, Unlearnable> {
        let laws: Vec<(Self, Vec<f64>)> =
            KNOTS.into_iter().filter_map(|knots| Self { knots, ..self.clone() }.fitted(prepared)).collect();
        // Weighed as the search weighs: a bend that a law lacks would be named there, however slow the noise that hides it.
        let (_, finest) = laws.last().ok_or(Unlearnable::Undetermined)?;
        let runs = prepared.open_runs();
        let noise = Noise::fit(finest, &runs, &noise_features(prepared));
        let criterion = |(law, rest): &(Self, Vec<f64>)| {
            let white = noise.whitened(rest, &runs);
            let rows = prepared.rows.len() as f64;
            2.0 * rows * root_mean_square(&white).max(f64::MIN_POSITIVE).ln() + 2.0 * law.coefficients.len() as f64
        };
        let best = laws.iter().min_by(|a, b| criterion(a).total_cmp(&criterion(b)));
        let (mut law, rest) = best.cloned().ok_or(Unlearnable::Undetermined)?;
        law.uncertainty = law.uncertain_directions(prepared, &rest, &noise);
        Ok(law)
    }

    /// Columns of the law behind the filter, then what is fitted beside it and left out: differentiation bias and the relaxation of
    /// the simulator's constraints.
    fn with_nuisances(&self, prepared: &Prepared, raw: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let relaxation = self.relaxation_column(&prepared.state).map(|column| prepared.filtered(&column));
        prepared.filtered_all(raw).into_iter().chain(nuisances(prepared)).chain(relaxation).collect()
    }

    /// Torque, for each unit of Coulomb friction, by which the simulator turns it over before the velocity.
    fn relaxation_column(&self, state: &JointState) -> Option<Vec<f64>> {
        self.relaxation_s.map(|time| relaxation::column(state, self.sign_velocity, time))
    }

    /// The law with its coefficients, and what it leaves. The sampling's delay is fitted beside it and left out.
    fn fitted(mut self, prepared: &Prepared) -> Option<(Self, Vec<f64>)> {
        let state = &prepared.state;
        let raw = self.columns(state);
        let target = prepared.filtered(&prepared.torque);
        let mut columns = self.with_nuisances(prepared, &raw);
        let roughly = least_squares(&columns, &target, &prepared.open_runs())?;
        let noise = root_mean_square(&residual(&columns, &target, &roughly));
        let bends = CurvaturePrior::of(&roughly[..self.knots]);
        let fit = |columns: &[Vec<f64>]| {
            let (mut columns, mut target, mut runs) = (columns.to_vec(), target.clone(), prepared.open_runs());
            runs.push(bends.put_behind(&mut columns, &mut target, noise));
            least_squares(&columns, &target, &runs)
        };
        let mut coefficients = fit(&columns)?;
        let late = state.rate_of(&weighted(&raw, &coefficients[..raw.len()]));
        columns.push(prepared.filtered(&late));
        coefficients = fit(&columns)?;
        let rest = residual(&columns, &target, &coefficients);
        self.rmse = root_mean_square(&rest);
        coefficients.truncate(raw.len());
        self.coefficients = coefficients;
        Some((self, rest))
    }

    /// Weights of each direction in which the law is not sure of itself, at one standard deviation: the axes of their
    /// covariance. `rest` is what the law leaves, `noise` its model. Empty where nothing is known of it.
    fn uncertain_directions(&self, prepared: &Prepared, rest: &[f64], noise: &Noise) -> Vec<Vec<f64>> {
        let mut runs = prepared.open_runs();
        let columns = self.with_nuisances(prepared, &self.columns(&prepared.state));
        let mut columns: Vec<Vec<f64>> = columns.iter().map(|column| noise.whitened(column, &runs)).collect();
        let mut rest = noise.whitened(rest, &runs);
        runs.push(CurvaturePrior::of(&self.coefficients[..self.knots]).put_behind(&mut columns, &mut rest, 1.0));
        let Some(all) = of_whitened(&columns, &rest, &[], &runs) else { return Vec::new() };
        let width = self.coefficients.len();
        let axes = all.view((0, 0), (width, width)).clone_owned().symmetric_eigen();
        let deviations = axes.eigenvalues.iter().map(|variance| variance.max(0.0).sqrt());
        let directions = axes.eigenvectors.column_iter().zip(deviations);
        directions.map(|(axis, deviation)| axis.iter().map(|weight| weight * deviation).collect()).collect()
    }

    /// Friction columns at one velocity with its smoothed sign: odd hats over speed, dense at low speed where friction
    /// bends and held where nothing is resolved, and Coulomb and viscous friction that differ between the directions.
    fn friction_columns(&self, velocity: f64, sign: f64) -> impl Iterator<Item = f64> {
        let speed = velocity.abs().max(self.resolved_speed);
        let hats = speed_hats(speed / self.top_speed.max(f64::MIN_POSITIVE), self.knots);
        hats.map(move |hat| hat * sign).chain([sign.abs(), velocity.abs()])
    }

    /// Number of friction columns; the rigid body follows.
    fn friction_width(&self) -> usize {
        self.knots + 2
    }

    /// Number of columns of the rigid body; the effects follow.
    fn rigid_body_width(&self) -> usize {
        2 + 2 * usize::from(self.gravity) + usize::from(self.given)
    }

    /// Smoothed sign of its friction.
    fn sign(&self, state: &JointState) -> Vec<f64> {
        state.leading_sign(self.lead_s, self.sign_velocity)
    }

    fn columns(&self, state: &JointState) -> Vec<Vec<f64>> {
        let sign = self.sign(state);
        let mut columns = vec![Vec::with_capacity(state.len()); self.friction_width()];
        for (velocity, sign) in state.velocity.iter().zip(&sign) {
            for (column, value) in columns.iter_mut().zip(self.friction_columns(*velocity, *sign)) {
                column.push(value);
            }
        }
        columns.push(state.acceleration.clone());
        columns.push(vec![1.0; state.len()]);
        if self.gravity {
            columns.push(state.map(|i| state.position[i].sin()));
            columns.push(state.map(|i| state.position[i].cos()));
        }
        if self.given {
            columns.extend(state.rigid_body.clone());
        }
        columns.extend(self.simulated.iter().flat_map(|effects| effects.columns(state)));
        columns
    }

    /// Friction at a velocity.
    #[must_use]
    pub fn friction(&self, velocity: f64) -> f64 {
        let columns = self.friction_columns(velocity, (velocity / self.sign_velocity).tanh());
        columns.zip(&self.coefficients).map(|(column, coefficient)| column * coefficient).sum()
    }

    /// Inertia, constant torque, gravity with sine and cosine, and factor of a given rigid-body torque.
    #[must_use]
    pub fn rigid_body(&self) -> [f64; 5] {
        let mut rest = self.coefficients[self.friction_width()..].iter().copied();
        let mut next = |present: bool| if present { rest.next().unwrap_or(0.0) } else { 0.0 };
        [next(true), next(true), next(self.gravity), next(self.gravity), next(self.given)]
    }

    /// Effects of the catalogue that the simulator holds, with shape and coefficients.
    pub fn effects(&self) -> impl Iterator<Item = (EffectId, &[f64], &[f64])> {
        self.placed_effects().map(|(found, place)| (found.effect, &found.shape[..], &self.coefficients[place]))
    }

    /// What the law leaves of the torque of its simulation, at each sample. Where friction turns over before the velocity the change of friction
    /// with time beside it: by how much earlier it does goes with the step of the simulator, which a recording does not have.
    fn left_of(&self, simulation: &Signals, state: &JointState) -> Vec<Vec<f64>> {
        let columns = self.columns(state);
        let torque = weighted(&columns, &self.coefficients);
        let residual = state.map(|i| simulation.torque[i] - torque[i]);
        let friction = weighted(&columns[..self.friction_width()], &self.coefficients[..self.friction_width()]);
        let [_, viscous] = sliding_friction(&self.friction_curve(), self.top_speed).unwrap_or_default();
        let turning = state.map(|i| friction[i] - viscous * state.velocity[i] + residual[i]);
        let rate = self.relaxation_s.map(|_| state.rate_of(&turning));
        std::iter::once(residual).chain(rate).collect()
    }

    /// The part of the torque that goes with acceleration, position and a given rigid body, constant torque included, from the columns
    /// of the law.
    fn rigid_body_of(&self, columns: &[Vec<f64>]) -> Vec<f64> {
        let begin = self.friction_width();
        let rigid_body = begin..begin + self.rigid_body_width();
        weighted(&columns[rigid_body.clone()], &self.coefficients[rigid_body])
    }

    /// Friction as pairs (velocity, torque) in ascending velocity.
    fn friction_curve(&self) -> Vec<(f64, f64)> {
        tabulated_velocities(1.2 * self.top_speed).map(|v| (v, self.friction(v))).collect()
    }

    /// The law at the states of the real recording. Coulomb and viscous friction may move.
    #[must_use]
    pub fn at(&self, state: &JointState) -> Reference {
        let columns = self.columns(state);
        let met = self.replay.as_ref().and_then(|residual| residual.at(state));
        let unmet = met.as_ref().map_or(1.0, |met| 1.0 - met.share);
        let formula_error = self.formula_error * unmet.sqrt();
        Reference {
            torque: weighted(&columns, &self.coefficients),
            rigid_body: self.rigid_body_of(&columns),
            jacobian: coulomb_and_viscous(&self.sign(state), &state.velocity),
            effects: self.effects().map(|(effect, ..)| effect).collect(),
            replayed: met.map_or_else(Vec::new, |met| met.series),
            formula_error,
            uncertainty: self.uncertainty.iter().map(|direction| weighted(&columns, direction)).collect(),
            outside: Outside::default(),
            is_fitted: false,
            friction: self.friction_curve(),
            sign_lead_s: self.lead_s,
            sign_width: self.sign_velocity,
        }
    }
}
