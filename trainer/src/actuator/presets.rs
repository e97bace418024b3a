//! Common actuators by their published figures. A preset is where identification starts and within which bounds it stays, no truth:
//! data sheets round, and units of one type differ.

use super::constants::{Constant, Known};
use super::kind::Kind;

/// An actuator that can be bought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Its name in joint.toml; capitals do not matter there.
    pub name: &'static str,
    /// What it is.
    pub kind: Kind,
    /// What is known of it.
    pub constants: &'static [(Constant, Known)],
    /// Where the figures are from.
    pub source: &'static str,
}

impl Preset {
    /// The preset of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name.eq_ignore_ascii_case(name))
    }
}

/// A constant that a data sheet gives, and that may differ from it by half or twice in a unit.
const fn about(value: f64) -> Known {
    Known::Between(value / 2.0, value * 2.0)
}

/// Torque constant and resistance of a servo from its stall at a voltage: torque in N m, current in A.
const fn stall(torque: f64, voltage: f64, current: f64) -> [(Constant, Known); 2] {
    [(Constant::TorqueConstant, about(torque / current)), (Constant::Resistance, about(voltage / current))]
}

const XL330: [(Constant, Known); 2] = stall(0.52, 5.0, 1.47);
/// Stall gives 0.35 N m/A and 6.7 ohm; BAM looks for up to 1.5 N m/A and 40 ohm.
const XL320: [(Constant, Known); 2] =
    [(Constant::TorqueConstant, Known::Between(0.18, 1.5)), (Constant::Resistance, Known::Between(3.4, 40.0))];
const MX64: [(Constant, Known); 2] = stall(6.0, 12.0, 4.1);
const MX106: [(Constant, Known); 2] = stall(8.4, 12.0, 5.2);
const XM430: [(Constant, Known); 2] = stall(4.1, 12.0, 2.3);
/// 8 kgf cm/A by the data sheet, as BAM quotes it, whose bounds these are: variants of the servo are for 7.4 and for 12 V.
const STS3215: [(Constant, Known); 2] =
    [(Constant::TorqueConstant, Known::Between(0.25, 2.5)), (Constant::Resistance, Known::Between(0.4, 10.0))];

/// Position counts per rad of an encoder of 12 bit.
const COUNTS_PER_RAD: f64 = 4096.0 / std::f64::consts::TAU;

/// Every preset.
pub static PRESETS: [Preset; 10] = [
    Preset {
        name: "XL330",
        kind: Kind::PositionServo,
        constants: &[
            XL330[0],
            XL330[1],
            (Constant::FirmwareErrorGain, Known::Given(COUNTS_PER_RAD / (256.0 * 885.0))),
            (Constant::DutyLimit, Known::Given(1.0)),
        ],
        source: "emanual.robotis.com/docs/en/dxl/x/xl330-m288: stall 0.52 N m and 1.47 A at 5 V, PWM limit 885; duty per error as in github.com/Rhoban/bam, bam/xl330/actuator.py (0.00246 a rad there, measured)",
    },
    Preset {
        name: "XL320",
        kind: Kind::PositionServo,
        constants: &[
            XL320[0],
            XL320[1],
            (Constant::FirmwareErrorGain, Known::Given(0.050_48)),
            (Constant::DutyLimit, Known::Given(1.0)),
        ],
        source: "emanual.robotis.com/docs/en/dxl/x/xl320: stall 0.39 N m and 1.1 A at 7.4 V; duty per error by oscilloscope and bounds: github.com/Rhoban/bam, bam/dynamixel/actuator.py",
    },
    Preset {
        name: "MX-64",
        kind: Kind::PositionServo,
        constants: &[
            MX64[0],
            MX64[1],
            (Constant::FirmwareErrorGain, Known::Given(0.158)),
            (Constant::DutyLimit, Known::Given(0.9625)),
        ],
        source: "emanual.robotis.com/docs/en/dxl/mx/mx-64: stall 6.0 N m and 4.1 A at 12 V; duty per error and its limit by oscilloscope: github.com/Rhoban/bam, bam/dynamixel/actuator.py",
    },
    Preset {
        name: "MX-106",
        kind: Kind::PositionServo,
        constants: &[
            MX106[0],
            MX106[1],
            (Constant::FirmwareErrorGain, Known::Given(0.158)),
            (Constant::DutyLimit, Known::Given(0.9625)),
        ],
        source: "emanual.robotis.com/docs/en/dxl/mx/mx-106: stall 8.4 N m and 5.2 A at 12 V; duty per error and its limit by oscilloscope: github.com/Rhoban/bam, bam/dynamixel/actuator.py",
    },
    Preset {
        name: "XM430",
        kind: Kind::PositionServo,
        constants: &[XM430[0], XM430[1], (Constant::DutyLimit, Known::Given(1.0))],
        source: "emanual.robotis.com/docs/en/dxl/x/xm430-w350: stall 4.1 N m and 2.3 A at 12 V; the duty per position error is not among its figures",
    },
    Preset {
        name: "STS3215",
        kind: Kind::PositionServo,
        constants: &[
            STS3215[0],
            STS3215[1],
            (Constant::FirmwareErrorGain, Known::Given(0.166)),
            (Constant::DutyLimit, Known::Given(0.97)),
        ],
        source: "github.com/Rhoban/bam, bam/feetech/actuator.py: 8 kgf cm/A by the data sheet, duty per error and its limit by oscilloscope, bounds of the constants",
    },
    Preset {
        name: "HLS2915",
        kind: Kind::Current,
        constants: &[(Constant::TorqueConstant, Known::Between(0.5, 1.6))],
        source: "github.com/Rhoban/bam, bam/feetech_hls/actuator.py: stall 14.2 kgf cm and 1.5 A by the data sheet, bounds of the constant; in constant-current mode",
    },
    Preset {
        name: "Go1",
        kind: Kind::Pd,
        constants: &[(Constant::Kp, about(20.0)), (Constant::Kd, about(0.5))],
        source: "github.com/Improbable-AI/walk-these-ways, go1_gym/envs/go1/go1_config.py (Margolis & Agrawal 2022): 20 N m/rad, 0.5 N m s/rad",
    },
    Preset {
        name: "Go2",
        kind: Kind::Pd,
        constants: &[(Constant::Kp, about(20.0)), (Constant::Kd, about(0.5))],
        source: "github.com/unitreerobotics/unitree_rl_gym, legged_gym/envs/go2/go2_config.py: 20 N m/rad, 0.5 N m s/rad",
    },
    Preset {
        name: "Damiao",
        kind: Kind::Pd,
        constants: &[(Constant::Kp, Known::Between(0.0, 500.0)), (Constant::Kd, Known::Between(0.0, 5.0))],
        source: "MIT mode of Damiao's DM-J motors, as drivers of the DM4310 define it (KP_MAX 500, KD_MAX 5): 0 to 500 N m/rad, 0 to 5 N m s/rad",
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_has_a_source_and_only_constants_of_its_kind() {
        for preset in &PRESETS {
            assert!(!preset.source.is_empty());
            for (constant, known) in preset.constants {
                assert!(preset.kind.constants().contains(constant), "{} {constant:?}", preset.name);
                assert!(constant.allows(known.start()), "{} {constant:?}", preset.name);
            }
        }
        assert_eq!(Preset::named("xl330").map(|preset| preset.name), Some("XL330"));
    }
}
