//! Chooses the one filter: its width by the error of the constants behind it, the source of the velocity by what it leaves of the recorded torque,
//! its output rate by its width (rules P1 and P2).

use std::f64::consts::PI;
use std::fmt;

use super::BendingLaw;
use super::grid::Grid;
use super::{Samples, width};
use crate::error::{Error, Result};
use crate::joint::Joint;
use crate::numerics::filter::gaussian::GaussianFilter;
use crate::numerics::statistics::{mean, quantile, root_mean_square};
use crate::recording::{Quantity, Recording};

/// Share of the acceleration that its noise may reach where there is no torque to judge by.
const ACCELERATION_NOISE_SHARE: f64 = 0.1;
/// Share of the root mean square velocity that the noise of the velocity may reach after the filter.
const VELOCITY_NOISE_SHARE: f64 = 0.01;
/// The filter may not be wider than this share of the time scale of the motion, rms(q) / rms(v).
const MOTION_SHARE: f64 = 0.15;
/// Gain left at half the output rate, as the product of frequency and sigma: 10 dB below the passband.
const NYQUIST_FREQUENCY_SIGMAS: f64 = 0.2415;
/// Periods over which the coarse velocity is taken.
const COARSE_PERIODS: f64 = 10.0;
/// Coarse velocity over what noise alone would make of it, root mean squares, from which a joint moves: its noise is a hundredth of its power.
const SEEN_OVER_NOISE: f64 = 10.0;
/// Nor wider than this share of the recording.
const SPAN_SHARE: f64 = 0.01;

/// What a caller may fix; anything left out is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Request {
    /// Standard deviation of the Gaussian filter, s.
    pub sigma_s: Option<f64>,
    /// Rate of the samples, Hz; the filter is widened where it would alias.
    pub rate_hz: Option<f64>,
}

/// Where velocity and acceleration come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocitySource {
    /// Derivatives of the recorded position.
    Derived,
    /// The recorded velocity and its derivative.
    Recorded,
}

/// How every recording of a joint is turned into samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preparation {
    /// Standard deviation of the filter, s; `None` for separated recordings, which are not filtered.
    pub sigma_s: Option<f64>,
    /// Rate of the samples, Hz; that of the recording when absent or faster.
    pub rate_hz: Option<f64>,
    /// Where velocity comes from.
    pub velocity: VelocitySource,
    /// Noise of the acceleration that passes the filter, rad/s2 or m/s2, that of the motion being white.
    pub acceleration_noise: f64,
    /// Time by which the torque of the actuator was recorded late, s (negative where early): it is put back.
    pub torque_delay_s: f64,
}

impl Preparation {
    /// Chooses filter, rate and source of the velocity for recordings of one joint: the source that leaves least of the recorded actuator on blocks
    /// held out, and the shortest filter behind which noise of the acceleration has little part in the error of inertia, gravity and friction.
    ///
    /// # Errors
    /// `FRK-D009` when motion or actuator is missing, `FRK-D016` when the velocity hardly changes, `FRK-D017` when a
    /// recording is too short.
    pub fn plan(recordings: &[&Recording], joint: &Joint, request: &Request) -> Result<Self> {
        if recordings.iter().all(|recording| is_static(recording)) {
            let velocity = recordings.iter().filter_map(|recording| recording.values(Quantity::Velocity));
            refuse_constant_velocity(recordings, velocity)?;
            return Ok(Self::unfiltered());
        }
        let motions = recordings.iter().map(|recording| Motion::of(recording)).collect::<Result<Vec<_>>>()?;
        refuse_constant_velocity(recordings, motions.iter().map(|motion| motion.velocity.as_slice()))?;
        let candidates = candidates(&motions, request);
        let judge = |samples: &Samples, tried: &Self| width::cross_fitted(samples, joint, tried.acceleration_noise);
        let trials = width::trials(recordings, &candidates, &judge);
        let chosen = width::to_learn_at(&trials).map(|trial| trial.preparation);
        Ok(chosen.unwrap_or_else(|| quietest(&motions, &candidates)))
    }

