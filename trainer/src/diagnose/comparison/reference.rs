//! A law from elsewhere (a simulation, a fitted model) evaluated at the recorded states, as the base of a comparison.

use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::preparation::states::{Known, Prepared};
use crate::numerics::least_squares::least_squares;
use crate::physics::{EffectId, JointState, friction_at};
use crate::samples::SLIDING_SPEED_SHARE;

/// Recordings that each row stands for of a simulation that was measured with noise and with its negative. What goes with the noise itself cancels over
/// both, so that they tell its bias as well as many simulations would. As two times five of them they add a tenth to the variance of what is found in the
/// recording; one simulation would double it.
const REPEATS_OF_BOTH_WAYS: f64 = 5.0;

/// A law at the states of a recording.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    /// Whole torque, one value a sample.
    pub torque: Vec<f64>,
    /// Its rigid-body part.
    pub rigid_body: Vec<f64>,
    /// Change of the torque with each parameter that may move, with its name.
    pub jacobian: Vec<(&'static str, Vec<f64>)>,
    /// Whether it is a model that was fitted to another recording.
    pub is_fitted: bool,
    /// Effects of the catalogue that it holds itself.
    pub effects: Vec<EffectId>,
    /// What the law leaves of the simulation from which it was learned, where that is of the same motion: series that the recording may have any
    /// share of.
    pub replayed: Vec<Vec<f64>>,
    /// Root mean square, behind the filter, of what its formulas get wrong beside that.
    pub formula_error: f64,
    /// Torque of each direction in which the law is not sure of itself, at one standard deviation.
    pub uncertainty: Vec<Vec<f64>>,
    /// Samples at which a channel lies beyond what the law was fitted on, and by which channels; empty where none does.
    pub outside: Outside,
    /// Its friction as pairs (velocity, torque) in ascending velocity.
    pub friction: Vec<(f64, f64)>,
    /// Time by which its friction turns over before the velocity, s.
    pub sign_lead_s: f64,
    /// Velocity below which its friction turns over.
    pub sign_width: f64,
}

impl Reference {
    /// Torque by which its friction would differ if it turned over as the smoothed sign of the states does: by nothing where the joint slides.
    /// From what the law has beside viscous friction, up to the Coulomb torque at which it slides; `None` where it has none.
    pub(crate) fn turned_otherwise(&self, state: &JointState) -> Option<Vec<f64>> {
        let [coulomb, viscous] = sliding_friction(&self.friction, state.top_speed())?;
        let turning = |v: f64| (friction_at(&self.friction, v) - viscous * v).clamp(-coulomb, coulomb);
        (coulomb > 0.0).then(|| state.map(|i| coulomb * state.sign[i] - turning(state.velocity[i])))
    }
}

/// Where a law is asked for more than it was fitted on: there it holds its last value, and the difference is its own.
#[derive(Clone, Debug, Default)]
pub struct Outside {
    /// One a sample; empty where all are within.
    pub samples: Vec<bool>,
    /// Each channel that is beyond, with the range that the law was fitted on and its unit.
    pub channels: Vec<(String, [f64; 2], String)>,
}

/// A recording and what it is compared with: a law from elsewhere, or nothing but a static model of the recording itself.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The recording.
    pub signals: Signals,
    /// The law of a simulation or a fitted model at the recorded states.
    pub reference: Option<Reference>,
    /// The recording of the simulation with its own law at its own states, where both stand in one model.
    pub simulation: Option<Box<Comparison>>,
    /// How many recordings with noise of their own each of its rows stands for: of a simulation that was measured without the noise's own part more
    /// than one.
    pub(crate) repeats: f64,
}

impl From<Signals> for Comparison {
    fn from(signals: Signals) -> Self {
        Self { signals, reference: None, simulation: None, repeats: 1.0 }
    }
}

impl Comparison {
    /// Compares a recording with a law. Its rigid body stands for the recording's where none is given.
    #[must_use]
    pub fn with(mut signals: Signals, reference: Reference) -> Self {
        if signals.rigid_body.is_none() && reference.rigid_body.iter().any(|torque| *torque != 0.0) {
            signals.rigid_body = Some(reference.rigid_body.clone());
        }
        Self { signals, reference: Some(reference), simulation: None, repeats: 1.0 }
    }

    /// The same with a simulation in one model, as the recording's encoder would have read it.
    #[must_use]
    pub fn beside(self, simulation: Self) -> Self {
        let signals = simulation.signals.read_in_steps(self.signals.position_resolution);
        Self { simulation: Some(Box::new(Self { signals, ..simulation })), ..self }
    }

    /// The same with a simulation that was measured as the recording was, with its noise and with the negative of that.
    #[must_use]
    pub(crate) fn beside_both_ways(self, simulation: Self) -> Self {
        let simulation = Self { repeats: REPEATS_OF_BOTH_WAYS, ..simulation };
        Self { simulation: Some(Box::new(simulation)), ..self }
    }

    /// The torque that needs no identification: the reference's, or the rigid body's.
    pub(crate) fn known(&self) -> Known<'_> {
        match &self.reference {
            Some(reference) => Known { torque: Some(&reference.torque), outside: &reference.outside.samples },
            None => Known::of(&self.signals),
        }
    }

    /// Whether it is with a model that was fitted to another recording.
    pub(crate) fn is_with_fitted_model(&self) -> bool {
        self.reference.as_ref().is_some_and(|reference| reference.is_fitted)
    }

    /// States and rows behind the filter that the recording asks for.
    pub fn prepare(&self, lock: Lock) -> Prepared {
        Prepared::new(&self.signals, self.known(), lock)
    }

    /// The same with the torque, recorded late by `delay` (s; negative where early), put back to its time.
    #[must_use]
    pub fn realigned(&self, delay: f64) -> Self {
        Self {
            signals: self.signals.realigned(delay),
            reference: self.reference.clone(),
            simulation: self.simulation.clone(),
            repeats: self.repeats,
        }
    }
}

/// Coulomb and viscous friction that may move beside a law, with the names of their changes.
pub(crate) fn coulomb_and_viscous(sign: &[f64], velocity: &[f64]) -> Vec<(&'static str, Vec<f64>)> {
    vec![("coulomb_torque_change", sign.to_vec()), ("viscous_coefficient_change", velocity.to_vec())]
}

/// Velocities at which a reference's friction is tabulated, denser towards zero.
pub(crate) fn tabulated_velocities(reach: f64) -> impl Iterator<Item = f64> {
    (-120..=120).map(move |k| {
        let x = f64::from(k) / 120.0;
        reach * x * x * x
    })
}

/// Coulomb torque and viscous coefficient of a tabulated friction where the joint slides, up to a top speed: a straight line over speed.
pub(crate) fn sliding_friction(friction: &[(f64, f64)], top_speed: f64) -> Option<[f64; 2]> {
    let sliding = |velocity: f64| (SLIDING_SPEED_SHARE * top_speed..=top_speed).contains(&velocity.abs());
    let curve: Vec<(f64, f64)> = friction.iter().copied().filter(|(velocity, _)| sliding(*velocity)).collect();
    let columns = [curve.iter().map(|(v, _)| v.signum()).collect(), curve.iter().map(|(v, _)| *v).collect()];
    let target: Vec<f64> = curve.iter().map(|(_, torque)| *torque).collect();
    let line = least_squares(&columns, &target, std::slice::from_ref(&(0..curve.len())))?;
    Some([line[0], line[1]])
}
