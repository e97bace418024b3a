//! A simulated arm of six axes: bodies, rotors, friction that is known, of two joints growing with the load.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

use frikan_trainer::arm::chain::{Chain, NAMES};
use frikan_trainer::arm::dynamics::{State, torques};
use frikan_trainer::kan::Random;

/// The true robot.
pub const SIX_AXES: &str = r#"<robot name="six">
  <link name="base"/>
  <link name="turret"><inertial><origin xyz="0.02 0.01 0.03"/><mass value="7.4"/><inertia ixx="0.03" iyy="0.03" izz="0.02" ixy="0.001" ixz="0" iyz="0.002"/></inertial></link>
  <link name="upper"><inertial><origin xyz="0 0.05 0.25"/><mass value="13"/><inertia ixx="0.42" iyy="0.43" izz="0.03" ixy="0.002" ixz="0.01" iyz="0"/></inertial></link>
  <link name="fore"><inertial><origin xyz="0.01 0.02 0.25"/><mass value="4"/><inertia ixx="0.11" iyy="0.11" izz="0.01" ixy="0" ixz="0.001" iyz="0.002"/></inertial></link>
  <link name="roll"><inertial><origin xyz="0.005 0.06 0.02"/><mass value="1.9"/><inertia ixx="0.005" iyy="0.004" izz="0.005" ixy="0" ixz="0" iyz="0.0003"/></inertial></link>
  <link name="hand"><inertial><origin xyz="0.003 0.01 0.05"/><mass value="1.9"/><inertia ixx="0.005" iyy="0.005" izz="0.004" ixy="0" ixz="0.0004" iyz="0"/></inertial></link>
  <link name="flange"><inertial><origin xyz="0 0.02 0.04"/><mass value="0.4"/><inertia ixx="0.001" iyy="0.001" izz="0.0012" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pan" type="revolute"><origin xyz="0 0 0.13"/><parent link="base"/><child link="turret"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="300" velocity="3"/></joint>
  <joint name="lift" type="revolute"><origin xyz="0 0.13 0" rpy="0 1.5708 0"/><parent link="turret"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="300" velocity="3"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0 -0.12 0.6"/><parent link="upper"/><child link="fore"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="150" velocity="3"/></joint>
  <joint name="wrist_1" type="revolute"><origin xyz="0 0 0.57" rpy="0 1.5708 0"/><parent link="fore"/><child link="roll"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="3"/></joint>
  <joint name="wrist_2" type="revolute"><origin xyz="0 0.12 0"/><parent link="roll"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="50" velocity="3"/></joint>
  <joint name="wrist_3" type="revolute"><origin xyz="0 0 0.12"/><parent link="hand"/><child link="flange"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="3"/></joint>
</robot>
"#;

