//! The delay of the torque against the motion, as a parameter of the whole model: every column stays, the target is shifted.

use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::weighing::{FIRST_PRICE, Weighing, first_noise, friction_of, white_noise};
use crate::diagnose::noise::autoregression::Noise;
use crate::inference::evidence::Candidate;
use crate::inference::sets::Field;
use crate::numerics::between_samples::between_samples;
use crate::numerics::least_squares::{orthonormal, project_out, weighted};
use crate::numerics::statistics::t_statistic;
use rayon::prelude::*;

/// Longest delay that is looked for, s: several periods of a field bus. Longer may fit one swing of a fast motion to the next.
const LONGEST_S: f64 = 0.03;
/// Periods of the cut-off between two delays that are tried: the likelihood of a band-limited torque is a parabola over less.
const STEP_PERIODS: f64 = 0.125;
/// Steps to both sides of the delay that reversals show. A limit of the computing time.
const NEIGHBOURS: i32 = 3;
/// Members of the sets beside which a delay is weighed. A limit of the computing time.
const MEMBERS: usize = 3;

/// A delay with its uncertainty.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TorqueDelay {
    /// Delay of the torque, s; negative where it was recorded early.
    pub delay_s: f64,
    /// Its standard deviation, s.
    pub deviation_s: f64,
    /// Log likelihood ratio against no delay, nats.
    pub gain_nats: f64,
    /// Mean gain of a block of rows over its standard error.
    pub shown_deviations: f64,
}

/// The likeliest delay, beside the few effects that explain most at that delay, and the noise that it leaves. First with white noise,
/// which reversals decide; then with the noise of what that delay leaves.
pub(crate) fn torque_delay(candidates: &Candidates, real: &Side, simulated: Option<&Side>) -> (TorqueDelay, Noise) {
    let step = STEP_PERIODS / real.prepared.filter.cut_off_hz;
    let longest = (LONGEST_S / step).floor() as i32;
    let roughly = {
        let profile = Profile::new(candidates, real, simulated, white_noise(candidates, real), 0);
        profile.likeliest(0.0, step, longest).delay_s
    };
    let noise = first_noise(candidates, &shifted(real, roughly), simulated);
    let profile = Profile::new(candidates, real, simulated, noise.clone(), MEMBERS);
    let found = profile.likeliest(roughly, step, NEIGHBOURS);
    let gain_nats = profile.at(found.delay_s) - profile.at(0.0);
    (TorqueDelay { gain_nats, shown_deviations: profile.shown_deviations(candidates, found.delay_s), ..found }, noise)
}

/// A side with its torque put back by a delay.
pub(crate) fn shifted<'a>(real: &Side<'a>, delay_s: f64) -> Side<'a> {
    Side { target: shifted_target(real, delay_s), ..real.clone() }
}

/// The likelihood over the delay.
struct Profile<'a> {
    real: &'a Side<'a>,
    noise: Noise,
    weighing: Weighing,
    weighed: Vec<Candidate>,
    members: usize,
}

impl<'a> Profile<'a> {
    fn new(
        candidates: &Candidates,
        real: &'a Side<'a>,
        simulated: Option<&Side>,
        noise: Noise,
        members: usize,
    ) -> Self {
        let friction = friction_of(real);
        let weighing = Weighing::new(candidates, real, simulated, &noise, friction);
        let weighed = candidates.weighed(friction, weighing.random());
        Self { real, noise, weighing, weighed, members }
    }

    /// Log likelihood of a delay, beside the effects that explain most there.
    fn at(&self, delay_s: f64) -> f64 {
        let Self { real, noise, .. } = self;
        let shifted = real.on_rows(&noise.whitened(&shifted_target(real, delay_s), &real.runs));
        let reduced = self.weighing.with_target(&shifted);
        let field = Field { reduced: &reduced, candidates: &self.weighed, price: FIRST_PRICE, temper: 1.0 };
        let found = field.settled(field.forward(self.members)).map_or(0.0, |set| field.weight(&set));
        found - 0.5 * reduced.energy
    }

    /// What blocks of rows gain by a delay beside the effects that explain most there: their mean over its standard error.
    fn shown_deviations(&self, candidates: &Candidates, delay_s: f64) -> f64 {
        let Self { real, noise, weighing, .. } = self;
        let white = |delay_s: f64| real.on_rows(&noise.whitened(&shifted_target(real, delay_s), &real.runs));
        let reduced = weighing.with_target(&white(delay_s));
        let field = Field { reduced: &reduced, candidates: &self.weighed, price: FIRST_PRICE, temper: 1.0 };
        let members = field.forward(self.members);
        let common = weighted(weighing.columns(), &weighing.common(&self.weighed, &members));
        let all = std::iter::once(0..common.len()).collect::<Vec<_>>();
        let basis = orthonormal(&weighing.beside(candidates, &members), &all);
        let left = |delay_s: f64| {
            let mut left: Vec<f64> =
                white(delay_s).iter().zip(&common).map(|(target, common)| target - common).collect();
            project_out(&mut left, &basis, &all);
            left
        };
        let (with, without) = (left(delay_s), left(0.0));
        let energy = |left: &[f64]| left.iter().map(|value| value * value).sum::<f64>();
        let gains: Vec<f64> =
            real.blocks().into_iter().map(|rows| energy(&without[rows.clone()]) - energy(&with[rows])).collect();
        t_statistic(&gains)
    }

    /// The likeliest of some delays to both sides of a centre, by a parabola through the best and its neighbours, a step and then a
    /// quarter of one apart.
    fn likeliest(&self, centre: f64, step: f64, count: i32) -> TorqueDelay {
        let tried: Vec<(f64, f64)> = (-count..=count)
            .into_par_iter()
            .map(|k| (centre + step * f64::from(k), self.at(centre + step * f64::from(k))))
            .collect();
        let best = tried.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1)).map_or(0, |(i, _)| i);
        let best = best.clamp(1, tried.len().saturating_sub(2).max(1));
        let (mut centre, mut width) = (tried[best].0, step);
        let mut values = [tried[best - 1].1, tried[best].1, tried[best + 1].1];
        let mut bend = 0.0;
        for _ in 0..2 {
            bend = (2.0 * values[1] - values[0] - values[2]) / (width * width);
            if bend <= 0.0 {
                break;
            }
            centre += (0.5 * (values[2] - values[0]) / (width * bend)).clamp(-width, width);
            width *= 0.25;
            values = [centre - width, centre, centre + width].map(|delay| self.at(delay));
        }
        let deviation_s = if bend > 0.0 { bend.sqrt().recip() } else { f64::INFINITY };
        TorqueDelay { delay_s: centre, deviation_s, gain_nats: 0.0, shown_deviations: 0.0 }
    }
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
