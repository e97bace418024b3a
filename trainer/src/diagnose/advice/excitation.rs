//! The library of excitations: positions from rest to rest within the limits of the joint. Knows no effect.

use std::f64::consts::TAU;
use std::ops::Range;

/// Limits within which a joint may move; SI units, rotary or linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Envelope {
    /// Lowest position, rad or m.
    pub low: f64,
    /// Highest position.
    pub high: f64,
    /// Where the motion begins and ends: between the two.
    pub home: f64,
    /// Largest speed, above zero.
    pub speed: f64,
    /// Largest acceleration, above zero.
    pub acceleration: f64,
    /// Smallest step of the position.
    pub resolution: f64,
}

/// One motion of the library.
#[derive(Clone, Debug)]
pub(crate) struct Excitation {
    /// In words.
    pub words: &'static str,
    /// Position at every sample.
    pub position: Vec<f64>,
}

/// Share (0..1) of each limit of position and speed that a planned motion uses. Chosen by judgement: smoothing,
/// quantisation and the controller take the rest; a larger share is refused by [`within`], a smaller one excites less.
const USED_LIMIT_SHARE: f64 = 0.95;
/// Length of the moving average over a trapezoidal move, s: it makes the jerk finite. Chosen by judgement: shorter lets
/// elastic joints ring, longer blurs reversals and stops.
const SMOOTHING_S: f64 = 0.04;

/// Every motion that fits into the envelope, `duration` s long, one position every `period` s.
pub(crate) fn library(envelope: &Envelope, duration: f64, period: f64) -> Vec<Excitation> {
    let clock = Clock { samples: (duration / period) as usize, period };
    let half = 0.5 * USED_LIMIT_SHARE * (envelope.high - envelope.low);
    let centre = 0.5 * (envelope.high + envelope.low);
    let top = USED_LIMIT_SHARE * envelope.speed;
    if !(half > 0.0 && top > 0.0 && envelope.acceleration > 0.0) {
        return Vec::new();
    }
    // Frequency at which half the range needs the largest speed, and the largest acceleration.
    let by_speed = |amplitude: f64| top / (TAU * amplitude);
    let by_acceleration = |amplitude: f64| (envelope.acceleration / amplitude).sqrt() / TAU;
    let wide = 0.5 * by_speed(half).min(by_acceleration(half));
    let fast = 0.7 * by_speed(0.1 * half).min(by_acceleration(0.1 * half));
    let moves = |moves: Vec<Move>| follow(&moves, envelope, clock);
    let sines = |tones: &[(f64, f64)]| multisine(tones, half, centre, envelope, clock);
    let between = |speed: f64, dwell: f64| -> Vec<Move> {
        (0..10_000).map(|i| Move { to: centre + if i % 2 == 0 { half } else { -half }, speed, dwell }).collect()
    };
    let slow = (0.05 * top).max(4.5 * half / duration);
    let motions = [
        ("a multisine over the whole range", sines(&spread(wide.max(2.0 / duration), 4.0 * wide, 7, 1.5))),
        ("a fast multisine", sines(&spread(0.3 * fast, fast, 7, 1.0))),
        ("a slow swing over the whole range with a fast one on top", sines(&[(0.6 * wide, 1.0), (fast, 0.12)])),
        ("fast triangles over the whole range", moves(between(top, 0.0))),
        ("slow triangles over the whole range", moves(between(slow, 0.0))),
        ("moves over the whole range with rests between them", moves(between(0.6 * top, 1.0))),
        ("stop-and-go with rests from 0.1 to 3 s", moves(stop_and_go(centre, half, 0.4 * top))),
        ("small reversals about several positions", moves(small_reversals(centre, half, top, envelope.resolution))),
        ("constant speeds from slow to fast, both ways", moves(plateaus(centre, half, top))),
        ("one direction at a time with a swinging speed", swings(centre, half, top, envelope, clock)),
    ];
    motions
        .into_iter()
        .map(|(words, position)| Excitation { words, position })
        .filter(|excitation| within(&excitation.position, envelope, period))
        .collect()
}

