//! Constants that a motion cannot tell apart, from the Fisher information of what each adds to the torque.
//!
//! Of every constant the information says how far it may be off when all others make up for it. Where the torque that it adds could be off
//! by as much as all the friction there is, the motion says nothing of it. Only what the filter sees in one direction counts, so that the
//! ends of a stroke at one speed do not tell Coulomb from viscous friction; and what the encoder's noise adds to the velocity is no
//! information.

use std::fmt;
use std::ops::Range;

use crate::fit::data::gather::Material;
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::{NORMAL_95, mean, root_mean_square};
use crate::samples::blocks::correlation_time;
use crate::samples::rigid_body::TermKind;
use crate::samples::top_speed;
use nalgebra::{DMatrix, SymmetricEigen};

/// Directions of less information, as a share of the most, are rounding.
const ROUNDING: f64 = 1e-10;
/// Share of a direction that a constant has at least where it takes part in it: below, it is rounding.
const PART: f64 = 1e-3;

/// Share of the top speed below which the joint is at rest, and multiples of the velocity's noise up to which it may be: noise alone is above
/// in less than one sample of a million.
const REST_SHARE: f64 = 0.01;
const CLEAR_OF_NOISE: f64 = 5.0;
/// Filtered sign above which all that the filter sees goes in one direction, rounding left aside.
const ONE_DIRECTION: f64 = 1.0 - 1e-9;
/// Speed over which friction falls from break-away, as a share of the top speed.
const STRIBECK_SPEED: f64 = 0.1;

/// A constant of the simple law: what adds to the torque of a joint in the first place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::fit) enum Constant {
    /// Torque against the motion at any speed.
    Coulomb,
    /// Torque per velocity.
    Viscous,
    /// Constant torque.
    Offset,
    /// Torque per acceleration.
    Inertia,
    /// Torque per sine of the position.
    GravitySine,
    /// Torque per cosine of the position.
    GravityCosine,
    /// Factor of the recorded rigid body.
    Scale,
}

/// An effect beside the simple law that one more column tells of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::fit) enum Effect {
    /// Friction that falls from break-away (Stribeck 1902), over a tenth of the top speed.
    Stribeck,
    /// Friction that bends over speed.
    ViscousNonlinearity,
    /// Friction over the temperature.
    Temperature,
    /// Friction over the transmitted load.
    LoadFriction,
}

/// What a motion says of the constants.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::fit) struct Identified {
    /// Every constant that the recording asks for, with how far the torque that it adds may be off with 95 %, over the friction; infinite where
    /// nothing is said.
    pub(in crate::fit) constants: Vec<(Constant, f64)>,
}

impl Identified {
    /// Looks at the motion and the noise of the material.
    pub(in crate::fit) fn by(material: &Material) -> Self {
        let law = SimpleLaw::of(material);
        let shares = law.shares(&law.columns);
        Self { constants: law.kinds.into_iter().zip(shares).collect() }
    }

    /// The constants of which nothing is known.
    pub(in crate::fit) fn unknown(&self) -> Vec<Constant> {
        self.constants.iter().filter(|(_, share)| *share >= 1.0).map(|(constant, _)| *constant).collect()
    }

    /// Whether a joint that goes one way only is all that is behind it: friction and offset are one constant, and the law holds where it was
    /// recorded.
    pub(in crate::fit) fn is_one_way(&self) -> bool {
        let mut unknown = self.unknown();
        unknown.retain(|constant| *constant != Constant::Offset);
        unknown == [Constant::Coulomb] && self.unknown().len() == 2
    }
}

/// The columns of the simple law where the joint moves; the first two are the sign and the velocity.
struct SimpleLaw<'a> {
    material: &'a Material,
    rows: Vec<usize>,
    kinds: Vec<Constant>,
    columns: Vec<Vec<f64>>,
    target: Vec<f64>,
}

impl<'a> SimpleLaw<'a> {
    fn of(material: &'a Material) -> Self {
        let velocity = material.samples.velocity.as_deref().unwrap_or_default();
        // At rest friction is any value within break-away, and the sign of the velocity that of its noise.
        let slowest = (REST_SHARE * top_speed(velocity)).max(CLEAR_OF_NOISE * material.velocity_noise);
        let sign = filtered_sign(material, velocity, slowest);
        // Around a reversal friction is no function of the velocity, and half a sample decides how alike its filtered sign and the velocity are.
        let counts = |row: &usize| velocity[*row].abs() > slowest && sign[*row].abs() > ONE_DIRECTION;
        let rows: Vec<usize> = material.rows.iter().copied().filter(counts).collect();
        let pick = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let mut kinds = vec![Constant::Coulomb, Constant::Viscous];
        let mut columns = vec![pick(&sign), pick(velocity)];
        // Beside friction that was separated there is nothing else.
        if material.separation.is_some() {
            kinds.push(Constant::Offset);
            columns.push(vec![1.0; rows.len()]);
        }
        for column in &material.columns {
            kinds.push(match column.kind {
                TermKind::TorqueOffset => continue,
                TermKind::Inertia | TermKind::ExtraInertia => Constant::Inertia,
                TermKind::GravitySine => Constant::GravitySine,
                TermKind::GravityCosine => Constant::GravityCosine,
                TermKind::TorqueScale => Constant::Scale,
            });
            columns.push(pick(&column.values));
        }
        let target = pick(&material.target);
        Self { material, rows, kinds, columns, target }
    }

