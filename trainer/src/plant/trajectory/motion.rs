//! Reference motions: position, velocity and acceleration at the sample instants, from rest at zero to rest at zero.

use super::moves::{follow, plateaus, small_reversals, stop_and_go, trapezoids, triangles};
use super::reference::{REST_S, Reference};
use crate::plant::random::Draws;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The shapes of motion a trajectory can have. Ranges are maxima; the details are drawn from the seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Motion {
    /// Sum of `lines` sinusoids with random phase.
    Multisine {
        /// Largest excursion, rad.
        amplitude_rad: f64,
        /// Lowest frequency, Hz.
        #[serde(rename = "lowest_Hz")]
        lowest_hz: f64,
        /// Highest frequency, Hz.
        #[serde(rename = "highest_Hz")]
        highest_hz: f64,
        /// Largest speed, rad/s; the excursion shrinks where it would be exceeded.
        speed_rad_s: f64,
        /// Number of sinusoids (>= 1).
        lines: usize,
    },
    /// Constant speed back and forth with quick turns.
    Triangles {
        /// Excursion to both sides, rad.
        amplitude_rad: f64,
        /// Speed, rad/s.
        speed_rad_s: f64,
    },
    /// Trapezoidal moves to positions in turn, resting for a random one of `dwells_s`.
    Trapezoids {
        /// Excursion to both sides, rad.
        amplitude_rad: f64,
        /// Speed of the moves, rad/s.
        speed_rad_s: f64,
        /// Lengths of rest to draw from, s.
        dwells_s: Vec<f64>,
    },
    /// Short moves in one direction with rests of random length between, then the other way.
    StopAndGo {
        /// Length of one move, rad.
        step_rad: f64,
        /// Speed of the moves, rad/s.
        speed_rad_s: f64,
        /// Lengths of rest to draw from, s.
        dwells_s: Vec<f64>,
    },
    /// Slow reversals of amplitudes spread over `smallest_rad..largest_rad` about several positions.
    SmallReversals {
        /// Smallest amplitude, rad.
        smallest_rad: f64,
        /// Largest amplitude, rad.
        largest_rad: f64,
        /// Rate of the reversals, Hz.
        #[serde(rename = "frequency_Hz")]
        frequency_hz: f64,
    },
    /// Logarithmic sine sweep with constant speed amplitude.
    Sweep {
        /// Amplitude at the lowest frequency, rad.
        amplitude_rad: f64,
        /// First frequency, Hz.
        #[serde(rename = "lowest_Hz")]
        lowest_hz: f64,
        /// Last frequency, Hz.
        #[serde(rename = "highest_Hz")]
        highest_hz: f64,
    },
    /// Constant-velocity plateaus, each forth and back over the same positions.
    Plateaus {
        /// Speeds in turn, rad/s.
        speeds_rad_s: Vec<f64>,
        /// Time on each plateau in one direction, s.
        hold_s: f64,
    },
    /// One direction only, at a speed that swings about its mean, then the other direction.
    UnidirectionalSwing {
        /// Mean speed, rad/s.
        speed_rad_s: f64,
        /// Swing over the mean, [0, 1).
        swing: f64,
        /// Frequency of the swing, Hz.
        #[serde(rename = "frequency_Hz")]
        frequency_hz: f64,
    },
    /// Positions given sample by sample; the last is held, or the rest cut, to fill the length of the trajectory.
    Samples {
        /// Position at every sample of the drive, rad; at rest at zero at both ends.
        position_rad: Vec<f64>,
    },
    /// No motion.
    Rest,
}

/// Time over which a periodic motion fades in and out, s.
const FADE_S: f64 = 0.4;