#[derive(Clone, Copy)]
struct Clock {
    samples: usize,
    period: f64,
}

impl Clock {
    fn time(self) -> impl Iterator<Item = f64> {
        (0..self.samples).map(move |k| k as f64 * self.period)
    }

    fn duration(self) -> f64 {
        self.samples as f64 * self.period
    }
}

/// One trapezoidal move and the rest behind it.
#[derive(Clone, Copy)]
struct Move {
    to: f64,
    speed: f64,
    dwell: f64,
}

fn stop_and_go(centre: f64, half: f64, speed: f64) -> Vec<Move> {
    /// Rests between the moves, s: over a decade and a half, as break-away rises with the logarithm of the dwell
    /// (Rabinowicz 1958; Dieterich 1979), in an order that no rate of the motion repeats.
    const DWELLS_S: [f64; 7] = [0.1, 1.0, 0.3, 3.0, 0.15, 0.6, 2.0];
    /// Stops a lap, one at either end. Prime to the number of rests, so that every rest is taken at every place.
    const STOPS_PER_LAP: usize = 11;
    (0..10_000)
        .map(|i| {
            let (lap, step) = (i / STOPS_PER_LAP, i % STOPS_PER_LAP);
            let place = 2.0 * step as f64 / (STOPS_PER_LAP - 1) as f64 - 1.0;
            let to = centre + half * if lap % 2 == 0 { place } else { -place };
            Move { to, speed, dwell: DWELLS_S[i % DWELLS_S.len()] }
        })
        .collect()
}

fn small_reversals(centre: f64, half: f64, top: f64, resolution: f64) -> Vec<Move> {
    /// Centres of the reversals over half the range (-1..1), in an order without a trend over position. Chosen by
    /// judgement: presliding is looked for at several places, as it may depend on position.
    const REVERSAL_CENTRES: [f64; 4] = [-0.6, 0.5, -0.2, 0.8];
    /// Amplitudes of the reversals about one centre, in geometric steps from some encoder steps to a seventh of half
    /// the range: the presliding distance is not known within decades (Al-Bender, Lampaert and Swevers 2005).
    const REVERSAL_AMPLITUDES: usize = 8;
    let smallest = (30.0 * resolution).clamp(1e-4 * half, 0.03 * half);
    let mut moves = Vec::new();
    for lap in 0..200 {
        let about = centre + half * REVERSAL_CENTRES[lap % REVERSAL_CENTRES.len()];
        moves.push(Move { to: about, speed: 0.5 * top, dwell: 0.05 });
        for size in 0..REVERSAL_AMPLITUDES {
            let amplitude = smallest * (0.15 * half / smallest).powf(size as f64 / (REVERSAL_AMPLITUDES - 1) as f64);
            // About two reversals a second, whatever their size.
            let speed = (8.0 * amplitude).min(0.5 * top);
            moves.push(Move { to: about + amplitude, speed, dwell: 0.0 });
            moves.push(Move { to: about - amplitude, speed, dwell: 0.0 });
        }
    }
    moves
}

fn plateaus(centre: f64, half: f64, top: f64) -> Vec<Move> {
    /// Speeds of the plateaus over the largest: factors of two down to a fiftieth, as a Stribeck velocity is not known
    /// beforehand (Armstrong-Helouvry, Dupont and Canudas de Wit 1994), in an order without a trend over time.
    const PLATEAU_SPEED_SHARES: [f64; 7] = [0.02, 1.0, 0.08, 0.35, 0.04, 0.7, 0.16];
    PLATEAU_SPEED_SHARES
        .iter()
        .cycle()
        .take(1000)
        .flat_map(|share| {
            let speed = share * top;
            // At most two seconds a plateau.
            let reach = half.min(speed);
            [Move { to: centre + reach, speed, dwell: 0.0 }, Move { to: centre - reach, speed, dwell: 0.0 }]
        })
        .collect()
}

