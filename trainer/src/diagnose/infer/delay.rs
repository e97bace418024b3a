//! The delay of the torque against the motion: every column stays, the target is shifted.

use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::weighing::{FIRST_PRICE, Weighing, first_noise, friction_of, white_noise};
use crate::diagnose::noise::autoregression::Noise;
use crate::inference::sets::{Field, MOST_MEMBERS, Member};
use crate::numerics::between_samples::between_samples;
use crate::numerics::least_squares::{orthonormal, project_out};
use crate::numerics::statistics::{DEVIATION_PER_MEDIAN, weighted_median};
use rayon::prelude::*;

/// Longest delay that is looked for, s: several periods of a field bus. Longer may fit one swing of a fast motion to the next.
const LONGEST_S: f64 = 0.03;
/// Periods of the cut-off between two delays that are tried: the likelihood of a band-limited torque is a parabola over less.
const STEP_PERIODS: f64 = 0.125;
/// Steps to both sides of the delay that reversals show. A limit of the computing time.
const NEIGHBOURS: i32 = 3;
/// Effects beside which a delay is sought, at most. A limit of the computing time.
const MEMBERS: usize = 3;

/// Standard deviations by which a delay that is told is longer than the sampling's own: normal noise exceeds them once in seven hundred.
const SHOWN_DEVIATIONS: f64 = 3.0;

/// A delay with its uncertainty.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TorqueDelay {
    /// Delay of the torque, s; negative where it was recorded early. Beside a simulation by how much more than there.
    pub delay_s: f64,
    /// Its standard deviation, s.
    pub deviation_s: f64,
    /// Log likelihood ratio against no delay, nats.
    pub gain_nats: f64,
}

impl TorqueDelay {
    /// By how much more than in a simulation.
    fn against(self, simulated: Option<Self>) -> Self {
        let Some(simulated) = simulated else { return self };
        let deviation_s = self.deviation_s.hypot(simulated.deviation_s);
        Self { delay_s: self.delay_s - simulated.delay_s, deviation_s, ..self }
    }

    fn is_shown(&self, longest_own_s: f64) -> bool {
        self.delay_s.abs() - longest_own_s > SHOWN_DEVIATIONS * self.deviation_s
    }
}

/// The noise, and the delay of the recording beside effects that explain most; against that of a simulation, where a solver has a step
/// between a torque and the state it leads to as well. `None` where it may be one that sampling has, up to `longest_own_s` (s).
pub(crate) fn torque_delay(
    candidates: &Candidates,
    real: &Side,
    simulated: Option<&Side>,
    longest_own_s: f64,
) -> (Noise, Option<TorqueDelay>) {
    let rough = Wanted { centre: 0.0, steps: (LONGEST_S / step_s(real)).floor() as i32, members: &[] };
    let white = white_noise(candidates, real);
    let [of_real, of_simulated] = sides_of(candidates, real, simulated, &white, [&rough, &rough]);
    let shift = |side, delay: Option<TorqueDelay>| shifted(side, delay.map_or(0.0, |delay| delay.delay_s));
    let (near, near_simulated) = (shift(real, of_real), simulated.map(|side| shift(side, of_simulated)));
    let noise = first_noise(candidates, &near, near_simulated.as_ref());
    let weighing = Weighing::new(candidates, &near, near_simulated.as_ref(), &noise, friction_of(real));
    let weighed = candidates.weighed(friction_of(real), weighing.random());
    let field = Field { reduced: &weighing.reduced, candidates: &weighed, price: FIRST_PRICE, temper: 1.0 };
    let members = field.forward(MEMBERS);
    let finely = |delay: Option<TorqueDelay>| Wanted {
        centre: delay.map_or(0.0, |d| d.delay_s),
        steps: NEIGHBOURS,
        members: &members,
    };
    let [of_real, of_simulated] =
        sides_of(candidates, real, simulated, &noise, [&finely(of_real), &finely(of_simulated)]);
    // Friction that follows late bends torque as a delay does: the likelier of the two, beside what explains most with each.
    let likelihood = |real: &Side| {
        let weighing = Weighing::new(candidates, real, simulated, &noise, friction_of(real));
        let field = Field { reduced: &weighing.reduced, candidates: &weighed, price: FIRST_PRICE, temper: 1.0 };
        let set = field.settled(field.forward(MOST_MEMBERS));
        set.map_or(0.0, |set| field.weight(&set)) - 0.5 * weighing.reduced.energy
    };
    let is_likelier = |delay: &TorqueDelay| likelihood(&shifted(real, delay.delay_s)) - likelihood(real) > FIRST_PRICE;
    let against = of_real.map(|real| real.against(of_simulated));
    let delay = against.filter(|delay| delay.is_shown(longest_own_s)).filter(is_likelier);
    (noise, delay)
}

/// Delays that are tried, and beside which effects.
struct Wanted<'m> {
    centre: f64,
    steps: i32,
    members: &'m [Member],
}

