//! What a simulated joint is made of: the `[plant]` section of `joint.toml`. Every key is optional.

use crate::actuator::Actuator;
use crate::plant::friction::Friction;
use crate::plant::trajectory::campaign::Campaign;
use serde::{Deserialize, Serialize};

/// A joint, its drive, its sensors and what is hidden in it.
///
/// SI units on the joint side. The nominal law is
/// `torque = inertia * acceleration + gravity_torque * sin(position + gravity_phase) + friction(velocity)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Joint {
    /// Total inertia at the joint, rotor included, kg m2 (> 0).
    pub inertia_kgm2: f64,
    /// Share of the inertia on the motor side of the gear, (0, 1); matters to compliant transmissions only.
    pub motor_inertia_share: f64,
    /// Amplitudes of the gravity torque, N m, one a payload; trajectories take them in turn unless they say otherwise.
    #[serde(rename = "gravity_torque_Nm")]
    pub gravity_torque_nm: Vec<f64>,
    /// Phase of the gravity torque, rad.
    pub gravity_phase_rad: f64,
    /// The velocity-only friction law.
    pub friction: Friction,
    /// The position controller.
    pub control: Control,
    /// Sampling, encoder and torque signal.
    pub drive: Drive,
    /// Noise of the torque signal and vibration of the base.
    pub noise: Noise,
    /// Temperature of the housing and its sensor.
    pub thermal: Thermal,
    /// What the `load_torque_Nm` column carries.
    pub load_channel: LoadChannel,
    /// The neighbouring joint that may couple into this one.
    pub other_joint: OtherJoint,
    /// Adds `link_position_rad`: a second encoder on the link side.
    pub link_encoder: bool,
    /// Which motions are recorded.
    pub campaign: Campaign,
    /// What the nominal law leaves out.
    pub effects: Vec<Hidden>,
    /// The actuator of a joint that reports no torque: what stands under `[actuator]` of joint.toml.
    #[serde(skip)]
    pub actuator: Option<Actuator>,
}

/// Proportional-derivative position control with feed-forward of the nominal law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Control {
    /// Closed-loop bandwidth, Hz (> 0).
    #[serde(rename = "bandwidth_Hz")]
    pub bandwidth_hz: f64,
    /// Damping ratio of the closed loop (> 0).
    pub damping_ratio: f64,
    /// Corner of the low-pass behind the differentiated encoder, Hz (> 0).
    #[serde(rename = "velocity_corner_Hz")]
    pub velocity_corner_hz: f64,
    /// Share of the nominal rigid-body torque and friction that is fed forward, [0, 1].
    pub feed_forward: f64,
}

/// Sampling, encoder and torque signal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Drive {
    /// Sample rate of control and recording, Hz (> 0).
    #[serde(rename = "rate_Hz")]
    pub rate_hz: f64,
    /// Integration steps within one sample (>= 1).
    pub steps_per_sample: usize,
    /// Encoder counts a joint turn (> 0).
    pub counts_per_turn: f64,
    /// Step of the torque signal, N m; 0 for none.
    #[serde(rename = "torque_resolution_Nm")]
    pub torque_resolution_nm: f64,
    /// Largest torque of the drive, N m; 0 for no limit.
    #[serde(rename = "torque_limit_Nm")]
    pub torque_limit_nm: f64,
    /// Gear ratio: rotor turns a joint turn (> 0).
    pub gear_ratio: f64,
}

/// Which noise the torque signal carries: the five kinds of control recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseKind {
    /// White only, of the total standard deviation.
    White,
    /// White plus slow coloured noise.
    Coloured,
    /// Coloured, with a standard deviation that grows with speed and acceleration.
    StateDependent,
    /// Coloured, with a 17-bit joint-side encoder.
    CoarseEncoder,
    /// Coloured, on a base that vibrates.
    FlexibleBase,
}

impl NoiseKind {
    /// All five kinds.
    pub const ALL: [Self; 5] =
        [Self::White, Self::Coloured, Self::StateDependent, Self::CoarseEncoder, Self::FlexibleBase];

    /// Its name in `[plant.noise]`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::Coloured => "coloured",
            Self::StateDependent => "state_dependent",
            Self::CoarseEncoder => "coarse_encoder",
            Self::FlexibleBase => "flexible_base",
        }
    }
}

/// Noise of the torque signal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Noise {
    /// Kind of noise.
    pub kind: NoiseKind,
    /// Standard deviation of the white part at the sample rate, N m.
    #[serde(rename = "white_torque_Nm")]
    pub white_torque_nm: f64,
    /// Standard deviation of the coloured part, N m.
    #[serde(rename = "coloured_torque_Nm")]
    pub coloured_torque_nm: f64,
    /// Correlation time of the coloured part, s (> 0).
    pub correlation_time_s: f64,
    /// The vibrating base of [`NoiseKind::FlexibleBase`].
    pub base: Base,
}

