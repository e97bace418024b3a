//! A motion of all joints that tells the base inertial parameters and friction apart: Fourier series of one period, which start again where they end
//! (Swevers, Ganseman, Tukel, De Schutter & Van Brussel 1997), within the limits of the joints.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use super::base::Base;
use super::chain::Chain;
use super::dynamics::{NUMBERS, State, regressor};
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

    /// The waves as large as the limits allow, in the middle of the range.
    fn within(waves: [[f64; 2]; TERMS], limits: &Limits) -> Self {
        let mut series = Self { centre: 0.0, amplitude: 1.0, waves };
        // The sum of all sizes is never exceeded, between instants either.
        let size = |k: usize, power: i32| {
            let [sine, cosine] = waves[k];
            (TAU * (k + 1) as f64 / PERIOD_S).powi(power) * sine.hypot(cosine)
        };
        let [travel, speed, acceleration] = [0, 1, 2].map(|power| (0..TERMS).map(|k| size(k, power)).sum::<f64>());
        let [low, high] = limits.position;
        series.centre = 0.5 * (low + high);
        series.amplitude =
            (0.5 * (high - low) / travel).min(limits.velocity / speed).min(limits.acceleration / acceleration);
        series
    }
}

impl Excitation {
    /// The best motion that was found; one seed, one motion.
    #[must_use]
    pub fn of(chain: &Chain, base: &Base, limits: &[Limits], seed: u64) -> Self {
        let draw = |number: u64| {
            let mut random = ChaCha8Rng::seed_from_u64(seed.wrapping_mul(DRAWN + CHANGED).wrapping_add(number));
            std::array::from_fn::<_, TERMS, _>(|_| [normal(&mut random), normal(&mut random)])
        };
        let joints = limits.len() as u64;
        let judged = |waves: Vec<[[f64; 2]; TERMS]>| {
            let series: Vec<Series> =
                waves.iter().zip(limits).map(|(waves, limits)| Series::within(*waves, limits)).collect();
            Self { period_s: PERIOD_S, condition: condition(chain, base, &series), series }
        };
        let drawn = (0..DRAWN).into_par_iter();
        let drawn = drawn.map(|number| judged((0..joints).map(|joint| draw(number * joints + joint)).collect()));
        let first = || judged((0..joints).map(draw).collect());
        let mut best = drawn.min_by(|a, b| a.condition.total_cmp(&b.condition)).unwrap_or_else(first);
        for number in 0..CHANGED {
            let share = number as f64 / CHANGED as f64;
            let change = CHANGE[0].powf(1.0 - share) * CHANGE[1].powf(share);
            let joint = (number % joints) as usize;
            let mut waves: Vec<_> = best.series.iter().map(|series| series.waves).collect();
            let by = draw((DRAWN + number) * joints);
            waves[joint].iter_mut().flatten().zip(by.iter().flatten()).for_each(|(wave, by)| *wave += change * by);
            let tried = judged(waves);
            if tried.condition < best.condition {
                best = tried;
            }
        }
        best
    }

    /// Position, velocity and acceleration of each joint at a time, s.
    pub fn at(&self, time: f64) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.series.iter().map(move |series| series.at(time))
    }
}

/// Condition number of the columns of base parameters, Coulomb and viscous friction, each of length one; infinite where they depend on each other.
fn condition(chain: &Chain, base: &Base, series: &[Series]) -> f64 {
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
        let planned = Excitation::of(&chain, &base, &limits, 1);
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
        assert!(Excitation::of(&chain, &base, &[limits[0], still], 1).condition > 5.0 * planned.condition);
    }
}
