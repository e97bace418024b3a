//! Chooses the one filter: its width follows the encoder, its output rate follows its width (rules P1 and P2).

use std::f64::consts::PI;
use std::fmt;

use super::bending::BendingLaw;
use super::filter::{GaussianFilter, Order, sigma_for_acceleration_noise};
use super::grid::Grid;
use super::prepare::prepare;
use super::regression::{dot, norm};
use super::{Samples, rigid_body};
use crate::error::{Error, Result};
use crate::joint::Joint;
use crate::recording::{Quantity, Recording};

/// Share of the torque residual that the noise of the acceleration may reach after the filter.
const ACCELERATION_NOISE_SHARE: f64 = 0.1;
/// Share of the root mean square velocity that the noise of the velocity may reach after the filter.
const VELOCITY_NOISE_SHARE: f64 = 0.01;
/// The filter may not be wider than this share of the time scale of the motion, rms(q) / rms(v).
const MOTION_SHARE: f64 = 0.15;
/// Gain left at half the output rate, as the product of frequency and sigma: 10 dB below the passband.
const NYQUIST_FREQUENCY_SIGMAS: f64 = 0.2415;
/// Rounds of filter, fit, new filter.
const ROUNDS: usize = 4;
/// A recorded velocity that lags by more than this share of a period has been filtered by the drive.
const LARGEST_LAG_PERIODS: f64 = 0.5;

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
}

impl Preparation {
    /// Chooses filter and rate for recordings of one joint, the shortest filter that keeps the noise of the
    /// acceleration below a tenth of the torque residual in every recording.
    ///
    /// # Errors
    /// `FRK-D009` when motion or actuator is missing, `FRK-D016` when the velocity hardly changes, `FRK-D017` when a
    /// recording is too short.
    pub fn plan(recordings: &[&Recording], joint: &Joint, request: &Request) -> Result<Self> {
        if recordings.iter().all(|recording| is_static(recording)) {
            let velocity = recordings.iter().filter_map(|recording| recording.values(Quantity::Velocity));
            refuse_constant_velocity(recordings, velocity)?;
            return Ok(Self { sigma_s: None, rate_hz: None, velocity: VelocitySource::Recorded });
        }
        let mut motions = Vec::with_capacity(recordings.len());
        for recording in recordings {
            motions.push(Motion::of(recording)?);
        }
        refuse_constant_velocity(recordings, motions.iter().map(|motion| motion.velocity.as_slice()))?;
        let recorded = motions.iter().all(|motion| motion.source == VelocitySource::Recorded);
        let velocity = if recorded { VelocitySource::Recorded } else { VelocitySource::Derived };
        let shortest = motions.iter().map(Motion::shortest_sigma_s).fold(0.0, f64::max);
        let longest = motions.iter().map(|motion| motion.longest_sigma_s).fold(f64::INFINITY, f64::min).max(shortest);
        let widened = request.rate_hz.map_or(0.0, |rate| NYQUIST_FREQUENCY_SIGMAS / (0.5 * rate));
        let mut sigma_s = request.sigma_s.unwrap_or_else(|| shortest.max(widened).min(longest));
        if request.sigma_s.is_none() && velocity == VelocitySource::Derived {
            for _ in 0..ROUNDS {
                let trial = Self { sigma_s: Some(sigma_s), rate_hz: request.rate_hz, velocity }.with_rate(request);
                let wanted = wanted_sigma(recordings, &motions, joint, &trial)?;
                sigma_s = wanted.max(shortest).max(widened).min(longest);
            }
        }
        Ok(Self { sigma_s: Some(sigma_s), rate_hz: request.rate_hz, velocity }.with_rate(request))
    }

    fn with_rate(mut self, request: &Request) -> Self {
        self.rate_hz = request.rate_hz.or(self.sigma_s.map(|sigma| 2.0 * NYQUIST_FREQUENCY_SIGMAS / sigma));
        self
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
            "every channel through one zero-phase Gaussian, sigma {:.2} ms (half power at {cutoff_hz:.1} Hz); {source}; \
             uneven time stamps linearly interpolated to a uniform grid",
            1e3 * sigma_s,
        )
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

/// What the choice needs to know of one recording's motion.
struct Motion {
    period_s: f64,
    noise: f64,
    /// Coarse velocity at every row, over ten periods.
    velocity: Vec<f64>,
    rms_velocity: f64,
    longest_sigma_s: f64,
    source: VelocitySource,
}

impl Motion {
    fn of(recording: &Recording) -> Result<Self> {
        let time = &recording.require(&[Quantity::Time], "a motion")?.values;
        let period_s = recording.health.period_s.unwrap_or(1.0);
        let motion = recording.require(&[Quantity::Position, Quantity::Velocity], "a motion")?;
        let span = time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first);
        let Some(position) = recording.values(Quantity::Position) else {
            let rms_velocity = norm(&motion.values) / (motion.values.len() as f64).sqrt();
            let source = VelocitySource::Recorded;
            let velocity = motion.values.clone();
            return Ok(Self { period_s, noise: 0.0, velocity, rms_velocity, longest_sigma_s: 0.01 * span, source });
        };
        // On the rows themselves an uneven clock would look like noise.
        let grid = Grid::of(recording, time);
        let longest = grid.segments.iter().max_by_key(|segment| segment.points);
        let even = longest.map_or_else(Vec::new, |segment| grid.values(segment, time, position));
        let noise = position_noise(&even, recording.health.position_resolution);
        let mean = position.iter().sum::<f64>() / position.len() as f64;
        let centred: Vec<f64> = position.iter().map(|q| q - mean).collect();
        let rms_position = norm(&centred) / (centred.len() as f64).sqrt();
        let reach = 10.min(position.len() - 1);
        let rates: Vec<f64> =
            position.windows(reach + 1).map(|w| (w[reach] - w[0]) / (reach as f64 * period_s)).collect();
        let rms_velocity = norm(&rates) / (rates.len() as f64).sqrt();
        let time_scale = if rms_velocity > 0.0 { rms_position / rms_velocity } else { span };
        let source = velocity_source(recording, position, period_s, noise);
        Ok(Self { period_s, noise, velocity: rates, rms_velocity, longest_sigma_s: MOTION_SHARE * time_scale, source })
    }