    /// Chooses filter and source of the velocity for the prediction of a recording by a known model. `residual` gives what the
    /// model leaves of [`Samples::recorded`]; where there is nothing to compare with, the noise of the motion decides.
    ///
    /// # Errors
    /// `FRK-D009` when clock or motion is missing.
    pub fn plan_prediction(
        recording: &Recording,
        residual: &(dyn Fn(&Samples) -> Result<Vec<f64>> + Sync),
    ) -> Result<Self> {
        // Without a clock nothing can be filtered, but a velocity may be all that the model reads.
        let is_bare = recording.channel(Quantity::Time).is_none() && recording.channel(Quantity::Velocity).is_some();
        if is_static(recording) || is_bare {
            return Ok(Self::unfiltered());
        }
        let motions = [Motion::of(recording)?];
        let candidates = candidates(&motions, &Request::default());
        let trials =
            width::trials(&[recording], &candidates, &|samples: &Samples, _: &Self| Ok((residual(samples)?, 0.0)));
        let chosen = width::best(&trials).map(|trial| trial.preparation);
        Ok(chosen.unwrap_or_else(|| quietest(&motions, &candidates)))
    }

    /// Every filter that the recordings of joints that move together allow, from each source of the velocity that all of them have;
    /// joints at rest do not count.
    ///
    /// # Errors
    /// `FRK-D009` when clock or motion is missing.
    pub(crate) fn of_joints(recordings: &[&Recording]) -> Result<Vec<Self>> {
        let mut motions = recordings.iter().map(|recording| Motion::of(recording)).collect::<Result<Vec<_>>>()?;
        let has = [VelocitySource::Derived, VelocitySource::Recorded]
            .map(|source| motions.iter().all(|motion| motion.has(source)));
        motions.retain(Motion::is_seen);
        let mut found = candidates(&motions, &Request::default());
        found.retain(|preparation| has[usize::from(preparation.velocity == VelocitySource::Recorded)]);
        Ok(found)
    }

    /// The same filter with the noise of this recording's motion.
    ///
    /// # Errors
    /// `FRK-D009` when clock or motion is missing.
    pub(crate) fn with_noise_of(&self, recording: &Recording) -> Result<Self> {
        let noise = Motion::of(recording)?.acceleration_noise(self.velocity, self.sigma_s.unwrap_or(0.0));
        Ok(Self { acceleration_noise: noise, ..*self })
    }

    fn unfiltered() -> Self {
        Self {
            sigma_s: None,
            rate_hz: None,
            velocity: VelocitySource::Recorded,
            acceleration_noise: 0.0,
            torque_delay_s: 0.0,
        }
    }

    fn with_rate(mut self, request: &Request) -> Self {
        self.rate_hz = request.rate_hz.or(self.sigma_s.map(|sigma| 2.0 * NYQUIST_FREQUENCY_SIGMAS / sigma));
        self
    }

    /// Noise of the velocity that passes the filter, rad/s or m/s, that of the motion being white: ||D F||^2 = period / (4 sqrt(pi) sigma^3)
    /// beside ||D2 F||^2 where the velocity is derived, ||F||^2 = period / (2 sqrt(pi) sigma) beside ||D F||^2 where it was recorded.
    pub(crate) fn velocity_noise(&self) -> f64 {
        let orders: f64 = match self.velocity {
            VelocitySource::Derived => 2.0 / 3.0,
            VelocitySource::Recorded => 2.0,
        };
        self.acceleration_noise * orders.sqrt() * self.sigma_s.unwrap_or(0.0)
    }

    /// Every how many periods a sample is kept.
    pub(super) fn stride(&self, period_s: f64) -> usize {
        self.rate_hz.map_or(1, |rate| (1.0 / (rate * period_s) + 0.01).floor().max(1.0) as usize)
    }
}

/// One sentence for reports.
impl fmt::Display for Preparation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(sigma_s) = self.sigma_s else { return f.write_str("not filtered") };
        let cutoff_hz = GaussianFilter::new(sigma_s, sigma_s).cutoff_hz();
        let source = match self.velocity {
            VelocitySource::Derived => "velocity and acceleration derived from position",
            VelocitySource::Recorded => "velocity as recorded, acceleration derived from it",
        };
        write!(
            f,
            "every channel through one zero-phase Gaussian, sigma {:.2} ms (half power at {cutoff_hz:.1} Hz); {source}",
            1e3 * sigma_s,
        )?;
        let delay_ms = 1e3 * self.torque_delay_s;
        match delay_ms {
            0.0 => Ok(()),
            _ if delay_ms > 0.0 => write!(f, "; torque recorded {delay_ms:.3} ms late and put back"),
            _ => write!(f, "; torque recorded {:.3} ms early and put back", -delay_ms),
        }
    }
}

