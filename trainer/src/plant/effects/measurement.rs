//! Faults of the measurement chain.

use super::mechanism::{Mechanism, Setting};
use crate::plant::measurement::sensors::SensorFault;
use crate::plant::random::Draws;

/// A current sensor that does not read zero at zero.
pub(super) fn torque_offset(draws: &mut Draws, setting: &Setting) -> Mechanism {
    Mechanism::Sensor(SensorFault::TorqueOffset(setting.amplitude * draws.signed("offset_Nm", 0.2, 0.5)))
}

/// The torque column early or late by more than a sample.
pub(super) fn time_misalignment(draws: &mut Draws, setting: &Setting) -> Mechanism {
    Mechanism::Sensor(SensorFault::TorqueDelay(setting.amplitude * draws.signed("delay_s", 0.004, 0.012)))
}

/// A log with fewer digits than the drive.
pub(super) fn quantisation(draws: &mut Draws, setting: &Setting) -> Mechanism {
    if draws.choice("of_torque", 2) == 0 {
        Mechanism::Sensor(SensorFault::PositionStep(
            setting.amplitude * draws.log_uniform("position_step_rad", 5e-4, 3e-3),
        ))
    } else {
        Mechanism::Sensor(SensorFault::TorqueStep(setting.amplitude * draws.log_uniform("torque_step_Nm", 0.5, 1.5)))
    }
}

/// A wrong sign or a wrong unit; an amplitude of 0 is none, any other is all of it.
pub(super) fn unit_or_sign(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let kind = draws.choice("torque_sign_position_sign_degrees_milli", 4);
    if setting.amplitude == 0.0 {
        return Mechanism::Sensor(SensorFault::TorqueFactor(1.0));
    }
    Mechanism::Sensor(match kind {
        0 => SensorFault::TorqueFactor(-1.0),
        1 => SensorFault::PositionFactor(-1.0),
        2 => SensorFault::PositionFactor(1.0_f64.to_degrees()),
        _ => SensorFault::TorqueFactor(1000.0),
    })
}

/// Samples that were never written; the amplitude multiplies the length of the gaps.
pub(super) fn clock_gaps(draws: &mut Draws, setting: &Setting) -> Mechanism {
    let count = 1 + draws.choice("gaps_less_one", 4);
    let gaps = (0..count)
        .map(|_| {
            let place = draws.uniform("place_share", 0.03, 0.95);
            (place, setting.amplitude * draws.log_uniform("length_s", 0.01, 0.4))
        })
        .collect();
    Mechanism::Sensor(SensorFault::LostSamples(gaps))
}
