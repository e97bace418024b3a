//! Base inertial parameters: the fewest combinations of the numbers of all bodies and rotors that torques depend on (Gautier & Khalil 1990),
//! found by a rank-revealing QR of the torques at random states (Gautier 1991).

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::chain::{Chain, INERTIAL, NAMES};
use super::dynamics::{NUMBERS, State, regressor};
use crate::law::significant;
use crate::numerics::products::{dot, norm};
use crate::numerics::random::uniform;

/// Random states for each joint: each gives a torque for every joint, and a joint has eleven numbers.
const STATES_PER_JOINT: usize = 40;
/// A column of which the ones before leave less than this share depends on them: rounding leaves 1e-13.
const DEPENDENT: f64 = 1e-8;
/// Factors below this are rounding.
const NO_FACTOR: f64 = 1e-9;
/// Ranges of the random velocities (rad/s, m/s) and accelerations (rad/s2, m/s2); any do.
const VELOCITY: f64 = 2.0;
const ACCELERATION: f64 = 5.0;
/// In which order the numbers of a link are kept, the others being told by them: first moments, moments of inertia, rotor, mass.
const ORDER: [usize; NUMBERS] = [1, 2, 3, 4, 5, 6, 7, 8, 9, INERTIAL, 0];

/// A number of one link, or the inertia of one rotor, as its place among those of the chain ([`NUMBERS`] for each joint).
pub type Place = usize;

/// A combination that torques depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseParameter {
    /// Numbers with their factors; the first, of factor 1, is the one that it stands for.
    pub terms: Vec<(Place, f64)>,
}

/// All of them: torques are linear in these, and none can be told from the others.
#[derive(Clone, Debug)]
pub struct Base {
    /// In the order of the chain.
    pub parameters: Vec<BaseParameter>,
}

impl Base {
    /// The base parameters of a chain.
    #[must_use]
    pub fn of(chain: &Chain) -> Self {
        let columns = at_random_states(chain);
        let energies: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
        // From the base outwards, so that what acts alike is told by the link nearer to the base.
        let order = (0..chain.len()).flat_map(|joint| ORDER.map(|number| joint * NUMBERS + number));
        let (mut kept, mut basis): (Vec<Place>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        let mut dependent: Vec<Place> = Vec::new();
        let most = energies.iter().copied().fold(0.0, f64::max);
        for place in order.filter(|place| energies[*place] > DEPENDENT * most) {
            let mut rest = columns[place].clone();
            // Gram-Schmidt, twice: what rounding leaves of the first pass the second takes.
            for _ in 0..2 {
                for direction in &basis {
                    let share = dot(&rest, direction);
                    rest.iter_mut().zip(direction).for_each(|(value, d)| *value -= share * d);
                }
            }
            let left = norm(&rest);
            if left > DEPENDENT * energies[place] {
                rest.iter_mut().for_each(|value| *value /= left);
                basis.push(rest);
                kept.push(place);
            } else {
                dependent.push(place);
            }
        }
        // Kept columns are the basis times a triangle.
        let triangle = DMatrix::from_fn(kept.len(), kept.len(), |i, j| dot(&basis[i], &columns[kept[j]]));
        let mut parameters: Vec<BaseParameter> =
            kept.iter().map(|place| BaseParameter { terms: vec![(*place, 1.0)] }).collect();
        dependent.sort_unstable();
        for place in dependent {
            let seen =
                DVector::from_iterator(kept.len(), basis.iter().map(|direction| dot(direction, &columns[place])));
            let Some(factors) = triangle.solve_upper_triangular(&seen) else { continue };
            for (parameter, factor) in parameters.iter_mut().zip(factors.iter()) {
                if factor.abs() > NO_FACTOR {
                    parameter.terms.push((place, *factor));
                }
            }
        }
        parameters.sort_by_key(|parameter| parameter.terms[0].0);
        Self { parameters }
    }

    /// Number of parameters.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parameters.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parameters.is_empty()
    }

    /// The values that these numbers of a chain make of them.
    #[must_use]
    pub fn values(&self, numbers: &[f64]) -> Vec<f64> {
        self.combined(|place, factor| factor * numbers[place])
    }

    /// Whether the rotor of a joint is told from the link that it turns.
    pub(super) fn tells_rotor(&self, joint: usize) -> bool {
        self.parameters.iter().any(|parameter| parameter.rotor() == Some(joint))
    }

    /// Sums over the terms of each parameter.
    pub(super) fn combined(&self, of: impl Fn(Place, f64) -> f64) -> Vec<f64> {
        let sum = |parameter: &BaseParameter| parameter.terms.iter().map(|(place, factor)| of(*place, *factor)).sum();
        self.parameters.iter().map(sum).collect()
    }
}