impl Motion {
    /// Samples the motion: `duration_s` seconds at `rate_hz`.
    pub(crate) fn reference(&self, duration_s: f64, rate_hz: f64, draws: &mut Draws) -> Reference {
        let samples = (duration_s * rate_hz).round() as usize;
        match self {
            Self::Multisine { amplitude_rad, lowest_hz, highest_hz, speed_rad_s, lines } => {
                let tones = tones(*lowest_hz, *highest_hz, *lines, draws);
                multisine(&tones, *amplitude_rad, *speed_rad_s, duration_s, rate_hz)
            }
            Self::Sweep { amplitude_rad, lowest_hz, highest_hz } => {
                sweep(*amplitude_rad, *lowest_hz, *highest_hz, duration_s, rate_hz)
            }
            Self::SmallReversals { smallest_rad, largest_rad, frequency_hz } => {
                let moves = small_reversals(*smallest_rad, *largest_rad, *frequency_hz, duration_s, draws);
                follow(&moves, samples, rate_hz)
            }
            Self::UnidirectionalSwing { speed_rad_s, swing, frequency_hz } => {
                unidirectional_swing(*speed_rad_s, *swing, *frequency_hz, duration_s, rate_hz)
            }
            Self::Triangles { amplitude_rad, speed_rad_s } => {
                let moves = triangles(*amplitude_rad, *speed_rad_s, duration_s);
                follow(&moves, samples, rate_hz)
            }
            Self::Trapezoids { amplitude_rad, speed_rad_s, dwells_s } => {
                let moves = trapezoids(*amplitude_rad, *speed_rad_s, dwells_s, duration_s, draws);
                follow(&moves, samples, rate_hz)
            }
            Self::StopAndGo { step_rad, speed_rad_s, dwells_s } => {
                let moves = stop_and_go(*step_rad, *speed_rad_s, dwells_s, duration_s, draws);
                follow(&moves, samples, rate_hz)
            }
            Self::Plateaus { speeds_rad_s, hold_s } => {
                let moves = plateaus(speeds_rad_s, *hold_s, duration_s);
                follow(&moves, samples, rate_hz)
            }
            Self::Samples { position_rad } => {
                let last = position_rad.last().copied().unwrap_or(0.0);
                let position = (0..samples).map(|k| position_rad.get(k).copied().unwrap_or(last)).collect();
                differentiated(position, rate_hz)
            }
            Self::Rest => Reference {
                position: vec![0.0; samples],
                velocity: vec![0.0; samples],
                acceleration: vec![0.0; samples],
            },
        }
    }
}

/// A reference from its positions, by central differences.
fn differentiated(position: Vec<f64>, rate: f64) -> Reference {
    let at = |k: isize| position[k.clamp(0, position.len() as isize - 1) as usize];
    let indices = 0..position.len() as isize;
    let velocity = indices.clone().map(|k| 0.5 * rate * (at(k + 1) - at(k - 1))).collect();
    let acceleration = indices.map(|k| rate * rate * (at(k + 1) - 2.0 * at(k) + at(k - 1))).collect();
    Reference { position, velocity, acceleration }
}

/// A value with its first and second time derivative.
type Jet = (f64, f64, f64);

/// A smooth window, three times differentiable at its ends: rest, fade in, one, fade out, rest.
fn window(time: f64, duration: f64) -> Jet {
    // Trajectories of less than about a second have less of both.
    let (fade, still) = (FADE_S.min(0.3 * duration), REST_S.min(0.1 * duration));
    let rise = |x: f64| -> Jet {
        if x <= 0.0 {
            (0.0, 0.0, 0.0)
        } else if x >= 1.0 {
            (1.0, 0.0, 0.0)
        } else {
            let x2 = x * x;
            let value = x2 * x2 * (35.0 - 84.0 * x + 70.0 * x2 - 20.0 * x2 * x);
            let slope = 140.0 * x2 * x * (1.0 - x).powi(3);
            let curvature = 420.0 * x2 * (1.0 - x).powi(2) * (1.0 - 2.0 * x);
            (value, slope / fade, curvature / (fade * fade))
        }
    };
    if time < duration / 2.0 {
        rise((time - still) / fade)
    } else {
        let (value, slope, curvature) = rise((duration - still - time) / fade);
        (value, -slope, curvature)
    }
}

/// Samples `signal` under the window.
fn windowed(duration: f64, rate: f64, signal: impl Fn(f64) -> Jet) -> Reference {
    let samples = (duration * rate).round() as usize;
    let mut reference = Reference::default();
    for k in 0..samples {
        let time = k as f64 / rate;
        let (w, dw, ddw) = window(time, duration);
        let (p, v, a) = signal(time);
        reference.position.push(w * p);
        reference.velocity.push(dw * p + w * v);
        reference.acceleration.push(ddw * p + 2.0 * dw * v + w * a);
    }
    reference
}

/// Angular frequency, relative size and phase of every sinusoid; frequencies are spread evenly on a logarithmic axis.
fn tones(lowest: f64, highest: f64, lines: usize, draws: &mut Draws) -> Vec<(f64, f64, f64)> {
    (0..lines)
        .map(|i| {
            let place = (i as f64 + draws.between(0.2, 0.8)) / lines as f64;
            let frequency = lowest * (highest / lowest).powf(place);
            // Between equal speed and equal acceleration of all lines.
            (TAU * frequency, (lowest / frequency).powf(1.5), draws.between(0.0, TAU))
        })
        .collect()
}