/// The delays of both sides for the noise of the recording, each beside base, smooth functions and members.
fn sides_of(
    candidates: &Candidates,
    real: &Side,
    simulated: Option<&Side>,
    noise: &Noise,
    wanted: [&Wanted; 2],
) -> [Option<TorqueDelay>; 2] {
    let places = |members: &[Member]| [candidates.shared(1.0, &[]).0, candidates.places(members)].concat();
    let beside = |side: &Side, all: &[Vec<f64>], wanted: &Wanted| -> Vec<Vec<f64>> {
        side.columns.iter().cloned().chain(places(wanted.members).into_iter().map(|place| all[place].clone())).collect()
    };
    let of_real = delay_of(real, noise, &beside(real, &candidates.real, wanted[0]), wanted[0]);
    let of_simulated = simulated.and_then(|side| {
        let noise = noise.at_rows_of(&side.features);
        delay_of(side, &noise, &beside(side, &candidates.simulated, wanted[1]), wanted[1])
    });
    [of_real, of_simulated]
}

/// The delay that most blocks agree on: the median of what each tells by a parabola through the best of those tried and its neighbours,
/// weighted by how sure it is. One event in one block is no delay. `None` where no block tells any.
fn delay_of(side: &Side, noise: &Noise, beside: &[Vec<f64>], wanted: &Wanted) -> Option<TorqueDelay> {
    let basis_of = side.whitened(beside, noise);
    let all = std::iter::once(0..basis_of.first().map_or(0, Vec::len)).collect::<Vec<_>>();
    let basis = orthonormal(&basis_of, &all);
    let blocks = side.blocks();
    let energies = |delay_s: f64| -> Vec<f64> {
        let mut left = side.on_rows(&noise.whitened(&shifted_target(side, delay_s), &side.runs));
        project_out(&mut left, &basis, &all);
        blocks.iter().map(|rows| left[rows.clone()].iter().map(|value| value * value).sum()).collect()
    };
    let agreed = |centre: f64, step: f64, count: i32| {
        let delays: Vec<f64> = (-count..=count).map(|k| centre + step * f64::from(k)).collect();
        let tried: Vec<Vec<f64>> = delays.par_iter().map(|delay| energies(*delay)).collect();
        let of_block = |block: usize| {
            let energy = |k: usize| tried[k][block];
            let best = (1..delays.len() - 1).min_by(|a, b| energy(*a).total_cmp(&energy(*b)))?;
            let bend = (energy(best - 1) + energy(best + 1) - 2.0 * energy(best)) / (step * step);
            let delay = delays[best] + (0.5 * (energy(best - 1) - energy(best + 1)) / (step * bend)).clamp(-step, step);
            // The curvature of half the energy is the precision of the delay.
            (bend > 0.0).then(|| (delay, (0.5 * bend).sqrt()))
        };
        let told: Vec<(f64, f64)> = (0..blocks.len()).filter_map(of_block).collect();
        Some((weighted_median(&told)?, told))
    };
    let (delay_s, _) = agreed(wanted.centre, step_s(side), wanted.steps)?;
    let (delay_s, told) = agreed(delay_s, 0.25 * step_s(side), 2)?;
    // Standard error of a median of normal values (Laplace), by their known deviations or by their own scatter.
    let precision: f64 = told.iter().map(|(_, weight)| weight).sum::<f64>();
    let scatter: Vec<(f64, f64)> =
        told.iter().map(|(delay, weight)| ((delay - delay_s).abs() * weight, *weight)).collect();
    let excess = (DEVIATION_PER_MEDIAN * weighted_median(&scatter)?).max(1.0);
    let deviation_s = excess * (std::f64::consts::FRAC_PI_2 * told.len() as f64).sqrt() / precision;
    let gains: Vec<f64> =
        energies(0.0).iter().zip(energies(delay_s)).map(|(without, with)| 0.5 * (without - with)).collect();
    Some(TorqueDelay { delay_s, deviation_s, gain_nats: gains.iter().sum() })
}

/// Time between two delays that are tried, s.
fn step_s(side: &Side) -> f64 {
    STEP_PERIODS / side.prepared.filter.cut_off_hz
}

/// A side with its torque put back by a delay.
pub(crate) fn shifted<'a>(side: &Side<'a>, delay_s: f64) -> Side<'a> {
    Side { target: shifted_target(side, delay_s), ..side.clone() }
}

/// The filtered target had the torque been recorded that much earlier.
fn shifted_target(real: &Side, delay_s: f64) -> Vec<f64> {
    let prepared = real.prepared;
    let shift = delay_s / prepared.state.period;
    let mut torque = prepared.torque.clone();
    for segment in &prepared.state.segments {
        let recorded = &prepared.torque[segment.clone()];
        for i in segment.clone() {
            torque[i] = between_samples(recorded, (i - segment.start) as f64 + shift);
        }
    }
    // What is known is not shifted.
    let friction: Vec<f64> =
        (0..torque.len()).map(|i| torque[i] - (prepared.torque[i] - prepared.friction_torque[i])).collect();
    prepared.filtered(&friction)
}
