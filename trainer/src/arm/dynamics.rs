//! Inverse dynamics of a chain by recursive Newton-Euler in the frames of its links (Craig, Introduction to Robotics, 6.5; Featherstone,
//! Rigid Body Dynamics Algorithms, 2008, 5.3), and the torques as they are linear in the bodies (Atkeson, An & Hollerbach 1986).

use nalgebra::{Matrix3, Matrix6, Rotation3, SMatrix, Unit, Vector3, Vector6};

use super::chain::{Chain, ChainJoint, INERTIAL, LinkInertia};

/// Numbers of a joint that torques are linear in: those of its link, then the inertia of its rotor seen through the gear (kg m2, or kg).
pub const NUMBERS: usize = INERTIAL + 1;

/// What all joints do at one instant, in the order of the chain: rad and rad/s, m and m/s.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Positions.
    pub position: &'a [f64],
    /// Velocities.
    pub velocity: &'a [f64],
    /// Accelerations.
    pub acceleration: &'a [f64],
}

/// How a link moves, in its own frame.
#[derive(Clone, Copy)]
struct LinkMotion {
    /// From the frame of the link to that of its carrier.
    rotation: Matrix3<f64>,
    /// Its origin there.
    origin: Vector3<f64>,
    spin: Vector3<f64>,
    spin_rate: Vector3<f64>,
    /// Acceleration of the origin less gravity.
    acceleration: Vector3<f64>,
}

/// Force, then moment about the origin of a link, for each of the numbers of a body.
type Wrenches = SMatrix<f64, 6, INERTIAL>;

fn link_motions(chain: &Chain, state: &State<'_>) -> Vec<LinkMotion> {
    let mut motions: Vec<LinkMotion> = Vec::with_capacity(chain.len());
    for (index, joint) in chain.joints.iter().enumerate() {
        let still = LinkMotion {
            rotation: Matrix3::identity(),
            origin: Vector3::zeros(),
            spin: Vector3::zeros(),
            spin_rate: Vector3::zeros(),
            acceleration: -chain.gravity,
        };
        let carrier = joint.parent.map_or(still, |parent| motions[parent]);
        let [q, v, a] = [state.position[index], state.velocity[index], state.acceleration[index]];
        motions.push(carried(&carrier, joint, q, v, a));
    }
    motions
}

fn carried(carrier: &LinkMotion, joint: &ChainJoint, q: f64, v: f64, a: f64) -> LinkMotion {
    let pose = joint.pose.rotation.to_rotation_matrix();
    let axis = joint.axis;
    let (rotation, origin) = if joint.is_prismatic {
        (*pose.matrix(), joint.pose.translation.vector + pose * axis * q)
    } else {
        let turned = Rotation3::from_axis_angle(&Unit::new_unchecked(axis), q);
        (*(pose * turned).matrix(), joint.pose.translation.vector)
    };
    let into = rotation.transpose();
    let [spin, spin_rate] = [into * carrier.spin, into * carrier.spin_rate];
    let lever = carrier.spin_rate.cross(&origin) + carrier.spin.cross(&carrier.spin.cross(&origin));
    let acceleration = into * (carrier.acceleration + lever);
    if joint.is_prismatic {
        let acceleration = acceleration + 2.0 * v * spin.cross(&axis) + a * axis;
        LinkMotion { rotation, origin, spin, spin_rate, acceleration }
    } else {
        let own_rate = spin.cross(&axis) * v + a * axis;
        LinkMotion { rotation, origin, spin: spin + v * axis, spin_rate: spin_rate + own_rate, acceleration }
    }
}

impl LinkMotion {
    /// What each number of a body needs to move so: m a + mc x..., I dw/dt + w x I w + mc x a.
    fn wrenches(&self) -> Wrenches {
        let [spin, rate] = [self.spin.cross_matrix(), self.spin_rate.cross_matrix()];
        let mut wrenches = Wrenches::zeros();
        wrenches.fixed_view_mut::<3, 1>(0, 0).copy_from(&self.acceleration);
        wrenches.fixed_view_mut::<3, 3>(0, 1).copy_from(&(rate + spin * spin));
        wrenches.fixed_view_mut::<3, 3>(3, 1).copy_from(&(-self.acceleration.cross_matrix()));
        let moments = products(&self.spin_rate) + spin * products(&self.spin);
        wrenches.fixed_view_mut::<3, 6>(3, 4).copy_from(&moments);
        wrenches
    }

    /// A wrench about the origin of the link as one about that of its carrier.
    fn to_carrier(self) -> Matrix6<f64> {
        let mut transform = Matrix6::zeros();
        transform.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.rotation);
        transform.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.rotation);
        transform.fixed_view_mut::<3, 3>(3, 0).copy_from(&(self.origin.cross_matrix() * self.rotation));
        transform
    }
}