/// A base that vibrates under the joint: the encoder sees the joint against the base, inertia moves in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Base {
    /// Natural frequency, Hz (> 0).
    #[serde(rename = "frequency_Hz")]
    pub frequency_hz: f64,
    /// Damping ratio (> 0).
    pub damping_ratio: f64,
    /// Standard deviation of the inertial torque that floor vibration causes, N m.
    #[serde(rename = "vibration_torque_Nm")]
    pub vibration_torque_nm: f64,
    /// Inertia of the base over that of the joint; the reaction torque excites the base through it. 0: no reaction.
    pub inertia_ratio: f64,
}

/// First-order thermal model of the housing: `time_constant * dT/dt = ambient + rise * power - T`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Thermal {
    /// Whether `temperature_C` is recorded.
    pub sensor: bool,
    /// Ambient and initial temperature, degC.
    #[serde(rename = "ambient_C")]
    pub ambient_c: f64,
    /// Steady rise a watt of friction and motor loss, K/W.
    #[serde(rename = "rise_K_W")]
    pub rise_k_w: f64,
    /// Steady rise from everything else that is switched on, K.
    #[serde(rename = "idle_rise_K")]
    pub idle_rise_k: f64,
    /// Time constant, s (> 0).
    pub time_constant_s: f64,
    /// Standard deviation of the sensor noise, K.
    #[serde(rename = "sensor_noise_K")]
    pub sensor_noise_k: f64,
    /// Step of the sensor, K; 0 for none.
    #[serde(rename = "sensor_resolution_K")]
    pub sensor_resolution_k: f64,
}

/// What the `load_torque_Nm` column carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadChannel {
    /// The nominal gravity torque of the payload at the measured position: what a drive computes. It contains no
    /// gravity error, so that `torque = inertia * acceleration + load_torque + friction` is the nominal law.
    NominalGravity,
    /// No such column.
    None,
}

/// A neighbouring joint that moves on its own: `other_position_rad`, `other_velocity_rad_s`, `other_acceleration_rad_s2`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OtherJoint {
    /// Whether it exists and is recorded.
    pub recorded: bool,
    /// Amplitude of its multisine, rad.
    pub amplitude_rad: f64,
    /// Highest frequency of its multisine, Hz.
    #[serde(rename = "highest_Hz")]
    pub highest_hz: f64,
}

/// An effect to hide in the joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hidden {
    /// Name in [`CATALOGUE`](super::CATALOGUE) or [`OUTSIDE`](super::OUTSIDE).
    pub name: String,
    /// Multiplier of the drawn effect; 1 is a plausible strength, 0 is none.
    pub amplitude: f64,
}

impl Default for Joint {
    fn default() -> Self {
        Self {
            inertia_kgm2: 0.5,
            motor_inertia_share: 0.6,
            gravity_torque_nm: vec![4.0, 6.0, 8.0],
            gravity_phase_rad: 0.0,
            friction: Friction::default(),
            control: Control::default(),
            drive: Drive::default(),
            noise: Noise::default(),
            thermal: Thermal::default(),
            load_channel: LoadChannel::NominalGravity,
            other_joint: OtherJoint::default(),
            link_encoder: false,
            campaign: Campaign::default(),
            effects: Vec::new(),
            actuator: None,
        }
    }
}

impl Default for Control {
    fn default() -> Self {
        Self { bandwidth_hz: 8.0, damping_ratio: 0.8, velocity_corner_hz: 120.0, feed_forward: 1.0 }
    }
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            rate_hz: 1000.0,
            steps_per_sample: 4,
            counts_per_turn: 2_097_152.0,
            torque_resolution_nm: 0.01,
            torque_limit_nm: 0.0,
            gear_ratio: 30.0,
        }
    }
}

impl Default for Noise {
    fn default() -> Self {
        Self {
            kind: NoiseKind::Coloured,
            white_torque_nm: 0.37,
            coloured_torque_nm: 0.06,
            correlation_time_s: 0.076,
            base: Base::default(),
        }
    }
}

impl Default for Base {
    fn default() -> Self {
        Self { frequency_hz: 14.0, damping_ratio: 0.05, vibration_torque_nm: 0.1, inertia_ratio: 0.0 }
    }
}

impl Default for Thermal {
    fn default() -> Self {
        Self {
            sensor: true,
            ambient_c: 25.0,
            rise_k_w: 2.5,
            idle_rise_k: 4.0,
            time_constant_s: 60.0,
            sensor_noise_k: 0.05,
            sensor_resolution_k: 0.1,
        }
    }
}

impl Default for OtherJoint {
    fn default() -> Self {
        Self { recorded: true, amplitude_rad: 0.8, highest_hz: 1.1 }
    }
}
