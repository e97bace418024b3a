//! Effects of the catalogue that a simulator computes itself: they are its law as much as its static friction, and nothing that
//! the real joint has beyond it.

use crate::diagnose::comparison::reference::{Comparison, Reference};
use crate::diagnose::comparison::simulation::InverseLaw;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::gravity::give_body;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::preparation::states::{Known, Prepared};
use crate::numerics::least_squares::{orthonormal, project_out, weighted};
use crate::numerics::random::normal;
use crate::numerics::statistics::root_mean_square;
use crate::physics::{EffectId, JointState, Shape, catalogue};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::ops::Range;

/// Finds the effects of the catalogue that a recording holds beside the law that it is compared with.
pub type FindEffects<'f> = &'f dyn Fn(&Comparison) -> Vec<Fitted>;

/// An effect of a law, at unit coefficients.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedEffect {
    pub effect: EffectId,
    pub shape: Shape,
    /// Number of its columns.
    pub width: usize,
}

/// Effects of a simulation, as their columns are worked out: beside the static law alone.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedEffects {
    pub effects: Vec<SimulatedEffect>,
    pub beside: Box<InverseLaw>,
}

/// Noise that the simulation is given, over that of the recording: what the recording shows is found in the simulation first.
const ADDED_NOISE_SHARE: f64 = 1.0 / 3.0;

/// Whether an effect is a function of the state, which another recording has as well, and not of the clock; nor a level of friction,
/// which the law has as its own.
fn belongs_to_the_state(effect: EffectId) -> bool {
    use EffectId::{FrictionLevel, SlowDrift, TimeMisalignment, TransientEvent};
    !matches!(effect, SlowDrift | TransientEvent | TimeMisalignment | FrictionLevel)
}

/// What a diagnosis of the simulation names beside its static law. `None` where that is nothing.
///
/// The simulation is given a share of the `noise` of the real recording: below that the formulas of simulator and catalogue
/// differ, and the recording could not show it.
pub(crate) fn simulated_effects(
    simulation: &Signals,
    law: &InverseLaw,
    noise: f64,
    find_effects: FindEffects,
) -> Option<SimulatedEffects> {
    let mut signals = simulation.clone();
    add_noise(&mut signals, ADDED_NOISE_SHARE * noise);
    let state = signals.states();
    // What a solver of constraints does near rest is no effect.
    let columns = law.columns(&state).into_iter().chain(law.relaxation_column(&state));
    let jacobian = columns.map(|column| ("model_parameter", column)).collect();
    let comparison = Comparison::with(signals, Reference { jacobian, uncertainty: Vec::new(), ..law.at(&state) });
    let found = find_effects(&comparison).into_iter().filter_map(|found| match found.label {
        Label::Named(effect) if belongs_to_the_state(effect) => {
            let width = found.coefficients.len();
            (width > 0).then_some(SimulatedEffect { effect, shape: found.shape, width })
        }
        _ => None,
    });
    let effects: Vec<SimulatedEffect> = found.collect();
    (!effects.is_empty()).then(|| SimulatedEffects { effects, beside: Box::new(law.clone()) })
}

impl InverseLaw {
    /// The same with effects of the catalogue beside it that its simulation shows, learned anew. Effects whose torque beyond law and other effects,
    /// root mean square, stays below `least` are left out one after the other, the smallest first. `None` where none is left, or where they
    /// cannot be told from the law.
    pub(crate) fn holding(
        &self,
        shown: impl Iterator<Item = SimulatedEffect>,
        simulation: &Signals,
        least: f64,
    ) -> Option<Self> {
        let prepared = Prepared::new(simulation, Known::of(simulation), Lock::Nothing);
        let mut effects: Vec<SimulatedEffect> = shown.filter(|shown| belongs_to_the_state(shown.effect)).collect();
        while !effects.is_empty() {
            let simulated = SimulatedEffects { effects: effects.clone(), beside: Box::new(self.clone()) };
            let law = Self { simulated: Some(simulated), ..self.clone() }.learned(&prepared).ok()?;
            let (smallest, size) =
                law.sizes_of_effects(&prepared).into_iter().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
            if size >= least {
                return Some(law);
            }
            effects.remove(smallest);
        }
        None
    }

    /// Torque of each of its effects behind the filter beyond all else of the law, root mean square over the rows of its simulation.
    fn sizes_of_effects(&self, prepared: &Prepared) -> Vec<f64> {
        let columns = prepared.filtered_all(&self.columns(&prepared.state));
        let runs = prepared.open_runs();
        let size = |place: Range<usize>| {
            let others = [&columns[..place.start], &columns[place.end..]].concat();
            let mut torque = weighted(&columns[place.clone()], &self.coefficients[place]);
            project_out(&mut torque, &orthonormal(&others, &runs), &runs);
            root_mean_square(&runs.iter().flat_map(|run| &torque[run.clone()]).copied().collect::<Vec<f64>>())
        };
        self.placed_effects().map(|(_, place)| size(place)).collect()
    }

    /// Its effects, each with the place of its columns among those of the law.
    pub(super) fn placed_effects(&self) -> impl Iterator<Item = (&SimulatedEffect, Range<usize>)> {
        let mut begin = self.friction_width() + self.rigid_body_width();
        self.simulated.iter().flat_map(|simulated| &simulated.effects).map(move |effect| {
            let place = begin..begin + effect.width;
            begin = place.end;
            (effect, place)
        })
    }
}

/// Adds white noise of a deviation behind the filter to the torque.
fn add_noise(signals: &mut Signals, deviation: f64) {
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let white: Vec<f64> = signals.torque.iter().map(|_| normal(&mut random)).collect();
    let behind = root_mean_square(&Prepared::new(signals, Known::of(signals), Lock::Nothing).filtered(&white));
    let scale = deviation / behind.max(f64::MIN_POSITIVE);
    signals.torque.iter_mut().zip(&white).for_each(|(torque, noise)| *torque += scale * noise);
}

impl SimulatedEffects {
    /// Torque of every effect per unit coefficient at the states of a recording; zero where the recording lacks a channel.
    pub fn columns(&self, state: &JointState) -> Vec<Vec<f64>> {
        let beside = self.beside.columns(state);
        let predicted = weighted(&beside, &self.beside.coefficients);
        let base_friction = self.beside.friction_curve();
        let mut state = JointState { predicted, base_friction, ..state.clone() };
        if state.rigid_body.is_none() {
            // As the simulation stood when the effects were found in it.
            give_body(&mut state, self.beside.rigid_body_of(&beside));
        }
        let hypotheses = catalogue();
        let hypothesis = |effect: EffectId| hypotheses.iter().find(|hypothesis| hypothesis.id() == effect);
        let columns = self.effects.iter().flat_map(|of| {
            let mut columns = hypothesis(of.effect).map(|h| h.columns(&state, &of.shape)).unwrap_or_default();
            columns.resize_with(of.width, || vec![0.0; state.len()]);
            columns
        });
        columns.collect()
    }
}