    /// Shortest filter that this motion allows without knowing the inertia: one period, and velocity noise in bounds,
    /// ||D F||^2 = period / (4 sqrt(pi) sigma^3).
    fn shortest_sigma_s(&self) -> f64 {
        if self.source == VelocitySource::Recorded || self.rms_velocity <= 0.0 {
            return self.period_s;
        }
        let limit = VELOCITY_NOISE_SHARE * self.rms_velocity;
        let velocity = (self.noise * self.noise * self.period_s / (4.0 * PI.sqrt() * limit * limit)).cbrt();
        velocity.max(self.period_s)
    }
}

/// Standard deviation of the noise of a recorded position: that of rounding to its resolution, or what fourth
/// differences of neighbours show where that is more (a motion has next to no fourth difference).
fn position_noise(position: &[f64], resolution: Option<f64>) -> f64 {
    let mut fourth: Vec<f64> =
        position.windows(5).map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs()).collect();
    fourth.sort_by(f64::total_cmp);
    // Median of |normal| is 0.6745 sigma; the squares of 1 4 6 4 1 add up to 70.
    let robust = fourth.get(fourth.len() / 2).map_or(0.0, |median| median / (0.6745 * 70.0_f64.sqrt()));
    robust.max(resolution.unwrap_or(0.0) / 12.0_f64.sqrt())
}

/// The recorded velocity is used only where it is finer than the derived one, has its scale, and does not lag.
fn velocity_source(recording: &Recording, position: &[f64], period_s: f64, noise: f64) -> VelocitySource {
    let Some(velocity) = recording.values(Quantity::Velocity) else { return VelocitySource::Derived };
    if !recording.health.gaps.is_empty() {
        return VelocitySource::Derived;
    }
    let filter = GaussianFilter::new(3.0 * period_s, period_s);
    let recorded = filter.apply(velocity, Order::Smooth, 1);
    let derived = filter.apply(position, Order::First, 1);
    let acceleration = filter.apply(position, Order::Second, 1);
    // recorded = scale * derived - lag * acceleration
    let (vv, va, aa) = (dot(&derived, &derived), dot(&derived, &acceleration), dot(&acceleration, &acceleration));
    let determinant = vv * aa - va * va;
    if determinant <= 0.0 {
        return VelocitySource::Derived;
    }
    let (rv, ra) = (dot(&recorded, &derived), dot(&recorded, &acceleration));
    let scale = (rv * aa - ra * va) / determinant;
    let lag_s = -(vv * ra - va * rv) / determinant;
    let mut steps: Vec<f64> =
        velocity.windows(5).map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs()).collect();
    steps.sort_by(f64::total_cmp);
    let own_noise = steps.get(steps.len() / 2).map_or(0.0, |median| median / (0.6745 * 70.0_f64.sqrt()));
    let finer = own_noise * filter.noise_gain(Order::Smooth) < noise * filter.noise_gain(Order::First);
    if finer && (scale - 1.0).abs() < 0.01 && lag_s.abs() < LARGEST_LAG_PERIODS * period_s {
        VelocitySource::Recorded
    } else {
        VelocitySource::Derived
    }
}

/// Filter width at which, with the inertia and the residual of a preliminary fit, rule P2 holds in every recording.
fn wanted_sigma(recordings: &[&Recording], motions: &[Motion], joint: &Joint, trial: &Preparation) -> Result<f64> {
    let mut parts = Vec::with_capacity(recordings.len());
    for recording in recordings {
        parts.push(prepare(recording, trial)?);
    }
    let samples = Samples::join(parts)?;
    if samples.actuator.is_none() || samples.acceleration.is_none() {
        return Ok(0.0);
    }
    let separation = rigid_body::separate(&samples, joint)?;
    let inertia = separation.inertia().abs();
    let residual = separation.rmse;
    if inertia <= 0.0 || residual <= 0.0 {
        return Ok(0.0);
    }
    let limit = ACCELERATION_NOISE_SHARE * residual / inertia;
    let sigma = |motion: &Motion| sigma_for_acceleration_noise(motion.noise, motion.period_s, limit);
    Ok(motions.iter().map(sigma).fold(0.0, f64::max))
}