/// I w as it is linear in Ixx, Ixy, Iyy, Ixz, Iyz, Izz.
fn products(w: &Vector3<f64>) -> SMatrix<f64, 3, 6> {
    let [x, y, z] = [w.x, w.y, w.z];
    #[rustfmt::skip]
    let rows = [
        x, y, 0.0, z, 0.0, 0.0,
        0.0, x, y, 0.0, z, 0.0,
        0.0, 0.0, 0.0, x, y, z,
    ];
    SMatrix::from_row_slice(&rows)
}

/// The part of a wrench that the actuator of a joint holds.
fn along(joint: &ChainJoint) -> Vector6<f64> {
    let mut along = Vector6::zeros();
    along.fixed_rows_mut::<3>(if joint.is_prismatic { 0 } else { 3 }).copy_from(&joint.axis);
    along
}

/// Torque (N m) or force (N) of every joint under this motion, friction and rotors left out.
#[must_use]
pub fn torques(chain: &Chain, bodies: &[LinkInertia], state: &State<'_>) -> Vec<f64> {
    let motions = link_motions(chain, state);
    let mut wrenches: Vec<Vector6<f64>> = motions
        .iter()
        .zip(bodies)
        .map(|(motion, body)| motion.wrenches() * SMatrix::<f64, INERTIAL, 1>::from(*body))
        .collect();
    for index in (0..chain.len()).rev() {
        if let Some(parent) = chain.joints[index].parent {
            let handed_on = motions[index].to_carrier() * wrenches[index];
            wrenches[parent] += handed_on;
        }
    }
    chain.joints.iter().zip(&wrenches).map(|(joint, wrench)| along(joint).dot(wrench)).collect()
}

