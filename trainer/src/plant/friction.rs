//! The friction of the nominal joint: `[plant.friction]` of joint.toml. Every key is optional.

use serde::{Deserialize, Serialize};

/// Coulomb, viscous and Stribeck friction of the nominal joint, and what it has of the torques at its gear; torque has the sign of the velocity.
///
/// The friction of a torque `motor` of the actuator and one `external` of gravity is `|load_friction_external external - load_friction_motor
/// motor|`, and as much of the shares called `_stribeck`, which decline over speed as the Stribeck torque does (Duclusaud et al. 2024). Both
/// torques count along the positive direction: those of a joint that holds its payload oppose each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Friction {
    /// Coulomb torque, N m (>= 0).
    #[serde(rename = "coulomb_torque_Nm")]
    pub coulomb_torque_nm: f64,
    /// Viscous coefficient, N m s/rad (>= 0).
    #[serde(rename = "viscous_Nm_s_rad")]
    pub viscous_nm_s_rad: f64,
    /// Torque above Coulomb at rest, N m; 0 switches the Stribeck effect off.
    #[serde(rename = "stribeck_torque_Nm")]
    pub stribeck_torque_nm: f64,
    /// Stribeck velocity, rad/s (> 0).
    pub stribeck_velocity_rad_s: f64,
    /// Exponent of the decline of that torque over speed (> 0): 1 exponential, 2 Gaussian.
    pub stribeck_exponent: f64,
    /// Stiffness of the contact before it slips, N m/rad; 0 for a contact that does not yield.
    #[serde(rename = "contact_stiffness_Nm_rad")]
    pub contact_stiffness_nm_rad: f64,
    /// Friction of the actuator's torque, N m for each N m (>= 0).
    pub load_friction_motor: f64,
    /// Friction of the torque of gravity, N m for each N m (>= 0).
    pub load_friction_external: f64,
    /// What the first is more at rest (>= 0).
    pub load_friction_motor_stribeck: f64,
    /// What the second is more at rest (>= 0).
    pub load_friction_external_stribeck: f64,
}

impl Default for Friction {
    fn default() -> Self {
        Self {
            coulomb_torque_nm: 2.0,
            viscous_nm_s_rad: 1.2,
            stribeck_torque_nm: 0.0,
            stribeck_velocity_rad_s: 0.05,
            stribeck_exponent: 1.0,
            contact_stiffness_nm_rad: 0.0,
            load_friction_motor: 0.0,
            load_friction_external: 0.0,
            load_friction_motor_stribeck: 0.0,
            load_friction_external_stribeck: 0.0,
        }
    }
}

impl Friction {
    /// Dry level at a speed without torques at the gear, N m: Coulomb plus Stribeck (Tustin 1947; Bo & Pavelescu 1982 for the exponent).
    pub(crate) fn dry_level(&self, speed: f64) -> f64 {
        if self.stribeck_torque_nm == 0.0 {
            return self.coulomb_torque_nm;
        }
        self.coulomb_torque_nm + self.stribeck_torque_nm * self.decline(speed)
    }

    /// Dry level at a speed that the torques of actuator and gravity add, N m.
    pub(crate) fn load_level(&self, speed: f64, motor: f64, external: f64) -> f64 {
        if !self.reads_load() {
            return 0.0;
        }
        let of = |outside: f64, inside: f64| (outside * external - inside * motor).abs();
        let at_rest = of(self.load_friction_external_stribeck, self.load_friction_motor_stribeck);
        let sliding = of(self.load_friction_external, self.load_friction_motor);
        if at_rest == 0.0 { sliding } else { sliding + at_rest * self.decline(speed) }
    }

    /// Dry level at a speed of a joint whose actuator holds a torque of gravity, N m.
    pub(crate) fn holding_level(&self, speed: f64, gravity: f64) -> f64 {
        self.dry_level(speed) + self.load_level(speed, gravity, -gravity)
    }

    /// Whether it depends on the torques at the gear.
    pub(crate) fn reads_load(&self) -> bool {
        self.load_shares().into_iter().any(|(_, share)| share != 0.0)
    }

    /// The shares of the torques, by their keys.
    pub(crate) fn load_shares(&self) -> [(&'static str, f64); 4] {
        [
            ("friction.load_friction_motor", self.load_friction_motor),
            ("friction.load_friction_external", self.load_friction_external),
            ("friction.load_friction_motor_stribeck", self.load_friction_motor_stribeck),
            ("friction.load_friction_external_stribeck", self.load_friction_external_stribeck),
        ]
    }

    fn decline(&self, speed: f64) -> f64 {
        (-(speed / self.stribeck_velocity_rad_s).powf(self.stribeck_exponent)).exp()
    }
}
