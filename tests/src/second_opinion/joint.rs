//! The joints and axes of the suite: rotary ones from a small servo to a large axis, and driven screws.
//!
//! Rotary ones count in rad, N m and kg m2, linear ones in m, N and kg.

use super::random::Random;

/// A joint with Coulomb and viscous friction, inertia and a weight.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// What it is called on the page.
    pub name: &'static str,
    /// Whether it counts in m and N.
    pub linear: bool,
    /// Coulomb friction, N m or N.
    pub coulomb: f64,
    /// Viscous friction, N m s/rad or N s/m.
    pub viscous: f64,
    /// Break-away above Coulomb friction, N m or N.
    pub stribeck: f64,
    /// Stribeck velocity, rad/s or m/s.
    pub stribeck_speed: f64,
    /// Speed at which the sign of the velocity is smooth, rad/s or m/s.
    pub sign_width: f64,
    /// Inertia or mass.
    pub inertia: f64,
    /// Greatest torque of the weight, N m.
    pub gravity: f64,
    /// Angle by which the weight is ahead of the position, rad.
    pub gravity_phase_rad: f64,
    /// Greatest speed, rad/s or m/s.
    pub top_speed: f64,
    /// Greatest distance from the middle, rad or m.
    pub reach: f64,
    /// Step of the encoder, rad or m.
    pub encoder_step: f64,
}

const TURN: f64 = std::f64::consts::TAU;

/// A servo of a hand's size.
pub const SERVO: Joint = joint("servo", false, [0.05, 0.008], [4e-4, 0.08], 5.0, 5.0, 0.003, TURN / 65_536.0);
/// The joint of a light robot.
pub const ROBOT: Joint = joint("robot joint", false, [3.0, 2.0], [1.2, 12.0], 1.5, 1.5, 0.003, TURN / 524_288.0);
/// The main axis of a large robot.
pub const LARGE: Joint = joint("large axis", false, [60.0, 35.0], [40.0, 200.0], 1.2, 1.2, 0.003, TURN / 1_048_576.0);
/// An axis driven by a screw.
pub const LINEAR: Joint = joint("linear axis", true, [25.0, 40.0], [12.0, 0.0], 0.5, 0.5, 0.003, 1e-6);

/// The same kinds again with other constants, for faults and mixtures.
pub const SERVO_2: Joint = joint("servo", false, [0.05, 0.012], [4e-4, 0.04], 5.0, 1.6, 0.004, TURN / 262_144.0);
/// The joint of a light robot, for faults and mixtures.
pub const ROBOT_2: Joint = joint("robot joint", false, [3.0, 1.6], [0.6, 9.0], 2.0, 1.4, 0.004, TURN / 262_144.0);
/// The main axis of a large robot, for faults and mixtures.
pub const LARGE_2: Joint = joint("large axis", false, [60.0, 35.0], [18.0, 150.0], 1.6, 1.2, 0.004, TURN / 262_144.0);
/// An axis driven by a screw, for faults and mixtures.
pub const LINEAR_2: Joint = joint("linear axis", true, [22.0, 50.0], [14.0, 0.0], 0.7, 0.3, 0.004, 1e-6);

#[allow(clippy::too_many_arguments, reason = "a table of constants, one line a joint")]
const fn joint(
    name: &'static str,
    linear: bool,
    [coulomb, viscous]: [f64; 2],
    [inertia, gravity]: [f64; 2],
    top_speed: f64,
    reach: f64,
    sign_width: f64,
    encoder_step: f64,
) -> Joint {
    Joint {
        name,
        linear,
        coulomb,
        viscous,
        stribeck: 0.0,
        stribeck_speed: 1.0,
        sign_width: sign_width * top_speed,
        inertia,
        gravity,
        gravity_phase_rad: 0.2,
        top_speed,
        reach,
        encoder_step,
    }
}

impl Joint {
    /// The joint with its weight at an angle of its own.
    #[must_use]
    pub fn drawn(self, random: &mut Random) -> Self {
        Self { gravity_phase_rad: self.gravity_phase_rad + random.uniform(-0.5, 0.5), ..self }
    }

    /// Sign of a velocity, smooth about zero.
    #[must_use]
    pub fn sign(&self, velocity: f64) -> f64 {
        (velocity / self.sign_width).tanh()
    }

    /// Coulomb friction, break-away and viscous friction, N m or N.
    #[must_use]
    pub fn friction(&self, velocity: f64) -> f64 {
        self.dry(velocity) * self.sign(velocity) + self.viscous * velocity
    }

    /// Coulomb friction and break-away at a speed, N m or N.
    #[must_use]
    pub fn dry(&self, velocity: f64) -> f64 {
        self.coulomb + self.stribeck * (-(velocity / self.stribeck_speed).powi(2)).exp()
    }

    /// Torque of the weight, N m.
    #[must_use]
    pub fn weight(&self, position: f64) -> f64 {
        self.gravity * (position + self.gravity_phase_rad).sin()
    }

    /// Torque of inertia and weight, N m or N.
    #[must_use]
    pub fn rigid_body(&self, position: f64, acceleration: f64) -> f64 {
        self.inertia * acceleration + self.weight(position)
    }

    /// The unit of its position as column names write it.
    #[must_use]
    pub const fn unit(&self) -> &'static str {
        if self.linear { "m" } else { "rad" }
    }

    /// The column of its torque or force.
    #[must_use]
    pub const fn actuator(&self) -> &'static str {
        if self.linear { "force_N" } else { "torque_Nm" }
    }

    /// A position as the encoder reads it.
    #[must_use]
    pub fn read(&self, position: f64) -> f64 {
        (position / self.encoder_step).round() * self.encoder_step
    }

    /// A joint file with its rigid body; without for linear axes, of which the column tells it.
    #[must_use]
    pub fn file(&self) -> String {
        let name = format!("name = \"{}\"\n", self.name);
        if self.linear {
            return name;
        }
        let Self { inertia, gravity, gravity_phase_rad, .. } = self;
        format!(
            "{name}[rigid_body]\ninertia_kgm2 = {inertia:?}\ngravity_torque_Nm = {gravity:?}\ngravity_phase_rad = {gravity_phase_rad:?}\n"
        )
    }
}