/// A constant velocity cannot tell friction from an offset; positions alone (no velocity at all) may still be of use.
fn refuse_constant_velocity<'a>(recordings: &[&Recording], velocity: impl Iterator<Item = &'a [f64]>) -> Result<()> {
    let all: Vec<f64> = velocity.flatten().copied().collect();
    if all.is_empty() {
        return Ok(());
    }
    let named = |error: Error| recordings.first().map_or(error.clone(), |recording| error.in_file(recording.file()));
    BendingLaw::over(&all).map(|_| ()).map_err(named)
}

/// Separated already, and nothing to differentiate.
fn is_static(recording: &Recording) -> bool {
    recording.separated_friction().is_some()
        && (recording.channel(Quantity::Time).is_none() || recording.channel(Quantity::Velocity).is_some())
}

/// Every width that the motions allow, from each source of the velocity that all of them have.
fn candidates(motions: &[Motion], request: &Request) -> Vec<Preparation> {
    let widened = request.rate_hz.map_or(0.0, |rate| NYQUIST_FREQUENCY_SIGMAS / (0.5 * rate));
    let mut candidates = Vec::new();
    for velocity in [VelocitySource::Recorded, VelocitySource::Derived] {
        if !motions.iter().all(|motion| motion.has(velocity)) {
            continue;
        }
        let shortest = motions.iter().map(|motion| motion.shortest_sigma_s(velocity)).fold(widened, f64::max);
        let longest = motions.iter().map(|motion| motion.longest_sigma_s).fold(f64::INFINITY, f64::min);
        let widths = request.sigma_s.map_or_else(|| width::ladder(shortest, longest), |sigma| vec![sigma]);
        let preparation = |sigma_s| {
            let noise = motions.iter().map(|motion| motion.acceleration_noise(velocity, sigma_s)).fold(0.0, f64::max);
            Preparation {
                sigma_s: Some(sigma_s),
                rate_hz: request.rate_hz,
                velocity,
                acceleration_noise: noise,
                torque_delay_s: 0.0,
            }
        };
        candidates.extend(widths.into_iter().map(|sigma_s| preparation(sigma_s).with_rate(request)));
    }
    candidates
}

/// Without a torque to compare with: the first, recorded velocities and short widths before others, at which the noise of the
/// acceleration is small beside the acceleration itself; the widest where there is none.
fn quietest(motions: &[Motion], candidates: &[Preparation]) -> Preparation {
    let scale = motions.iter().map(|motion| motion.acceleration_scale).fold(f64::INFINITY, f64::min);
    let quiet = |preparation: &&Preparation| preparation.acceleration_noise <= ACCELERATION_NOISE_SHARE * scale;
    let found = candidates.iter().find(quiet).or(candidates.last());
    found.copied().unwrap_or_else(Preparation::unfiltered)
}

/// What the choice needs to know of one recording's motion.
pub(super) struct Motion {
    period_s: f64,
    /// Noise of the recorded position and of the recorded velocity; `None` where there is none.
    position_noise: Option<f64>,
    velocity_noise: Option<f64>,
    /// Coarse velocity at every row, over [`COARSE_PERIODS`].
    velocity: Vec<f64>,
    rms_velocity: f64,
    /// Usual size of the acceleration, rad/s2 or m/s2.
    acceleration_scale: f64,
    longest_sigma_s: f64,
}

