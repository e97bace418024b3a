//! What each effect adds in one sample, from its specification in [`frikan_shared::effect`].

use frikan_shared::effect::{Effect, Kind};
use frikan_shared::elementary::{cos, exp, lag_share, log, power, sin, tanh};
use frikan_shared::table::Cell;

use crate::compile::reference::single_table;

/// What an effect sees of a sample: channels held to their trained ranges, in SI.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// rad/s.
    pub velocity: f32,
    /// rad.
    pub position: f32,
    /// Position as measured, rad.
    pub angle: f32,
    /// Distance since the sample before, rad.
    pub travel: f32,
    /// N m.
    pub load: f32,
    /// degC.
    pub temperature: f32,
    /// Friction of the static law, N m.
    pub law: f32,
    /// Sample period, s.
    pub dt: f32,
    /// The model's pool.
    pub cells: &'a [Cell],
}

/// What an effect adds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Added {
    /// N m.
    pub torque: f32,
    /// Of the link against the motor, rad.
    pub position: f32,
    /// The velocity that the law sees, of a lag alone, rad/s.
    pub velocity: f32,
}

/// What an effect keeps from one sample to the next, at most four numbers; nothing before the first sample.
pub type Memory = Option<[f32; 4]>;

/// Distances after which a latched breakaway torque counts as spent.
const SPENT: f32 = 20.0;

/// What `effect` adds in one sample.
#[must_use]
pub fn added(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    let v = seen.velocity;
    let smooth = |smoothing_velocity: f32| tanh(v / smoothing_velocity);
    let square = |x: f32| x * x;
    let torque = match effect {
        Effect::Coulomb { coulomb, viscous, smoothing_velocity } => coulomb * smooth(*smoothing_velocity) + viscous * v,
        Effect::Stribeck { amplitude, velocity, exponent, smoothing_velocity } => {
            amplitude * exp(-power(v / velocity, *exponent)) * smooth(*smoothing_velocity)
        }
        Effect::PowerViscous { coefficient, exponent, smoothing_velocity } => {
            coefficient * power(v, *exponent) * smooth(*smoothing_velocity)
        }
        Effect::Asymmetry { coulomb, viscous, smoothing_velocity } => {
            coulomb * smooth(*smoothing_velocity).abs() + viscous * v.abs()
        }
        Effect::Temperature { reference, coulomb, viscous, decay, smoothing_velocity } => {
            let warmth = seen.temperature - reference;
            let thinned = if *decay == 0.0 { warmth } else { (1.0 - exp(-(decay * warmth))) / decay };
            coulomb * smooth(*smoothing_velocity) * warmth + viscous * v * thinned
        }
        Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity } => {
            let heat = warmed(memory, (*time_constant, *power_limit), seen);
            (coulomb * smooth(*smoothing_velocity) + viscous * v) * heat
        }
        Effect::Load { mean, difference, quadratic, stribeck, velocity, smoothing_velocity } => {
            let (s, load) = (smooth(*smoothing_velocity), seen.load);
            let at_speed = mean + stribeck * exp(-square(v / velocity));
            at_speed * load.abs() * s + difference * load * s.abs() + quadratic * load * load * s
        }
        Effect::FrictionalLag { time_constant } => {
            let [before, ..] = memory.unwrap_or([v, 0.0, 0.0, 0.0]);
            let lagged = before + lag_share(seen.dt / time_constant) * (v - before);
            *memory = Some([lagged, 0.0, 0.0, 0.0]);
            return Added { velocity: lagged, ..Added::default() };
        }
        Effect::Presliding { smoothing_velocity, elements } => {
            let mut stretched = memory.unwrap_or_default();
            for (z, element) in stretched.iter_mut().zip(elements) {
                *z = turned_over(*z, seen.travel, element.distance);
            }
            *memory = Some(stretched);
            let held = elements.iter().zip(stretched).fold(0.0, |sum, (element, z)| sum + element.torque * z);
            let slipping = elements.iter().fold(0.0, |sum, element| sum + element.torque);
            held - slipping * smooth(*smoothing_velocity)
        }
        Effect::DwellBreakaway { gain, time, distance, rest_velocity, dwell_limit, smoothing_velocity } => {
            let [dwell, travelled, latched, _] = memory.unwrap_or_default();
            let now = if v.abs() < *rest_velocity {
                let dwell = lower(dwell + seen.dt, *dwell_limit);
                [dwell, 0.0, gain * log(1.0 + dwell / time), 0.0]
            } else {
                [0.0, lower(travelled + seen.travel.abs() / distance, SPENT), latched, 0.0]
            };
            *memory = Some(now);
            now[2] * exp(-now[1]) * smooth(*smoothing_velocity)
        }
        Effect::Ripple { kind, smoothing_velocity, harmonics } => {
            let sum = harmonics.iter().fold(0.0, |sum, line| {
                let angle = line.order * seen.angle;
                sum + (line.cosine * cos(angle) + line.sine * sin(angle))
            });
            return of_kind(*kind, sum, smooth(*smoothing_velocity));
        }
        Effect::PositionTable { kind, smoothing_velocity, table } => {
            return of_kind(*kind, single_table(table, seen.cells, seen.position), smooth(*smoothing_velocity));
        }
        Effect::Play { half_width, torque } => {
            let q = seen.position;
            let [link, ..] = memory.unwrap_or([q, 0.0, 0.0, 0.0]);
            let (low, high) = (q - half_width, q + half_width);
            let link = lower(if link > low { link } else { low }, high);
            *memory = Some([link, 0.0, 0.0, 0.0]);
            return Added { torque: torque * ((q - link) / half_width), position: -(q - link), velocity: 0.0 };
        }
        Effect::WindupHysteresis { torque, distance } => {
            let [z, ..] = memory.unwrap_or_default();
            let z = turned_over(z, seen.travel, *distance);
            *memory = Some([z, 0.0, 0.0, 0.0]);
            torque * z
        }
        Effect::Spring { stiffness, rest } => stiffness * (seen.position - rest),
    };
    Added { torque, ..Added::default() }
}

/// `x` below `limit`, else `limit`: [`f32::min`] may take either of two zeros.
fn lower(x: f32, limit: f32) -> f32 {
    if x < limit { x } else { limit }
}

/// `z r + (1 - r) S` with `r = exp(-|dq| / distance)` and `S` the sign of `dq`.
fn turned_over(z: f32, travel: f32, distance: f32) -> f32 {
    let left = exp(-(travel.abs() / distance));
    z * left + (1.0 - left) * travel.signum()
}

/// The filtered power, W; the second number of the memory is what rounding put in too much (Kahan 1965).
fn warmed(memory: &mut Memory, (time_constant, power_limit): (f32, f32), seen: &Seen<'_>) -> f32 {
    let [heat, excess, ..] = memory.unwrap_or_default();
    let power = lower((seen.law * seen.velocity).abs(), power_limit);
    let increment = lag_share(seen.dt / time_constant) * (power - heat) - excess;
    let sum = heat + increment;
    let excess = (sum - heat) - increment;
    let heat = if sum > 0.0 { lower(sum, power_limit) } else { 0.0 };
    *memory = Some([heat, excess, 0.0, 0.0]);
    heat
}

fn of_kind(kind: Kind, value: f32, smooth_sign: f32) -> Added {
    match kind {
        Kind::Torque => Added { torque: value, ..Added::default() },
        Kind::Friction => Added { torque: value * smooth_sign, ..Added::default() },
        Kind::Position => Added { position: value, ..Added::default() },
    }
}
