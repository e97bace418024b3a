//! `[drive]` and `[limits]` of `joint.toml`.

use serde::Deserialize;

/// Parameters of the drive.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Motor torque per ampere, N m/A; above zero.
    #[serde(rename = "torque_constant_Nm_A")]
    pub torque_constant_nm_a: Option<f64>,
    /// Motor turns per joint turn; not zero.
    pub gear_ratio: Option<f64>,
    /// Encoder counts per turn of the shaft that carries the encoder; above zero.
    pub counts_per_turn: Option<f64>,
    /// Largest torque of the drive at the joint, N m; above zero.
    #[serde(rename = "torque_limit_Nm")]
    pub torque_limit_nm: Option<f64>,
    /// Rate of the control loop, Hz; above zero.
    #[serde(rename = "rate_Hz")]
    pub rate_hz: Option<f64>,
    /// Velocity of the joint that is one count where the drive calculates in integers, rad/s (m/s on a linear axis); above zero.
    #[serde(alias = "velocity_count_m_s")]
    pub velocity_count_rad_s: Option<f64>,
    /// Torque at the joint that is one count where the drive calculates in integers, N m (N, A, as the actuator column); above zero.
    #[serde(rename = "torque_count_Nm", alias = "torque_count_N", alias = "torque_count_A")]
    pub torque_count_nm: Option<f64>,
}

/// Limits within which the joint may be moved; what is absent is taken from a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Lowest position, rad (m on a linear axis).
    #[serde(alias = "lowest_position_m")]
    pub lowest_position_rad: Option<f64>,
    /// Highest position, rad (m).
    #[serde(alias = "highest_position_m")]
    pub highest_position_rad: Option<f64>,
    /// Largest speed, rad/s (m/s); from 1e-9 to 1e9.
    #[serde(alias = "velocity_m_s")]
    pub velocity_rad_s: Option<f64>,
    /// Largest acceleration, rad/s2 (m/s2); from 1e-9 to 1e9.
    #[serde(alias = "acceleration_m_s2")]
    pub acceleration_rad_s2: Option<f64>,
}

impl Drive {
    /// Joint torque per ampere of motor current, N m/A, when known.
    #[must_use]
    pub fn joint_torque_per_ampere(&self) -> Option<f64> {
        self.torque_constant_nm_a.map(|constant| constant * self.gear_ratio.unwrap_or(1.0))
    }
}