    fn pick(&self, values: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| values[*row]).collect()
    }

    /// How far the torque that each of `columns`, those of the law and any others, adds may be off with 95 %, over the friction.
    fn shares(&self, columns: &[Vec<f64>]) -> Vec<f64> {
        if self.rows.len() <= columns.len() {
            return vec![f64::INFINITY; columns.len()];
        }
        let whole = 0..self.rows.len();
        let whole = std::slice::from_ref(&whole);
        let fit = least_squares(columns, &self.target, whole);
        let spread = fit.rmse * (correlation_time(&fit.residuals, whole) as f64).sqrt();
        // However the two are shared out, their sum is known.
        let friction = columns[0].iter().zip(&columns[1]);
        let friction =
            friction.map(|(sign, v)| fit.coefficients[0] * sign + fit.coefficients[1] * v).collect::<Vec<_>>();
        let friction = root_mean_square(&friction).max(f64::MIN_POSITIVE);
        let mut noise = vec![0.0; columns.len()];
        noise[1] = self.material.velocity_noise.powi(2) * self.rows.len() as f64;
        let of_torque = |column: &[f64], error: f64| NORMAL_95 * spread * error * root_mean_square(column) / friction;
        let errors = errors(columns, &noise).into_iter();
        columns
            .iter()
            .zip(errors)
            .map(|(column, error)| if error.is_finite() { of_torque(column, error) } else { error })
            .collect()
    }
}

/// The same of effects beside the simple law, those that the recording has a column for.
pub(in crate::fit) fn effects(material: &Material) -> Vec<(Effect, f64)> {
    let law = SimpleLaw::of(material);
    let [sign, velocity] = [&law.columns[0], &law.columns[1]];
    let top = top_speed(velocity).max(f64::MIN_POSITIVE);
    let over = |values: &[f64]| {
        let values = law.pick(values);
        let centre = mean(&values);
        sign.iter().zip(values).map(|(sign, value)| sign * (value - centre)).collect::<Vec<f64>>()
    };
    let of_velocity =
        |law: &dyn Fn(f64) -> f64| sign.iter().zip(velocity).map(|(sign, v)| sign * law(v.abs() / top)).collect();
    let mut added: Vec<(Effect, Vec<f64>)> = vec![
        (Effect::Stribeck, of_velocity(&|speed| (-(speed / STRIBECK_SPEED).powi(2)).exp())),
        (Effect::ViscousNonlinearity, of_velocity(&|speed| speed * speed)),
    ];
    let input = |name: &str| material.samples.input(name);
    added.extend(input("temperature").map(|values| (Effect::Temperature, over(values))));
    let load = input("load_torque").or_else(|| input("rigid_body_torque"));
    added.extend(load.map(|load| (Effect::LoadFriction, over(&load.iter().map(|x| x.abs()).collect::<Vec<_>>()))));
    let share = |column: Vec<f64>| {
        let all: Vec<Vec<f64>> = law.columns.iter().cloned().chain([column]).collect();
        law.shares(&all).last().copied().unwrap_or(f64::INFINITY)
    };
    added.into_iter().map(|(effect, column)| (effect, share(column))).collect()
}

/// The sign of the velocity behind the filter of the torque; slower than `slowest` it stays what it was.
fn filtered_sign(material: &Material, velocity: &[f64], slowest: f64) -> Vec<f64> {
    let of_segment = |segment: &Range<usize>| {
        let velocity = &velocity[segment.clone()];
        let first = velocity.iter().find(|v| v.abs() > slowest).map_or(0.0, |v| v.signum());
        let held = velocity.iter().scan(first, |sign, v| {
            if v.abs() > slowest {
                *sign = v.signum();
            }
            Some(*sign)
        });
        let sign: Vec<f64> = held.collect();
        match (material.sigma_s, material.samples.rate_hz) {
            (Some(sigma_s), Some(rate_hz)) => {
                GaussianFilter::new(sigma_s, 1.0 / rate_hz).apply_everywhere(&sign, Order::Smooth)
            }
            _ => sign,
        }
    };
    material.samples.segments.iter().flat_map(of_segment).collect()
}