impl Motion {
    pub(super) fn of(recording: &Recording) -> Result<Self> {
        let time = &recording.require(&[Quantity::Time], "a motion")?.values;
        let period_s = recording.health.period_s.unwrap_or(1.0);
        let motion = recording.require(&[Quantity::Position, Quantity::Velocity], "a motion")?;
        let span = time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first);
        // On the rows themselves an uneven clock would look like noise.
        let grid = Grid::of(recording, time);
        let longest = grid.segments.iter().max_by_key(|segment| segment.points);
        let noise = |channel| longest.map_or(0.0, |segment| white_noise(&grid.values(segment, time, channel)));
        let velocity_noise = recording.values(Quantity::Velocity).map(noise);
        let Some(position) = recording.values(Quantity::Position) else {
            let velocity = motion.values.clone();
            let rms_velocity = root_mean_square(&velocity);
            return Ok(Self {
                period_s,
                position_noise: None,
                velocity_noise,
                acceleration_scale: rms_velocity / (SPAN_SHARE * span).max(period_s),
                velocity,
                rms_velocity,
                longest_sigma_s: SPAN_SHARE * span,
            });
        };
        let rounding = recording.health.position_resolution.unwrap_or(0.0) / 12.0_f64.sqrt();
        let centre = mean(position);
        let centred: Vec<f64> = position.iter().map(|q| q - centre).collect();
        let reach = (COARSE_PERIODS as usize).min(position.len() - 1);
        let rates: Vec<f64> =
            position.windows(reach + 1).map(|w| (w[reach] - w[0]) / (reach as f64 * period_s)).collect();
        let rms_velocity = root_mean_square(&rates);
        let time_scale = if rms_velocity > 0.0 { root_mean_square(&centred) / rms_velocity } else { span };
        Ok(Self {
            period_s,
            position_noise: Some(noise(position).max(rounding)),
            velocity_noise,
            velocity: rates,
            rms_velocity,
            acceleration_scale: rms_velocity / time_scale.max(period_s),
            longest_sigma_s: (MOTION_SHARE * time_scale).min(SPAN_SHARE * span),
        })
    }

    /// Whether the motion stands out of the noise of the position.
    fn is_seen(&self) -> bool {
        let noise = self.position_noise.map_or(0.0, |noise| noise * 2.0_f64.sqrt() / (COARSE_PERIODS * self.period_s));
        self.rms_velocity > SEEN_OVER_NOISE * noise
    }

    fn has(&self, velocity: VelocitySource) -> bool {
        match velocity {
            VelocitySource::Derived => self.position_noise.is_some(),
            VelocitySource::Recorded => self.velocity_noise.is_some(),
        }
    }

    /// Noise of what the velocity is derived from or recorded as; 0 where it is not recorded.
    pub(super) fn noise(&self, velocity: VelocitySource) -> f64 {
        let noise = match velocity {
            VelocitySource::Derived => self.position_noise,
            VelocitySource::Recorded => self.velocity_noise,
        };
        noise.unwrap_or(0.0)
    }

    /// Shortest filter that is tried: one period, and noise of a derived velocity in bounds,
    /// ||D F||^2 = period / (4 sqrt(pi) sigma^3).
    fn shortest_sigma_s(&self, velocity: VelocitySource) -> f64 {
        let noise = self.position_noise.filter(|_| velocity == VelocitySource::Derived && self.rms_velocity > 0.0);
        let limit = VELOCITY_NOISE_SHARE * self.rms_velocity;
        let sigma =
            noise.map_or(0.0, |noise| (noise * noise * self.period_s / (4.0 * PI.sqrt() * limit * limit)).cbrt());
        sigma.max(self.period_s)
    }

    /// White noise of the recorded position or velocity after the filter and its derivatives:
    /// ||D2 F||^2 = 3 period / (8 sqrt(pi) sigma^5).
    fn acceleration_noise(&self, velocity: VelocitySource, sigma_s: f64) -> f64 {
        let sigma = sigma_s.max(self.period_s);
        match velocity {
            VelocitySource::Derived => {
                self.position_noise.unwrap_or(0.0) * (3.0 * self.period_s / (8.0 * PI.sqrt() * sigma.powi(5))).sqrt()
            }
            VelocitySource::Recorded => {
                self.velocity_noise.unwrap_or(0.0) * (self.period_s / (4.0 * PI.sqrt() * sigma.powi(3))).sqrt()
            }
        }
    }
}

/// Standard deviation of the white noise of a series, from the fourth differences of neighbours (a motion has next to none).
fn white_noise(series: &[f64]) -> f64 {
    let fourth = series.windows(5).map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs());
    // Median of |normal| is 0.6745 sigma; the squares of 1 4 6 4 1 add up to 70.
    quantile(fourth, 0.5) / (0.6745 * 70.0_f64.sqrt())
}