/// Samples moves with a trapezoidal speed, goes home in time, and rounds the corners.
fn follow(moves: &[Move], envelope: &Envelope, clock: Clock) -> Vec<f64> {
    let rounding = ((0.5 * SMOOTHING_S / clock.period) as usize).max(1);
    let acceleration = 0.8 * envelope.acceleration;
    let home_speed = 0.5 * envelope.speed;
    let mut raw = vec![envelope.home; 2 * rounding];
    let mut at = envelope.home;
    for next in moves {
        let back = travel_time((next.to - envelope.home).abs(), home_speed, acceleration);
        let needed = travel_time((next.to - at).abs(), next.speed, acceleration) + next.dwell + back;
        if raw.len() + (needed / clock.period) as usize + 3 * rounding > clock.samples {
            break;
        }
        travel(&mut raw, at, next.to, next.speed, acceleration, clock.period);
        at = next.to;
        raw.extend(std::iter::repeat_n(at, (next.dwell / clock.period) as usize));
    }
    travel(&mut raw, at, envelope.home, home_speed, acceleration, clock.period);
    raw.resize(clock.samples.max(raw.len()), envelope.home);
    // Moving average, held at both ends.
    let mut sums = vec![0.0];
    for value in &raw {
        sums.push(sums[sums.len() - 1] + (value - envelope.home));
    }
    (0..raw.len())
        .map(|i| {
            let window: Range<usize> = i.saturating_sub(rounding)..(i + rounding + 1).min(raw.len());
            envelope.home + (sums[window.end] - sums[window.start]) / window.len() as f64
        })
        .collect()
}

fn travel_time(distance: f64, speed: f64, acceleration: f64) -> f64 {
    let ramp = (speed / acceleration).min((distance / acceleration).sqrt());
    if ramp > 0.0 { ramp + distance / (acceleration * ramp) } else { 0.0 }
}

fn travel(raw: &mut Vec<f64>, from: f64, to: f64, speed: f64, acceleration: f64, period: f64) {
    let distance = (to - from).abs();
    let ramp = (speed / acceleration).min((distance / acceleration).sqrt());
    let total = travel_time(distance, speed, acceleration);
    for k in 1..=(total / period) as usize {
        let time = k as f64 * period;
        let left = total - time;
        let way = if time < ramp {
            0.5 * acceleration * time * time
        } else if left < ramp {
            distance - 0.5 * acceleration * left * left
        } else {
            acceleration * ramp * (time - 0.5 * ramp)
        };
        raw.push(from + (to - from).signum() * way);
    }
}

/// `count` tones from `low` to `high` Hz, their size falling with frequency to the power `fall`.
fn spread(low: f64, high: f64, count: usize, fall: f64) -> Vec<(f64, f64)> {
    (0..count)
        .map(|i| {
            // Off the harmonics of each other.
            let place = (i as f64 + 0.13 * (i % 3) as f64) / count as f64;
            let frequency = low * (high / low).powf(place);
            (frequency, (low / frequency).powf(fall))
        })
        .collect()
}

/// A smooth step from 0 to 1 with zero first and second derivative at both ends.
fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
}

/// Tones (frequency in Hz, size) about the centre, phases by Schroeder (1970), as large as the limits allow.
fn multisine(tones: &[(f64, f64)], half: f64, centre: f64, envelope: &Envelope, clock: Clock) -> Vec<f64> {
    let fade = (4.0 * (centre - envelope.home).abs() / envelope.speed).max(1.0).min(0.3 * clock.duration());
    let window = |t: f64| smooth_step(t / fade) * smooth_step((clock.duration() - t) / fade);
    let power: f64 = tones.iter().map(|(_, size)| size * size).sum();
    let mut phases = Vec::new();
    let (mut before, mut phase) = (0.0, 0.0);
    for (_, size) in tones {
        phase -= TAU * before;
        phases.push(phase);
        before += size * size / power;
    }
    let signal: Vec<f64> = clock
        .time()
        .map(|t| {
            let sum: f64 = tones.iter().zip(&phases).map(|((f, size), phase)| size * (TAU * f * t + phase).sin()).sum();
            window(t) * sum
        })
        .collect();
    let way = |scale: f64| -> Vec<f64> {
        clock
            .time()
            .zip(&signal)
            .map(|(t, s)| envelope.home + (centre - envelope.home) * window(t) + scale * s)
            .collect()
    };
    let peak = signal.iter().fold(f64::MIN_POSITIVE, |peak, s| peak.max(s.abs()));
    let mut scale = half / peak;
    for _ in 0..4 {
        let (speed, acceleration) = peaks(&way(scale), clock.period);
        let over = (speed / (USED_LIMIT_SHARE * envelope.speed))
            .max(acceleration / (USED_LIMIT_SHARE * envelope.acceleration));
        scale /= over.max(1.0);
    }
    way(scale)
}

