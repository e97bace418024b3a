//! Structures without a name, several effects at once, and comparisons with simulations and models.

mod added;
mod pairs;
mod references;
mod unnamed;

use super::Case;
use super::joint::{Joint, LARGE_2, LINEAR_2, ROBOT_2, SERVO_2};
use super::motion::Plan;
use super::protocol::Protocol;

const LINES: Plan = Plan::Lines { times: 1.0 };

/// How they are recorded; cases name one by its place.
const PROTOCOLS: [Protocol; 8] = [
    protocol(ROBOT_2, LINES, [500.0, 24.0], 2.0, 0.0),
    protocol(LINEAR_2, Plan::PointToPoint, [500.0, 24.0], 2.0, 0.0),
    protocol(ROBOT_2, Plan::PointToPoint, [1000.0, 15.0], 0.3, 0.7),
    protocol(SERVO_2, LINES, [500.0, 30.0], 5.0, 0.0),
    protocol(ROBOT_2, LINES, [250.0, 60.0], 2.0, 0.6),
    protocol(SERVO_2, Plan::PointToPoint, [500.0, 24.0], 2.0, 0.0),
    protocol(LARGE_2, LINES, [250.0, 60.0], 2.0, 0.0),
    protocol(ROBOT_2, Plan::PointToPoint, [250.0, 60.0], 2.0, 0.0),
];

const fn protocol(
    joint: Joint,
    plan: Plan,
    [rate_hz, duration_s]: [f64; 2],
    noise_percent: f64,
    correlation: f64,
) -> Protocol {
    Protocol { joint, plan, rate_hz, duration_s, noise_percent, correlation }
}

/// All of them.
#[must_use]
pub fn cases() -> Vec<Case> {
    let mut cases = unnamed::cases();
    cases.extend(pairs::cases());
    cases.extend(references::cases());
    cases
}