fn multisine(tones: &[(f64, f64, f64)], amplitude: f64, speed: f64, duration: f64, rate: f64) -> Reference {
    let signal = |time: f64| {
        tones.iter().fold((0.0, 0.0, 0.0), |(p, v, a), &(omega, weight, phase)| {
            let (sine, cosine) = (omega * time + phase).sin_cos();
            (p + weight * sine, v + weight * omega * cosine, a - weight * omega * omega * sine)
        })
    };
    let mut reference = windowed(duration, rate, signal);
    let peak = |values: &[f64]| values.iter().fold(f64::MIN_POSITIVE, |peak, x| peak.max(x.abs()));
    let scale = (amplitude / peak(&reference.position)).min(speed / peak(&reference.velocity));
    for channel in [&mut reference.position, &mut reference.velocity, &mut reference.acceleration] {
        channel.iter_mut().for_each(|x| *x *= scale);
    }
    reference
}

fn sweep(amplitude: f64, lowest: f64, highest: f64, duration: f64, rate: f64) -> Reference {
    let growth = (highest / lowest).ln() / duration;
    windowed(duration, rate, |time| {
        let omega = TAU * lowest * (growth * time).exp();
        let phase = (omega - TAU * lowest) / growth;
        let size = amplitude * (-growth * time).exp();
        let (sine, cosine) = phase.sin_cos();
        let position = size * sine;
        let velocity = size * omega * cosine - growth * position;
        // size * omega is constant: d/dt (size * omega * cos) = -size * omega^2 * sin.
        (position, velocity, -size * omega * omega * sine - growth * velocity)
    })
}

fn unidirectional_swing(speed: f64, swing: f64, frequency: f64, duration: f64, rate: f64) -> Reference {
    // Forth for half of the time and back for the other half, with a slow smooth turn between.
    let samples = (duration * rate).round() as usize;
    let omega = TAU * frequency;
    let half = duration / 2.0;
    let speed_at = |time: f64| {
        let (local, sign) = if time < half { (time, 1.0) } else { (duration - time, -1.0) };
        let (rise, _, _) = window(local, half * 2.0);
        let (fall, _, _) = window(half - local + REST_S * 0.5, half * 2.0);
        sign * speed * rise * fall * (1.0 + swing * (omega * local).sin())
    };
    let mut reference = Reference::default();
    let (mut position, step) = (0.0, 1.0 / rate);
    for k in 0..samples {
        let time = k as f64 * step;
        reference.position.push(position);
        reference.velocity.push(speed_at(time));
        reference.acceleration.push((speed_at(time + step / 2.0) - speed_at(time - step / 2.0)) * rate);
        // Simpson's rule over one sample.
        position += step / 6.0 * (speed_at(time) + 4.0 * speed_at(time + step / 2.0) + speed_at(time + step));
    }
    reference
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::Campaign;
    use crate::plant::random::Purpose;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Every motion begins and ends at rest at zero, and its derivatives are derivatives.
        #[test]
        fn references_are_consistent(seed in any::<u64>(), duration in 0.5..9.0_f64) {
            for (index, trajectory) in Campaign::default().trajectories.iter().enumerate() {
                let mut draws = Draws::new(seed, Purpose::Motion, index as u64);
                let reference = trajectory.motion.reference(duration, 1000.0, &mut draws);
                let last = reference.position.len() - 1;
                prop_assert_eq!(last + 1, (duration * 1000.0).round() as usize);
                for end in [0, last] {
                    prop_assert!(reference.position[end].abs() < 0.01, "{:?} {}", trajectory.motion, end);
                    prop_assert!(reference.velocity[end].abs() < 0.05, "{:?} {}", trajectory.motion, end);
                }
                for k in 1..last {
                    let slope = (reference.position[k + 1] - reference.position[k - 1]) * 500.0;
                    let error = (slope - reference.velocity[k]).abs();
                    prop_assert!(error < 0.08, "{:?} at {k}: {slope} {}", trajectory.motion, reference.velocity[k]);
                    let slope = (reference.velocity[k + 1] - reference.velocity[k - 1]) * 500.0;
                    let error = (slope - reference.acceleration[k]).abs();
                    prop_assert!(error < 3.0, "{:?} at {k}: {slope} {}", trajectory.motion, reference.acceleration[k]);
                }
            }
        }
    }
}