/// Torque of every joint per unit of each number: a row for each joint, [`NUMBERS`] columns for each joint of the chain, written over
/// `rows` (of their product, row by row).
pub fn regressor(chain: &Chain, state: &State<'_>, rows: &mut [f64]) {
    let width = NUMBERS * chain.len();
    rows.fill(0.0);
    let motions = link_motions(chain, state);
    for link in 0..chain.len() {
        let mut wrenches = motions[link].wrenches();
        let mut at = Some(link);
        while let Some(index) = at {
            let joint = &chain.joints[index];
            let held = along(joint).transpose() * wrenches;
            let begin = index * width + link * NUMBERS;
            rows[begin..begin + INERTIAL].copy_from_slice(held.as_slice());
            wrenches = motions[index].to_carrier() * wrenches;
            at = joint.parent;
        }
        rows[link * width + link * NUMBERS + INERTIAL] = state.acceleration[link];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A swinging arm of two links in a vertical plane, axes along y, hanging at zero.
    const TWO_LINKS: &str = r#"<robot name="r"><link name="base"/>
        <link name="upper"><inertial><origin xyz="0 0 -0.2"/><mass value="2"/><inertia ixx="0.03" iyy="0.04" izz="0.01"/></inertial></link>
        <link name="lower"><inertial><origin xyz="0.02 0.1 -0.15"/><mass value="1.5"/><inertia ixx="0.01" iyy="0.02" izz="0.003" ixy="0.001"/></inertial></link>
        <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
        <joint name="elbow" type="revolute"><origin xyz="0 0 -0.5"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/></joint></robot>"#;

    /// A turntable with a tilted slide and a wrist on it.
    const MIXED: &str = r#"<robot name="r"><link name="base"/>
        <link name="table"><inertial><origin xyz="0.1 0 0.05"/><mass value="4"/><inertia ixx="0.2" iyy="0.25" izz="0.3" ixz="0.02"/></inertial></link>
        <link name="slide"><inertial><origin xyz="0 -0.1 0.2"/><mass value="2.5"/><inertia ixx="0.05" iyy="0.06" izz="0.04" iyz="0.01"/></inertial></link>
        <link name="wrist"><inertial><origin xyz="0.05 0.02 0.1"/><mass value="1.2"/><inertia ixx="0.01" iyy="0.012" izz="0.006" ixy="-0.001"/></inertial></link>
        <joint name="a" type="continuous"><origin xyz="0 0 0.3" rpy="0.2 0 0.1"/><parent link="base"/><child link="table"/><axis xyz="0 0 1"/></joint>
        <joint name="b" type="prismatic"><origin xyz="0.2 0 0.4" rpy="0.3 0.7 0"/><parent link="table"/><child link="slide"/><axis xyz="0 1 1"/></joint>
        <joint name="c" type="revolute"><origin xyz="0 0.1 0.3" rpy="1 0.2 -0.4"/><parent link="slide"/><child link="wrist"/><axis xyz="1 0 1"/></joint></robot>"#;

    fn nominal(chain: &Chain) -> Vec<LinkInertia> {
        chain.joints.iter().map(|joint| joint.nominal).collect()
    }

    #[test]
    fn a_pendulum_of_two_links_is_that_of_the_textbook() {
        let chain = Chain::parse(TWO_LINKS, &[]).unwrap();
        let (m1, c1, i1, length) = (2.0, 0.2, 0.04, 0.5);
        let (m2, i2, x, z) = (1.5, 0.02, 0.02, -0.15);
        let (q, v, a) = ([0.7, -0.4], [1.1, 2.3], [-3.0, 5.0]);
        let found = torques(&chain, &nominal(&chain), &State { position: &q, velocity: &v, acceleration: &a });
        // Turning by q about y takes (x, z) to (x cos q + z sin q, z cos q - x sin q); the elbow is at (0, -length) of the first link.
        let far = x * x + z * z;
        // Of the second link's centre, seen along the first link and across it.
        let (cosine, sine) = (q[1].cos(), q[1].sin());
        let (along, across) = (-(z * cosine - x * sine), x * cosine + z * sine);
        let coupling = m2 * length * along;
        let inertia = [
            i1 + m1 * c1 * c1 + m2 * length * length + i2 + m2 * far + 2.0 * coupling,
            i2 + m2 * far + coupling,
            i2 + m2 * far,
        ];
        // d(along)/dq2 = across * ... : the Christoffel symbol of the coupling.
        let slope = m2 * length * across;
        let g = 9.806_65;
        let height = |q: [f64; 2]| {
            let of = |angle: f64, x: f64, z: f64| z * angle.cos() - x * angle.sin();
            m1 * of(q[0], 0.0, -c1) + m2 * (of(q[0], 0.0, -length) + of(q[0] + q[1], x, z))
        };
        let gravity = |joint: usize| {
            let moved = |by: f64| {
                let mut q = q;
                q[joint] += by;
                g * height(q)
            };
            (moved(1e-6) - moved(-1e-6)) / 2e-6
        };
        let wanted = [
            inertia[0] * a[0] + inertia[1] * a[1] + slope * (2.0 * v[0] * v[1] + v[1] * v[1]) + gravity(0),
            inertia[1] * a[0] + inertia[2] * a[1] - slope * v[0] * v[0] + gravity(1),
        ];
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-7, "{found} {wanted}");
        }
    }

    #[test]
    fn torques_are_linear_in_the_bodies_and_rotors() {
        let chain = Chain::parse(MIXED, &[]).unwrap();
        let (q, v, a) = ([0.4, -0.2, 1.3], [1.0, 0.5, -2.0], [0.3, -4.0, 6.0]);
        let state = State { position: &q, velocity: &v, acceleration: &a };
        let mut rows = vec![0.0; 3 * 3 * NUMBERS];
        regressor(&chain, &state, &mut rows);
        let rotors = [0.5, 0.25, 0.125];
        let numbers: Vec<f64> =
            nominal(&chain).iter().zip(rotors).flat_map(|(body, rotor)| body.iter().copied().chain([rotor])).collect();
        for (joint, torque) in torques(&chain, &nominal(&chain), &state).into_iter().enumerate() {
            let row = &rows[joint * 3 * NUMBERS..][..3 * NUMBERS];
            let linear: f64 = row.iter().zip(&numbers).map(|(x, y)| x * y).sum();
            assert!((linear - torque - rotors[joint] * a[joint]).abs() < 1e-10, "{joint}: {linear} {torque}");
        }
    }

    /// The work of all joints is what kinetic and potential energy gain. Both are read off inverse dynamics itself: the kinetic energy as half of
    /// v M v, the potential as the integral of the torques that hold the arm.
    #[test]
    fn work_becomes_energy() {
        let chain = Chain::parse(MIXED, &[]).unwrap();
        let bodies = nominal(&chain);
        let weightless = Chain { gravity: Vector3::zeros(), ..chain.clone() };
        let motion = |t: f64| {
            let of = |k: usize, order: i32| {
                let (rate, phase) = (1.0 + 0.7 * k as f64, 0.3 * k as f64);
                let angle = rate * t + phase + std::f64::consts::FRAC_PI_2 * f64::from(order);
                0.6 * rate.powi(order) * angle.sin()
            };
            [0, 1, 2].map(|order| [of(0, order), of(1, order), of(2, order)])
        };
        let zero = [0.0; 3];
        let kinetic = |t: f64| {
            let [q, v, _] = motion(t);
            let momentum = torques(&weightless, &bodies, &State { position: &q, velocity: &zero, acceleration: &v });
            0.5 * momentum.iter().zip(v).map(|(p, v)| p * v).sum::<f64>()
        };
        let power = |t: f64| {
            let [q, v, a] = motion(t);
            let all = torques(&chain, &bodies, &State { position: &q, velocity: &v, acceleration: &a });
            let holding = torques(&chain, &bodies, &State { position: &q, velocity: &zero, acceleration: &zero });
            all.iter().zip(holding).zip(v).map(|((all, holding), v)| (all - holding) * v).sum::<f64>()
        };
        let steps = 2000;
        let step = 2.0 / f64::from(steps);
        // Simpson's rule.
        let work: f64 = (0..steps)
            .map(|i| {
                let t = f64::from(i) * step;
                step / 6.0 * (power(t) + 4.0 * power(t + 0.5 * step) + power(t + step))
            })
            .sum();
        let gained = kinetic(2.0) - kinetic(0.0);
        assert!((work - gained).abs() < 1e-9 * kinetic(2.0).abs().max(1.0), "{work} {gained}");
    }
}
