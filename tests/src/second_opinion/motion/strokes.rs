//! Point-to-point motion: strokes with smooth ramps and rests between them.

use super::{Grid, Trajectory};
use crate::second_opinion::joint::Joint;
use crate::second_opinion::numeric::smooth_step;
use crate::second_opinion::random::{Random, pick};

/// One stroke.
#[derive(Clone, Debug)]
struct Stroke {
    begin_s: f64,
    from: f64,
    /// Signed speed between the ramps.
    speed: f64,
    ramp_s: f64,
    cruise_s: f64,
}

impl Stroke {
    fn new(begin_s: f64, from: f64, length: f64, speed: f64, ramp_s: f64) -> Self {
        let speed = speed.min(length.abs() / ramp_s);
        Self { begin_s, from, speed: speed.copysign(length), ramp_s, cruise_s: length.abs() / speed - ramp_s }
    }

    fn end_s(&self) -> f64 {
        self.begin_s + 2.0 * self.ramp_s + self.cruise_s
    }

    fn to(&self) -> f64 {
        self.from + self.speed * (self.ramp_s + self.cruise_s)
    }

    fn state(&self, t: f64) -> [f64; 3] {
        if t >= self.end_s() {
            return [self.to(), 0.0, 0.0];
        }
        let ramp = |u: f64| {
            let x = (u / self.ramp_s).clamp(0.0, 1.0);
            [
                self.ramp_s * x.powi(3) * (1.0 - 0.5 * x) + (u - self.ramp_s).max(0.0),
                smooth_step(x),
                6.0 * x * (1.0 - x) / self.ramp_s,
            ]
        };
        let u = t - self.begin_s;
        let (up, down) = (ramp(u), ramp(u - self.ramp_s - self.cruise_s));
        let part = |which: usize| self.speed * (up[which] - down[which]);
        [self.from + part(0), part(1), part(2)]
    }
}

/// Strokes one after the other.
#[derive(Clone, Debug)]
pub struct Strokes(Vec<Stroke>);

/// Shares of the top speed of the strokes of one round.
const SPEEDS: [f64; 8] = [1.0, 0.5, 0.25, 0.75, 0.12, 0.05, 0.9, 0.35];

impl Strokes {
    /// Back and forth over one stroke at several speeds; slow strokes are short. `ramp_s` is the time from rest to top speed
    /// at constant acceleration, `dwells_s` the rests to choose from.
    pub fn back_and_forth(
        joint: &Joint,
        stroke: f64,
        acceleration: f64,
        dwells_s: &[f64],
        duration_s: f64,
        random: &mut Random,
    ) -> Self {
        let mut strokes: Vec<Stroke> = Vec::new();
        let (mut time, mut at, mut direction) = (random.uniform(0.05, 0.15), -0.5 * stroke, 1.0);
        while time < duration_s {
            let index = strokes.len();
            let share = SPEEDS[index % SPEEDS.len()];
            let speed = joint.top_speed * share * random.uniform(0.85, 1.0);
            let is_short = share < 0.3 && 2.5 * speed + 0.05 * stroke < stroke;
            let length = if is_short { 2.5 * speed + 0.05 * stroke } else { stroke };
            // A short stroke is followed back, or the next would leave the range.
            let returns = index % 2 == 1 && is_short;
            direction = if returns {
                -direction
            } else if at <= 0.0 {
                1.0
            } else {
                -1.0
            };
            let next = Stroke::new(time, at, direction * length, speed, 1.5 * speed / acceleration + 0.02);
            at = next.to();
            time = next.end_s() + pick(random, dwells_s);
            strokes.push(next);
        }
        Self(strokes)
    }

    /// To points within reach at several speeds.
    pub fn point_to_point(joint: &Joint, duration_s: f64, random: &mut Random) -> Self {
        let target = |_: f64, random: &mut Random| random.uniform(-joint.reach, joint.reach);
        Self::to_targets(joint, duration_s, &[0.1, 0.25, 0.5, 0.75, 1.0], 0.15 * joint.reach, target, random)
    }

    /// Over several turns.
    pub fn many_turns(joint: &Joint, duration_s: f64, random: &mut Random) -> Self {
        let target = |at: f64, random: &mut Random| {
            if at.abs() < 20.0 {
                at + random.sign() * random.uniform(4.0, 12.0)
            } else {
                at - random.uniform(6.0, 14.0).copysign(at)
            }
        };
        Self::to_targets(joint, duration_s, &[0.3, 0.6, 1.0], 0.15 * joint.reach, target, random)
    }

    fn to_targets(
        joint: &Joint,
        duration_s: f64,
        speeds: &[f64],
        shortest: f64,
        target: impl Fn(f64, &mut Random) -> f64,
        random: &mut Random,
    ) -> Self {
        let mut strokes: Vec<Stroke> = Vec::new();
        let (mut time, mut at) = (0.5, 0.0);
        while time < duration_s {
            let length = target(at, random) - at;
            if length.abs() < shortest {
                continue;
            }
            let speed = joint.top_speed * pick(random, speeds);
            let ramp_s = (speed / joint.top_speed * random.uniform(0.12, 0.3)).max(0.05);
            let next = Stroke::new(time, at, length, speed, ramp_s);
            at = next.to();
            time = next.end_s() + pick(random, &[0.1, 0.3, 0.7, 1.5]);
            strokes.push(next);
        }
        Self(strokes)
    }

    pub(super) fn at(&self, grid: &Grid) -> Trajectory {
        Trajectory::of(grid, |t| {
            let begun = self.0.partition_point(|stroke| stroke.begin_s <= t);
            match begun.checked_sub(1) {
                Some(last) => self.0[last].state(t),
                None => [self.0.first().map_or(0.0, |first| first.from), 0.0, 0.0],
            }
        })
    }
}