/// Standard errors of the coefficients for noise of one; `noise` is the energy that noise adds to each column.
fn errors(columns: &[Vec<f64>], noise: &[f64]) -> Vec<f64> {
    let width = columns.len();
    let product = |i: usize, j: usize| columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum::<f64>();
    let scales: Vec<f64> = (0..width).map(|i| product(i, i).sqrt().max(f64::MIN_POSITIVE)).collect();
    let information = DMatrix::from_fn(width, width, |i, j| {
        (product(i, j) - if i == j { noise[i] } else { 0.0 }) / (scales[i] * scales[j])
    });
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(information);
    let least = ROUNDING * eigenvalues.max();
    let variance = |i: usize| -> f64 {
        let directions = eigenvalues.iter().enumerate();
        let parts = directions.map(|(direction, value)| (eigenvectors[(i, direction)].powi(2), *value));
        parts
            .map(|(part, value)| match value > least {
                true => part / value,
                false if part > PART => f64::INFINITY,
                false => 0.0,
            })
            .sum()
    };
    (0..width).map(|i| variance(i).sqrt() / scales[i]).collect()
}

impl Constant {
    /// Whether a parameter of results, by its name, is this constant.
    pub(in crate::fit) fn is_named(self, name: &str) -> bool {
        let begins: &[&str] = match self {
            Self::Coulomb => &["coulomb"],
            Self::Viscous => &["viscous"],
            Self::Offset => &["torque_offset"],
            Self::Inertia => &["inertia", "mass", "extra_inertia", "extra_mass"],
            Self::GravitySine => &["gravity_sine"],
            Self::GravityCosine => &["gravity_cosine"],
            Self::Scale => &["torque_scale"],
        };
        begins.iter().any(|begin| name.starts_with(begin))
    }

    /// What has to be recorded for it.
    pub(in crate::fit) fn asks_for(self) -> &'static str {
        match self {
            Self::Coulomb | Self::Offset => "the same motion in both directions",
            Self::Viscous => "at least two speeds in each direction, one several times the other",
            Self::Inertia => "a motion that speeds up and slows down faster, at the same speeds",
            Self::GravitySine | Self::GravityCosine => "positions beyond +-60 degrees",
            Self::Scale => "a motion at which the rigid body needs more torque than friction",
        }
    }
}

impl Effect {
    /// What has to be recorded for it.
    pub(in crate::fit) fn asks_for(self) -> &'static str {
        match self {
            Self::Stribeck => "slow motion in both directions, down to a hundredth of the top speed",
            Self::ViscousNonlinearity => "three speeds or more in each direction, evenly apart",
            Self::Temperature => "the same motion cold and warm",
            Self::LoadFriction => "the same motion with several loads, or at several postures",
        }
    }
}

/// Its name in the catalogue.
impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stribeck => "stribeck",
            Self::ViscousNonlinearity => "viscous_nonlinearity",
            Self::Temperature => "temperature",
            Self::LoadFriction => "load_friction",
        })
    }
}

/// Its name in the plain.
impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Coulomb => "Coulomb friction",
            Self::Viscous => "viscous friction",
            Self::Offset => "offset",
            Self::Inertia => "inertia",
            Self::GravitySine => "gravity (sine)",
            Self::GravityCosine => "gravity (cosine)",
            Self::Scale => "scale of the rigid body",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_one_shape_are_known_together_only() {
        let swing: Vec<f64> = (0..400).map(|i| (0.1 * f64::from(i)).sin()).collect();
        let twice = swing.iter().map(|x| 2.0 * x).collect();
        let other: Vec<f64> = (0..400).map(|i| (0.1 * f64::from(i)).cos()).collect();
        let found = errors(&[swing.clone(), twice, other.clone()], &[0.0; 3]);
        assert!(
            found[0].is_infinite() && found[1].is_infinite() && (found[2] * 200f64.sqrt() - 1.0).abs() < 0.02,
            "{found:?}"
        );
        let apart = errors(&[swing.clone(), other.clone()], &[0.0; 2]);
        assert!(apart.iter().all(|error| (error * 200f64.sqrt() - 1.0).abs() < 0.02), "{apart:?}");
        // A difference that is all noise says nothing.
        let noisy: Vec<f64> = swing.iter().zip(&other).map(|(swing, other)| swing + 0.01 * other).collect();
        let energy = 1e-4 * other.iter().map(|x| x * x).sum::<f64>();
        assert!(errors(&[swing.clone(), noisy.clone()], &[0.0, 1.01 * energy])[1].is_infinite());
        assert!(errors(&[swing, noisy], &[0.0, 0.0])[1].is_finite());
    }
}
