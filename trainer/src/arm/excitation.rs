//! A motion of all joints that tells the base inertial parameters and friction apart: Fourier series of one period, which start again where they end
//! (Swevers, Ganseman, Tukel, De Schutter & Van Brussel 1997), within the limits of the joints and clear of what the arm may not touch.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use super::base::Base;
use super::chain::Chain;
use super::clearance::{Nearest, Path, Room};
use super::dynamics::{NUMBERS, State, regressor};
use crate::error::Result;
use crate::numerics::random::normal;

/// Time after which the motion starts again, s: a joint at 1 rad/s passes its range several times.
const PERIOD_S: f64 = 20.0;
/// Terms of the series of each joint: up to a quarter of a hertz, as fast as an arm swings through most of its range.
const TERMS: usize = 5;
/// Instants of the period at which the motion is judged: twenty of its fastest term.
const INSTANTS: usize = 100;
/// Series that are drawn, and changes of the best of them that are tried after that. A limit of the computing time: a second for six joints.
const DRAWN: u64 = 200;
const CHANGED: u64 = 300;
/// Size of a change over that of a coefficient, at first and at last.
const CHANGE: [f64; 2] = [0.5, 0.05];
/// What the motion of all joints is made smaller by where it is not clear, and how often at most: to a fiftieth, of which a recording shows little.
const SMALLER: f64 = std::f64::consts::FRAC_1_SQRT_2;
const TIMES_SMALLER: i32 = 11;
/// Speed over the largest within which the sign of friction turns.
const TURNING_SHARE: f64 = 0.02;

/// Within what a joint may be moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Lowest and highest position, rad or m.
    pub position: [f64; 2],
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
    /// Largest acceleration, rad/s2 or m/s2.
    pub acceleration: f64,
}

/// A planned motion.
#[derive(Clone, Debug)]
pub struct Excitation {
    /// Time after which it starts again, s.
    pub period_s: f64,
    /// Condition number of the torques over base parameters and friction, each scaled to its own size: by how much noise of the torque may grow
    /// in what is identified.
    pub condition: f64,
    series: Vec<Series>,
}

/// The series of one joint.
#[derive(Clone, Debug)]
struct Series {
    centre: f64,
    /// Size of the sines and cosines below, rad or m.
    amplitude: f64,
    waves: [[f64; 2]; TERMS],
}

impl Series {
    /// Position, velocity and acceleration at a time, s.
    fn at(&self, time: f64) -> [f64; 3] {
        let mut motion = [self.centre, 0.0, 0.0];
        for (k, [sine, cosine]) in self.waves.iter().enumerate() {
            let rate = TAU * (k + 1) as f64 / PERIOD_S;
            let (s, c) = (rate * time).sin_cos();
            let [sine, cosine] = [self.amplitude * sine, self.amplitude * cosine];
            motion[0] += sine * s + cosine * c;
            motion[1] += rate * (sine * c - cosine * s);
            motion[2] -= rate * rate * (sine * s + cosine * c);
        }
        motion
    }

    /// A share of the waves as large as the limits allow about a centre.
    fn within(part: &Part, limits: &Limits) -> Self {
        let mut series = Self { centre: part.centre, amplitude: 1.0, waves: part.waves };
        let [travel, speed, acceleration] = [0, 1, 2].map(|order| series.most(order));
        let [low, high] = limits.position;
        let room = (high - part.centre).min(part.centre - low);
        series.amplitude =
            part.share * (room / travel).min(limits.velocity / speed).min(limits.acceleration / acceleration);
        series
    }

    /// What a derivative of this order does not exceed, between instants either: the sum of the sizes of all terms.
    fn most(&self, order: i32) -> f64 {
        let size = |(k, [sine, cosine]): (usize, &[f64; 2])| {
            (TAU * (k + 1) as f64 / PERIOD_S).powi(order) * sine.hypot(*cosine)
        };
        self.amplitude * self.waves.iter().enumerate().map(size).sum::<f64>()
    }
}

/// What a series is made of.
#[derive(Clone, Debug)]
struct Part {
    waves: [[f64; 2]; TERMS],
    centre: f64,
    /// Of the amplitude that the limits allow, above 0 to 1.
    share: f64,
}

