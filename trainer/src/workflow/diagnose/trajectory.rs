//! A planned motion as a file to run.

use crate::diagnose::advice::Plan;
use crate::numerics::derivatives::{first_derivative, second_derivative};
use std::fmt::Write;

/// The motion as CSV: time, position, velocity, acceleration, and the load torque where a payload is asked for. A
/// rest is the step of time behind the first row, over which the position is held.
pub(super) fn to_csv(plan: &Plan, rotary: bool) -> String {
    let all = [0..plan.position.len()];
    let velocity = first_derivative(&plan.position, &all, plan.period);
    let acceleration = second_derivative(&plan.position, &all, plan.period);
    let header = match (rotary, plan.load.is_some()) {
        (true, false) => "time_s,position_rad,velocity_rad_s,acceleration_rad_s2",
        (true, true) => "time_s,position_rad,velocity_rad_s,acceleration_rad_s2,load_torque_Nm",
        (false, false) => "time_s,position_m,velocity_m_s,acceleration_m_s2",
        (false, true) => "time_s,position_m,velocity_m_s,acceleration_m_s2,load_torque_N",
    };
    let mut text = format!("{header}\n");
    for (k, position) in plan.position.iter().enumerate() {
        let rest = if k > 0 { plan.rest_before_s } else { 0.0 };
        let time = rest + k as f64 * plan.period;
        // Writing to a string cannot fail.
        let _ = write!(text, "{time:.6},{position:.9},{:.6},{:.6}", velocity[k], acceleration[k]);
        let _ = match &plan.load {
            Some(load) => writeln!(text, ",{:.6}", load[k]),
            None => writeln!(text),
        };
    }
    text
}