/// There and back over the whole range at a speed that swings by 0.8 of its mean.
fn swings(centre: f64, half: f64, top: f64, envelope: &Envelope, clock: Clock) -> Vec<f64> {
    let mean = 0.3 * top;
    let frequency = (0.4 * envelope.acceleration / (0.8 * mean * TAU)).min(2.0);
    let legs = follow(
        &(0..10_000)
            .map(|i| Move { to: centre + if i % 2 == 0 { half } else { -half }, speed: mean, dwell: 0.2 })
            .collect::<Vec<_>>(),
        envelope,
        clock,
    );
    // The swing is a warp of the clock: t + 0.8 sin(w t) / w never runs backwards.
    let omega = TAU * frequency;
    clock
        .time()
        .map(|t| {
            let place = (t + 0.8 * (omega * t).sin() / omega).clamp(0.0, clock.duration()) / clock.period;
            let (low, share) = (place as usize, place.fract());
            let value = |i: usize| legs[i.min(legs.len() - 1)];
            value(low) + share * (value(low + 1) - value(low))
        })
        .collect()
}

/// Largest speed and acceleration of sampled positions.
fn peaks(position: &[f64], period: f64) -> (f64, f64) {
    position.windows(3).fold((0.0, 0.0), |(speed, acceleration), w| {
        let v = (w[2] - w[0]) / (2.0 * period);
        let a = (w[2] - 2.0 * w[1] + w[0]) / (period * period);
        (f64::max(speed, v.abs()), f64::max(acceleration, a.abs()))
    })
}

/// Whether a motion stays within the limits.
fn within(position: &[f64], envelope: &Envelope, period: f64) -> bool {
    let (speed, acceleration) = peaks(position, period);
    let inside = position.iter().all(|q| (envelope.low..=envelope.high).contains(q));
    position.len() > 3 && inside && speed <= envelope.speed && acceleration <= envelope.acceleration
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_motion_stays_within_the_limits_and_ends_where_it_begins() {
        for (low, high, home, speed, acceleration) in
            [(-1.5, 1.5, 0.0, 3.0, 20.0), (0.1, 0.4, 0.35, 0.2, 1.0), (-3.0, 1.0, -0.5, 5.0, 60.0)]
        {
            let envelope = Envelope { low, high, home, speed, acceleration, resolution: 1e-6 };
            let motions = library(&envelope, 40.0, 0.002);
            let words: Vec<_> = motions.iter().map(|m| m.words).collect();
            assert!(motions.len() >= 9, "{words:?}");
            for motion in motions {
                let (first, last) = (motion.position[0], motion.position[motion.position.len() - 1]);
                assert!((first - home).abs() < 1e-6 && (last - home).abs() < 1e-3, "{} {first} {last}", motion.words);
                assert_eq!(motion.position.len(), 20_000, "{}", motion.words);
            }
        }
    }

    #[test]
    fn a_joint_that_may_not_move_is_not_moved() {
        let envelope = Envelope { low: 0.2, high: 0.2, home: 0.2, speed: 1.0, acceleration: 1.0, resolution: 0.0 };
        assert!(library(&envelope, 20.0, 0.01).is_empty());
    }
}