impl Part {
    /// Another centre and share, where the motion has to keep clear of something.
    fn moved(&mut self, limits: &Limits, by: [f64; 2]) {
        let [low, high] = limits.position;
        self.centre = (self.centre + 0.5 * (high - low) * by[0]).clamp(low, high);
        self.share = (self.share * by[1].exp()).min(1.0);
    }
}

/// A motion on the way to the best.
struct Trial {
    parts: Vec<Part>,
    motion: Excitation,
    /// Condition number over the size of the motion: whatever is told by a motion of half the size is told half as well.
    cost: f64,
}

impl Excitation {
    /// The best motion that was found among those that keep clear; one seed, one motion.
    ///
    /// # Errors
    /// `FRK-D047` where none keeps clear.
    pub fn of(chain: &Chain, base: &Base, limits: &[Limits], room: &Room<'_>, seed: u64) -> Result<Self> {
        let random = |number: u64| ChaCha8Rng::seed_from_u64(seed.wrapping_mul(DRAWN + CHANGED).wrapping_add(number));
        let waves = |random: &mut ChaCha8Rng| std::array::from_fn(|_| [normal(random), normal(random)]);
        let joints = limits.len() as u64;
        let drawn = |number: u64| {
            let start = &room.starts()[number as usize % room.starts().len()];
            let part = |(joint, centre): (u64, &f64)| Part {
                waves: waves(&mut random(number * joints + joint)),
                centre: *centre,
                share: 1.0,
            };
            let mut parts: Vec<Part> = (0..joints).zip(start).map(part).collect();
            for _ in 0..TIMES_SMALLER {
                let motion = Self::made(&parts, limits);
                if motion.is_clear(room) {
                    return Some(motion.judged(parts, chain, base, limits));
                }
                parts.iter_mut().for_each(|part| part.share *= SMALLER);
            }
            None
        };
        let drawn = (0..DRAWN).into_par_iter().filter_map(drawn);
        let best = drawn.min_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut best = best.ok_or_else(|| room.no_motion())?;
        for number in 0..CHANGED {
            let share = number as f64 / CHANGED as f64;
            let change = CHANGE[0].powf(1.0 - share) * CHANGE[1].powf(share);
            let joint = (number % joints) as usize;
            let mut parts = best.parts.clone();
            let mut random = random((DRAWN + number) * joints);
            let by: [[f64; 2]; TERMS] = waves(&mut random);
            parts[joint]
                .waves
                .iter_mut()
                .flatten()
                .zip(by.iter().flatten())
                .for_each(|(wave, by)| *wave += change * by);
            if !room.is_open() {
                parts[joint].moved(&limits[joint], [change * normal(&mut random), change * normal(&mut random)]);
            }
            let tried = Self::made(&parts, limits).judged(parts, chain, base, limits);
            if tried.cost < best.cost && tried.motion.is_clear(room) {
                best = tried;
            }
        }
        Ok(best.motion)
    }

    fn made(parts: &[Part], limits: &[Limits]) -> Self {
        let series = parts.iter().zip(limits).map(|(part, limits)| Series::within(part, limits)).collect();
        Self { period_s: PERIOD_S, condition: f64::INFINITY, series }
    }

    fn judged(self, parts: Vec<Part>, chain: &Chain, base: &Base, limits: &[Limits]) -> Trial {
        let condition = condition(chain, base, &self.series);
        let size = parts.iter().zip(&self.series).zip(limits).map(|((part, series), limits)| {
            let [low, high] = limits.position;
            let full = Series::within(&Part { centre: 0.5 * (low + high), share: 1.0, ..part.clone() }, limits);
            (series.amplitude / full.amplitude).ln()
        });
        let size = (size.sum::<f64>() / limits.len() as f64).exp();
        Trial { parts, motion: Self { condition, ..self }, cost: condition / size }
    }

    fn is_clear(&self, room: &Room<'_>) -> bool {
        self.along(|path| room.is_clear(path))
    }

    /// The closest that a link comes to obstacles (or, where `to_obstacles` is false, to other links); `None` where nothing is looked at.
    #[must_use]
    pub fn nearest(&self, room: &Room<'_>, to_obstacles: bool) -> Option<Nearest> {
        self.along(|path| room.nearest(path, to_obstacles))
    }

