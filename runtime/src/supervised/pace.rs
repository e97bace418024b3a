//! What of the settings depends on the sample period: worked out once for all samples of one period, since a drive's hardly ever changes.

use frikan_shared::elementary::lag_share;

use super::settings::Supervision;

/// The settings for one sample period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Sample period, s.
    pub dt: f32,
    /// 1/s.
    pub rate: f32,
    /// Share by which the low-pass of the observer moves in a sample.
    pub observer: f32,
    /// Torque that the inertia takes where the velocity is so much above its low-pass, N m s/rad.
    pub inertia: f32,
    /// Share of the gain that the monitor takes back in a sample where all friction is over-compensated once more.
    pub fall: f32,
    /// Share that it gives back where nothing is compensated.
    pub rise: f32,
    /// Share by which the low-pass of the plausibility moves in a sample.
    pub plausibility: f32,
    /// Share by which the means of the adaptation move in a sample.
    pub memory: f32,
}

impl Pace {
    /// No sample yet.
    pub const NONE: Self =
        Self { dt: 0.0, rate: 0.0, observer: 0.0, inertia: 0.0, fall: 0.0, rise: 0.0, plausibility: 0.0, memory: 0.0 };

    /// The settings for a period of `dt` seconds, above 0.
    #[must_use]
    #[inline(never)]
    pub fn at(supervision: &Supervision, dt: f32) -> Self {
        let observer = lag_share(dt / supervision.observer_time);
        Self {
            dt,
            rate: 1.0 / dt,
            observer,
            // The low-pass of the differences of the velocity, whatever the sample period.
            inertia: supervision.inertia * observer / dt,
            fall: dt / supervision.fall_time,
            rise: dt / supervision.rise_time,
            plausibility: lag_share(PLAUSIBILITY_SHARE * dt / supervision.implausible_time),
            memory: supervision.adaptation.map_or(0.0, |adaptation| lag_share(dt / adaptation.memory())),
        }
    }
}

/// Implausible time over the time constant of the low-pass behind which velocity and position are compared.
const PLAUSIBILITY_SHARE: f32 = 4.0;
