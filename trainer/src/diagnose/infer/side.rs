//! One side of a comparison: a prepared recording or simulation, its base, and columns on its rows.

use crate::diagnose::comparison::base::{Base, Delay};
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::statistics::root_mean_square;
use crate::physics::{Hypothesis, JointState};
use crate::samples::interpolate;
use rayon::prelude::*;
use std::ops::Range;

/// Change of the time at which friction turns over, each way, by which its column is differenced, s: short beside any filter here, so
/// that the column does not depend on it.
const TURN_OVER_STEP_S: f64 = 0.0005;

/// Filtered torque of friction that turns over earlier before the velocity, for each unit of Coulomb friction: a solver of constraints
/// evaluates friction at the begin of a step, and the steps of recording and simulation may differ. `None` where it turns over with it.
fn earlier_turn_over(prepared: &Prepared) -> Option<Vec<f64>> {
    let state = &prepared.state;
    let sign = |lead_s: f64| state.leading_sign(lead_s, state.sign_velocity);
    let lead_s = Some(state.sign_lead_s).filter(|lead_s| *lead_s > 0.0)?;
    let (from, to) = (sign(lead_s - TURN_OVER_STEP_S), sign(lead_s + TURN_OVER_STEP_S));
    Some(prepared.filtered(&state.map(|i| to[i] - from[i])))
}

/// A prepared recording or simulation with what it is compared with.
#[derive(Clone)]
pub(crate) struct Side<'a> {
    pub prepared: &'a Prepared,
    /// Filtered torque that base and effects have to explain.
    pub target: Vec<f64>,
    /// Filtered columns of the base: its parameters, and what trades with an effect by nature.
    pub columns: Vec<Vec<f64>>,
    /// Runs of rows that are weighed.
    pub runs: Vec<Range<usize>>,
    /// What the variance of the noise depends on, at every row.
    pub features: Vec<Vec<f64>>,
    /// How many recordings each row stands for.
    pub repeats: f64,
}

impl<'a> Side<'a> {
    /// The open rows of a recording, with nothing that stands for a delay of the torque.
    pub fn without_delay(prepared: &'a Prepared, base: &Base) -> Self {
        let mut columns = base.columns.clone();
        if matches!(base.delay, Delay::OfSampling(_)) {
            columns.pop();
        }
        let (runs, features) = (prepared.open_runs(), noise_features(prepared));
        Self { runs, features, columns, target: base.target.clone(), prepared, repeats: 1.0 }
    }

    /// The open rows of a recording whose torque is in step with the motion but for a part of a sample.
    pub fn new(prepared: &'a Prepared, base: &Base) -> Self {
        let mut side = Self::without_delay(prepared, base);
        if base.delay != Delay::None {
            side.columns.push(prepared.filtered(&prepared.state.rate_of(&prepared.state.predicted)));
        }
        side.columns.extend(earlier_turn_over(prepared));
        side
    }

    /// Whether it moves as another side does at the same times: most of the other's velocity is that of this one.
    pub fn follows(&self, other: &Self) -> bool {
        let velocities = |side: &Self| -> (Vec<f64>, Vec<f64>) {
            let state = &side.prepared.state;
            let mut of_rows: Vec<(f64, f64)> =
                side.prepared.rows.iter().map(|&i| (state.time[i], state.velocity[i])).collect();
            of_rows.sort_by(|a, b| a.0.total_cmp(&b.0));
            of_rows.into_iter().unzip()
        };
        let ((own_time, own), (time, velocity)) = (velocities(self), velocities(other));
        let apart: Vec<f64> =
            interpolate(&own_time, &own, &time).iter().zip(&velocity).map(|(own, other)| other - own).collect();
        2.0 * root_mean_square(&apart).powi(2) < root_mean_square(&velocity).powi(2)
    }

    /// The same where each row stands for so many recordings.
    pub fn standing_for(self, repeats: f64) -> Self {
        Self { repeats, ..self }
    }

    /// Filtered columns of a label and shape at all rows; `among` are the states whose values rank those of a channel.
    pub fn filtered(
        &self,
        hypotheses: &[Box<dyn Hypothesis + Send>],
        (label, shape): (&Label, &[f64]),
        among: &JointState,
    ) -> Vec<Vec<f64>> {
        let state = &self.prepared.state;
        let columns = match label {
            Label::Named(effect) => {
                let hypothesis = hypotheses.iter().find(|hypothesis| hypothesis.id() == *effect);
                hypothesis.map(|hypothesis| hypothesis.columns(state, shape)).unwrap_or_default()
            }
            Label::Generic(rival) => rival.columns_ranked(state, among, shape),
        };
        self.prepared.filtered_all(&columns)
    }

    /// What the noise of the recorded torque adds to the product of torque and first column of a label, both whitened: a column that follows that
    /// torque holds its noise too. By Stein's lemma the product is expected to be larger by the sum of the column's slope over the torque; as the slope
    /// of the likelihood's Jacobian it is what a transformed target pays (Box and Cox 1964). Zero for a column of the motion.
    pub fn product_with_own_noise(
        &self,
        hypotheses: &[Box<dyn Hypothesis + Send>],
        label: &Label,
        shape: &[f64],
    ) -> f64 {
        let Label::Named(effect) = label else { return 0.0 };
        let hypothesis = hypotheses.iter().find(|hypothesis| hypothesis.id() == *effect);
        let slope = hypothesis.and_then(|h| h.slope_over_recorded_torque(&self.prepared.state, shape));
        slope.map_or(0.0, |slope| self.on_rows(&self.prepared.at_rows(&slope)).iter().sum())
    }

    /// Columns behind the noise's whitening filter, on the weighed rows alone.
    pub fn whitened(&self, columns: &[Vec<f64>], noise: &Noise) -> Vec<Vec<f64>> {
        columns.par_iter().map(|column| self.on_rows(&noise.whitened(column, &self.runs))).collect()
    }

    /// What the variance of the noise depends on beside effects of some torque, which leave a residual: a joint follows the formula of a strong
    /// effect only roughly, and what the formula leaves where the effect acts is no other effect.
    pub fn features_beside(&self, effects: &[f64], left: &[f64]) -> Vec<Vec<f64>> {
        let noise = root_mean_square(&self.on_rows(left)).max(f64::MIN_POSITIVE);
        let feature = effects.iter().map(|torque| (torque / noise).powi(2).ln_1p()).collect();
        self.features.iter().cloned().chain([feature]).collect()
    }

    /// A column on the weighed rows alone.
    pub fn on_rows(&self, column: &[f64]) -> Vec<f64> {
        self.runs.iter().flat_map(|run| &column[run.clone()]).copied().collect()
    }

    /// Places of each open block among the weighed rows.
    pub fn blocks(&self) -> Vec<Range<usize>> {
        let mut end = 0;
        let lengths = self.prepared.open_blocks().into_iter().map(|runs| runs.iter().map(Range::len).sum::<usize>());
        let place = |length: usize| {
            end += length;
            end - length..end
        };
        lengths.map(place).collect()
    }
}