    fn along<T>(&self, with: impl FnOnce(&Path<'_>) -> T) -> T {
        let position = |time: f64| self.at(time).map(|[position, ..]| position).collect();
        let speeds: Vec<f64> = self.series.iter().map(|series| series.most(1)).collect();
        with(&Path { position: &position, speeds: &speeds, period_s: self.period_s })
    }

    /// Position, velocity and acceleration of each joint at a time, s.
    pub fn at(&self, time: f64) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.series.iter().map(move |series| series.at(time))
    }
}

/// Condition number of the columns of base parameters, Coulomb and viscous friction, each of length one; infinite where they depend on each other.
fn condition(chain: &Chain, base: &Base, series: &[Series]) -> f64 {
    if series.iter().any(|series| series.amplitude == 0.0) {
        return f64::INFINITY;
    }
    let (joints, parameters) = (chain.len(), base.len());
    let mut rows = vec![0.0; joints * joints * NUMBERS];
    let mut table = DMatrix::zeros(INSTANTS * joints, parameters + 2 * joints);
    for instant in 0..INSTANTS {
        let motion: Vec<[f64; 3]> =
            series.iter().map(|series| series.at(instant as f64 / INSTANTS as f64 * PERIOD_S)).collect();
        let [position, velocity, acceleration]: [Vec<f64>; 3] =
            std::array::from_fn(|order| motion.iter().map(|motion| motion[order]).collect());
        let state = State { position: &position, velocity: &velocity, acceleration: &acceleration };
        regressor(chain, &state, &mut rows);
        for joint in 0..joints {
            let row = instant * joints + joint;
            for (column, parameter) in base.parameters.iter().enumerate() {
                table[(row, column)] = rows[joint * joints * NUMBERS + parameter.terms[0].0];
            }
            let turning = TURNING_SHARE * TAU / PERIOD_S * series[joint].amplitude;
            table[(row, parameters + joint)] = (velocity[joint] / turning).tanh();
            table[(row, parameters + joints + joint)] = velocity[joint];
        }
    }
    for mut column in table.column_iter_mut() {
        let length = column.norm();
        if length == 0.0 {
            return f64::INFINITY;
        }
        column /= length;
    }
    let sizes = table.singular_values();
    let [least, most] = [sizes.min(), sizes.max()];
    if least > f64::EPSILON * most { most / least } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Surroundings;
    use crate::robot::parse;

    const ARM: &str = r#"<robot name="r"><link name="base"/>
        <link name="upper"><inertial><origin xyz="0 0 0.2"/><mass value="2"/><inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <link name="fore"><inertial><origin xyz="0 0.05 0.2"/><mass value="1"/><inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <joint name="a" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-2" upper="1" effort="1" velocity="1"/></joint>
        <joint name="b" type="revolute"><origin xyz="0 0 0.4"/><parent link="upper"/><child link="fore"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"#;

    #[test]
    fn a_planned_motion_keeps_its_limits_and_tells_everything_apart() {
        let chain = Chain::parse(ARM, &[]).unwrap();
        let base = Base::of(&chain);
        let limits = [([-2.0, 1.0], 2.0, 4.0), ([-1.0, 1.0], 0.5, 4.0)];
        let limits = limits.map(|(position, velocity, acceleration)| Limits { position, velocity, acceleration });
        let robot = parse(ARM).unwrap();
        let ranges = limits.map(|limits| limits.position);
        let room = Room::of(&robot, &chain, &ranges, &Surroundings::default(), 1).unwrap();
        let planned = Excitation::of(&chain, &base, &limits, &room, 1).unwrap();
        assert!(planned.condition < 60.0, "{}", planned.condition);
        for step in 0..2000 {
            for ([q, v, a], limits) in planned.at(0.01 * f64::from(step)).zip(&limits) {
                let [low, high] = limits.position;
                assert!(q >= low - 1e-9 && q <= high + 1e-9);
                assert!(v.abs() <= limits.velocity + 1e-9 && a.abs() <= limits.acceleration + 1e-9);
            }
        }
        let again: Vec<[f64; 3]> = planned.at(PERIOD_S).collect();
        assert!(planned.at(0.0).zip(again).all(|(a, b)| (a[0] - b[0]).abs() < 1e-9));
        // A second joint that hardly moves is told by nothing as well.
        let still = Limits { velocity: 1e-6, acceleration: 1e-6, ..limits[1] };
        let narrow = Excitation::of(&chain, &base, &[limits[0], still], &room, 1).unwrap();
        assert!(narrow.condition > 5.0 * planned.condition);
    }
}
