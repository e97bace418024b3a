//! Limits, events, transmission and measurement: six recordings of each fault.

mod clock;
mod events;
mod measurement;
mod transmission;

use super::joint::{LARGE_2, LINEAR_2, ROBOT_2, SERVO_2};
use super::motion::Plan;
use super::protocol::Protocol;
use super::random::Random;
use super::recording::Material;
use super::{Case, Part};

/// Recordings of each fault.
const COUNT: usize = 6;

const LINES: Plan = Plan::Lines { times: 1.0 };

/// How the six are recorded.
const PROTOCOLS: [Protocol; COUNT] = [
    Protocol {
        joint: SERVO_2,
        plan: Plan::PointToPoint,
        rate_hz: 1000.0,
        duration_s: 12.0,
        noise_percent: 0.3,
        correlation: 0.0,
    },
    Protocol { joint: ROBOT_2, plan: LINES, rate_hz: 500.0, duration_s: 24.0, noise_percent: 2.0, correlation: 0.0 },
    Protocol {
        joint: LARGE_2,
        plan: Plan::Sweep,
        rate_hz: 250.0,
        duration_s: 40.0,
        noise_percent: 5.0,
        correlation: 0.8,
    },
    Protocol {
        joint: LINEAR_2,
        plan: Plan::PointToPoint,
        rate_hz: 500.0,
        duration_s: 24.0,
        noise_percent: 2.0,
        correlation: 0.0,
    },
    Protocol {
        joint: ROBOT_2,
        plan: Plan::PointToPoint,
        rate_hz: 1000.0,
        duration_s: 15.0,
        noise_percent: 0.3,
        correlation: 0.7,
    },
    Protocol {
        joint: SERVO_2,
        plan: Plan::Sweep,
        rate_hz: 100.0,
        duration_s: 60.0,
        noise_percent: 2.0,
        correlation: 0.0,
    },
];

/// Makes the recording of one of the six ways.
type Record = fn(usize, &Protocol, &mut Random) -> Material;

/// All of them, those of the clock last.
#[must_use]
pub fn cases() -> Vec<Case> {
    let faults: [(&'static str, Record); 10] = [
        ("saturation", events::saturation),
        ("contact", events::contact),
        ("transient_event", events::transient),
        ("recurrent_fault", events::recurrent),
        ("backlash", transmission::backlash),
        ("elasticity", transmission::elasticity),
        ("windup_hysteresis", transmission::windup),
        ("time_misalignment", measurement::late_torque),
        ("quantisation", measurement::coarse_torque),
        ("unit_or_sign", measurement::wrong_unit),
    ];
    let mut cases: Vec<Case> = faults
        .into_iter()
        .flat_map(|(name, record)| {
            (0..COUNT).map(move |way| {
                let make = move |random: &mut _| record(way, &PROTOCOLS[way], random);
                Case::new(format!("{name}-{}", way + 1), Part::Faults, vec![name], make)
            })
        })
        .collect();
    cases.extend(clock::cases(&PROTOCOLS));
    cases
}