/// What may not be run into of the links of [`SIX_AXES`]: place in their frames, m, and shape.
const SOLIDS: [(&str, [f64; 3], &str); 7] = [
    ("base", [0.0, 0.0, 0.04], r#"<cylinder radius="0.09" length="0.08"/>"#),
    ("turret", [0.0, 0.0, 0.0], r#"<cylinder radius="0.08" length="0.16"/>"#),
    ("upper", [0.0, 0.0, 0.3], r#"<cylinder radius="0.06" length="0.6"/>"#),
    ("fore", [0.0, 0.0, 0.28], r#"<box size="0.1 0.1 0.6"/>"#),
    ("roll", [0.0, 0.06, 0.0], r#"<cylinder radius="0.045" length="0.1"/>"#),
    ("hand", [0.0, 0.0, 0.06], r#"<cylinder radius="0.045" length="0.12"/>"#),
    ("flange", [0.0, 0.05, 0.0], r#"<sphere radius="0.06"/>"#),
];

/// Pairs of links of [`SIX_AXES`] that hang on each other.
pub const NEIGHBOURS: [[&str; 2]; 6] = [
    ["base", "turret"],
    ["turret", "upper"],
    ["upper", "fore"],
    ["fore", "roll"],
    ["roll", "hand"],
    ["hand", "flange"],
];

/// Limits of an arm among boxes, for its `arm.toml`.
pub const LIMITS: &str = "[limits]
lowest_position_rad = -2
highest_position_rad = 2
velocity_rad_s = 1.5
acceleration_rad_s2 = 4
";

/// Boxes around the robot: name, middle (m), edges (m), and turn about z (rad).
pub const BOXES: [(&str, [f64; 3], [f64; 3], f64); 3] = [
    ("table", [0.0, 0.0, -0.05], [1.6, 1.6, 0.06], 0.0),
    ("wall", [-0.5, 0.0, 0.8], [0.1, 2.0, 1.6], 0.0),
    ("crate", [0.6, 0.5, 0.2], [0.3, 0.3, 0.4], 0.4),
];

/// The robot with the shapes of its links.
#[must_use]
pub fn solid_robot() -> String {
    SOLIDS.iter().fold(SIX_AXES.to_owned(), |text, (link, [x, y, z], shape)| {
        let collision = format!(r#"<collision><origin xyz="{x} {y} {z}"/><geometry>{shape}</geometry></collision>"#);
        let [open, empty] = [">", "/>"].map(|end| format!(r#"<link name="{link}"{end}"#));
        let text = text.replace(&empty, &format!("{open}</link>"));
        text.replace(&open, &format!("{open}{collision}"))
    })
}

/// The boxes as `[[obstacles]]` of `arm.toml`.
#[must_use]
pub fn obstacles() -> String {
    let table = |(name, centre, size, yaw): &(&str, [f64; 3], [f64; 3], f64)| {
        format!(
            "[[obstacles]]\nname = \"{name}\"\ncentre_m = {centre:?}\nsize_m = {size:?}\nrpy_rad = [0, 0, {yaw:?}]\n"
        )
    };
    BOXES.iter().map(table).collect()
}

/// Number of joints.
pub const JOINTS: usize = 6;
/// Inertia of the rotors seen through the gears, kg m2.
pub const ROTOR: [f64; JOINTS] = [1.2, 1.5, 0.8, 0.15, 0.12, 0.08];
/// Coulomb torque, N m.
pub const COULOMB: [f64; JOINTS] = [9.0, 12.0, 7.0, 2.5, 2.2, 1.8];
/// Viscous coefficient, N m s/rad.
pub const VISCOUS: [f64; JOINTS] = [12.0, 14.0, 8.0, 1.5, 1.4, 1.1];
/// Friction per transmitted load.
pub const LOAD: [f64; JOINTS] = [0.0, 0.08, 0.0, 0.1, 0.0, 0.0];
/// Standard deviation of the noise of the torque, N m.
pub const NOISE: [f64; JOINTS] = [0.8, 1.0, 0.6, 0.15, 0.12, 0.08];
/// Step of the encoders, rad.
const ENCODER: f64 = TAU / (1 << 20) as f64;
/// Rate of the recordings, Hz.
const RATE_HZ: f64 = 250.0;
/// Velocity over which friction changes its sign, rad/s.
const SIGN_WIDTH: f64 = 1e-3;

/// Position, velocity and acceleration of every joint at one instant.
pub type Instant = [[f64; JOINTS]; 3];

/// Six tones a joint over so many seconds.
#[must_use]
pub fn tones(seconds: f64, seed: u64) -> Vec<Instant> {
    let mut random = Random::new(seed, 0);
    let mut drawn = Vec::new();
    for joint in 0..JOINTS {
        for tone in 1..=6 {
            let amplitude = 0.8 * random.sign() / f64::from(tone).sqrt();
            let rate = TAU / 20.0 * f64::from(tone) * (1.0 + 0.07 * joint as f64);
            drawn.push((joint, amplitude, rate, random.uniform(0.0, TAU)));
        }
    }
    let at = |t: f64| {
        let mut instant = [[0.0; JOINTS]; 3];
        for (joint, amplitude, rate, phase) in &drawn {
            let (sine, cosine) = (rate * t + phase).sin_cos();
            instant[0][*joint] += amplitude * sine;
            instant[1][*joint] += amplitude * rate * cosine;
            instant[2][*joint] -= amplitude * rate * rate * sine;
        }
        instant
    };
    (0..(seconds * RATE_HZ) as usize).map(|row| at(row as f64 / RATE_HZ)).collect()
}

/// From point to point by polynomials of degree five, all joints at once, with a stop at each; no faster than the tones.
#[must_use]
pub fn point_to_point(moves: usize, seed: u64) -> Vec<Instant> {
    let mut random = Random::new(seed, 0);
    let mut point = || [0; JOINTS].map(|_| random.uniform(-1.5, 1.5));
    let (mut from, mut motion) = (point(), Vec::new());
    for _ in 0..moves {
        let to = point();
        let way: [f64; JOINTS] = std::array::from_fn(|joint| to[joint] - from[joint]);
        let seconds = 0.5 + way.iter().fold(0.0_f64, |most, way| most.max(way.abs())) / 0.8;
        for row in 0..(seconds * RATE_HZ) as usize {
            let s = row as f64 / RATE_HZ / seconds;
            let shape = [
                s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s),
                30.0 * s * s * (1.0 - s).powi(2) / seconds,
                60.0 * s * (1.0 - 3.0 * s + 2.0 * s * s) / seconds.powi(2),
            ];
            let begin = [from, [0.0; JOINTS], [0.0; JOINTS]];
            motion.push(std::array::from_fn(|order| {
                std::array::from_fn(|joint| begin[order][joint] + way[joint] * shape[order])
            }));
        }
        motion.extend(std::iter::repeat_n([to, [0.0; JOINTS], [0.0; JOINTS]], (0.3 * RATE_HZ) as usize));
        from = to;
    }
    motion
}

/// The recording of a motion as CSV.
///
/// # Panics
/// Never: the robot is one.
#[must_use]
pub fn recorded(motion: &[Instant], seed: u64) -> String {
    let mut random = Random::new(seed, 0);
    let chain = Chain::parse(SIX_AXES, &[]).expect("the robot is a chain");
    let bodies: Vec<_> = chain.joints.iter().map(|joint| joint.nominal).collect();
    let columns =
        |ending: &str| chain.joints.iter().map(|joint| format!(",{}_{ending}", joint.name)).collect::<String>();
    let mut text = format!("time_s{}{}\n", columns("position_rad"), columns("torque_Nm"));
    for (row, [position, velocity, acceleration]) in motion.iter().enumerate() {
        let load = torques(&chain, &bodies, &State { position, velocity, acceleration });
        write!(text, "{}", row as f64 / RATE_HZ).expect("a string takes all");
        for position in position {
            write!(text, ",{:.9}", (position / ENCODER).round() * ENCODER).expect("a string takes all");
        }
        for joint in 0..JOINTS {
            let v = velocity[joint];
            let dry = (COULOMB[joint] + LOAD[joint] * load[joint].abs()) * (v / SIGN_WIDTH).tanh();
            let friction = dry + VISCOUS[joint] * v;
            let torque = load[joint] + ROTOR[joint] * acceleration[joint] + friction + NOISE[joint] * random.normal();
            write!(text, ",{torque:.6}").expect("a string takes all");
        }
        text.push('\n');
    }
    text
}

/// The numbers of bodies and rotors by the names that expressions of base parameters give them.
///
/// # Panics
/// Never: the robot is one.
#[must_use]
pub fn numbers() -> BTreeMap<String, f64> {
    let chain = Chain::parse(SIX_AXES, &[]).expect("the robot is a chain");
    let mut numbers = BTreeMap::new();
    for (joint, rotor) in chain.joints.iter().zip(ROTOR) {
        let of_body =
            NAMES.iter().zip(joint.nominal).map(|((name, _), value)| (format!("{name}[{}]", joint.link), value));
        numbers.extend(of_body.chain([(format!("Ia[{}]", joint.name), rotor)]));
    }
    numbers
}

/// The value of an expression such as `Izz[a] - 0.25*m[b]`.
///
/// # Panics
/// Where a term is none.
#[must_use]
pub fn evaluate(expression: &str, numbers: &BTreeMap<String, f64>) -> f64 {
    let signed = expression.replace(" - ", " + -");
    let term = |term: &str| {
        let (sign, term) = term.strip_prefix('-').map_or((1.0, term), |rest| (-1.0, rest));
        let (factor, name) = term.split_once('*').unwrap_or(("1", term));
        sign * factor.parse::<f64>().expect("a factor is a number") * numbers[name]
    };
    signed.split(" + ").map(term).sum()
}