impl BaseParameter {
    /// As text, such as `Izz[forearm] + 0.25*m[hand]`: names as in [`NAMES`], about the frame of the link that is named, and `Ia` for
    /// the rotor of the joint that is named.
    #[must_use]
    pub fn expression(&self, chain: &Chain) -> String {
        let mut text = String::new();
        for (index, (place, factor)) in self.terms.iter().enumerate() {
            let joint = &chain.joints[place / NUMBERS];
            let name = match NAMES.get(place % NUMBERS) {
                Some((name, _)) => format!("{name}[{}]", joint.link),
                None => format!("Ia[{}]", joint.name),
            };
            let size = significant(factor.abs(), 7);
            let size = if size == "1" { String::new() } else { format!("{size}*") };
            let sign = match (index, *factor < 0.0) {
                (0, _) => "",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            text += &format!("{sign}{size}{name}");
        }
        text
    }

    /// Its unit.
    #[must_use]
    pub fn unit(&self, chain: &Chain) -> &'static str {
        let place = self.terms[0].0;
        match NAMES.get(place % NUMBERS) {
            Some((_, unit)) => unit,
            None if chain.joints[place / NUMBERS].is_prismatic => "kg",
            None => "kg m²",
        }
    }

    /// The joint whose rotor it stands for, if it does for one.
    #[must_use]
    pub fn rotor(&self) -> Option<usize> {
        let place = self.terms[0].0;
        (place % NUMBERS == INERTIAL).then_some(place / NUMBERS)
    }
}

/// Torques of all joints at random states, a column for each number.
fn at_random_states(chain: &Chain) -> Vec<Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let joints = chain.len();
    let states = STATES_PER_JOINT * joints;
    let mut columns = vec![Vec::with_capacity(states * joints); NUMBERS * joints];
    let mut rows = vec![0.0; joints * columns.len()];
    for _ in 0..states {
        let mut within = |low: f64, high: f64| low + (high - low) * uniform(&mut random);
        let range = |joint: &super::chain::ChainJoint| {
            let free = if joint.is_prismatic { 1.0 } else { std::f64::consts::PI };
            joint.limits.unwrap_or([-free, free])
        };
        let position: Vec<f64> = chain.joints.iter().map(range).map(|[low, high]| within(low, high)).collect();
        let velocity: Vec<f64> = (0..joints).map(|_| within(-VELOCITY, VELOCITY)).collect();
        let acceleration: Vec<f64> = (0..joints).map(|_| within(-ACCELERATION, ACCELERATION)).collect();
        let state = State { position: &position, velocity: &velocity, acceleration: &acceleration };
        regressor(chain, &state, &mut rows);
        for row in rows.chunks(columns.len()) {
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(*value));
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::dynamics::torques;

    /// A planar arm of two links in the vertical plane, axes along y.
    const PLANAR: &str = r#"<robot name="r"><link name="base"/>
        <link name="upper"><inertial><origin xyz="0.01 0 -0.2"/><mass value="2"/><inertia ixx="0.03" iyy="0.04" izz="0.01"/></inertial></link>
        <link name="lower"><inertial><origin xyz="0.02 0.1 -0.15"/><mass value="1.5"/><inertia ixx="0.01" iyy="0.02" izz="0.003"/></inertial></link>
        <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
        <joint name="elbow" type="continuous"><origin xyz="0 0 -0.5"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/></joint></robot>"#;

    /// Those of the textbook: of two links in a plane, first moments and inertia of each, with the mass of the second at its elbow (Craig, 6.8).
    #[test]
    fn a_planar_arm_has_those_of_the_textbook() {
        let chain = Chain::parse(PLANAR, &[]).unwrap();
        let base = Base::of(&chain);
        let expressions: Vec<String> = base.parameters.iter().map(|parameter| parameter.expression(&chain)).collect();
        assert_eq!(
            expressions,
            [
                "mx[upper]",
                "mz[upper] - 0.5*m[lower]",
                "Iyy[upper] + Ia[shoulder] + 0.25*m[lower]",
                "mx[lower]",
                "mz[lower]",
                "Iyy[lower]",
                "Ia[elbow]"
            ]
        );
        assert_eq!((base.parameters[6].rotor(), base.parameters[6].unit(&chain)), (Some(1), "kg m²"));
    }

    #[test]
    fn torques_are_those_of_the_base_parameters_alone() {
        let chain = Chain::parse(PLANAR, &[]).unwrap();
        let base = Base::of(&chain);
        let bodies: Vec<_> = chain.joints.iter().map(|joint| joint.nominal).collect();
        let numbers: Vec<f64> = bodies.iter().flat_map(|body| body.iter().copied().chain([0.0])).collect();
        let values = base.values(&numbers);
        let (q, v, a) = ([0.3, -1.2], [0.7, 1.9], [2.0, -3.0]);
        let state = State { position: &q, velocity: &v, acceleration: &a };
        let mut rows = vec![0.0; 2 * 2 * NUMBERS];
        regressor(&chain, &state, &mut rows);
        for (joint, torque) in torques(&chain, &bodies, &state).into_iter().enumerate() {
            let row = &rows[joint * 2 * NUMBERS..];
            let of_base: f64 = base.parameters.iter().zip(&values).map(|(p, value)| row[p.terms[0].0] * value).sum();
            assert!((of_base - torque).abs() < 1e-9, "{joint}: {of_base} {torque}");
        }
    }
}
